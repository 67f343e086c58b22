// What is known of a device that EGL offers.
#pragma once

#include "engine/gpu/driver.h"

#include <cstdint>
#include <string>

namespace qtrace::gpu {

struct DeviceInfo {
  int index = 0;           // position in list_devices()
  std::string renderer;    // GL_RENDERER
  std::string vendor;      // GL_VENDOR
  std::string gl_version;  // GL_VERSION: OpenGL and driver version
  std::string platform;    // how EGL reached it: "device" or "surfaceless"
  bool software = false;   // computes on the CPU
  DriverChoices choices;   // by which shaders are compiled for it
  std::uint32_t loop_limit =
      0;                // turns after which the driver ends all loops of an invocation; 0: none was seen
  std::string problem;  // why it cannot be used; empty where it can
};

}  // namespace qtrace::gpu
