// How configs say what of a scene's file is shown, and from where (engine/scene/view.h).
#pragma once

#include "engine/scene/view.h"
#include "experiments/config/knob_type.h"

namespace qtrace::experiments {

// A name, or an index from 0; an empty name: whichever the file has first.
template <>
struct KnobType<NameOrIndex> {
  static std::string describe(const KnobInfo&);
  static void read(const Json& json, const KnobInfo& info, const std::string& path, NameOrIndex& value);
  static Json write(const NameOrIndex& value);
  static Json schema(const KnobInfo&);
};

// "fit", a camera of the file by its name or index, or where one stands.
template <>
struct KnobType<CameraChoice> {
  static std::string describe(const KnobInfo&);
  static void read(const Json& json, const KnobInfo& info, const std::string& path, CameraChoice& choice);
  static Json write(const CameraChoice& choice);
  static Json schema(const KnobInfo&);
};

}  // namespace qtrace::experiments
