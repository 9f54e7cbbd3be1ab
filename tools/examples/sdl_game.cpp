// A game's own window and loop (SDL2); gaitpad drives the character in it. The arrow keys or a
// pad's left stick walk it, Escape ends.
//   sdl_game [--frames N] [--stick X,Y] [--picture FILE.bmp]
#include <SDL2/SDL.h>
#include <gaitpad/clean_strides.h>
#include <gaitpad/control.h>
#include <gaitpad/skeleton.h>
#include <gaitpad/walk.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

constexpr int kRate_hz = 240, kFrames_per_s = 60;
constexpr int kWidth = 960, kHeight = 540;
constexpr double kPixels_per_m = 200.0;

struct Options {
  int frames = -1;  // number of frames to draw; -1: until the window is closed
  gaitpad::vec2 stick{0.0};
  const char* picture = nullptr;
};

gaitpad::vec2 stick_of_keys() {
  const Uint8* keys = SDL_GetKeyboardState(nullptr);
  return gaitpad::vec2(keys[SDL_SCANCODE_RIGHT] - keys[SDL_SCANCODE_LEFT],
                       keys[SDL_SCANCODE_UP] - keys[SDL_SCANCODE_DOWN]);
}

// The pad's stick, -1 .. 1, y forward. A small round dead zone replaces a calibration.
gaitpad::vec2 stick_of_pad(SDL_GameController* pad) {
  const gaitpad::vec2 raw(SDL_GameControllerGetAxis(pad, SDL_CONTROLLER_AXIS_LEFTX) / 32767.0,
                          -SDL_GameControllerGetAxis(pad, SDL_CONTROLLER_AXIS_LEFTY) / 32767.0);
  const double length = std::hypot(raw.x, raw.y);
  return length < 0.2 ? gaitpad::vec2(0.0) : raw * (std::min(1.0, (length - 0.2) / 0.75) / length);
}

// Draws the skeleton from the side. The camera moves with the hips.
void draw(SDL_Renderer* renderer, const gaitpad::Skeleton& skeleton, const gaitpad::Pose& pose) {
  gaitpad::JointFrames world;
  gaitpad::forward_kinematics(skeleton, pose, world);
  const double middle_m = pose.root_m.z;
  SDL_SetRenderDrawColor(renderer, 24, 26, 30, 255);
  SDL_RenderClear(renderer);
  const int floor = kHeight - 60;
  SDL_SetRenderDrawColor(renderer, 90, 96, 104, 255);
  SDL_RenderDrawLine(renderer, 0, floor, kWidth, floor);
  for (double mark_m = std::floor(middle_m - 3.0); mark_m < middle_m + 3.0; mark_m += 0.5) {
    const int x = kWidth / 2 + static_cast<int>((mark_m - middle_m) * kPixels_per_m);
    SDL_RenderDrawLine(renderer, x, floor, x - 6, floor + 8);
  }
  SDL_SetRenderDrawColor(renderer, 230, 180, 90, 255);
  for (std::size_t j = 1; j < skeleton.joints.size(); ++j) {
    const gaitpad::vec3 from = world.position_m[skeleton.joints[j].parent],
                        to = world.position_m[j];
    SDL_RenderDrawLine(renderer, kWidth / 2 + static_cast<int>((from.z - middle_m) * kPixels_per_m),
                       floor - static_cast<int>(from.y * kPixels_per_m),
                       kWidth / 2 + static_cast<int>((to.z - middle_m) * kPixels_per_m),
                       floor - static_cast<int>(to.y * kPixels_per_m));
  }
}

bool save_picture(SDL_Renderer* renderer, const char* path) {
  SDL_Surface* surface =
      SDL_CreateRGBSurfaceWithFormat(0, kWidth, kHeight, 32, SDL_PIXELFORMAT_ARGB8888);
  if (surface == nullptr) return false;
  const bool is_saved = SDL_RenderReadPixels(renderer, nullptr, SDL_PIXELFORMAT_ARGB8888,
                                             surface->pixels, surface->pitch) == 0 &&
                        SDL_SaveBMP(surface, path) == 0;
  SDL_FreeSurface(surface);
  return is_saved;
}

