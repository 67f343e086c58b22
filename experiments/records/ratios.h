// Ratios of a baseline to the other configurations: above 1 where the baseline needs more.
#pragma once

#include "experiments/config/experiment_config.h"
#include "experiments/records/configurations.h"
#include "experiments/records/curve.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace qtrace::experiments {

// A positive figure with its 95 % interval, where there is one.
struct Interval {
  double value = 0;
  std::optional<double> low;
  std::optional<double> high;
};

// above / below, with Welch's interval on the logarithms: the standard error of log m is s / (m sqrt(n))
// (delta method), the two add up as if they were independent, with the degrees of freedom of Welch and
// Satterthwaite. Where both sides use the same seeds they share camera rays, which can only make the interval
// too wide. Nothing unless both means are positive.
std::optional<Interval> ratio_of_means(const Estimate& above, const Estimate& below);

// exp of `log_value` with the interval that follows from leaving out one seed after the other (delete-one
// jackknife of two independent samples, Welch-Satterthwaite degrees): `log_above` and `log_below` hold
// log_value without each seed of either side. A side that is known exactly is empty.
Interval jackknife(double log_value, const std::vector<double>& log_above,
                   const std::vector<double>& log_below);

// From so many seeds on, the interval of a ratio that is read off two curves leaves out the same seed of
// both, where both have the same seeds: their runs took turns, so that a machine that drifts slows both
// alike. Right whatever the two share. With fewer, Student's t for so few differences takes back what that
// gains.
constexpr std::size_t kFewestPairedSeeds = 5;

// How long a configuration takes to reach an error, read off the mean curve of its seeds.
std::optional<Interval> time_to_error(const std::vector<Curve>& seeds, double target);

struct TimeToError {
  std::optional<double> target;  // the mean error of the baseline at its end
  std::optional<Interval>
      time;  // seconds of the configuration; empty if never reached, or before its first snapshot
  std::optional<Interval> ratio;  // the baseline's mean seconds / time; the target varies with the baseline
};

// One configuration against its baseline.
struct Ratios {
  std::string configuration;
  std::string baseline;
  std::string scene;
  std::map<std::string, Interval> figures;   // by column of configurations.csv
  std::map<std::string, TimeToError> times;  // by metric: those that are followed
  // By metric, those that are timed: errors after the same seconds, which are those of whichever ends first.
  std::map<std::string, std::optional<Interval>> equal_seconds;

  std::optional<Interval> figure(const std::string& column) const;  // nothing where one side has none
};

// Nothing where the experiment names no baseline. In the order of the configurations.
std::vector<Ratios> baseline_ratios(const Experiment& experiment,
                                    const std::vector<Configuration>& configurations);

}  // namespace qtrace::experiments
