#include "tests/bench/staged_frame.h"

#include "engine/accel/build_bvh.h"
#include "engine/core/check.h"
#include "engine/gpu/driver.h"
#include "engine/gpu/program.h"
#include "engine/gpu/shader_source.h"
#include "engine/tracer/parameters.h"
#include "engine/tracer/shader_variant.h"
#include "engine/tracer/tiles.h"
#include "engine/tracer/tracer.h"

#include <string>
#include <vector>

namespace qtrace::bench {
namespace {

// Stand between two includes of trace.comp: behind the functions that they replace, before their use.
// parameters.clamp_radiance is 0 here.
constexpr std::string_view kCellTwice = R"(
#include "learning/cells.glsl"
Cell find_cell_twice(Surface s) {
  Cell first = find_cell(s);
  s.position += parameters.clamp_radiance;
  s.mesh_normal += parameters.clamp_radiance;
  Cell second = find_cell(s);
  return Cell(max(first.index, second.index), max(first.tangent, second.tangent));
}
#define find_cell find_cell_twice
)";
constexpr std::string_view kDirectionTwice = R"(
#include "sampling/direction.glsl"
DirectionSample sample_direction_twice(Event e, uvec4 bits) {
  DirectionSample first = sample_direction(e, bits);
  bits += uint(parameters.clamp_radiance);
  e.cell.tangent += parameters.clamp_radiance;
  DirectionSample second = sample_direction(e, bits);
  return DirectionSample(max(first.direction, second.direction), max(first.pdf, second.pdf),
                         max(first.bsdf, second.bsdf), max(first.entry, second.entry), max(first.share, second.share));
}
float direction_pdf_twice(Event e, vec3 wi) {
  float first = direction_pdf(e, wi);
  wi += parameters.clamp_radiance;
  return max(first, direction_pdf(e, wi));
}
#define sample_direction sample_direction_twice
#define direction_pdf direction_pdf_twice
)";
constexpr std::string_view kNoTargets = R"(
#include "learning/cells.glsl"
#include "learning/actions.glsl"
#define gather_target(entry, target) false
#define gather_light_target(entry, target) false
)";

// In the order of TraceForm.
constexpr std::array<std::string_view, kTraceForms.size()> kChanges{"", kCellTwice, kDirectionTwice,
                                                                    kNoTargets};

gpu::Program program_of(TraceForm form, const gpu::Defines& defines) {
  constexpr std::string_view kBefore = "#include \"path/path.glsl\"\n";
  std::string text(gpu::shader_file("passes/trace.comp"));
  const std::size_t place = text.find(kBefore);
  check(place != std::string::npos, "trace.comp does not include path.glsl any more");
  text.insert(place, kChanges[static_cast<std::size_t>(form)]);
  return gpu::Program(gpu::assemble("trace.comp of the benchmark", text, gpu::for_driver(defines)));
}

std::array<gpu::Program, kTraceForms.size()> programs_of(const gpu::Defines& defines) {
  return {program_of(TraceForm::plain, defines), program_of(TraceForm::cell_twice, defines),
          program_of(TraceForm::direction_twice, defines), program_of(TraceForm::no_targets, defines)};
}

}  // namespace

StagedFrame::StagedFrame(const gpu::Context& context, const Scene& scene, const RenderSettings& settings)
    : buffers_(scene, build_bvh(scene, settings.bvh), settings.lights),
      settings_(effective_settings(settings, buffers_.features())),
      defines_(shader_defines(settings_, buffers_.features())),
      table_(scene, settings_.rl, table_actions(settings_, buffers_.features()), defines_,
             context.programs()),
      film_(settings_.width, settings_.height, 1, 0, context.programs()),
      parameters_("parameters", sizeof(gpu::Parameters)),
      trace_(programs_of(with_cells(defines_, table_.cells()))) {
  check(settings_.clamp_radiance == 0, "the passes of a frame are timed without clamping");
  const gpu::Parameters block =
      make_parameters(scene.camera, settings_, buffers_.features(), &table_.cells());
  parameters_.write(0, &block, sizeof(block));
  bind();
  film_.reset();
  table_.reset();
}

void StagedFrame::bind() const {
  parameters_.bind_uniform(gpu::BINDING_PARAMETERS);
  buffers_.bind();
  film_.bind();
  table_.bind();
}

void StagedFrame::trace(TraceForm form) {
  bind();
  film_.start_frame();
  gpu::Program& program = trace_[static_cast<std::size_t>(form)];
  program.set_frame(frame_);
  program.set_teaches(true);
  program.dispatch(tiles(settings_.width), tiles(settings_.height));
}

RadianceImage StagedFrame::image_of(TraceForm form, std::uint32_t frames) {
  bind();
  film_.reset();
  table_.reset();
  for (frame_ = 1; frame_ <= frames; ++frame_) {
    trace(form);
    accumulate();
    learn();
  }
  return film_.radiance();
}

void check_same_image(const gpu::Context& context, const Scene& scene, const RenderSettings& settings,
                      StagedFrame& staged) {
  constexpr int kFrames = 3;
  Tracer tracer(context, scene, settings);
  std::vector<RadianceImage> wanted;
  for (int i = 0; i < kFrames; ++i) {
    tracer.render_frame();
    wanted.push_back(tracer.radiance());
  }
  for (std::size_t i = 0; i < kTraceForms.size(); ++i) {
    const auto form = static_cast<TraceForm>(i);
    const std::uint32_t frames = form == TraceForm::no_targets ? 1 : kFrames;
    check(
        staged.image_of(form, frames).mean == wanted[frames - 1].mean,
        "the frame taken apart, form {}, does not render the tracer's image: the benchmark's passes are not "
        "the tracer's",
        kTraceForms[i]);
  }
}

}  // namespace qtrace::bench
