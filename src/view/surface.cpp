#include "view/surface.h"

#include <SDL2/SDL_syswm.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <utility>

#include "view/gui.h"

namespace gaitpad {
namespace {

constexpr int kSmallest_px = 64, kLargestWindow_px = 16384;
// The window's least size at scale 1.
constexpr int kSmallestWindowWidth = 640, kSmallestWindowHeight = 400;
constexpr int kNeededGl = 33;  // OpenGL 3.3
constexpr const char* kPictures = "--screenshot FILE.png and --video FILE.mp4 draw without one";

std::atomic<bool> is_display_lost = false;  // Xlib's connection outlives every surface

bool is_offscreen(const char* driver) {
  const std::string_view name = driver ? driver : "";
  return name == "offscreen" || name == "dummy";
}

void set_hints(bool is_hidden) {
  constexpr std::pair<const char*, const char*> kHints[] = {
      {SDL_HINT_NO_SIGNAL_HANDLERS, "1"},
      {SDL_HINT_AUTO_UPDATE_JOYSTICKS, "0"},
      {SDL_HINT_APP_NAME, "gaitpad"},
      {SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0"}};
  for (const auto& [name, value] : kHints) SDL_SetHintWithPriority(name, value, SDL_HINT_OVERRIDE);
  if (is_hidden) {
    SDL_SetHintWithPriority(SDL_HINT_VIDEODRIVER, "offscreen", SDL_HINT_OVERRIDE);
  } else {
    SDL_ResetHint(SDL_HINT_VIDEODRIVER);  // lets $SDL_VIDEODRIVER choose the driver again
    // Without this folder Wayland cannot work, and its library would print an error.
    const char* runtime = std::getenv("XDG_RUNTIME_DIR");
    if (!runtime || *runtime == '\0') SDL_SetHint(SDL_HINT_VIDEODRIVER, "x11,KMSDRM,offscreen");
  }
}

// The reason why SDL's video driver cannot open a window; empty if it can.
std::string display_problem(const SurfaceOptions& options) {
  if (options.is_hidden || !is_offscreen(SDL_GetCurrentVideoDriver())) return {};
  const char* asked = std::getenv("SDL_VIDEODRIVER");
  if (asked && is_offscreen(asked)) return {};
  return fmt::format("no display to open a window on; {}, {}", options.without_display, kPictures);
}

std::string video_problem(const SurfaceOptions& options) {
  const std::string cause = SDL_GetError();
  if (options.is_hidden) return fmt::format("nothing to draw on without a display: {}", cause);
  return fmt::format("no display to open a window on: {}; {}, {}", cause, options.without_display,
                     kPictures);
}

// The scene has its own frame buffers for anti-aliasing and depth.
void set_gl_attributes() {
  SDL_GL_ResetAttributes();
  SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, kNeededGl / 10);
  SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, kNeededGl % 10);
  SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
  SDL_GL_SetAttribute(SDL_GL_DOUBLEBUFFER, 1);
  SDL_GL_SetAttribute(SDL_GL_DEPTH_SIZE, 24);
}

double scale_of_display(const SurfaceOptions& options, int display) {
  float dots_per_inch = 0.0f;
  if (options.is_hidden || SDL_GetDisplayDPI(display, &dots_per_inch, nullptr, nullptr) != 0) {
    dots_per_inch = 0.0f;
  }
  return display_scale(options.scale, static_cast<double>(dots_per_inch));
}

int scaled(int pixels, double scale) {
  return static_cast<int>(
      std::lround(std::clamp(pixels * scale, 1.0 * kSmallest_px, 1.0 * kLargestWindow_px)));
}

SDL_Window* new_window(const SurfaceOptions& options, double scale) {
  int width = scaled(options.width, scale), height = scaled(options.height, scale);
  SDL_Rect usable{};
  if (!options.is_hidden && SDL_GetDisplayUsableBounds(0, &usable) == 0 && usable.w > 0) {
    width = std::min(width, std::max(usable.w, kSmallest_px));
    height = std::min(height, std::max(usable.h, kSmallest_px));
  }
  // Without SDL_WINDOW_ALLOW_HIGHDPI a window is measured in drawable pixels on every driver.
  const Uint32 flags = SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE;
  SDL_Window* window = SDL_CreateWindow(options.title.c_str(), SDL_WINDOWPOS_CENTERED,
                                        SDL_WINDOWPOS_CENTERED, width, height, flags);
  if (window && !options.is_hidden) {
    SDL_SetWindowMinimumSize(window, std::min(width, scaled(kSmallestWindowWidth, scale)),
                             std::min(height, scaled(kSmallestWindowHeight, scale)));
  }
  return window;
}

Error gl_problem(const char* what) {
  return Error{
      fmt::format("no OpenGL 3.3: {}: {}; Debian has a renderer for every machine in "
                  "libgl1-mesa-dri",
                  what, SDL_GetError())};
}

}  // namespace

Result<std::unique_ptr<WindowSurface>> WindowSurface::open(const SurfaceOptions& options) {
  set_hints(options.is_hidden);
  if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0) return Error{video_problem(options)};
  std::unique_ptr<WindowSurface> surface(new WindowSurface);  // its destructor stops SDL's video
  if (std::string problem = display_problem(options); !problem.empty()) {
    return Error{std::move(problem)};
  }
  surface->options_ = options;
  surface->scale_ = scale_of_display(options, 0);
  set_gl_attributes();
  surface->window_ = new_window(options, surface->scale_);
  if (!surface->window_) return gl_problem("no window");
  surface->context_ = SDL_GL_CreateContext(surface->window_);
  if (!surface->context_) return gl_problem("no context");
  if (SDL_GL_MakeCurrent(surface->window_, surface->context_) != 0) {
    return gl_problem("the context is refused");
  }
  if (epoxy_gl_version() < kNeededGl) {
    return Error{fmt::format("no OpenGL 3.3: {} has {}.{}",
                             reinterpret_cast<const char*>(glGetString(GL_RENDERER)),
                             epoxy_gl_version() / 10, epoxy_gl_version() % 10)};
  }
  surface->outlive_x_server();
  // Swaps in step with the display; if that is impossible, the caller limits the rate.
  SDL_GL_SetSwapInterval(options.is_hidden ? 0 : 1);
  return surface;
}

