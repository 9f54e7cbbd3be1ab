// What was drawn, as a PNG.
#include <cairo/cairo.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <cstring>

#include "base/files.h"
#include "view/drawing.h"
#include "view/surface.h"

namespace gaitpad {
namespace {

constexpr std::size_t kChannels = 4;

std::size_t row_bytes(const Pixels& pixels) {
  return static_cast<std::size_t>(pixels.width) * kChannels;
}

// Cairo's pixels are one native number each, red in bits 16 to 23.
std::vector<std::uint32_t> cairo_pixels(const Pixels& pixels) {
  std::vector<std::uint32_t> out(pixels.rgba.size() / kChannels);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint8_t* p = pixels.rgba.data() + i * kChannels;
    out[i] = 0xff000000u | std::uint32_t{p[0]} << 16 | std::uint32_t{p[1]} << 8 | p[2];
  }
  return out;
}

std::string encoded(const Pixels& pixels) {
  std::vector<std::uint32_t> rgb = cairo_pixels(pixels);
  const Surface surface(cairo_image_surface_create_for_data(
      reinterpret_cast<unsigned char*>(rgb.data()), CAIRO_FORMAT_RGB24, pixels.width, pixels.height,
      static_cast<int>(row_bytes(pixels))));
  return png_of(surface.get());
}

}  // namespace

Pixels read_pixels(int width, int height) {
  Pixels pixels{std::max(width, 0), std::max(height, 0), {}};
  const std::size_t row = row_bytes(pixels), rows = static_cast<std::size_t>(pixels.height);
  std::vector<std::uint8_t> upwards(row * rows);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, pixels.width, pixels.height, GL_RGBA, GL_UNSIGNED_BYTE, upwards.data());
  pixels.rgba.resize(upwards.size());
  for (std::size_t y = 0; y < rows; ++y) {
    std::memcpy(pixels.rgba.data() + y * row, upwards.data() + (rows - 1 - y) * row, row);
  }
  for (std::size_t i = 3; i < pixels.rgba.size(); i += kChannels) pixels.rgba[i] = 0xff;
  return pixels;
}

std::optional<Error> write_png(const std::string& path, const Pixels& pixels) {
  if (pixels.width <= 0 || pixels.height <= 0 ||
      pixels.rgba.size() != row_bytes(pixels) * static_cast<std::size_t>(pixels.height)) {
    return Error{path + ": cannot be written: there is no picture"};
  }
  const std::string png = encoded(pixels);
  if (png.empty()) return Error{path + ": cannot be written: cairo has no memory"};
  return write_file(path, png);
}

}  // namespace gaitpad
