#include "tests/independent/comparison.h"

#include "engine/gltf/load_gltf.h"
#include "experiments/images/environment_file.h"
#include "tests/independent/feature_rooms.h"
#include "tests/render/comparison.h"

#include <algorithm>
#include <cmath>

namespace qtrace::independent {

bool is_file(const std::string& scene) { return scene.find('/') != std::string::npos; }

namespace {

constexpr int kBounces = 5;
constexpr double kRounding = 1e-6;  // of an image in single precision, relative

double mean_of(const glm::dvec3& v) { return (v.x + v.y + v.z) / 3; }

// Of the mean over channels, which share their paths: standard deviations add up, where they are in step.
// Colours dampen all channels of a path in much the same way.
double variance_of(const glm::dvec3& v) {
  const double deviation = (std::sqrt(v.x) + std::sqrt(v.y) + std::sqrt(v.z)) / 3;
  return deviation * deviation;
}

EnvironmentMap shipped_sky() {
  return experiments::read_environment(std::string(QTRACE_SOURCE_DIR) + "/configs/scenes/sunlit_sky.hdr");
}

Scene load(const std::string& name) {
  if (is_file(name)) return load_gltf(name);
  if (std::ranges::count(kRooms, name) > 0) return feature_room(name);
  if (name == "glossy") return test::glossy_room();
  Scene scene = test::shipped(name.c_str());
  if (name == "sunlit_bath.glb") scene.environment = shipped_sky();
  return scene;
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
    : scene_(load(scene)), sky_(scene == "open_sky.glb" ? 1 : 0), size_(size), samples_(size.samples) {
  Options options;
  options.width = options.height = size.size;
  options.samples = size.samples;
  options.max_bounces = kBounces;
  options.environment = glm::dvec3(sky_);
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

RenderSettings Comparison::settings_of(Sampler sampler, Nee nee, RandomNumbers random,
                                       LightChoice lights) const {
  RenderSettings settings;
  settings.width = settings.height = size_.size;
  settings.max_bounces = kBounces;
  settings.sampler = sampler;
  settings.nee = nee;
  settings.seed = 77;
  settings.random = random;
  settings.lights = lights;
  settings.replicates = random == RandomNumbers::sobol ? 16 : 1;
  settings.rl.sites_per_object = 40;
  settings.environment = {sky_, sky_, sky_};
  return settings;
}

Agreement Comparison::measure(Sampler sampler, Nee nee, int frames, int most_frames, double precision,
                              const std::function<void(const Agreement&)>& watch, RandomNumbers random,
                              LightChoice lights) const {
  Tracer tracer(test::device(), scene_, settings_of(sampler, nee, random, lights));
  Agreement result;
  std::uint64_t non_finite = 0;
  do {
    const test::Rendering r = test::render(tracer, frames);
    non_finite += r.non_finite;
    result = compare(r.image);
    result.frames = static_cast<int>(tracer.frames());
    result.non_finite = non_finite;
    if (watch) watch(result);
  } while (result.mean_ratio_error > precision && result.frames + frames <= most_frames);
  return result;
}

Agreement Comparison::measure_light_paths(Sampler sampler, Nee nee, LightPaths paths, int frames,
                                          LightChoice lights) const {
  RenderSettings settings = settings_of(sampler, nee, RandomNumbers::independent, lights);
  settings.light_paths = paths;
  settings.light_path_trial = 0;
  std::vector<RadianceImage> images;
  std::uint64_t non_finite = 0;
  for (int i = 0; i < kSeeds; ++i, ++settings.seed) {
    const test::Rendering r = test::render(scene_, settings, frames);
    images.push_back(r.image);
    non_finite += r.non_finite;
  }
  Agreement result = compare(images);
  result.frames = kSeeds * frames;
  result.non_finite = non_finite;
  return result;
}

// The pixels of a learning sampler share a table, and their estimates are uncorrelated all the same: a frame
// samples by the table of the frames before, given which its pixels are independent, and unbiased. So
// variances of pixels add up, those of frames too, and a pixel's own samples tell its variance.
Agreement Comparison::compare(const RadianceImage& image) const {
  Agreement result;
  Difference difference;
  difference.scale = truth_.mean;
  double a = 0, b = 0, var_a = 0, var_b = 0;
  for (std::size_t i = 0; i < truth_.mean.size(); ++i) {
    difference.mean.push_back(image.mean[i] - truth_.mean[i]);
    difference.variance.push_back(image.variance[i] + truth_.variance[i]);
    if (edges_[i] != 0) continue;
    a += mean_of(image.mean[i]), b += mean_of(truth_.mean[i]);
    var_a += variance_of(image.variance[i]), var_b += variance_of(truth_.variance[i]);
  }
  result.pixels = pooled_chi2(difference, 1, kBlock);
  result.blocks = pooled_chi2(difference, kBlock, kBlocksInPool);
  result.mean_ratio = a / b;
  result.mean_ratio_error = result.mean_ratio * std::sqrt(var_a / (a * a) + var_b / (b * b)) + kRounding;
  return result;
}

namespace {

// Of several estimates of one thing.
struct Spread {
  glm::dvec3 sum{0}, squares{0};
  double count = 0;

  void add(const glm::dvec3& value) { sum += value, squares += value * value, ++count; }
  glm::dvec3 mean() const { return sum / count; }
  glm::dvec3 variance_of_mean() const {
    return glm::max(squares / count - mean() * mean(), 0.0) / (count - 1);
  }
};

// Means of blocks of kBlock x kBlock pixels.
std::vector<glm::dvec3> blocks_of(const std::vector<glm::dvec3>& pixels, int size) {
  const int row = size / kBlock;
  std::vector<glm::dvec3> blocks(static_cast<std::size_t>(row * row), glm::dvec3(0));
  for (int i = 0; i < size * size; ++i) {
    const int block = i / size / kBlock * row + i % size / kBlock;
    blocks[static_cast<std::size_t>(block)] += pixels[static_cast<std::size_t>(i)] / (1.0 * kBlock * kBlock);
  }
  return blocks;
}

}  // namespace

Agreement Comparison::compare(const std::vector<RadianceImage>& seeds) const {
  const auto size = static_cast<std::size_t>(size_.size) * static_cast<std::size_t>(size_.size);
  std::vector<Spread> pixels(size), blocks(size / (kBlock * kBlock));
  Spread whole;
  double truth = 0, variance_of_truth = 0;
  for (const RadianceImage& image : seeds) {
    for (std::size_t i = 0; i < size; ++i) pixels[i].add(image.mean[i]);
    const std::vector<glm::dvec3> of_image = blocks_of(image.mean, size_.size);
    for (std::size_t i = 0; i < of_image.size(); ++i) blocks[i].add(of_image[i]);
    double mean = 0;
    for (std::size_t i = 0; i < size; ++i) mean += edges_[i] == 0 ? mean_of(image.mean[i]) : 0;
    whole.add(glm::dvec3(mean));
  }
  Difference of_pixels, of_blocks;
  of_pixels.scale = truth_.mean;
  of_blocks.scale = blocks_of(truth_.mean, size_.size);
  for (std::size_t i = 0; i < size; ++i) {
    of_pixels.mean.push_back(pixels[i].mean() - truth_.mean[i]);
    of_pixels.variance.push_back(pixels[i].variance_of_mean() + truth_.variance[i]);
    if (edges_[i] != 0) continue;
    truth += mean_of(truth_.mean[i]), variance_of_truth += variance_of(truth_.variance[i]);
  }
  const std::vector<glm::dvec3> truth_variance = blocks_of(truth_.variance, size_.size);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    of_blocks.mean.push_back(blocks[i].mean() - of_blocks.scale[i]);
    of_blocks.variance.push_back(blocks[i].variance_of_mean() + truth_variance[i] / (1.0 * kBlock * kBlock));
  }
  Agreement result;
  result.pixels = pooled_chi2(of_pixels, 1, kBlock);
  result.blocks = pooled_chi2(of_blocks, 1, kBlocksInPool);
  const double mean = whole.mean().x, variance = whole.variance_of_mean().x;
  result.mean_ratio = mean / truth;
  result.mean_ratio_error =
      result.mean_ratio * std::sqrt(variance / (mean * mean) + variance_of_truth / (truth * truth)) +
      kRounding;
  return result;
}

}  // namespace qtrace::independent
