#include "tests/bench/texel_bench.h"

#include "engine/gpu/buffer.h"
#include "engine/gpu/program.h"
#include "experiments/files/atomic_file.h"
#include "experiments/files/csv.h"
#include "experiments/files/text_table.h"
#include "tests/bench/rounds.h"

#include <epoxy/gl.h>
#include <glm/gtc/packing.hpp>

#include <array>
#include <cstdio>
#include <string_view>

namespace qtrace::bench {
namespace {

constexpr std::size_t kSide = 1024;
constexpr std::size_t kTexels = kSide * kSide;
constexpr std::uint32_t kLookups = 1 << 18;
constexpr int kOutputBinding = 15;

// Hashed places, four look-ups each.
constexpr std::string_view kHead = R"(#version 450 core
layout(local_size_x = 64) in;
layout(std430, binding = 15) restrict writeonly buffer ResultBuffer { vec4 results[]; };
vec2 place_of(uint i) {
  uvec2 h = uvec2(i * 747796405u + 2891336453u, i * 277803737u + 12345u);
  h ^= h >> 16u;
  h *= 0x7feb352du;
  h ^= h >> 15u;
  return vec2(h >> 8u) * (3.0 / 16777216.0) - 1.0;
}
)";
constexpr std::string_view kOwnFilter = R"(
float wrapped(float i) { return clamp(i - 1024.0 * floor(i / 1024.0), 0.0, 1023.0); }
vec4 look_up(vec2 uv) {
  vec2 p = uv * 1024.0 - 0.5;
  vec2 low = floor(p);
  vec2 part = p - low;
  uint x0 = uint(wrapped(low.x));
  uint x1 = uint(wrapped(low.x + 1.0));
  uint row0 = 1024u * uint(wrapped(low.y));
  uint row1 = 1024u * uint(wrapped(low.y + 1.0));
  return mix(mix(texel(row0 + x0), texel(row0 + x1), part.x), mix(texel(row1 + x0), texel(row1 + x1), part.x), part.y);
}
)";
constexpr std::string_view kDriversFilter = "vec4 look_up(vec2 uv) { return textureLod(image, vec3(uv, 0.0), 0.0); }\n";
constexpr std::string_view kTail = R"(
void main() {
  vec2 uv = place_of(gl_GlobalInvocationID.x);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    sum += look_up(uv);
    uv = fract(uv * 1.37 + 0.11);
  }
  results[gl_GlobalInvocationID.x] = sum;
}
)";

enum Unit : int { half_buffer, float_buffer, byte_buffer, half_array, byte_array, float_array };

struct Way {
  std::string name;
  std::string declarations;  // of the image, and of texel() where the shader filters
  std::string_view filter;
};

std::vector<Way> ways() {
  return {{"image buffer, 16-bit floats, filtered by the shader",
           "layout(rgba16f, binding = 0) uniform readonly imageBuffer image;\n"
           "vec4 texel(uint i) { return imageLoad(image, int(i)); }\n",
           kOwnFilter},
          {"image buffer, 32-bit floats, filtered by the shader",
           "layout(rgba32f, binding = 1) uniform readonly imageBuffer image;\n"
           "vec4 texel(uint i) { return imageLoad(image, int(i)); }\n",
           kOwnFilter},
          {"image buffer, 8 bits, decoded and filtered by the shader",
           "layout(r32ui, binding = 2) uniform readonly uimageBuffer image;\n"
           "vec4 texel(uint i) {\n"
           "  vec4 c = unpackUnorm4x8(imageLoad(image, int(i)).x);\n"
           "  vec3 high = pow((c.rgb + 0.055) / 1.055, vec3(2.4));\n"
           "  return vec4(mix(c.rgb / 12.92, high, greaterThan(c.rgb, vec3(0.04045))), c.a);\n}\n",
           kOwnFilter},
          {"buffer texture, 16-bit floats, filtered by the shader",
           "layout(binding = 0) uniform samplerBuffer image;\n"
           "vec4 texel(uint i) { return texelFetch(image, int(i)); }\n",
           kOwnFilter},
          {"array texture, 16-bit floats, filtered by the shader",
           "layout(binding = 3) uniform sampler2DArray image;\n"
           "vec4 texel(uint i) { return texelFetch(image, ivec3(int(i & 1023u), int(i >> 10u), 0), 0); }\n",
           kOwnFilter},
          {"array texture, 16-bit floats, filtered by the driver", "layout(binding = 3) uniform sampler2DArray image;\n",
           kDriversFilter},
          {"array texture, 8 bits in sRGB, filtered by the driver", "layout(binding = 4) uniform sampler2DArray image;\n",
           kDriversFilter},
          {"array texture, 32-bit floats, filtered by the driver", "layout(binding = 5) uniform sampler2DArray image;\n",
           kDriversFilter}};
}

