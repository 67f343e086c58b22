// How configs say what light comes from outside of a scene: the same from everywhere, or an image's.
#pragma once

#include "experiments/config/knob_type.h"

#include <array>
#include <optional>
#include <string>

namespace qtrace::experiments {

// Factors of the image's radiance: a number in configs where they are the same for all channels.
struct RadianceScale {
  std::array<double, 3> rgb{1, 1, 1};

  bool operator==(const RadianceScale&) const = default;
};

// An image in latitude and longitude, turned as EnvironmentMap::rotation says.
struct EnvironmentImage {
  std::string file;  // OpenEXR or Radiance RGBE, relative to the config
  RadianceScale scale;
  double rotation = 0;  // degrees

  bool operator==(const EnvironmentImage&) const = default;
};

// The value of the key 'environment': where there is an image, the constant is black.
struct EnvironmentKnob {
  std::array<double, 3>& constant;
  std::optional<EnvironmentImage>& image;
};

template <>
struct KnobType<RadianceScale> {
  static std::string describe(const KnobInfo&);
  static void read(const Json& json, const KnobInfo& info, const std::string& path, RadianceScale& scale);
  static Json write(const RadianceScale& scale);
  static Json schema(const KnobInfo&);
};

template <>
struct KnobType<EnvironmentKnob> {
  static std::string describe(const KnobInfo&);
  static void read(const Json& json, const KnobInfo& info, const std::string& path, EnvironmentKnob& knob);
  static Json write(const EnvironmentKnob& knob);
  static Json schema(const KnobInfo&);
};

Json environment_json(const EnvironmentImage& image);

}  // namespace qtrace::experiments
