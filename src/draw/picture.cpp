#include "draw/picture.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "base/text.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxTextBytes = 1024;
constexpr std::string_view kCut = "...";
constexpr std::size_t kChannels = 4;

void set_font(cairo_t* cr, const TextStyle& style) {
  cairo_select_font_face(cr, "sans", CAIRO_FONT_SLANT_NORMAL,
                         style.is_bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, style.size);
}

void drop_last_character(std::string& text) {
  while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80) text.pop_back();
  if (!text.empty()) text.pop_back();
}

std::string cut_to(cairo_t* cr, const TextStyle& style, std::string text, double max_width) {
  if (text_width(cr, style, text) <= max_width) return text;
  while (!text.empty() && text_width(cr, style, text + std::string(kCut)) > max_width) {
    drop_last_character(text);
  }
  return text + std::string(kCut);
}

std::size_t row_bytes(const Pixels& pixels) {
  return static_cast<std::size_t>(pixels.width) * kChannels;
}

// A cairo pixel is one number in the machine's byte order, red in bits 16 to 23. Converts in place:
// a picture of a large window has 15 MB.
void turn_into_cairo_pixels(Pixels& pixels) {
  for (std::size_t i = 0; i < pixels.rgba.size(); i += kChannels) {
    std::uint8_t* p = pixels.rgba.data() + i;
    const std::uint32_t pixel =
        0xff000000u | std::uint32_t{p[0]} << 16 | std::uint32_t{p[1]} << 8 | p[2];
    std::memcpy(p, &pixel, sizeof pixel);
  }
}

}  // namespace

void set_colour(cairo_t* cr, const Colour& c) {
  cairo_set_source_rgba(cr, c.red, c.green, c.blue, c.alpha);
}

void fill_box(cairo_t* cr, const Box& box, const Colour& c) {
  set_colour(cr, c);
  cairo_rectangle(cr, box.x, box.y, box.width, box.height);
  cairo_fill(cr);
}

void stroke_box(cairo_t* cr, const Box& box, const Colour& c, double width) {
  set_colour(cr, c);
  cairo_set_line_width(cr, width);
  cairo_rectangle(cr, box.x + 0.5, box.y + 0.5, box.width - 1.0, box.height - 1.0);
  cairo_stroke(cr);
}

void set_dashes(cairo_t* cr, bool is_dashed) {
  constexpr double kDashes[] = {6.0, 4.0};
  cairo_set_dash(cr, kDashes, is_dashed ? 2 : 0, 0.0);
}

void draw_dot(cairo_t* cr, const vec2& at, double radius, const Colour& c) {
  set_colour(cr, c);
  cairo_arc(cr, at.x, at.y, radius, 0.0, 2.0 * kPi);
  cairo_fill(cr);
}

void line(cairo_t* cr, const vec2& from, const vec2& to) {
  cairo_move_to(cr, from.x, from.y);
  cairo_line_to(cr, to.x, to.y);
}

std::string drawable(std::string_view text) {
  text = text.substr(0, kMaxTextBytes);
  std::string out;
  while (!text.empty()) {
    const std::size_t size = character_bytes(text);
    const auto c = static_cast<unsigned char>(text.front());
    if (size == 0) {
      out += '?';
    } else if (c < 0x20 || c == 0x7f) {
      out += ' ';
    } else {
      out += text.substr(0, size);
    }
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  return out;
}

double text_width(cairo_t* cr, const TextStyle& style, const std::string& text) {
  set_font(cr, style);
  cairo_text_extents_t extents;
  cairo_text_extents(cr, text.c_str(), &extents);
  return extents.x_advance;
}

void draw_text(cairo_t* cr, const TextStyle& style, const vec2& baseline, std::string_view text,
               double max_width) {
  std::string shown = drawable(text);
  if (max_width > 0.0) shown = cut_to(cr, style, std::move(shown), max_width);
  double x = baseline.x;
  if (style.align != Align::left) {
    x -= text_width(cr, style, shown) * (style.align == Align::centre ? 0.5 : 1.0);
  }
  set_font(cr, style);
  set_colour(cr, rgb(style.colour));
  cairo_move_to(cr, x, baseline.y);
  cairo_show_text(cr, shown.c_str());
  cairo_new_path(cr);
}

std::vector<std::string> wrapped(cairo_t* cr, const TextStyle& style, std::string_view text,
                                 double max_width, std::size_t max_lines) {
  const std::string all = drawable(text);
  std::vector<std::string> lines(1);
  std::string_view rest = all;
  while (!rest.empty()) {
    const std::string word(take_part(rest, ' '));
    const std::string longer = lines.back().empty() ? word : lines.back() + " " + word;
    if (lines.back().empty() || text_width(cr, style, longer) <= max_width) {
      lines.back() = longer;
    } else if (lines.size() < max_lines) {
      lines.push_back(word);
    } else {
      lines.back() += std::string(" ") + std::string(kCut);
      break;
    }
  }
  for (std::string& l : lines) l = cut_to(cr, style, std::move(l), max_width);
  return lines;
}

std::string png_of(cairo_surface_t* surface) {
  std::string bytes;
  const auto append = [](void* to, const unsigned char* data, unsigned size) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), size);
    return CAIRO_STATUS_SUCCESS;
  };
  cairo_surface_flush(surface);
  if (cairo_surface_write_to_png_stream(surface, append, &bytes) != CAIRO_STATUS_SUCCESS) return {};
  return bytes;
}

std::optional<Error> write_png(const std::string& path, Pixels pixels) {
  if (pixels.width <= 0 || pixels.height <= 0 ||
      pixels.rgba.size() != row_bytes(pixels) * static_cast<std::size_t>(pixels.height)) {
    return Error{path + ": cannot be written: there is no picture"};
  }
  turn_into_cairo_pixels(pixels);
  const Surface surface(cairo_image_surface_create_for_data(pixels.rgba.data(), CAIRO_FORMAT_RGB24,
                                                            pixels.width, pixels.height,
                                                            static_cast<int>(row_bytes(pixels))));
  return write_png(path, surface.get());
}

std::optional<Error> write_png(const std::string& path, cairo_surface_t* surface) {
  const std::string png = png_of(surface);
  if (png.empty()) return Error{path + ": cannot be written: cairo has no memory"};
  return write_file(path, png);
}

}  // namespace gaitpad
