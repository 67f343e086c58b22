// Rooms that need what few scenes do: each of textures, alpha, glass, mirrors, coats, skies and lamps without
// a surface.
#pragma once

#include "engine/scene/scene.h"

#include <array>
#include <string>
#include <string_view>

namespace qtrace::independent {

inline constexpr std::array kRooms{
    "textures", "normals",    "alpha",    "plastic",       "mirror", "thin", "glass",        "rough_glass",
    "coat",     "rough_coat", "in_glass", "lamp_in_glass", "unlit",  "sky",  "sky_and_lamp", "punctual"};

// A box with a lamp below its ceiling (a roofless one under a sky, or one without a lamp where the name says
// so) and a ball.
Scene feature_room(const std::string& name);

// Whether paths alone meet its light: what has no surface, none does.
inline bool shines_on_paths(std::string_view name) { return name != "punctual"; }

}  // namespace qtrace::independent
