#include "view/display_guard.h"

#include <SDL2/SDL_syswm.h>
#include <dlfcn.h>

#include <atomic>

namespace gaitpad {
namespace {

std::atomic<bool> is_lost{false};

}  // namespace

bool is_display_lost() noexcept { return is_lost.load(); }

#ifdef SDL_VIDEO_DRIVER_X11
namespace {

int note_loss(Display*) {
  is_lost = true;
  return 0;
}
// Returning from here is allowed: what is asked of Xlib afterwards fails and does nothing.
void go_on(Display*, void*) { is_lost = true; }

// SDL has loaded Xlib itself, or there is none.
template <class Function>
Function xlib_function(const char* name) noexcept {
  void* library = ::dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD);
  return library ? reinterpret_cast<Function>(::dlsym(library, name)) : nullptr;
}

}  // namespace

void watch_display(SDL_Window* window) noexcept {
  is_lost = false;
  SDL_SysWMinfo info;
  SDL_VERSION(&info.version);
  if (SDL_GetWindowWMInfo(window, &info) != SDL_TRUE || info.subsystem != SDL_SYSWM_X11) return;
  using SetHandler = XIOErrorHandler (*)(XIOErrorHandler);
  using SetExitHandler = void (*)(Display*, void (*)(Display*, void*), void*);
  const auto set_handler = xlib_function<SetHandler>("XSetIOErrorHandler");
  const auto set_exit = xlib_function<SetExitHandler>("XSetIOErrorExitHandler");
  if (set_handler == nullptr || set_exit == nullptr) return;  // Xlib before 1.7
  set_handler(&note_loss);
  set_exit(info.info.x11.display, &go_on, nullptr);
}
#else
void watch_display(SDL_Window*) noexcept { is_lost = false; }
#endif

}  // namespace gaitpad
