#include "engine/gltf_document/image.h"

#include "engine/gltf_document/expansion.h"
#include "engine/gltf_document/file.h"
#include "engine/gltf_document/texture_use.h"
#include "engine/gltf_document/uri.h"

#include <array>
#include <map>
#include <utility>

namespace qtrace::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view kDataUri = "data:image/png;base64, or data:image/jpeg;base64,";
// Images that need decoders of their own; the texture's `source` is there for programs without them.
constexpr std::array<const char*, 4> kOtherImages{"EXT_texture_avif", "EXT_texture_webp",
                                                  "KHR_texture_basisu", "MSFT_texture_dds"};

std::string text(const json& object, const char* name) { return object.value(name, std::string()); }

class Finder {
 public:
  Finder(Source& source, const json& document, std::vector<tinygltf::Buffer>& buffers,
         const std::filesystem::path& folder, std::size_t max_bytes)
      : source_(source),
        document_(document),
        buffers_(buffers),
        folder_(folder),
        max_bytes_(max_bytes),
        rest_(max_bytes) {}

  void add(std::size_t texture, std::size_t material) {
    if (found_.sources.contains(texture)) return;
    const json& file = document_.at("textures").at(texture);
    TextureSource& result = found_.sources[texture];
    if (file.contains("source")) {
      result.image = image(file["source"].get<std::size_t>());
    } else {
      refuse_others(file, texture, material);
    }
    if (file.contains("sampler"))
      set_sampler(document_["samplers"][file["sampler"].get<std::size_t>()], result);
  }

  Textures take() { return std::move(found_); }

 private:
  void refuse_others(const json& file, std::size_t texture, std::size_t material) const {
    const auto extensions = file.find("extensions");
    if (extensions == file.end()) return;
    for (const char* name : kOtherImages) {
      source_.check(
          !extensions->contains(name),
          "texture {}, which {} reads, has its image by {} alone; a PNG or JPEG as its source beside "
          "that would be right",
          texture, label("material", material, text(document_["materials"][material], "name")), name);
    }
  }

  static Wrap wrap(int code) {
    if (code == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp_to_edge;
    return code == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirrored_repeat : Wrap::repeat;
  }

  static void set_sampler(const json& sampler, TextureSource& result) {
    result.wrap_u = wrap(sampler.value("wrapS", TINYGLTF_TEXTURE_WRAP_REPEAT));
    result.wrap_v = wrap(sampler.value("wrapT", TINYGLTF_TEXTURE_WRAP_REPEAT));
    result.is_nearest =
        sampler.value("magFilter", TINYGLTF_TEXTURE_FILTER_LINEAR) == TINYGLTF_TEXTURE_FILTER_NEAREST;
  }

  // Its index in what was found. Images of the same bytes are one.
  std::size_t image(std::size_t index) {
    const json& file = document_.at("images").at(index);
    const bool has_view = file.contains("bufferView");
    const std::string name = text(file, "name"), uri = text(file, "uri");
    const std::string place = label("image", index, name);
    source_.check(has_view != file.contains("uri"),
                  "{} has {} uri and bufferView; one of them would be right", place,
                  has_view ? "both" : "neither");
    const std::string key = has_view ? file["bufferView"].dump() : "uri " + uri;
    const auto [known, is_new] = indices_.try_emplace(key, found_.images.size());
    if (!is_new) return known->second;
    ImageBytes& bytes = found_.images.emplace_back();
    bytes.label = place;
    bytes.name = name;
    bytes.media_type = text(file, "mimeType");
    if (has_view) {
      set_view(file["bufferView"].get<std::size_t>(), bytes);
    } else {
      load(uri, bytes);
    }
    return known->second;
  }

  void set_view(std::size_t index, ImageBytes& bytes) const {
    const std::span<const unsigned char> view = view_bytes(source_, document_, buffers_, index);
    const json& file = document_["bufferViews"][index];
    bytes.buffer = file.at("buffer").get<std::size_t>();
    bytes.offset = file.value("byteOffset", std::size_t{0});
    bytes.length = view.size();
  }

  void load(const std::string& uri, ImageBytes& bytes) {
    std::vector<unsigned char> data;
    if (uri.starts_with("data:")) {
      data = decode_data_uri(source_, bytes.label, uri, kDataUri);
      const std::string type = uri.substr(5, uri.find_first_of(";,") - 5);
      if (bytes.media_type.empty() && type.starts_with("image/")) bytes.media_type = type;
    } else {
      const std::filesystem::path file = resolve_uri(source_, bytes.label, uri, folder_);
      const std::string what = fmt::format("{}: {}: '{}'", source_.file, bytes.label, one_line(uri));
      const std::size_t size = regular_file_size(file, what);
      source_.check(size <= rest_,
                    "the images ask for more than {} bytes of files, which is the most supported",
                    max_bytes_);
      rest_ -= size;
      data = read_bytes(file, size, what);
    }
    bytes.buffer = buffers_.size();
    bytes.length = data.size();
    buffers_.emplace_back().data = std::move(data);
  }

  Source& source_;
  const json& document_;
  std::vector<tinygltf::Buffer>& buffers_;
  const std::filesystem::path& folder_;
  std::size_t max_bytes_, rest_;
  std::map<std::string, std::size_t> indices_;
  Textures found_;
};

}  // namespace

Textures find_textures(Source& source, const json& document, std::vector<tinygltf::Buffer>& buffers,
                       const std::filesystem::path& folder, std::size_t max_bytes) {
  std::vector<std::vector<TextureUse>> uses = texture_uses(document);
  Finder finder(source, document, buffers, folder, max_bytes);
  for (std::size_t i = 0; i < uses.size(); ++i) {
    for (const TextureUse& use : uses[i]) finder.add(use.texture, i);
  }
  Textures textures = finder.take();
  textures.uses = std::move(uses);
  return textures;
}

}  // namespace qtrace::gltf
