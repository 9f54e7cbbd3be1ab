// Pictures in memory with cairo: colours, lines, text, PNG files. Without an installed font cairo
// draws with a built-in one.
#pragma once
#include <cairo/cairo.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/math.h"
#include "gaitpad/result.h"

namespace gaitpad {

struct Colour {
  double red = 0.0, green = 0.0, blue = 0.0, alpha = 1.0;
};
constexpr Colour rgb(unsigned hex, double alpha = 1.0) {
  return {((hex >> 16) & 0xff) / 255.0, ((hex >> 8) & 0xff) / 255.0, (hex & 0xff) / 255.0, alpha};
}
inline Colour faint(Colour colour, double alpha) {
  colour.alpha = alpha;
  return colour;
}
inline Colour mixed(const Colour& a, const Colour& b, double share) {
  return {mix(a.red, b.red, share), mix(a.green, b.green, share), mix(a.blue, b.blue, share),
          a.alpha};
}
// Okabe and Ito's palette, distinguishable with any colour vision, and greys.
namespace colour {
inline constexpr unsigned kOrange = 0xe69f00, kSkyBlue = 0x56b4e9, kGreen = 0x009e73,
                          kBlue = 0x0072b2, kVermilion = 0xd55e00, kPurple = 0xcc79a7;
inline constexpr unsigned kPaper = 0xf4f5f7, kCard = 0xffffff, kBorder = 0xd5d9df, kGrid = 0xe6e9ed,
                          kFaint = 0x6b7480, kInk = 0x1d2430;
}  // namespace colour

struct SurfaceDeleter {
  void operator()(cairo_surface_t* s) const noexcept { cairo_surface_destroy(s); }
};
struct CairoDeleter {
  void operator()(cairo_t* c) const noexcept { cairo_destroy(c); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;
using Cairo = std::unique_ptr<cairo_t, CairoDeleter>;

struct Box {  // a rectangle in pixels, y downwards
  double x = 0.0, y = 0.0, width = 0.0, height = 0.0;
};

enum class Align { left, centre, right };
struct TextStyle {
  double size = 13.0;  // height of the type in pixels
  unsigned colour = colour::kInk;
  Align align = Align::left;
  bool is_bold = false;
};

void set_colour(cairo_t* cr, const Colour& c);
void fill_box(cairo_t* cr, const Box& box, const Colour& c);
void stroke_box(cairo_t* cr, const Box& box, const Colour& c, double width);
void set_dashes(cairo_t* cr, bool is_dashed);
void draw_dot(cairo_t* cr, const vec2& at, double radius, const Colour& c);
// Adds a line to the path without drawing it.
void line(cairo_t* cr, const vec2& from, const vec2& to);

// While an object of this class exists, drawing is clipped to the box.
class Clipped {
 public:
  Clipped(cairo_t* cr, const Box& box) : cr_(cr) {
    cairo_save(cr);
    cairo_rectangle(cr, box.x, box.y, box.width, box.height);
    cairo_clip(cr);
  }
  ~Clipped() { cairo_restore(cr_); }
  Clipped(const Clipped&) = delete;
  Clipped& operator=(const Clipped&) = delete;

 private:
  cairo_t* cr_;
};

// Makes text from outside, such as a device's name, valid UTF-8 on one line of at most 1024 bytes:
// invalid bytes become `?`, control characters become blanks.
std::string drawable(std::string_view text);
double text_width(cairo_t* cr, const TextStyle& style, const std::string& text);
// Draws at this baseline. Text wider than `max_width` (0: no limit) is cut and ends with `...`.
void draw_text(cairo_t* cr, const TextStyle& style, const vec2& baseline, std::string_view text,
               double max_width = 0.0);
// Breaks the text between words into at most `max_lines` lines; text that does not fit is cut and
// ends with `...`.
std::vector<std::string> wrapped(cairo_t* cr, const TextStyle& style, std::string_view text,
                                 double max_width, std::size_t max_lines);

// The bytes of a PNG file; empty if cairo has no memory.
std::string png_of(cairo_surface_t* surface);

struct Pixels {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;  // four bytes for each pixel, rows from the top, opaque
};
// Both functions write beside `path` first and rename, so that an error leaves the old file
// unchanged.
std::optional<Error> write_png(const std::string& path, Pixels pixels);
std::optional<Error> write_png(const std::string& path, cairo_surface_t* surface);

}  // namespace gaitpad
