// What a target takes from the table at the next hit, against closed forms and numerical integration.
#include "tests/support/learning_stage.h"
#include "tests/support/statistics.h"

#include <cmath>
#include <random>

namespace qtrace::test {
namespace {

class Expectation : public LearningStage {
 protected:
  std::vector<float> random_table() const {
    std::vector<float> values(table_->values().size());
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform;
    for (float& v : values) v = uniform(random) < 0.2F ? 10 * uniform(random) : 0.1F;
    return values;
  }

  // The integral of Q f_r cos(theta), averaged over channels, by midpoints: uniform in cos(theta) and phi. A
  // lobe of alpha 0.04 is some 30 points wide.
  double integral_in_view() const {
    constexpr std::uint32_t kRows = 2048;
    const auto sums = probe<glm::vec4>(
        "vec4",
        {"shared/variants.glsl", "learning/cells.glsl", "learning/qtable.glsl", "geometry/camera.glsl",
         "geometry/traverse.glsl"},
        "",
        kViewedSurface +
            "Cell cell = find_cell(s);\nBsdf b = bsdf_of(s, -d);\n"
            "float z = (float(index) + 0.5) / 2048.0;\nfloat sum = 0.0;\nuint i = 0u;\ndo {\n"
            "  float phi = 2.0 * PI * (float(i) + 0.5) / 2048.0;\n  float r = sqrt(1.0 - z * z);\n"
            "  vec3 local = vec3(r * cos(phi), r * sin(phi), z);\n"
            "  vec3 wi = to_world(local, cell.tangent, s.normal);\n"
            "  sum += fetch_one(q_values, first_bin(uint(cell.index)) + bin_of(local)) * "
            "average(table_lobes_cosine(s, b, -d, wi));\n"
            "  ++i;\n} while (i < 2048u);\nresult = vec4(sum);",
        kRows, defines_);
    double sum = 0;
    for (const glm::vec4& row : sums) sum += row.x;
    return sum * 2 * 3.141592653589793 / (double{kRows} * kRows);
  }
};

// With the same radiance L from everywhere, expected SARSA expects rho L back from a Lambert surface.
TEST_F(Expectation, OfAConstantTableIsReflectanceTimesRadiance) {
  table_->set_values(std::vector<float>(table_->values().size(), 3.0F));
  EXPECT_NEAR(next_values_in_view()[0], 0.8 * 3, 1e-4);
}

// Both bin maps, Lambert: exact, but for bins that the midpoints cut.
TEST_F(Expectation, OfLambertIsTheIntegral) {
  for (const BinMap map : {BinMap::cylindrical, BinMap::concentric}) {
    settings_.rl.bin_map = map;
    settings_.rl.bins_theta = 6;
    settings_.rl.bins_phi = 7;
    build();
    table_->set_values(random_table());
    EXPECT_NEAR(next_values_in_view()[0] / integral_in_view(), 1, 2e-3) << enum_name(map);
  }
}

// Metal and plastic, from broad lobes to ones far narrower than a bin: the mean over rotations is the
// integral, within the noise of that mean.
TEST_F(Expectation, OfGlossySurfacesIsTheIntegral) {
  settings_.rl.bins_theta = 6;
  settings_.rl.bins_phi = 8;
  for (const float roughness : {0.2F, 0.45F, 0.8F}) {
    for (const float metallic : {1.0F, 0.0F}) {
      SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", metallic " << metallic);
      for (Material& m : scene_.materials) {
        m.metallic = metallic;
        m.specular = 1;
        m.roughness = roughness;
      }
      build();
      table_->set_values(random_table());
      const std::vector<float> values = next_values_in_view(8192);
      double sum = 0;
      double squares = 0;
      for (const float v : values) {
        sum += v;
        squares += double{v} * v;
      }
      const auto n = static_cast<double>(values.size());
      const double mean = sum / n;
      const double error = std::sqrt((squares / n - mean * mean) / n);
      const double integral = integral_in_view();
      EXPECT_LT(std::abs(mean - integral), z_threshold(6) * error + 1e-3 * integral)
          << mean << " +- " << error << " against " << integral;
    }
  }
}

// q_learning: the best bin's value, discounted by the reflectance; the listing: by the path's throughput.
TEST_F(Expectation, OfTheBestBinIsDiscounted) {
  for (const auto& [rule, discount] :
       {std::pair{UpdateRule::q_learning, 0.8}, std::pair{UpdateRule::paper_listing, 0.5}}) {
    settings_.rl.update = rule;
    build();
    std::vector<float> values(table_->values().size(), 1.0F);
    for (std::size_t i = 2; i < values.size(); i += 4) values[i] = 7;
    table_->set_values(values);
    EXPECT_NEAR(next_values_in_view()[0], discount * 7, 1e-4) << enum_name(rule);
  }
}

}  // namespace
}  // namespace qtrace::test