// One image in every form.
class Images {
 public:
  Images() {
    std::vector<std::uint8_t> bytes;
    std::vector<std::uint16_t> halves;
    std::vector<float> floats;
    for (std::uint32_t i = 0; i < 4 * kTexels; ++i) {
      bytes.push_back(static_cast<std::uint8_t>((i * 2654435761U) >> 24U));
      floats.push_back(static_cast<float>(bytes.back()) / 255);
      halves.push_back(glm::packHalf1x16(floats.back()));
    }
    add_buffer(half_buffer, halves, gpu::Texels::half4);
    add_buffer(float_buffer, floats, gpu::Texels::float4);
    add_buffer(byte_buffer, bytes, gpu::Texels::uint1);
    add_array(half_array, GL_RGBA16F, GL_HALF_FLOAT, halves.data());
    add_array(byte_array, GL_SRGB8_ALPHA8, GL_UNSIGNED_BYTE, bytes.data());
    add_array(float_array, GL_RGBA32F, GL_FLOAT, floats.data());
  }
  ~Images() { glDeleteTextures(static_cast<GLsizei>(arrays_.size()), arrays_.data()); }
  Images(const Images&) = delete;
  Images& operator=(const Images&) = delete;

 private:
  template <class T>
  void add_buffer(Unit unit, const std::vector<T>& data, gpu::Texels texels) {
    buffers_.emplace_back("texels", data, gpu::only_fetched(texels)).bind_fetched(unit);
  }

  void add_array(Unit unit, GLenum format, GLenum type, const void* data) {
    GLuint& id = arrays_.emplace_back();
    constexpr auto kPixels = static_cast<GLsizei>(kSide);
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &id);
    glTextureStorage3D(id, 1, format, kPixels, kPixels, 1);
    glTextureSubImage3D(id, 0, 0, 0, 0, kPixels, kPixels, 1, GL_RGBA, type, data);
    glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glBindTextureUnit(static_cast<GLuint>(unit), id);
  }

  std::vector<gpu::Buffer> buffers_;
  std::vector<GLuint> arrays_;
};

struct Row {
  std::string way;
  Spread nanoseconds;  // of processor time for a look-up
  Spread over_first;
};

const std::vector<experiments::Column<Row>>& columns() {
  static const std::vector<experiments::Column<Row>> all{
      {"way", [](const Row& r) { return r.way; }},
      {"cpu_ns", [](const Row& r) { return r.nanoseconds.median; }},
      {"cpu_ns_low", [](const Row& r) { return r.nanoseconds.low; }},
      {"cpu_ns_high", [](const Row& r) { return r.nanoseconds.high; }},
      {"over_first", [](const Row& r) { return r.over_first.median; }},
      {"over_first_low", [](const Row& r) { return r.over_first.low; }},
      {"over_first_high", [](const Row& r) { return r.over_first.high; }},
  };
  return all;
}

}  // namespace

void bench_texels(const gpu::Context& context, const FrameBenchOptions& options) {
  const Images images;
  const gpu::Buffer output("look-ups", kLookups * sizeof(glm::vec4));
  output.bind_storage(kOutputBinding);
  std::vector<gpu::Program> programs;
  std::vector<Contender> contenders;
  programs.reserve(ways().size());
  for (const Way& way : ways()) {
    programs.emplace_back(gpu::assemble("bench_texels.comp", fmt::format("{}{}{}{}", kHead, way.declarations, way.filter, kTail), {}));
    contenders.push_back({way.name, [&context, program = &programs.back()] {
                            return timed([&] { program->dispatch(kLookups / 64); }, [&] { context.finish(); });
                          }});
  }
  run_rounds(contenders, options.rounds);
  std::vector<Row> rows;
  std::vector<RoundRow> rounds;
  std::vector<std::vector<std::string>> cells;
  for (const Contender& c : contenders) {
    rows.push_back({c.name, 1e9 / (4.0 * kLookups) * spread_of(c.cpu_s), ratio_of(c.cpu_s, contenders[0].cpu_s)});
    cells.push_back({c.name, text_of(rows.back().nanoseconds), text_of(rows.back().over_first)});
    append_rounds(rounds, {c.name}, c);
  }
  fmt::print("\n{}\n", experiments::markdown_table({"texels", "ns of processor time a look-up", "over the first"}, cells, 1));
  std::fflush(stdout);
  experiments::write_file(options.out / "texels.csv", experiments::csv_text(columns(), rows));
  experiments::write_file(options.out / "texel_rounds.csv", rounds_csv({"way"}, rounds));
}

}  // namespace qtrace::bench
