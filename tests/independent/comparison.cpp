#include "tests/independent/comparison.h"

#include "engine/scene/gltf.h"
#include "tests/render/comparison.h"

#include <fmt/format.h>
#include <boost/math/distributions/normal.hpp>

#include <cmath>

namespace qtrace::independent {
namespace {

constexpr int kBounces = 5;
constexpr double kNoNoise = 1e-5;   // standard error, relative
constexpr double kRounding = 1e-6;  // of an image in single precision, relative

double mean_of(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3; }

// Of the mean over channels, which share their paths: standard deviations add up, where they are in step.
// Colours dampen all channels of a path in much the same way.
double variance_of(const glm::dvec3& v) {
  const double deviation = (std::sqrt(v.x) + std::sqrt(v.y) + std::sqrt(v.z)) / 3;
  return deviation * deviation;
}

// Mean over the channels that are not the same whatever the path, where single precision is all that differs;
// -1 if there is none.
double channel_chi2(const glm::dvec3& difference, const glm::dvec3& variance, const glm::dvec3& truth) {
  double sum = 0, channels = 0;
  for (int k = 0; k < 3; ++k) {
    if (std::sqrt(variance[k]) < kNoNoise * truth[k] || variance[k] == 0) continue;
    sum += difference[k] * difference[k] / variance[k];
    ++channels;
  }
  return channels > 0 ? sum / channels : -1;
}

Scene load(const std::string& name) {
  return name == "glossy" ? test::glossy_room() : test::shipped(name.c_str());
}

// The mean of two images with as many samples each.
void average(Image& image, const Image& other) {
  for (std::size_t i = 0; i < image.mean.size(); ++i) {
    image.mean[i] = 0.5 * (image.mean[i] + other.mean[i]);
    image.variance[i] = 0.25 * (image.variance[i] + other.variance[i]);
  }
}

}  // namespace

Comparison::Comparison(const std::string& scene, Size size)
    : scene_(load(scene)), size_(size), samples_(size.samples) {
  Options options;
  options.width = options.height = size.size;
  options.samples = size.samples;
  options.max_bounces = kBounces;
  options.sample_lights = scene != "furnace.glb";  // its walls are lights, and meet
  edges_ = edges_of_lights(scene_, options);
  truth_ = trace(scene_, options);
  while (truth_error() > size_.precision * std::sqrt(0.5) && 2 * samples_ <= size_.most_samples) {
    options.samples = samples_;
    ++options.seed;
    average(truth_, trace(scene_, options));
    samples_ *= 2;
  }
}

double Comparison::truth_error() const {
  double sum = 0, variance = 0;
  for (std::size_t i = 0; i < truth_.mean.size(); ++i) {
    if (edges_[i] != 0) continue;
    sum += mean_of(truth_.mean[i]);
    variance += variance_of(truth_.variance[i]);
  }
  return std::sqrt(variance) / sum;
}

Agreement Comparison::measure(Sampler sampler, Nee nee, int frames, int most_frames, double precision) const {
  RenderSettings settings;
  settings.width = settings.height = size_.size;
  settings.max_bounces = kBounces;
  settings.sampler = sampler;
  settings.nee = nee;
  settings.seed = 77;
  settings.rl.sites_per_object = 40;
  Tracer tracer(test::device(), scene_, settings);
  Agreement result;
  std::uint64_t non_finite = 0;
  do {
    const test::Rendering r = test::render(tracer, frames);
    non_finite += r.non_finite;
    result = compare(r.image);
    result.frames = static_cast<int>(tracer.frames());
    result.non_finite = non_finite;
  } while (result.mean_ratio_error > precision && result.frames + frames <= most_frames);
  return result;
}

Agreement Comparison::compare(const RadianceImage& image) const {
  Agreement result;
  double chi2 = 0, chi4 = 0, a = 0, b = 0, var_a = 0, var_b = 0, counted = 0;
  for (std::size_t i = 0; i < truth_.mean.size(); ++i) {
    const double x = mean_of(image.mean[i]);
    const double y = mean_of(truth_.mean[i]);
    const double var_x = variance_of(image.variance[i]);
    const double var_y = variance_of(truth_.variance[i]);
    if (edges_[i] == 0) a += x, b += y, var_a += var_x, var_b += var_y;
    const double c =
        channel_chi2(image.mean[i] - truth_.mean[i], image.variance[i] + truth_.variance[i], truth_.mean[i]);
    if (c < 0) continue;
    chi2 += c, chi4 += c * c, ++counted;
  }
  result.mean_ratio = a / b;
  result.mean_ratio_error = result.mean_ratio * std::sqrt(var_a / (a * a) + var_b / (b * b)) + kRounding;
  result.chi2_per_pixel = counted == 0 ? 1 : chi2 / counted;
  result.chi2_error = counted == 0 ? 0 : std::sqrt((chi4 / counted - std::pow(chi2 / counted, 2)) / counted);
  return result;
}

bool Agreement::agrees(double chance) const {
  const double z = boost::math::quantile(boost::math::complement(boost::math::normal(), chance / 4));
  return std::abs(chi2_per_pixel - 1) <= z * chi2_error && std::abs(mean_ratio - 1) <= z * mean_ratio_error;
}

std::string Agreement::text() const {
  return fmt::format("chi2 per pixel {:.3f} +- {:.3f}, mean ratio {:.5f} +- {:.5f} after {} frames",
                     chi2_per_pixel, chi2_error, mean_ratio, mean_ratio_error, frames);
}

}  // namespace qtrace::independent
