// Dear ImGui on the window: its context, SDL2 and OpenGL 3 back ends, fonts and style.
#pragma once
#include "view/controls.h"
#include "view/surface.h"
#include "view/theme.h"

namespace gaitpad {

class Gui {
 public:
  explicit Gui(const WindowSurface& surface);  // one at a time
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  const Fonts& fonts() const noexcept { return fonts_; }
  void apply(const Theme& theme);
  void take(const SDL_Event& event);
  Taken taken() const noexcept;
  // `passed_s` > 0: instead of the clock's, for pictures.
  void begin(const Mouse& mouse, double passed_s);
  void end();  // draws into the frame buffer that is bound

 private:
  double scale_ = 1.0;
  Fonts fonts_;
};

}  // namespace gaitpad
