// Notices that the X server has gone, so that the window ends in good order: Xlib would end the
// program on the spot, recordings half-written. Other displays tell by SDL_QUIT.
#pragma once
#include <SDL2/SDL_video.h>

namespace gaitpad {

// For this window, until the program ends; nothing where it is no X window.
void watch_display(SDL_Window* window) noexcept;
// From then on the window is not to be drawn into, shown or closed.
bool is_display_lost() noexcept;

}  // namespace gaitpad
