// soak SECONDS MOTION MOTION: runs the window for a long time with everything that may leak: a pad
// plugged in and out, styles, panels, themes, motions loaded again. Prints the memory in use every
// few seconds; exit status 1 if it grows. tools/soak.sh builds it and makes the motions.
#include <SDL2/SDL.h>
#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "gaitpad/config_files.h"
#include "view/window.h"

namespace gaitpad {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kLook_s = 5.0, kPlug_s = 8.0, kStyle_s = 1.7, kKey_s = 0.9, kLoad_s = 11.0;
// Allowed growth from the second quarter to the last one; in the first the caches fill.
constexpr double kGrowth_mb = 4.0;

// Sanitizers keep freed memory.
#ifdef GAITPAD_SANITIZED
constexpr bool kIsJudged = false;
#else
constexpr bool kIsJudged = true;
#endif

double resident_mb() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1e6;
}

// A pad that only SDL sees.
class VirtualPad {
 public:
  void plug() {
    SDL_VirtualJoystickDesc desc{};
    desc.version = SDL_VIRTUAL_JOYSTICK_DESC_VERSION;
    desc.type = SDL_JOYSTICK_TYPE_GAMECONTROLLER;
    desc.naxes = SDL_CONTROLLER_AXIS_MAX;
    desc.nbuttons = SDL_CONTROLLER_BUTTON_MAX;
    desc.vendor_id = 0x1209;
    desc.product_id = 0x0005;
    desc.name = "soak pad";
    index_ = SDL_JoystickAttachVirtualEx(&desc);
    joystick_ = index_ < 0 ? nullptr : SDL_JoystickOpen(index_);
    plugs_ += joystick_ != nullptr;
  }
  void unplug() {
    if (joystick_ != nullptr) SDL_JoystickClose(joystick_);
    if (index_ >= 0) SDL_JoystickDetachVirtual(index_);
    joystick_ = nullptr;
    index_ = -1;
  }
  bool is_plugged() const { return joystick_ != nullptr; }
  int plugs() const { return plugs_; }  // how often it was plugged in
  void push(double forward) {
    if (joystick_ == nullptr) return;
    SDL_JoystickSetVirtualAxis(joystick_, SDL_CONTROLLER_AXIS_LEFTY,
                               static_cast<Sint16>(-32767.0 * forward));
  }

 private:
  int index_ = -1;
  int plugs_ = 0;
  SDL_Joystick* joystick_ = nullptr;
};

void press(SDL_Keycode key) {
  for (const Uint32 type : {SDL_KEYDOWN, SDL_KEYUP}) {
    SDL_Event event{};
    event.type = type;
    event.key.state = type == SDL_KEYDOWN ? SDL_PRESSED : SDL_RELEASED;
    event.key.keysym.sym = key;
    event.key.keysym.scancode = SDL_GetScancodeFromKey(key);
    SDL_PushEvent(&event);
  }
}

void drop(const std::string& path) {
  SDL_Event event{};
  event.type = SDL_DROPFILE;
  event.drop.file = SDL_strdup(path.c_str());
  SDL_PushEvent(&event);
}

// Due every so many seconds.
class Every {
 public:
  explicit Every(double period_s) : period_s_(period_s), next_s_(period_s) {}
  bool is_due(double time_s) {
    if (time_s < next_s_) return false;
    next_s_ = time_s + period_s_;
    return true;
  }

 private:
  double period_s_, next_s_;
};

class Soak {
 public:
  Soak(double seconds, std::vector<std::string> motions)
      : seconds_(seconds), motions_(std::move(motions)) {}

  void frame() {
    const double time_s = std::chrono::duration<double>(Clock::now() - start_).count();
    pad_.push(0.5 + 0.5 * std::sin(time_s));
    if (plug_.is_due(time_s)) pad_.is_plugged() ? pad_.unplug() : pad_.plug();
    if (style_.is_due(time_s)) press(kStyles[count_++ % kStyles.size()]);
    if (key_.is_due(time_s)) press(kKeys[count_++ % kKeys.size()]);
    if (load_.is_due(time_s)) drop(motions_[count_++ % motions_.size()]);
    if (look_.is_due(time_s)) look(time_s);
    if (time_s >= seconds_) press_quit();
  }

  int plugs() const { return pad_.plugs(); }

  // Megabytes by which the last quarter is above the second.
  double growth_mb() const {
    const std::size_t quarter = memory_mb_.size() / 4;
    if (quarter == 0) return 0.0;
    const auto mean = [&](std::size_t from) {
      const auto begin = memory_mb_.begin() + static_cast<std::ptrdiff_t>(from);
      return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(quarter), 0.0) /
             static_cast<double>(quarter);
    };
    return mean(memory_mb_.size() - quarter) - mean(quarter);
  }

 private:
  static constexpr std::array kStyles = {SDLK_1, SDLK_2, SDLK_3, SDLK_4};
  static constexpr std::array kKeys = {SDLK_F1, SDLK_F2, SDLK_F3,  SDLK_F4, SDLK_F5,
                                       SDLK_F6, SDLK_F7, SDLK_TAB, SDLK_t};

  void look(double time_s) {
    ::malloc_trim(0);  // free memory that was not given back is no leak
    memory_mb_.push_back(resident_mb());
    fmt::print("{:6.0f} s  {:7.1f} MB\n", time_s, memory_mb_.back());
    std::fflush(stdout);
  }
  static void press_quit() {
    SDL_Event event{};
    event.type = SDL_QUIT;
    SDL_PushEvent(&event);
  }

  double seconds_;
  std::vector<std::string> motions_;
  Clock::time_point start_ = Clock::now();
  VirtualPad pad_;
  Every plug_{kPlug_s}, style_{kStyle_s}, key_{kKey_s}, load_{kLoad_s}, look_{kLook_s};
  std::size_t count_ = 0;
  std::vector<double> memory_mb_;
};

int run(double seconds, const std::vector<std::string>& motions) {
  if (SDL_InitSubSystem(SDL_INIT_JOYSTICK) != 0) {
    fmt::print(stderr, "soak: {}\n", SDL_GetError());
    return 1;
  }
  Soak soak(seconds, motions);
  WindowOptions options;
  options.session.config_folders = config_folders(GAITPAD_CONFIG_DIR);
  options.session.walk.styles = {"even", "stiff_hip", "stiff_knee", "limp_left"};
  options.session.pad.wish.driver = "sdl";
  options.session.live.keyboard = true;
  options.script = [&soak](const WindowGlance&) { soak.frame(); };
  const auto result = run_window(options);
  if (!result) {
    fmt::print(stderr, "soak: {}\n", result.error().message);
    return 1;
  }
  for (const std::string& remark : result->remarks) fmt::print("{}\n", remark);
  const double growth_mb = soak.growth_mb();
  const bool is_flat = growth_mb < kGrowth_mb || !kIsJudged;
  fmt::print("{} frames, {} times plugged in; memory grew by {:.1f} MB: {}\n", result->frames,
             soak.plugs(), growth_mb,
             !kIsJudged ? "not judged"
             : is_flat  ? "flat"
                        : "NOT flat");
  return is_flat ? 0 : 1;
}

}  // namespace
}  // namespace gaitpad

int main(int count, char** arguments) {
  if (count < 4) {
    fmt::print(stderr, "usage: soak SECONDS MOTION MOTION...\n");
    return 2;
  }
  return gaitpad::run(std::atof(arguments[1]), {arguments + 2, arguments + count});
}
