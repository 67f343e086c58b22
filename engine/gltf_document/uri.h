// What the URIs of buffers and images stand for.
#pragma once

#include "engine/gltf_document/source.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace qtrace::gltf {

// The file that a relative URI names. A scene must not read files that are none of its business, whatever its
// author wrote: Error for what lies outside `folder`, the scene's. `what` names the buffer or image.
std::filesystem::path resolve_uri(const Source& source, const std::string& what, const std::string& uri,
                                  const std::filesystem::path& folder);

// The bytes of a data URI. A warning where it begins with a media type that glTF does not have there, as
// `right` does. Error where it is not base64.
std::vector<unsigned char> decode_data_uri(Source& source, const std::string& what, std::string uri,
                                           std::string_view right);

}  // namespace qtrace::gltf
