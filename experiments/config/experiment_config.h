// A config file: a base config, a sweep over it, and the runs that follow from both.
#pragma once

#include "experiments/config/config.h"
#include "experiments/config/json_knobs.h"
#include "experiments/config/sweep.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace qtrace::experiments {

// Milliseconds per frame by configuration ("simple / RL").
struct PublishedTimes {
  std::vector<std::pair<std::string, double>> by_configuration;

  const double* find(const std::string& configuration) const;  // null where nothing was published
};

template <>
struct KnobType<PublishedTimes> {
  static std::string describe(const KnobInfo&);
  static void read(const Json& json, const KnobInfo& info, const std::string& path, PublishedTimes& times);
  static Json write(const PublishedTimes& times);
  static Json schema(const KnobInfo&);
};

// Figures of a publication that a table shows beside the measured ones.
struct Published {
  std::string source;
  std::string note;
  PublishedTimes ms_per_frame;
  std::array<std::string, 2> ratio;
};

template <class Visitor>
void visit_knobs(Visitor& visit, Published& published) {
  visit(KnobInfo{"source", "", "where the figures come from"}, published.source);
  visit(KnobInfo{"note", "", "one sentence on what is comparable; the table ends with it"}, published.note);
  visit(KnobInfo{"ms_per_frame", "ms", "published times by configuration: axis labels joined by ' / '"},
        published.ms_per_frame);
  visit(KnobInfo{"ratio", "", "two labels of one axis: the table shows first / second"}, published.ratio);
}

struct ExperimentKeys {
  RunConfig run;
  Sweep sweep;
  Published published;
  std::string baseline;
  std::string preset;
};

template <class Visitor>
void visit_knobs(Visitor& visit, ExperimentKeys& keys) {
  visit_knobs(visit, keys.run);
  visit(KnobInfo{"sweep", "",
                 "axes {\"key\": [values]} or {\"label\": {\"name\": {overrides}}}; runs are their product"},
        keys.sweep);
  visit(KnobInfo{"published", "", "figures of a publication for the table"}, keys.published);
  visit(
      KnobInfo{
          "baseline", "",
          "a label of one axis, or a configuration (axis labels joined by ' / '): ratios.csv compares with "
          "it every configuration that differs from it in one label alone; empty: no ratios"},
      keys.baseline);
  visit(KnobInfo{"preset", "",
                 "a file with settings of a run, relative to the config; what the config sets itself "
                 "overrides them"},
        keys.preset);
}

struct Run {
  std::string id;
  std::string configuration;
  std::vector<std::string> labels;  // one per axis
  RunConfig config;
};

struct Experiment {
  std::filesystem::path file;
  std::string name;
  Json config;  // as written, after --set
  std::vector<Axis> axes;
  std::vector<Run> runs;
  Published published;
  std::string baseline;
  std::vector<std::string> warnings;  // legal, but surely not meant

  std::filesystem::path folder() const { return file.parent_path(); }
  std::filesystem::path scene_file(const Run& run) const { return folder() / run.config.scene; }
  // With its file's place; nothing where the run has no image.
  std::optional<EnvironmentImage> environment_image(const Run& run) const;
  // Of what the run's reference shows.
  std::filesystem::path reference_file(const Run& run) const {
    return folder() / (run.config.reference.scene.empty() ? run.config.scene : run.config.reference.scene);
  }
};

// Reads and checks a config and all its runs. `sets` are "key=value": the value is JSON, or a text where
// it is not. They change the base config; a key that a sweep axis sets is an error, "sweep.AXIS=..."
// replaces that axis's values, "sweep=..." the whole sweep.
// Throws Error that names the file, the run where only one is concerned, and the key.
Experiment load_experiment(const std::filesystem::path& file, const std::vector<std::string>& sets = {});

// The same of a text in memory; `file` is what messages call it, and scenes are relative to its folder.
Experiment parse_experiment(const std::string& text, const std::filesystem::path& file,
                            const std::vector<std::string>& sets = {}, const SweepLimits& limits = {});

}  // namespace qtrace::experiments
