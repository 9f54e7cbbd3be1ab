#include "view/drawing.h"

#include <algorithm>

#include "base/text.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMaxTextBytes = 1024;
constexpr std::string_view kCut = "...";

void use(cairo_t* cr, const TextStyle& style) {
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
  use(cr, style);
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
  use(cr, style);
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

}  // namespace gaitpad

// Fontconfig and D-Bus (through SDL) keep what they looked up until the process ends, out of the
// leak checker's sight.
#ifdef __SANITIZE_ADDRESS__
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libdbus-1\n"
         "leak:libfontconfig";
}
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
// A thread-local block that glibc allocates for Mesa on the heap, 16 bytes into a page: GCC 12's
// libasan takes it for one of glibc 2.19, whose size stands before it, and the leak checker reads
// astray and crashes. Not told of such blocks it finds them all the same, as what the dynamic
// linker allocated.
extern "C" const char* __asan_default_options() { return "intercept_tls_get_addr=0"; }
#endif
