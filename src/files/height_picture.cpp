#include "files/height_picture.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstring>

#include "files/input_files.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMaxBytes = 4 << 20;

// libpng reports errors by longjmp, which skips destructors: no function here that calls libpng may
// hold an object with a destructor.
struct PngReader {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string_view bytes;
  std::size_t at = 0;
  std::array<char, 160> problem{};
};

void keep_problem(png_structp png, const char* text) {
  auto& reader = *static_cast<PngReader*>(png_get_error_ptr(png));
  std::strncpy(reader.problem.data(), text, reader.problem.size() - 1);
  png_longjmp(png, 1);
}

void take_bytes(png_structp png, png_bytep to, png_size_t count) {
  auto& reader = *static_cast<PngReader*>(png_get_io_ptr(png));
  if (count > reader.bytes.size() - reader.at) png_error(png, "it ends too early");
  std::memcpy(to, reader.bytes.data() + reader.at, count);
  reader.at += count;
}

bool begin(PngReader& reader) noexcept {
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, &keep_problem,
                                      [](png_structp, const char*) {});
  if (reader.png == nullptr) return false;
  reader.info = png_create_info_struct(reader.png);
  if (reader.info == nullptr) return false;
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  png_set_read_fn(reader.png, &reader, &take_bytes);
  png_set_user_limits(reader.png, kMaxPictureSide, kMaxPictureSide);
  png_set_chunk_cache_max(reader.png, 16);
  png_set_chunk_malloc_max(reader.png, 1 << 16);
  png_set_keep_unknown_chunks(reader.png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
  png_read_info(reader.png, reader.info);
  const int colours = png_get_color_type(reader.png, reader.info);
  if (colours != PNG_COLOR_TYPE_GRAY && colours != PNG_COLOR_TYPE_GRAY_ALPHA)
    png_error(reader.png, "it is not grey");
  png_set_expand_gray_1_2_4_to_8(reader.png);
  png_set_strip_alpha(reader.png);
  return true;
}

// Reads all rows into `to`, one or two bytes per sample, `row_bytes` per row.
bool read_rows(PngReader& reader, png_bytep to, std::size_t row_bytes, std::size_t rows) noexcept {
  if (setjmp(png_jmpbuf(reader.png)) != 0) return false;
  const int passes = png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  if (png_get_rowbytes(reader.png, reader.info) != row_bytes)
    png_error(reader.png, "it is not grey");
  for (int pass = 0; pass < passes; ++pass) {
    for (std::size_t row = 0; row < rows; ++row)
      png_read_row(reader.png, to + row * row_bytes, nullptr);
  }
  png_read_end(reader.png, nullptr);
  return true;
}

bool read(PngReader& reader, HeightPicture& picture) {
  if (!begin(reader)) return false;
  picture.columns = static_cast<int>(png_get_image_width(reader.png, reader.info));
  picture.rows = static_cast<int>(png_get_image_height(reader.png, reader.info));
  const auto columns = static_cast<std::size_t>(picture.columns);
  const auto rows = static_cast<std::size_t>(picture.rows);
  const std::size_t bytes = png_get_bit_depth(reader.png, reader.info) == 16 ? 2 : 1;
  std::vector<png_byte> raw(columns * rows * bytes);
  if (!read_rows(reader, raw.data(), columns * bytes, rows)) return false;
  picture.samples.resize(columns * rows);
  for (std::size_t i = 0; i < picture.samples.size(); ++i) {
    picture.samples[i] =
        static_cast<std::uint16_t>(bytes == 2 ? raw[2 * i] * 256 + raw[2 * i + 1] : raw[i] * 257);
  }
  return true;
}

}  // namespace

Result<HeightPicture> height_picture(std::string_view png, const std::string& name) {
  PngReader reader;
  reader.bytes = png;
  HeightPicture picture;
  const bool is_read = read(reader, picture);
  png_destroy_read_struct(&reader.png, &reader.info, nullptr);
  if (is_read) return picture;
  const std::string cause = reader.problem[0] != '\0' ? reader.problem.data() : "no memory";
  return Error{
      fmt::format("{}: is not a height picture (a grey PNG of at most {} samples a side): {}", name,
                  kMaxPictureSide, cause)};
}

Result<HeightPicture> load_height_picture(const std::string& path) {
  auto bytes = input_text(path, kMaxBytes);
  if (!bytes) return bytes.error();
  return height_picture(*bytes, path);
}

}  // namespace gaitpad
