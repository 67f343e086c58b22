#include "engine/picture/jpeg.h"

#include "engine/core/check.h"
#include "engine/core/text.h"

#include <cstdio>  // jpeglib.h uses FILE and does not include it

#include <jpeglib.h>

#include <jerror.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <vector>

namespace qtrace::picture {
namespace {

// Of a progressive picture; each of them may change all of it. Encoders write about ten.
constexpr int kMostScans = 500;

// A decoder and what it says. libjpeg leaves by longjmp() where it fails, so that nothing with a destructor
// may begin between setjmp() and there. The destructor frees its memory however decoding ends.
struct Reader {
  Reader() {
    jpeg.err = jpeg_std_error(&errors);
    errors.error_exit = leave;
    errors.emit_message = note;
    errors.output_message = [](j_common_ptr) {};
    jpeg.client_data = this;
    progress.progress_monitor = count_scans;
  }
  ~Reader() { jpeg_destroy_decompress(&jpeg); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  [[noreturn]] static void leave(j_common_ptr common) {
    auto* reader = static_cast<Reader*>(common->client_data);
    common->err->format_message(common, reader->message.data());
    std::longjmp(reader->jump, 1);
  }

  // Where data is missing libjpeg warns and goes on with grey.
  static void note(j_common_ptr common, int level) {
    constexpr std::array kLosses{JWRN_HIT_MARKER,   JWRN_HUFF_BAD_CODE,  JWRN_JPEG_EOF,
                                 JWRN_MUST_RESYNC,  JWRN_ARITH_BAD_CODE, JWRN_BOGUS_PROGRESSION,
                                 JWRN_TOO_MUCH_DATA};
    const bool is_loss = level < 0 && std::ranges::count(kLosses, common->err->msg_code) > 0;
    if (is_loss) leave(common);
  }

  static void count_scans(j_common_ptr common) {
    if (reinterpret_cast<j_decompress_ptr>(common)->input_scan_number <= kMostScans) return;
    auto* reader = static_cast<Reader*>(common->client_data);
    reader->has_too_many_scans = true;
    std::longjmp(reader->jump, 1);
  }

  std::string reason() const {
    return has_too_many_scans ? fmt::format("it has more than {} scans", kMostScans)
                              : one_line(message.data());
  }

  jpeg_decompress_struct jpeg{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr progress{};
  std::jmp_buf jump{};
  std::array<char, JMSG_LENGTH_MAX> message{};
  bool has_too_many_scans = false;
};

// False where libjpeg failed; the reader then knows why.
bool read_header(Reader& reader, Bytes bytes) {
  if (setjmp(reader.jump) != 0) return false;
  jpeg_create_decompress(&reader.jpeg);
  reader.jpeg.client_data = &reader;
  reader.jpeg.progress = &reader.progress;
  jpeg_mem_src(&reader.jpeg, bytes.data(), static_cast<unsigned long>(bytes.size()));
  jpeg_read_header(&reader.jpeg, TRUE);
  return true;
}

void widen(const std::vector<JSAMPLE>& row, TextureImage::Texel* texels) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    texels[i / 4][i % 4] = static_cast<std::uint16_t>(row[i] * 257U);
  }
}

bool read_rows(Reader& reader, std::vector<JSAMPLE>& row, TextureImage& image) {
  if (setjmp(reader.jump) != 0) return false;
  reader.jpeg.out_color_space = JCS_EXT_RGBA;
  jpeg_start_decompress(&reader.jpeg);
  while (reader.jpeg.output_scanline < reader.jpeg.output_height) {
    TextureImage::Texel* texels =
        image.texels.data() + std::size_t{reader.jpeg.output_scanline} * image.width;
    JSAMPROW to = row.data();
    jpeg_read_scanlines(&reader.jpeg, &to, 1);
    widen(row, texels);
  }
  jpeg_finish_decompress(&reader.jpeg);
  return true;
}

void check_done(bool is_done, const Reader& reader, const std::string& what) {
  check(is_done, "{}: the JPEG cannot be decoded: {}", what, reader.reason());
}

}  // namespace

Size read_jpeg_size(Bytes bytes, const std::string& what) {
  Reader reader;
  check_done(read_header(reader, bytes), reader, what);
  return {reader.jpeg.image_width, reader.jpeg.image_height};
}

void decode_jpeg(Bytes bytes, const std::string& what, TextureImage& image) {
  Reader reader;
  check_done(read_header(reader, bytes), reader, what);
  const J_COLOR_SPACE space = reader.jpeg.jpeg_color_space;
  check(space == JCS_GRAYSCALE || space == JCS_YCbCr || space == JCS_RGB,
        "{}: the JPEG has the colours of a print ({}); RGB or grey would be right", what,
        space == JCS_YCCK   ? "YCCK"
        : space == JCS_CMYK ? "CMYK"
                            : "unknown");
  image.texels.resize(std::size_t{image.width} * image.height);
  std::vector<JSAMPLE> row(std::size_t{4} * image.width);
  check_done(read_rows(reader, row, image), reader, what);
}

}  // namespace qtrace::picture
