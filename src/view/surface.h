// The window of the display, or a picture in memory where there is none: SDL and its OpenGL 3.3
// core context; and what was drawn, as a PNG.
// (As a video: view/video.h.)
//
// SDL has one state for the whole program, and drivers/sdl_driver.cpp uses its joysticks on another
// thread. Both live together by four rules:
// - Starting and stopping SDL's parts is safe from one thread at a time only: a surface is opened
//   before the first LiveSession starts and closed after the last one was stopped.
// - Each stops what it started (SDL_QuitSubSystem), nobody calls SDL_Quit().
// - Only the window's thread takes events off SDL's queue. It looks at no joystick while doing so
//   (SDL_HINT_AUTO_UPDATE_JOYSTICKS is off: looking waits for the kernel when one was plugged in);
//   the driver looks at them on its own thread, sees them by a watch, and throws away what it finds
//   of them on the queue: a window does not count on SDL's joystick events.
// - SDL's signal handlers stay out; Ctrl-C is the program's own.
#pragma once
#include <SDL2/SDL.h>

#include <cstdint>
#include <memory>
#include <string>

#include "draw/picture.h"
#include "gaitpad/result.h"

namespace gaitpad {

struct SurfaceOptions {
  std::string title = "gaitpad";
  int width = 1280, height = 720;  // pixels at scale 1
  double scale = 0.0;              // 0: the display's
  bool is_hidden = false;          // only pictures are wanted: SDL's offscreen driver, at scale 1
};

class WindowSurface {
 public:
  // One sentence where there is neither a display nor EGL, and what to do. Without a display only
  // what is hidden opens, or what $SDL_VIDEODRIVER asks for: a window that nobody sees would never
  // be closed. One at a time.
  static Result<std::unique_ptr<WindowSurface>> open(const SurfaceOptions& options);
  ~WindowSurface();
  SDL_Window* window() const noexcept { return window_; }
  SDL_GLContext context() const noexcept { return context_; }
  double scale() const noexcept { return scale_; }
  void size(int& width_px, int& height_px) const noexcept;  // drawable pixels
  // Before anything of a frame is drawn: binds the frame buffer that it goes into, of that size.
  // The window's own, or, as SDL's offscreen windows do not grow, one in memory.
  void begin();
  void show();  // what was drawn: swaps
  // The X server has gone: nothing can be shown or asked any more, no further call here or of SDL's
  // video is to be made, the program is to come to its end. (Xlib would have ended it at once, in
  // the middle of a recording.)
  bool is_lost() const noexcept;

 private:
  WindowSurface() = default;
  void outlive_x_server();
  SDL_Window* window_ = nullptr;
  SDL_GLContext context_ = nullptr;
  double scale_ = 1.0;
  // Offscreen: frame buffer, its picture, their size.
  unsigned frame_buffer_ = 0, picture_ = 0;
  int width_px_ = 0, height_px_ = 0;
};

// Of the frame buffer that is bound, between begin() and show().
Pixels read_pixels(int width, int height);
}  // namespace gaitpad
