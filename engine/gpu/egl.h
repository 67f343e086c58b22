// EGL displays that need no screen, and OpenGL contexts on them.
#pragma once

#include "engine/gpu/device_info.h"

#include <epoxy/egl.h>

#include <string>
#include <vector>

namespace qtrace::gpu {

// A place to ask for a context: one of EGL's devices, or Mesa's surfaceless platform.
struct Platform {
  EGLDeviceEXT device = nullptr;  // null: surfaceless
  bool software_device = false;   // what EGL says of it
};

std::vector<Platform> list_platforms();

// An OpenGL 4.5 core context, current on this thread. Empty `problem` of info() means that it works.
class EglContext {
 public:
  explicit EglContext(const Platform& platform);
  ~EglContext();
  EglContext(const EglContext&) = delete;
  EglContext& operator=(const EglContext&) = delete;

  const DeviceInfo& info() const { return info_; }

 private:
  void open(const Platform& platform);
  void describe(const Platform& platform);

  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
  DeviceInfo info_;
};

}  // namespace qtrace::gpu
