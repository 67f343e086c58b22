// An OpenGL 4.5 core context without display, through EGL.
#pragma once

#include "engine/core/check.h"
#include "engine/gpu/device_info.h"
#include "engine/gpu/program_cache.h"

#include <memory>
#include <string>
#include <vector>

namespace qtrace::gpu {

// Everything that EGL offers, usable or not.
std::vector<DeviceInfo> list_devices();

// The driver has given up the context: everything on the device is lost. A renewed context may work.
class ContextLost : public Error {
 public:
  using Error::Error;
};

class Context {
 public:
  // `choice`: a device's index, a part of its renderer name, or empty: the first usable hardware device,
  // else the first usable software device. Throws Error that lists the devices where none fits.
  // Current on the calling thread until destroyed; one context per thread at a time.
  explicit Context(const std::string& choice = "");
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;

  const DeviceInfo& device() const;
  // From now on shaders are compiled by these; at first by usual_choices(). Throws Error where the device
  // does not offer them.
  void use(const DriverChoices& choices);
  ProgramCache& programs() const;  // for as long as the context is not renewed
  void finish() const;             // returns when all work is done
  void check_alive() const;  // throws ContextLost after a reset of the device, where the driver tells of it

  // A new context on the same device; no object of the old one may be left. Throws Error where there is none.
  void renew();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace qtrace::gpu
