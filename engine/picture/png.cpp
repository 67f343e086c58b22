#include "engine/picture/png.h"

#include "engine/core/check.h"
#include "engine/core/text.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <vector>

namespace qtrace::picture {
namespace {

// What libpng is handed, and says. It leaves by longjmp() where it fails, so that nothing with a destructor
// may begin between setjmp() and there.
struct State {
  Bytes rest;
  std::array<char, 200> message{};
};

void copy_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto* state = static_cast<State*>(png_get_io_ptr(png));
  if (count > state->rest.size()) png_error(png, "it is cut short");
  std::memcpy(to, state->rest.data(), count);
  state->rest = state->rest.subspan(count);
}

[[noreturn]] void leave(png_structp png, png_const_charp message) {
  auto* state = static_cast<State*>(png_get_error_ptr(png));
  std::strncpy(state->message.data(), message, state->message.size() - 1);
  png_longjmp(png, 1);
}

void ignore_warning(png_structp /*png*/, png_const_charp /*message*/) {}

// The reader and its state; the destructor frees both however decoding ends.
struct Reader {
  explicit Reader(Bytes bytes) : state{bytes, {}} {
    png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &state, leave, ignore_warning);
    if (png != nullptr) info = png_create_info_struct(png);
  }
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  State state;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

// False where libpng failed; state.message then says why.
bool read_header(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_read_fn(reader.png, &reader.state, copy_bytes);
  png_set_user_limits(reader.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // read_size() has limits of its own
  // What a file says of its colours does not count, and what it says in text is nobody's business.
  png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(reader.png, reader.info);
  return true;
}

bool read_rows(Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_expand_16(reader.png);  // also makes colours of palettes and A of tRNS
  png_set_gray_to_rgb(reader.png);
  png_set_add_alpha(reader.png, 0xffff, PNG_FILLER_AFTER);
  if (std::endian::native == std::endian::little) png_set_swap(reader.png);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

void check_done(bool is_done, const Reader& reader, const std::string& what) {
  check(is_done, "{}: the PNG cannot be decoded: {}", what, one_line(reader.state.message.data()));
}

// Deflate makes at most 1032 bytes of one (RFC 1951: 258 bytes by two bits). A file that declares far more
// texels than that is refused before there is memory for them.
void check_is_plausible(Bytes bytes, const Reader& reader, const std::string& what) {
  constexpr std::size_t kMostOfAByte = 1032;
  const std::size_t row = png_get_rowbytes(reader.png, reader.info);
  const std::size_t height = png_get_image_height(reader.png, reader.info);
  check(row * height <= kMostOfAByte * bytes.size(),
        "{}: the PNG is cut short: it declares {} x {} texels and has {} bytes", what,
        png_get_image_width(reader.png, reader.info), height, bytes.size());
}

}  // namespace

Size read_png_size(Bytes bytes, const std::string& what) {
  Reader reader(bytes);
  check(reader.info != nullptr, "{}: libpng cannot be started", what);
  check_done(read_header(reader), reader, what);
  return {png_get_image_width(reader.png, reader.info), png_get_image_height(reader.png, reader.info)};
}

void decode_png(Bytes bytes, const std::string& what, TextureImage& image) {
  Reader reader(bytes);
  check(reader.info != nullptr, "{}: libpng cannot be started", what);
  check_done(read_header(reader), reader, what);
  check_is_plausible(bytes, reader, what);
  image.texels.resize(std::size_t{image.width} * image.height);
  std::vector<png_bytep> rows(image.height);
  for (std::size_t y = 0; y < rows.size(); ++y) {
    rows[y] = reinterpret_cast<png_bytep>(image.texels.data() + y * image.width);
  }
  check_done(read_rows(reader, rows.data()), reader, what);
}

}  // namespace qtrace::picture
