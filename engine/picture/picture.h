// Pictures in files: PNG and JPEG, decoded as they are.
#pragma once

#include "engine/picture/encoded.h"
#include "engine/scene/texture.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace qtrace::picture {

inline constexpr std::uint32_t kMostOfASide = 32768;

// What the bytes are, by their first ones and not by a name: "image/png", "image/jpeg", or another that this
// cannot decode; empty where nothing is known that begins so.
std::string_view media_type(Bytes bytes);

// Each for a PNG or a JPEG. Error, which begins with `what`, for bytes that are neither, broken or cut short,
// and for pictures of more than kMostOfASide texels a side or of a kind that cannot be decoded.

// From the header alone.
Size read_size(Bytes bytes, const std::string& what);

// The file's values, without regard to what it says of their colour space (glTF 2.0, section 3.8.2): grey
// levels in R, G and B alike, a palette's colours, 1 for A where there is no transparency. Besides the texels
// no more memory is used than eight bytes for each of them.
TextureImage decode(Bytes bytes, const std::string& what);

}  // namespace qtrace::picture
