// A sweep: axes of values or of named groups of overrides, and the runs that are their product.
#pragma once

#include "experiments/config/config.h"
#include "experiments/files/json.h"

#include <functional>
#include <string>
#include <vector>

namespace qtrace::experiments {

struct AxisValue {
  std::string label;  // for tables: the group's name, the file name of a scene, else the value
  std::string slug;   // for file names; made of this value alone, so that other values do not change it
  Json overrides;     // object; keys may be dotted
};

struct Axis {
  std::string name;      // the key, or the label of named groups
  bool is_seed = false;  // runs that differ only here are repetitions of one configuration
  std::vector<AxisValue> values;
};

struct Sweep {
  std::vector<Axis> axes;
};

// [ {"key": [value, ...]}, {"label": {"name": {overrides}, ...}}, ... ]
template <>
struct KnobType<Sweep> {
  static std::string describe(const KnobInfo&);
  static void read(const Json& json, const KnobInfo& info, const std::string& path, Sweep& sweep);
  static Json write(const Sweep& sweep);
  static Json schema(const KnobInfo&);  // of "#/$defs/axis", see json_schema.h
};

// One point of a sweep before it is read: which values, and what they change of the base config.
struct SweepPoint {
  std::string id;                   // "scene=occluded,method=rl,seed=3"; "run" without axes
  std::string configuration;        // labels of all axes but the seed, joined by " / "
  std::vector<std::string> labels;  // one per axis
  Json overrides;
};

struct SweepLimits {
  double runs = 100'000;
  double text =
      128 * 1024 * 1024;  // bytes of the configs of all runs, which are read before the first begins
};

// Throws Error for more runs than `limits`, or more text: of `base` bytes, a config's, and the overrides.
void check_size(const Sweep& sweep, std::size_t base, const SweepLimits& limits);

// Hands on the product of the axes, the last one fastest. Throws Error for ids that are too long for a file
// name.
void expand_sweep(const Sweep& sweep, const std::function<void(const SweepPoint&)>& use);

// Lower-case letters, digits, '.', '_' and '-' of the text; everything else becomes a single '-'.
std::string slug(std::string_view text);

}  // namespace qtrace::experiments
