#include "view/window_loop.h"

#include <SDL2/SDL.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "drivers/posix.h"
#include "view/layout.h"

namespace gaitpad {
namespace {

constexpr double kSoftwareFrame_s = 1.0 / 30.0;  // leaves time to the session
constexpr double kFrame_s = 1.0 / 120.0;         // where the display keeps no time
constexpr double kUnseenFrame_s = 0.1;           // minimized
constexpr double kOrbitMouse_rad = 0.006;        // a pixel at scale 1
constexpr double kOrbitStick_rad_s = 1.8;
constexpr double kStickRest = 0.02;  // of the right stick: a camera does not creep
constexpr std::int64_t kMessage_ns = 15'000'000'000;

}  // namespace

WindowLoop::WindowLoop(const WindowOptions& options)
    : options_(options), browser_(options.recent_file) {
  // Without a pad the keys walk. For pictures time is that of the frames.
  options_.session.live.keyboard = true;
  if (makes_pictures()) options_.session.live.clock = SessionSpec::Live::Clock::by_hand;
}

WindowLoop::~WindowLoop() {
  show_.reset();  // before SDL's parts are stopped
  if (surface_ == nullptr || !surface_->is_lost()) return;
  // Closing what lies on a display that has gone could wait for it: the end of the program does it.
  static_cast<void>(calibration_.release());
  static_cast<void>(scene_.release());
  static_cast<void>(gui_.release());
  static_cast<void>(surface_.release());
}

bool WindowLoop::makes_pictures() const noexcept {
  return !options_.screenshot.empty() || !options_.video.empty();
}

bool WindowLoop::makes_still() const noexcept {
  return makes_pictures() && options_.video.empty() && options_.frames > 0;
}

// As it was left, but for what was asked for this once.
void WindowLoop::take_layout(const UiState& layout) {
  state_ = remembered_ = layout;
  if (options_.theme) state_.theme = *options_.theme;
  if (options_.are_panels_given) {
    state_.is_open.fill(false);
    for (const Panel panel : options_.panels)
      state_.is_open[static_cast<std::size_t>(panel)] = true;
  }
  bool* const shown[] = {&state_.has_trails, &state_.has_grid, &state_.has_shadows,
                         &state_.has_source, &state_.has_names};
  for (std::size_t i = 0; i < std::size(kScenePartNames); ++i)
    if (std::ranges::count(options_.hidden, kScenePartNames[i]) > 0) *shown[i] = false;
}

std::optional<Error> WindowLoop::open() {
  Layout layout = load_layout(options_.layout_file);
  take_layout(layout.state);
  // Words of files before anything is opened for them.
  auto start = Show::prepare(options_.session);
  if (!start) return start.error();
  auto surface = WindowSurface::open(
      {"gaitpad", options_.width, options_.height, options_.scale, options_.is_hidden});
  if (!surface) return surface.error();
  surface_ = std::move(*surface);
  auto scene = Scene::create(makes_still() ? Scene::Quality::high : Scene::Quality::automatic);
  if (!scene) return scene.error();
  scene_ = std::move(*scene);
  gui_ = std::make_unique<Gui>(*surface_);
  auto show = (*start)();
  if (!show) return show.error();
  install(std::move(*show));
  say(std::move(layout.remark));
  if (makes_pictures()) return std::nullopt;
  const bool keeps_time = SDL_GL_GetSwapInterval() != 0 && !scene_->is_software();
  clock_.set_least(scene_->is_software() ? kSoftwareFrame_s : keeps_time ? 0.0 : kFrame_s);
  return std::nullopt;
}

Result<WindowResult> WindowLoop::run() {
  while (!failure_ && draw_frame()) {
  }
  if (video_ && !failure_) failure_ = video_->finish();
  return result();
}

bool WindowLoop::draw_frame() {
  clock_.begin(now_ns());
  call_script();
  take_events();
  take_wishes(controls_.wishes());
  if (options_.take_commands)
    for (const std::string& command : options_.take_commands()) show_->command(command);
  look();
  const bool is_last = is_ended();
  const bool is_seen = (SDL_GetWindowFlags(surface_->window()) & SDL_WINDOW_MINIMIZED) == 0;
  if (!surface_->is_lost() && (is_seen || makes_pictures())) draw(is_last);
  if (surface_->is_lost()) end_lost();
  ++result_.frames;
  if (!is_seen) SDL_Delay(static_cast<Uint32>(kUnseenFrame_s * 1e3));
  clock_.wait();
  return !is_last;
}

bool WindowLoop::is_ended() {
  if (is_quitting_) return true;
  if (options_.is_ended_from_outside && options_.is_ended_from_outside()) return true;
  if (options_.frames > 0) return result_.frames + 1 >= options_.frames;
  const UiTimeline* timeline = show_->timeline();
  return makes_pictures() && timeline != nullptr && timeline->tick + 1 >= timeline->ticks;
}

void WindowLoop::end_lost() {
  if (!failure_) failure_ = Error{"the display has gone: the window ends, the session with it"};
}

void WindowLoop::call_script() {
  if (!options_.script) return;
  options_.script({result_.frames, show_->frame(), show_->cast(), state_, camera_, show_->pace(),
                   !show_->is_live(), browser_.is_open(), calibration_ != nullptr,
                   show_->options().live.record, messages_.sentences()});
}

void WindowLoop::take_events() {
  for (SDL_Event event; !surface_->is_lost() && SDL_PollEvent(&event) != 0;) {
    gui_->take(event);
    controls_.take(event, gui_->taken());
    if (event.type == SDL_DROPFILE) SDL_free(event.drop.file);
  }
}

void WindowLoop::take_wishes(Wishes wishes) {
  const bool is_modal = browser_.is_open() || calibration_ != nullptr;
  if (show_->is_live() && !makes_pictures()) take_buttons(wishes.actions);
  for (const Action action : wishes.actions) {
    const bool is_always = action == Action::back || action == Action::quit ||
                           action == Action::screenshot || action == Action::fullscreen;
    if (is_always || !is_modal) obey(action);
  }
  for (const std::string& file : wishes.files) open_file(file);
  if (is_modal) controls_.let_go();
  show_->steer(controls_.walk());
  move_camera(wishes);
}

// The buttons of a recording that is the pad walk and look as they did, but begin and end nothing:
// its last press may be the one that ended it.
void WindowLoop::take_buttons(std::vector<Action>& wanted) {
  std::vector<Action> pressed;
  presses_.take(show_->frame(), pressed);
  if (is_recording(show_->options().pad.wish.pad)) {
    std::erase_if(pressed, [](Action action) {
      return action == Action::record || action == Action::screenshot ||
             action == Action::open_file || action == Action::calibrate || action == Action::quit;
    });
  }
  wanted.insert(wanted.end(), pressed.begin(), pressed.end());
}

void WindowLoop::move_camera(const Wishes& wishes) {
  const double rad = kOrbitMouse_rad / surface_->scale();
  orbit(camera_, -wishes.orbit_px.x * rad, wishes.orbit_px.y * rad);
  if (wishes.pan_px != vec2(0.0)) {
    int width_px = 0, height_px = 0;
    surface_->size(width_px, height_px);
    pan(camera_, wishes.pan_px, height_px);
  }
  if (wishes.dolly != 1.0) dolly(camera_, wishes.dolly);
  if (!show_->is_live() || makes_pictures()) return;
  const vec2& stick = show_->frame().stick.right;
  if (glm::length(stick) < kStickRest) return;
  const double angle_rad = kOrbitStick_rad_s * clock_.passed_s();
  orbit(camera_, -stick.x * angle_rad, stick.y * angle_rad);
}

void WindowLoop::look() {
  if (makes_pictures()) {
    show_->look_for_picture();
  } else {
    show_->look(clock_.passed_s());
    messages_.forget_before(clock_.now_ns() - kMessage_ns);
  }
  take_remarks();
  if (!show_->has_ended() || std::exchange(is_end_told_, true) || makes_pictures()) return;
  say("the recording has come to its end; the keys walk on");
}

void WindowLoop::remember_layout() {
  if (options_.layout_file.empty()) return;
  // What was asked for this once is not remembered.
  if (options_.theme == state_.theme) state_.theme = remembered_.theme;
  if (options_.are_panels_given) state_.is_open = remembered_.is_open;
  if (!options_.hidden.empty()) {
    state_.has_trails = remembered_.has_trails;
    state_.has_grid = remembered_.has_grid;
    state_.has_shadows = remembered_.has_shadows;
    state_.has_source = remembered_.has_source;
    state_.has_names = remembered_.has_names;
  }
  if (auto problem = save_layout(options_.layout_file, state_))
    result_.remarks.push_back(problem->message);
}

Result<WindowResult> WindowLoop::result() {
  remember_layout();
  if (const LiveStatus* status = show_->status()) result_.status = *status;
  auto summary = show_->stop();
  take_remarks();
  if (failure_) return *failure_;
  if (!summary) return summary.error();
  if (const LiveStatus* status = show_->status()) result_.status = *status;
  result_.summary = std::move(*summary);
  result_.frames_per_second = clock_.mean_frames_per_second();
  return std::move(result_);
}

}  // namespace gaitpad