bool WindowSurface::follow_display() noexcept {
  const double before = scale_;
  scale_ = scale_of_display(options_, std::max(SDL_GetWindowDisplayIndex(window_), 0));
  return scale_ != before;
}

// After an I/O error Xlib ends the program, in the error handler or right after it. Both handlers
// must be replaced, which versions before 1.7 do not allow. A swap that the lost server does not
// answer first gives a request error (GLXBadDrawable), which would also end the program. It is
// ignored; the next request gives an I/O error.
void WindowSurface::outlive_x_server() {
#ifdef SDL_VIDEO_DRIVER_X11
  using SetHandler = void (*)(int (*)(Display*));
  using SetErrorHandler = void (*)(int (*)(Display*, XErrorEvent*));
  using SetExit = void (*)(Display*, void (*)(Display*, void*), void*);
  SDL_SysWMinfo info;
  SDL_VERSION(&info.version);
  if (!SDL_GetWindowWMInfo(window_, &info) || info.subsystem != SDL_SYSWM_X11) return;
  void* xlib = SDL_LoadObject("libX11.so.6");  // SDL has loaded it already
  if (!xlib) return;
  const auto set_exit = reinterpret_cast<SetExit>(SDL_LoadFunction(xlib, "XSetIOErrorExitHandler"));
  const auto set_handler =
      reinterpret_cast<SetHandler>(SDL_LoadFunction(xlib, "XSetIOErrorHandler"));
  const auto set_error_handler =
      reinterpret_cast<SetErrorHandler>(SDL_LoadFunction(xlib, "XSetErrorHandler"));
  if (set_exit && set_handler && set_error_handler) {
    set_error_handler([](Display*, XErrorEvent*) { return 0; });
    set_handler([](Display*) { return 0; });
    set_exit(
        info.info.x11.display, [](Display*, void*) { is_display_lost = true; }, nullptr);
  }
  SDL_UnloadObject(xlib);
#endif
}

bool WindowSurface::is_lost() const noexcept { return is_display_lost; }

WindowSurface::~WindowSurface() {
  if (is_display_lost) return;  // SDL would wait for the server without end
  if (frame_buffer_ != 0) {
    glDeleteRenderbuffers(1, &picture_);
    glDeleteFramebuffers(1, &frame_buffer_);
  }
  if (context_) SDL_GL_DeleteContext(context_);
  if (window_) SDL_DestroyWindow(window_);
  SDL_QuitSubSystem(SDL_INIT_VIDEO);
}

void WindowSurface::size(int& width_px, int& height_px) const noexcept {
  SDL_GL_GetDrawableSize(window_, &width_px, &height_px);
}

void WindowSurface::begin() {
  int width_px = 0, height_px = 0;
  size(width_px, height_px);
  if (!is_offscreen(SDL_GetCurrentVideoDriver())) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return;
  }
  if (frame_buffer_ == 0) {
    glGenFramebuffers(1, &frame_buffer_);
    glGenRenderbuffers(1, &picture_);
  }
  glBindFramebuffer(GL_FRAMEBUFFER, frame_buffer_);
  if (width_px == width_px_ && height_px == height_px_) return;
  glBindRenderbuffer(GL_RENDERBUFFER, picture_);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width_px, height_px);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, picture_);
  width_px_ = width_px;
  height_px_ = height_px;
}

void WindowSurface::show() {
  SDL_GL_SwapWindow(window_);
  // Without a display the driver queues frames without end, so wait for each.
  if (is_offscreen(SDL_GetCurrentVideoDriver())) glFinish();
}

Pixels read_pixels(int width, int height) {
  constexpr std::size_t kChannels = 4;
  Pixels pixels{std::max(width, 0), std::max(height, 0), {}};
  const std::size_t row = static_cast<std::size_t>(pixels.width) * kChannels;
  pixels.rgba.resize(row * static_cast<std::size_t>(pixels.height));
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, pixels.width, pixels.height, GL_RGBA, GL_UNSIGNED_BYTE, pixels.rgba.data());
  // OpenGL's rows begin at the bottom.
  std::uint8_t *upper = pixels.rgba.data(), *lower = upper + pixels.rgba.size();
  for (int y = 0; y < pixels.height / 2; ++y, upper += row) {
    lower -= row;
    std::swap_ranges(upper, upper + row, lower);
  }
  for (std::size_t i = 3; i < pixels.rgba.size(); i += kChannels) pixels.rgba[i] = 0xff;
  return pixels;
}

}  // namespace gaitpad
