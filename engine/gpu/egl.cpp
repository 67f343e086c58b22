#include "engine/gpu/egl.h"

#include "engine/core/check.h"

#include <epoxy/gl.h>

#include <array>
#include <string_view>

namespace qtrace::gpu {
namespace {

bool has_word(const char* list, std::string_view word) {
  if (list == nullptr) return false;
  const std::string padded = " " + std::string(list) + " ";
  return padded.find(" " + std::string(word) + " ") != std::string::npos;
}

bool client_has(std::string_view extension) {
  return has_word(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), extension);
}

// eglGetPlatformDisplay of EGL 1.5 is avoided: where only EGL 1.4 client functions are found, libepoxy ends
// the program at its first use. The older extension is everywhere.
EGLDisplay display_of(const Platform& platform) {
  if (platform.device != nullptr) {
    return eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, platform.device, nullptr);
  }
  return eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
}

bool is_software_renderer(std::string_view renderer) {
  for (const std::string_view name : {"llvmpipe", "softpipe", "swrast", "SWR"}) {
    if (renderer.find(name) != std::string_view::npos) return true;
  }
  return false;
}

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text == nullptr ? "" : text;
}

// One that tells of resets of the device, where the driver knows such.
EGLContext create_context(EGLDisplay display) {
  const auto create = [display](std::initializer_list<EGLint> more) {
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION,       4,
                                   EGL_CONTEXT_MINOR_VERSION,       5,
                                   EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT};
    attributes.insert(attributes.end(), more);
    attributes.push_back(EGL_NONE);
    return eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes.data());
  };
  const EGLContext telling =
      create({EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY, EGL_LOSE_CONTEXT_ON_RESET});
  return telling != EGL_NO_CONTEXT ? telling : create({});
}

}  // namespace

std::vector<Platform> list_platforms() {
  std::vector<Platform> platforms;
  if (!client_has("EGL_EXT_platform_base")) return platforms;
  if (client_has("EGL_EXT_platform_device") &&
      (client_has("EGL_EXT_device_enumeration") || client_has("EGL_EXT_device_base"))) {
    EGLint count = 0;
    eglQueryDevicesEXT(0, nullptr, &count);
    std::vector<EGLDeviceEXT> devices(static_cast<std::size_t>(count));
    if (count > 0) eglQueryDevicesEXT(count, devices.data(), &count);
    for (EGLDeviceEXT device : devices) {
      const char* extensions = eglQueryDeviceStringEXT(device, EGL_EXTENSIONS);
      platforms.push_back({device, has_word(extensions, "EGL_MESA_device_software")});
    }
  }
  if (platforms.empty() && client_has("EGL_MESA_platform_surfaceless")) platforms.push_back({});
  return platforms;
}

EglContext::EglContext(const Platform& platform) {
  info_.platform = platform.device != nullptr ? "device" : "surfaceless";
  info_.software = platform.software_device;
  open(platform);
  if (info_.problem.empty()) describe(platform);
}

void EglContext::open(const Platform& platform) {
  const auto fail_at = [&](const char* call) {
    info_.problem = fmt::format("{} failed with EGL error 0x{:04x}", call, eglGetError());
  };
  display_ = display_of(platform);
  if (display_ == EGL_NO_DISPLAY) return fail_at("eglGetPlatformDisplayEXT");
  if (!eglInitialize(display_, nullptr, nullptr)) {
    display_ = EGL_NO_DISPLAY;
    return fail_at("eglInitialize");
  }
  const char* extensions = eglQueryString(display_, EGL_EXTENSIONS);
  for (const char* needed : {"EGL_KHR_surfaceless_context", "EGL_KHR_no_config_context"}) {
    if (!has_word(extensions, needed)) {
      info_.problem = fmt::format("the driver lacks {}", needed);
      return;
    }
  }
  if (!eglBindAPI(EGL_OPENGL_API)) return fail_at("eglBindAPI");
  context_ = create_context(display_);
  if (context_ == EGL_NO_CONTEXT) return fail_at("eglCreateContext for OpenGL 4.5 core");
  if (!eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) fail_at("eglMakeCurrent");
}

void EglContext::describe(const Platform& platform) {
  info_.renderer = gl_string(GL_RENDERER);
  info_.vendor = gl_string(GL_VENDOR);
  info_.gl_version = gl_string(GL_VERSION);
  info_.software = platform.software_device || is_software_renderer(info_.renderer);
  info_.choices = usual_choices();
}

EglContext::~EglContext() {
  if (display_ == EGL_NO_DISPLAY) return;
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (context_ != EGL_NO_CONTEXT) eglDestroyContext(display_, context_);
  eglTerminate(display_);
}

}  // namespace qtrace::gpu
