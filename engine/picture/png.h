// PNG, by libpng.
#pragma once

#include "engine/picture/encoded.h"
#include "engine/scene/texture.h"

#include <string>

namespace qtrace::picture {

Size read_png_size(Bytes bytes, const std::string& what);

// Fills the texels of an image that has the size of the picture.
void decode_png(Bytes bytes, const std::string& what, TextureImage& image);

}  // namespace qtrace::picture
