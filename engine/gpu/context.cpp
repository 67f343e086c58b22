#include "engine/gpu/context.h"

#include "engine/core/check.h"
#include "engine/gpu/driver_probe.h"
#include "engine/gpu/egl.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <charconv>
#include <optional>

namespace qtrace::gpu {
namespace {

std::string describe(const std::vector<DeviceInfo>& devices) {
  std::string text;
  for (const DeviceInfo& d : devices) {
    text += fmt::format("\n  {}: {} ({})", d.index,
                        d.renderer.empty() ? "EGL device without context" : d.renderer,
                        d.problem.empty() ? (d.software ? "software" : "hardware") : d.problem);
  }
  return text;
}

// A number is an index, or a part of a name where no device has that index.
bool matches(const DeviceInfo& device, const std::string& choice, std::size_t devices) {
  int index = -1;
  const auto [end, error] = std::from_chars(choice.data(), choice.data() + choice.size(), index);
  const bool is_number = error == std::errc() && end == choice.data() + choice.size();
  if (is_number && index >= 0 && static_cast<std::size_t>(index) < devices) return device.index == index;
  return device.renderer.find(choice) != std::string::npos;
}

int choose(const std::vector<DeviceInfo>& devices, const std::string& choice) {
  std::optional<int> software;
  for (const DeviceInfo& device : devices) {
    if (!device.problem.empty() || (!choice.empty() && !matches(device, choice, devices.size()))) continue;
    if (!device.software || !choice.empty()) return device.index;
    if (!software) software = device.index;
  }
  if (software) return *software;
  if (devices.empty())
    fail("EGL offers no device: install a driver, such as Mesa's (libegl-mesa0, libgl1-mesa-dri)");
  if (choice.empty()) fail("no EGL device can run OpenGL 4.5 compute shaders; found:{}", describe(devices));
  fail("no usable device fits '{}'; give an index or a part of a name out of:{}", choice, describe(devices));
}

}  // namespace

std::vector<DeviceInfo> list_devices() {
  std::vector<DeviceInfo> devices;
  for (const Platform& platform : list_platforms()) {
    const EglContext probe(platform);
    devices.push_back(probe.info());
    devices.back().index = static_cast<int>(devices.size()) - 1;
  }
  return devices;
}

struct Context::State {
  State(const Platform& from, const DeviceInfo& info) : platform(from), egl(from), device(info) {}
  Platform platform;
  EglContext egl;
  DeviceInfo device;
  ProgramCache programs;  // gone before the context is
};

Context::Context(const std::string& choice) {
  const std::vector<DeviceInfo> devices = list_devices();
  const auto index = static_cast<std::size_t>(choose(devices, choice));
  state_ = std::make_unique<State>(list_platforms().at(index), devices[index]);
  check(state_->egl.info().problem.empty(), "device {} ({}) worked and then did not: {}", index,
        devices[index].renderer, state_->egl.info().problem);
  use(state_->device.choices);
  state_->device.loop_limit = probe_loop_limit();
}

Context::~Context() = default;

const DeviceInfo& Context::device() const { return state_->device; }

void Context::use(const DriverChoices& choices) {
  check(offers(choices.fetch), "device {} ({}) does not offer as many units as shaders fetch from by {}",
        state_->device.index, state_->device.renderer, fetch_name(choices.fetch));
  state_->device.choices = choices;
  set_driver_choices(choices);
}

ProgramCache& Context::programs() const { return state_->programs; }

void Context::finish() const {
  glFinish();
  const GLenum error = glGetError();
  if (error == GL_CONTEXT_LOST) check_alive();
  check(error == GL_NO_ERROR, "the OpenGL driver reported error 0x{:04x} ({})", error,
        error == GL_OUT_OF_MEMORY ? "out of memory" : "a mistake of this program");
}

void Context::check_alive() const {
  const GLenum status = glGetGraphicsResetStatus();
  if (status == GL_NO_ERROR) return;
  throw ContextLost(fmt::format("the device was reset ({})",
                                status == GL_GUILTY_CONTEXT_RESET     ? "by a fault of this program"
                                : status == GL_INNOCENT_CONTEXT_RESET ? "by another program"
                                                                      : "the driver does not say why"));
}

void Context::renew() {
  const Platform platform = state_->platform;
  const DeviceInfo device = state_->device;
  state_.reset();  // one context per thread at a time
  state_ = std::make_unique<State>(platform, device);
  check(state_->egl.info().problem.empty(), "device {} ({}) was lost and gives no new context: {}",
        device.index, device.renderer, state_->egl.info().problem);
  set_driver_choices(device.choices);
}

}  // namespace qtrace::gpu
