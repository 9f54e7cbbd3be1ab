// A plain SDL2 program in the style of its documentation: the reference in the table of latencies.
// Arguments and output as rig_latency's, without WAY.
#include <SDL2/SDL.h>
#include <time.h>

#include <cstdio>
#include <cstdlib>
#include <utility>
#include <vector>

namespace {

long long now_ns() {
  timespec now = {};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * 1'000'000'000LL + now.tv_nsec;
}

// An axis's value as a byte 0..255, as SDL scales an axis without dead zone.
int byte_of(int value) { return (value + 32768) / 257; }

SDL_Joystick* opened(unsigned vendor, unsigned product) {
  for (int i = 0; i < SDL_NumJoysticks(); ++i) {
    if (SDL_JoystickGetDeviceVendor(i) == vendor && SDL_JoystickGetDeviceProduct(i) == product)
      return SDL_JoystickOpen(i);
  }
  return nullptr;
}

}  // namespace

int main(int argc, char** argv) {
  unsigned vendor = 0, product = 0;
  if (argc != 3 || std::sscanf(argv[1], "%x:%x", &vendor, &product) != 2) return 2;
  const auto count = static_cast<std::size_t>(std::atoi(argv[2]));
  SDL_SetHint(SDL_HINT_JOYSTICK_HIDAPI, "0");
  SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
  if (SDL_Init(SDL_INIT_JOYSTICK) != 0) return 1;
  SDL_Joystick* pad = opened(vendor, product);
  if (pad == nullptr) return 1;
  std::puts("ready");
  std::fflush(stdout);
  std::vector<std::pair<long long, int>> readings;
  SDL_Event event;
  // The two axes of one report come as two events: the second one completes the report.
  while (readings.size() < count && SDL_WaitEventTimeout(&event, 1000) == 1) {
    if (event.type != SDL_JOYAXISMOTION) continue;
    const int x = byte_of(SDL_JoystickGetAxis(pad, 0)), y = byte_of(SDL_JoystickGetAxis(pad, 1));
    readings.emplace_back(now_ns(), x + 256 * y);
  }
  for (const auto& [time_ns, number] : readings) std::printf("%lld %d\n", time_ns, number);
  SDL_JoystickClose(pad);
  SDL_Quit();
}
