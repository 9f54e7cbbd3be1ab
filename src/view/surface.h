// A window on the display, or a picture in memory without one: SDL and its OpenGL 3.3 core context.
//
// SDL has one state for the whole program, and drivers/sdl_driver.cpp uses its joysticks on another
// thread. Four rules keep the two apart:
// - Starting and stopping SDL's subsystems is not thread-safe: open a surface before the first
//   LiveSession starts and close it after the last one has stopped.
// - Each side stops what it started (SDL_QuitSubSystem); SDL_Quit() is never called.
// - Only the window's thread takes events off SDL's queue. It does not update joysticks then
//   (SDL_HINT_AUTO_UPDATE_JOYSTICKS is off), because that waits for the kernel after a hot plug.
//   The driver updates them on its own thread, sees their events by an event watch and removes
//   those that it finds on the queue, so the window must not rely on SDL's joystick events.
// - SDL installs no signal handlers; the program handles Ctrl-C itself.
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
  int width = 1280, height = 720;  // size in pixels at scale 1
  double scale = 0.0;              // factor on sizes; 0: the display's own
  std::string without_display;     // what to do without a display, for the error
  bool is_hidden = false;          // no window: only pictures, by SDL's offscreen driver at scale 1
};

class WindowSurface {
 public:
  // Only one surface may be open. The error says what to do without a display and without EGL.
  // Without a display only a hidden surface opens, or one that $SDL_VIDEODRIVER asks for, because
  // an invisible window could not be closed.
  static Result<std::unique_ptr<WindowSurface>> open(const SurfaceOptions& options);
  ~WindowSurface();
  SDL_Window* window() const noexcept { return window_; }
  SDL_GLContext context() const noexcept { return context_; }
  double scale() const noexcept { return scale_; }
  // Call it after the window was moved: takes the scale of its display. Returns true if it changed.
  bool follow_display() noexcept;
  void size(int& width_px, int& height_px) const noexcept;  // The size in drawable pixels.
  // Call it before drawing a frame: binds the frame buffer to draw into, which has that size. It is
  // the window's own, or one in memory, because SDL's offscreen windows cannot grow.
  void begin();
  void show();  // Swaps the buffers, so that the display shows the frame.
  // True after the X server has gone. Then no function of this class or of SDL's video may be
  // called, and the program has to end. (Xlib alone would end it at once, in the middle of a
  // recording.)
  bool is_lost() const noexcept;

 private:
  WindowSurface() = default;
  void outlive_x_server();
  SDL_Window* window_ = nullptr;
  SDL_GLContext context_ = nullptr;
  SurfaceOptions options_;
  double scale_ = 1.0;
  // Offscreen: the frame buffer, its render buffer and their size.
  unsigned frame_buffer_ = 0, picture_ = 0;
  int width_px_ = 0, height_px_ = 0;
};

// Reads the bound frame buffer; call it between begin() and show().
Pixels read_pixels(int width, int height);
}  // namespace gaitpad
