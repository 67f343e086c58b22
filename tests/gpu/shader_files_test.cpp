// Every file of shaders/ compiles on its own: it includes what it uses, whatever its includers have included
// before.
#include "engine/gpu/driver.h"
#include "engine/gpu/embedded_shaders.h"
#include "engine/gpu/program.h"
#include "engine/tracer/shader_variant.h"
#include "tests/support/device.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace qtrace::test {
namespace {

struct Variant {
  std::string name;
  gpu::Defines defines;
};

gpu::SceneFeatures features(bool specular) {
  gpu::SceneFeatures result;
  result.lights = 3;
  result.specular = specular;
  return result;
}

RenderSettings guided(UpdateRule rule) {
  RenderSettings settings;
  settings.nee = Nee::one_ray;
  settings.lights = LightChoice::learned;
  settings.rl.update = rule;
  return settings;
}

RenderSettings with_light_paths(RenderSettings settings, LightPaths paths) {
  settings.light_paths = paths;
  return settings;
}

// A scene that has everything.
gpu::SceneFeatures everything() {
  gpu::SceneFeatures result = features(true);
  result.textures = (1U << kTextureSlots) - 1;
  result.tangents = result.colors = true;
  result.transmission = result.absorption = result.clearcoat = result.delta = true;
  result.unlit = result.alpha = result.punctual = true;
  result.sky = {4, 2};
  return result;
}

// One extension alone: what it needs, it must not have from another.
gpu::SceneFeatures with(bool gpu::SceneFeatures::*feature) {
  gpu::SceneFeatures result = features(true);
  result.*feature = true;
  return result;
}

// Each choice that leaves code out is made in one of them and not in another.
std::vector<Variant> variants() {
  RenderSettings plain;
  plain.sampler = Sampler::bsdf;
  RenderSettings two_ray = plain;
  two_ray.sampler = Sampler::uniform;
  two_ray.nee = Nee::two_ray;
  two_ray.bvh = BvhKind::threaded;
  RenderSettings sobol = plain;
  sobol.random = RandomNumbers::sobol;
  RenderSettings lights = plain;
  lights.nee = Nee::one_ray;
  lights.lights = LightChoice::learned;
  RenderSettings sarsa = guided(UpdateRule::sarsa);
  sarsa.nee = Nee::none;
  sarsa.environment = {1, 1, 1};
  sarsa.rl.cells = CellKind::grid;
  sarsa.rl.bin_map = BinMap::concentric;
  sarsa.rl.learning_rate = LearningRate::power;
  sarsa.rl.mixture = Mixture::fixed;
  sarsa.rl.bsdf_fraction = 0;
  sarsa.rl.shrinkage = 0;
  sarsa.rl.roulette = Roulette::throughput;
  sarsa.rl.initial_table = InitialTable::random;
  RenderSettings monte_carlo = guided(UpdateRule::monte_carlo);
  monte_carlo.rl.site_search = SiteSearch::linear;
  monte_carlo.rl.learning_rate = LearningRate::visits_per_cell;
  return {{"bsdf", shader_defines(plain, features(true))},
          {"sobol", shader_defines(sobol, features(true))},
          {"two_ray", shader_defines(two_ray, features(false))},
          {"learned lights", shader_defines(lights, features(true))},
          {"expected_sarsa", shader_defines(guided(UpdateRule::expected_sarsa), features(true))},
          {"sarsa", shader_defines(sarsa, features(false))},
          {"monte_carlo", shader_defines(monte_carlo, features(false))},
          {"everything", shader_defines(guided(UpdateRule::expected_sarsa), everything())},
          {"everything with paths", shader_defines(guided(UpdateRule::monte_carlo), everything())},
          {"everything in two rays", shader_defines(two_ray, everything())},
          {"light paths", shader_defines(with_light_paths(plain, LightPaths::trace), features(false))},
          {"light paths and light samples",
           shader_defines(with_light_paths(lights, LightPaths::trace), features(true))},
          {"connections", shader_defines(with_light_paths(plain, LightPaths::connect), features(false))},
          {"connections of everything",
           shader_defines(with_light_paths(guided(UpdateRule::expected_sarsa), LightPaths::connect),
                          everything())},
          {"mirrors", shader_defines(plain, with(&gpu::SceneFeatures::delta))},
          {"glass", shader_defines(plain, with(&gpu::SceneFeatures::transmission))},
          {"coats", shader_defines(plain, with(&gpu::SceneFeatures::clearcoat))}};
}

// Which files a variant's programs have in common with no other: they are never compiled without its choice.
bool belongs_to(const std::string& file, const gpu::Defines& defines) {
  const bool has_table = defines.contains("HAS_TABLE");
  const bool has_bins = defines.contains("BINS_THETA");
  for (const char* room : {"mis/", "connection/", "light_path/"}) {
    if (file.starts_with(room)) return defines.contains("HAS_LIGHT_PATHS");
  }
  if (file == "learning/cell.glsl" || file == "learning/grid.glsl" || file == "learning/voronoi.glsl")
    return true;
  if (file == "learning/bins.glsl" || file == "learning/qtable.glsl" || file == "learning/shrinkage.glsl")
    return has_bins;
  if (file == "path/td_rules.glsl") return has_bins;
  if (file == "path/monte_carlo.glsl") return has_bins;
  if (file == "sampling/sobol.glsl") return defines.contains("STRATIFIED_EVENTS");
  return has_table || !file.starts_with("learning/");
}

// Compiled, not linked: what other files would call is not called here.
void compile_alone(const std::string& file, const gpu::Defines& defines) {
  const std::string text =
      "#version 450 core\n#include \"" + file + "\"\nlayout(local_size_x = 1) in;\nvoid main() {}\n";
  const gpu::Program program(gpu::assemble("alone", text, gpu::for_driver(defines)));
}

TEST(ShaderFiles, EachCompilesOnItsOwn) {
  device();
  int compiled = 0;
  for (const Variant& variant : variants()) {
    for (const gpu::EmbeddedShader& shader : gpu::embedded_shaders()) {
      const std::string file(shader.name);
      if (!file.ends_with(".glsl") || !belongs_to(file, variant.defines)) continue;
      SCOPED_TRACE(file + " of variant " + variant.name);
      EXPECT_NO_THROW(compile_alone(file, variant.defines));
      ++compiled;
    }
  }
  EXPECT_GT(compiled, 150);
}

}  // namespace
}  // namespace qtrace::test