bool read_options(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; i += 2) {
    const std::string_view name = argv[i];
    if (i + 1 == argc) return false;
    if (name == "--frames") {
      options.frames = std::atoi(argv[i + 1]);
    } else if (name == "--stick") {
      if (std::sscanf(argv[i + 1], "%lf,%lf", &options.stick.x, &options.stick.y) != 2)
        return false;
    } else if (name == "--picture") {
      options.picture = argv[i + 1];
    } else {
      return false;
    }
  }
  return true;
}

int print_error(const gaitpad::Error& error) {
  std::fprintf(stderr, "sdl_game: %s\n", error.message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (!read_options(argc, argv, options)) {
    std::fputs("usage: sdl_game [--frames N] [--stick X,Y] [--picture FILE.bmp]\n", stderr);
    return 2;
  }
  const auto cycle = gaitpad::with_clean_strides(gaitpad::procedural_gait());
  if (!cycle) return print_error(cycle.error());
  const auto model = gaitpad::walk_model(*cycle, gaitpad::Character{});
  if (!model) return print_error(model.error());
  if (SDL_Init(SDL_INIT_VIDEO | SDL_INIT_GAMECONTROLLER) != 0) {
    std::fprintf(stderr, "sdl_game: %s\n", SDL_GetError());
    return 1;
  }
  SDL_Window* window = SDL_CreateWindow("A game with gaitpad", SDL_WINDOWPOS_CENTERED,
                                        SDL_WINDOWPOS_CENTERED, kWidth, kHeight, 0);
  SDL_Renderer* renderer = SDL_CreateRenderer(window, -1, SDL_RENDERER_SOFTWARE);
  SDL_GameController* pad = SDL_NumJoysticks() > 0 ? SDL_GameControllerOpen(0) : nullptr;

  const gaitpad::GaitLimits limits = gaitpad::gait_limits(*model);
  const gaitpad::StyleValues style;
  gaitpad::Pose pose;
  gaitpad::WalkState state = gaitpad::standing(*model, gaitpad::vec3(0.0), pose);
  const bool has_window = window != nullptr && renderer != nullptr;
  bool is_open = has_window, is_saved = true;
  for (int frame = 0; is_open && frame != options.frames; ++frame) {
    for (SDL_Event event; SDL_PollEvent(&event) != 0;) {
      const bool is_escape = event.type == SDL_KEYDOWN && event.key.keysym.sym == SDLK_ESCAPE;
      if (event.type == SDL_QUIT || is_escape) is_open = false;
    }
    gaitpad::Stick stick;
    stick.left = options.stick + stick_of_keys() + (pad ? stick_of_pad(pad) : gaitpad::vec2(0.0));
    const double length = std::hypot(stick.left.x, stick.left.y);
    if (length > 1.0) stick.left = stick.left * (1.0 / length);
    // The walk has its own fixed rate; the game draws whatever pose is the newest.
    for (int tick = 0; tick < kRate_hz / kFrames_per_s; ++tick) {
      gaitpad::advance(*model, gaitpad::gait_params(stick, style, limits), gaitpad::IkMode::robust,
                       1.0 / kRate_hz, state, pose);
    }
    draw(renderer, model->cycle.skeleton, pose);
    if (frame + 1 == options.frames && options.picture != nullptr) {
      is_saved = save_picture(renderer, options.picture);
    }
    SDL_RenderPresent(renderer);
    if (options.frames < 0) SDL_Delay(1000 / kFrames_per_s);
  }
  const std::array<int, 2> steps = gaitpad::walk_steps(state).steps;
  std::printf("walked to x %.3f m, z %.3f m in %d steps\n", pose.root_m.x, pose.root_m.z,
              steps[0] + steps[1]);
  if (pad != nullptr) SDL_GameControllerClose(pad);
  SDL_DestroyRenderer(renderer);
  SDL_DestroyWindow(window);
  SDL_Quit();
  return has_window && is_saved ? 0 : 1;
}
