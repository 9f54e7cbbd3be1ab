#include "view/window.h"

#include <SDL2/SDL.h>
#include <epoxy/gl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <deque>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "draw/picture.h"
#include "drivers/posix.h"
#include "gaitpad/config_files.h"
#include "view/calibration_view.h"
#include "view/controls.h"
#include "view/ensemble.h"
#include "view/file_browser.h"
#include "view/gui.h"
#include "view/layout.h"
#include "view/scene.h"
#include "view/show.h"
#include "view/surface.h"
#include "view/video.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;
constexpr std::int64_t kWarmFrames = 5;
constexpr double kLongest_s = 0.25;  // after a suspended machine wakes up

// When frames begin, how many there are in a second, and how many reports a pad sends meanwhile.
class FrameClock {
 public:
  // Least time between two frames; 0: no limit.
  void set_least(double seconds) noexcept { least_s_ = seconds; }
  // Returns the seconds since the last frame began, at most a quarter.
  double begin_frame(std::int64_t now_ns) noexcept;
  // Sleeps until the next frame may begin.
  void wait_for_next() noexcept;
  std::int64_t now_ns() const noexcept { return now_ns_; }  // when this frame began
  double passed_s() const noexcept { return passed_s_; }

  double frames_per_second() const noexcept { return shown_; }  // over the last half second
  // Over all frames except the first few, in which shaders are compiled.
  double mean_frames_per_second() const noexcept;

  // How fast a growing count grows, over the last second.
  double rate_hz(std::uint64_t count) noexcept;

 private:
  double least_s_ = 0.0, passed_s_ = 0.0, shown_ = 0.0;
  std::int64_t now_ns_ = 0, due_ns_ = 0, shown_since_ns_ = 0, warm_ns_ = 0;
  std::int64_t frames_ = 0, shown_frames_ = 0;
  std::int64_t counted_ns_ = 0;
  std::uint64_t counted_ = 0;
  double rate_hz_ = 0.0;
};

double FrameClock::begin_frame(std::int64_t time_ns) noexcept {
  passed_s_ = now_ns_ == 0 ? 0.0 : static_cast<double>(time_ns - now_ns_) / 1e9;
  passed_s_ = std::clamp(passed_s_, 0.0, kLongest_s);
  now_ns_ = time_ns;
  if (frames_++ == kWarmFrames) warm_ns_ = time_ns;
  ++shown_frames_;
  if (shown_since_ns_ == 0) shown_since_ns_ = time_ns;
  if (const std::int64_t shown_ns = time_ns - shown_since_ns_; shown_ns > kSecond_ns / 2) {
    shown_ = static_cast<double>(shown_frames_) * 1e9 / static_cast<double>(shown_ns);
    shown_since_ns_ = time_ns;
    shown_frames_ = 0;
  }
  return passed_s_;
}

void FrameClock::wait_for_next() noexcept {
  if (least_s_ <= 0.0) return;
  const auto least_ns = static_cast<std::int64_t>(least_s_ * 1e9);
  // Counted from the planned time, so that the frame after a late one can catch up.
  due_ns_ = std::max(due_ns_ + least_ns, now_ns_);
  if (due_ns_ <= gaitpad::now_ns()) return;
  const timespec due = {static_cast<time_t>(due_ns_ / kSecond_ns),
                        static_cast<long>(due_ns_ % kSecond_ns)};
  while (::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, nullptr) == EINTR) {
  }
}

double FrameClock::mean_frames_per_second() const noexcept {
  if (warm_ns_ == 0 || now_ns_ <= warm_ns_) return 0.0;
  return static_cast<double>(frames_ - 1 - kWarmFrames) * 1e9 /
         static_cast<double>(now_ns_ - warm_ns_);
}

double FrameClock::rate_hz(std::uint64_t count) noexcept {
  if (counted_ns_ == 0 || count < counted_) {  // a new session counts from 0
    counted_ns_ = now_ns_;
    counted_ = count;
    rate_hz_ = 0.0;
  }
  if (const std::int64_t span_ns = now_ns_ - counted_ns_; span_ns >= kSecond_ns) {
    rate_hz_ = static_cast<double>(count - counted_) * 1e9 / static_cast<double>(span_ns);
    counted_ns_ = now_ns_;
    counted_ = count;
  }
  return rate_hz_;
}

// Errors and remarks for the person, each shown for a while, newest last.
class Messages {
 public:
  void add(std::string sentence, std::int64_t time_ns) {
    if (sentence.empty()) return;
    if (!shown_.empty() && shown_.back().sentence == sentence) shown_.pop_back();
    shown_.push_back({std::move(sentence), time_ns});
    if (shown_.size() > kMost) shown_.pop_front();
  }
  void forget_before(std::int64_t time_ns) {
    while (!shown_.empty() && shown_.front().time_ns < time_ns) shown_.pop_front();
  }
  void clear() noexcept { shown_.clear(); }
  std::vector<std::string> sentences() const {
    std::vector<std::string> all;
    for (const Message& message : shown_) all.push_back(message.sentence);
    return all;
  }

 private:
  static constexpr std::size_t kMost = 6;
  struct Message {
    std::string sentence;
    std::int64_t time_ns = 0;
  };
  std::deque<Message> shown_;
};

constexpr double kSoftwareFrame_s = 1.0 / 30.0;  // leaves processor time to the session
constexpr double kFrame_s = 1.0 / 120.0;         // if the display does not limit the rate
constexpr double kUnseenFrame_s = 0.1;           // minimized
constexpr double kOrbitMouse_rad = 0.006;        // per pixel at scale 1
constexpr double kOrbitStick_rad_s = 1.8;
constexpr double kStickRest = 0.02;  // of the right stick; less does not move the camera
constexpr std::int64_t kMessage_ns = 15'000'000'000;

// Runs the window: opens it, draws frame after frame, does what the person asks for, and closes it.
class WindowLoop {
 public:
  explicit WindowLoop(const WindowOptions& options);
  ~WindowLoop();
  std::optional<Error> open();
  Result<WindowResult> run();

 private:
  // The order of a frame.
  bool makes_pictures() const noexcept;
  bool makes_still() const noexcept;  // only the last frame is kept
  bool draw_frame();                  // false after the last frame
  bool is_ended();
  void handle_events();
  void follow_wishes(Wishes wishes);
  void add_button_actions(std::vector<Action>& wanted);
  void move_camera(const Wishes& wishes);
  void call_script();
  void apply_layout(const UiState& layout);
  void fail_without_display();
  void remember_layout();
  Result<WindowResult> result();

  // What a frame shows.
  void update_show();
  void draw_window(bool is_last);
  UiOutput draw_panels(int width_px, int height_px);
  UiInput ui_input();
  const LiveStatus* shown_status();
  void draw_browser(Ui& ui, const ImVec2& window_px);
  void draw_calibration(Ui& ui, const ImVec2& window_px);
  void reset_camera();
  void keep_pictures(int width_px, int height_px, bool is_last);

  // What the person asked for. The functions that return bool return false for an action of another
  // kind.
  void run_actions(const UiOutput& out);
  void run_action(Action action);
  bool run_session_action(Action action);  // pause, step, styles
  bool run_view_action(Action action);     // camera, theme, panels
  void run_other_action(Action action);
  void choose_style(const std::string& name);
  void choose_style_after(int steps);
  void toggle_panel(Panel panel);
  void step_once();
  void reset_session();
  void go_back();
  void save_walkers_style(const std::string& name);

  // Ends one show and begins another.
  void show_message(std::string sentence);
  void show_remarks();
  void install_show(std::unique_ptr<Show> show);
  void end_show();  // its last state stays visible
  bool switch_to(const SessionSpec& next);
  bool restart(Result<std::unique_ptr<Show>> show, const SessionSpec& otherwise);
  void open_file(const std::string& path);
  void choose_next_terrain();
  void toggle_recording();
  void begin_calibration();
  void end_calibration(CalibrationView::State state);
  void take_screenshot(int width_px, int height_px);

  WindowOptions options_;
  WindowResult result_;
  std::optional<Error> failure_;  // ends the window

  // In the order in which they depend on each other.
  std::unique_ptr<WindowSurface> surface_;
  std::unique_ptr<Gui> gui_;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<VideoWriter> video_;
  std::unique_ptr<CalibrationView> calibration_;
  std::unique_ptr<Show> show_;
  std::unique_ptr<Ensemble> ensemble_;
  std::optional<SessionSpec> live_before_;  // during a playback: the live session before it

  UiState state_;
  UiState remembered_;  // the layout file's
  std::optional<ThemeName> applied_theme_;
  Camera camera_;
  bool is_camera_new_ = true;
  SceneContent content_;
  Controls controls_;
  ButtonPresses presses_;
  FileBrowser browser_;
  Messages messages_;
  FrameClock clock_;
  LiveStatus picture_status_;
  double pace_before_pause_ = 1.0;
  std::optional<std::string> chosen_file_;  // in the browser, in this frame
  CalibrationView::State calibration_state_ = CalibrationView::State::goes_on;
  bool wants_screenshot_ = false, is_quitting_ = false;
  bool is_end_told_ = false, is_untouched_told_ = false;  // to the person
};

WindowLoop::WindowLoop(const WindowOptions& options)
    : options_(options), browser_(options.recent_file) {
  // Without a pad the keyboard steers. For pictures the session's time is that of the frames.
  options_.session.live.keyboard = true;
  if (makes_pictures()) options_.session.live.clock = SessionSpec::Live::Clock::by_hand;
}

WindowLoop::~WindowLoop() {
  show_.reset();  // before SDL is stopped
  if (surface_ == nullptr || !surface_->is_lost()) return;
  // Closing anything on a lost display could wait for ever, so it is left to the program's end.
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

// The remembered layout, changed by the options of this start.
void WindowLoop::apply_layout(const UiState& layout) {
  state_ = remembered_ = layout;
  if (options_.theme) state_.theme = *options_.theme;
  if (options_.are_panels_given) {
    state_.is_open.fill(false);
    for (const Panel panel : options_.panels)
      state_.is_open[static_cast<std::size_t>(panel)] = true;
  }
  for (const ScenePart& part : kSceneParts) {
    if (std::ranges::count(options_.hidden, part.name) > 0) state_.*part.is_shown = false;
  }
}

std::optional<Error> WindowLoop::open() {
  Layout layout = load_layout(options_.layout_file);
  apply_layout(layout.state);
  // Files are checked before anything is opened.
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
  install_show(std::move(*show));
  show_message(std::move(layout.remark));
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
  clock_.begin_frame(now_ns());
  call_script();
  handle_events();
  follow_wishes(controls_.take_wishes());
  if (options_.take_commands)
    for (const std::string& command : options_.take_commands()) show_->command(command);
  update_show();
  const bool is_last = is_ended();
  const bool is_seen = (SDL_GetWindowFlags(surface_->window()) & SDL_WINDOW_MINIMIZED) == 0;
  if (!surface_->is_lost() && (is_seen || makes_pictures())) draw_window(is_last);
  if (surface_->is_lost()) fail_without_display();
  ++result_.frames;
  if (!is_seen) SDL_Delay(static_cast<Uint32>(kUnseenFrame_s * 1e3));
  clock_.wait_for_next();
  return !is_last;
}

bool WindowLoop::is_ended() {
  if (is_quitting_) return true;
  if (options_.is_ended_from_outside && options_.is_ended_from_outside()) return true;
  if (options_.frames > 0) return result_.frames + 1 >= options_.frames;
  const UiTimeline* timeline = show_->timeline();
  return makes_pictures() && timeline != nullptr && timeline->tick + 1 >= timeline->ticks;
}

void WindowLoop::fail_without_display() {
  if (!failure_) failure_ = Error{"the display is lost: the window and its session end"};
}

void WindowLoop::call_script() {
  if (!options_.script) return;
  options_.script({result_.frames, show_->frame(), show_->cast(), state_, camera_, show_->pace(),
                   !show_->is_live(), browser_.is_open(), calibration_ != nullptr,
                   show_->options().live.record, messages_.sentences()});
}

void WindowLoop::handle_events() {
  for (SDL_Event event; !surface_->is_lost() && SDL_PollEvent(&event) != 0;) {
    gui_->handle_event(event);
    controls_.handle_event(event, gui_->taken_input());
    if (event.type == SDL_DROPFILE) SDL_free(event.drop.file);
  }
}

void WindowLoop::follow_wishes(Wishes wishes) {
  const bool is_modal = browser_.is_open() || calibration_ != nullptr;
  if (show_->is_live() && !makes_pictures()) add_button_actions(wishes.actions);
  for (const Action action : wishes.actions) {
    const bool is_always = action == Action::back || action == Action::quit ||
                           action == Action::screenshot || action == Action::fullscreen;
    if (is_always || !is_modal) run_action(action);
  }
  for (const std::string& file : wishes.files) open_file(file);
  if (is_modal) controls_.release_all();
  show_->steer(controls_.walk());
  move_camera(wishes);
}

// A recording that plays as the pad steers and moves the camera as it did, but its buttons cannot
// record, open, calibrate or quit: its last press may be the one that ended the recording.
void WindowLoop::add_button_actions(std::vector<Action>& wanted) {
  std::vector<Action> pressed;
  presses_.add_new_presses(show_->frame(), pressed);
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

void WindowLoop::update_show() {
  if (makes_pictures()) {
    show_->update_for_picture();
  } else {
    show_->update(clock_.passed_s());
    messages_.forget_before(clock_.now_ns() - kMessage_ns);
  }
  show_remarks();
  if (!show_->has_ended() || std::exchange(is_end_told_, true) || makes_pictures()) return;
  show_message("the recording is over; the keyboard steers now");
}

void WindowLoop::remember_layout() {
  if (options_.layout_file.empty()) return;
  // Options of this start are not remembered.
  if (options_.theme == state_.theme) state_.theme = remembered_.theme;
  if (options_.are_panels_given) state_.is_open = remembered_.is_open;
  if (!options_.hidden.empty()) {
    for (const ScenePart& part : kSceneParts) {
      state_.*part.is_shown = remembered_.*part.is_shown;
    }
  }
  if (auto problem = save_layout(options_.layout_file, state_))
    result_.remarks.push_back(problem->message);
}

Result<WindowResult> WindowLoop::result() {
  remember_layout();
  if (const LiveStatus* status = show_->status()) result_.status = *status;
  auto summary = show_->stop();
  show_remarks();
  if (failure_) return *failure_;
  if (!summary) return summary.error();
  if (const LiveStatus* status = show_->status()) result_.status = *status;
  result_.summary = std::move(*summary);
  result_.frames_per_second = clock_.mean_frames_per_second();
  return std::move(result_);
}

constexpr double kAside_rad = 1.1, kAbove_rad = 0.3, kAboveCrowd_rad = 0.36;

// Resident memory of the whole program; 0 if not known.
double memory_mib() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0.0;
  long all = 0, resident = 0;
  const bool is_read = std::fscanf(file, "%ld %ld", &all, &resident) == 2;
  std::fclose(file);
  if (!is_read) return 0.0;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1048576.0;
}

void WindowLoop::draw_window(bool is_last) {
  int width_px = 0, height_px = 0;
  surface_->size(width_px, height_px);
  surface_->begin();
  const Theme& theme = theme_of(state_.theme);
  if (applied_theme_ != state_.theme) gui_->apply(theme);
  applied_theme_ = state_.theme;
  glViewport(0, 0, width_px, height_px);
  glClearColor(static_cast<float>(theme.window.red), static_cast<float>(theme.window.green),
               static_cast<float>(theme.window.blue), 1.0f);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);

  const Viewport viewport =
      scene_viewport(state_, show_->timeline() != nullptr, width_px, height_px, surface_->scale());
  ensemble_->look_from(camera_.eye_m());
  ensemble_->fill(show_->frame(), show_->history(), show_->share(now_ns()), show_->cast(), state_,
                  theme, content_);
  if (std::exchange(is_camera_new_, false)) reset_camera();
  const double passed_s = makes_pictures() ? 1.0 / kPictureRateHz : clock_.passed_s();
  follow(camera_, ensemble_->focus_m(state_.walker), passed_s);
  ensemble_->stand_on_ground(camera_);
  const bool is_kept = !makes_still() || is_last || wants_screenshot_;
  if (is_kept && viewport.width > 0 && viewport.height > 0)
    scene_->draw(content_, camera_, theme, viewport, height_px, surface_->scale());
  run_actions(draw_panels(width_px, height_px));
  keep_pictures(width_px, height_px, is_last);
  surface_->show();
}

void WindowLoop::reset_camera() {
  int width_px = 0, height_px = 0;
  surface_->size(width_px, height_px);
  const Viewport viewport =
      scene_viewport(state_, show_->timeline() != nullptr, width_px, height_px, surface_->scale());
  camera_ = Camera();
  if (ensemble_->is_on_uneven_ground()) {  // from the side, so that steps ahead hide no feet
    camera_.yaw_rad = kAside_rad;
    camera_.pitch_rad = kAbove_rad;
  }
  if (ensemble_->has_crowd()) camera_.pitch_rad = kAboveCrowd_rad;
  if (options_.camera_deg.size() == 2) {
    camera_.yaw_rad = options_.camera_deg[0] * kDegree;
    camera_.pitch_rad = options_.camera_deg[1] * kDegree;
  }
  camera_.target_m = camera_.followed_m = ensemble_->focus_m(state_.walker);
  camera_.distance_m = ensemble_->distance_m(state_.walker, camera_, viewport);
}

// For pictures without the values that depend on the machine's speed.
const LiveStatus* WindowLoop::shown_status() {
  const LiveStatus* status = show_->status();
  if (status == nullptr || !makes_pictures()) return status;
  picture_status_ = LiveStatus();
  picture_status_.ticks = status->ticks;
  picture_status_.time_policy = status->time_policy;
  picture_status_.pads = status->pads;
  return &picture_status_;
}

UiInput WindowLoop::ui_input() {
  const SessionFrame& frame = show_->frame();
  const UiTimeline* timeline = show_->timeline();
  UiInput in{.frame = frame,
             .cast = show_->cast(),
             .history = show_->history(),
             .status = timeline == nullptr ? shown_status() : nullptr,
             .timeline = timeline,
             .pad_name = show_->pad_name(),
             .pace = show_->pace(),
             .recording = show_->options().live.record,
             .source = show_->options().replay.trace,
             .renderer = scene_->renderer(),
             .labels = {},
             .messages = messages_.sentences(),
             .is_modal = browser_.is_open() || calibration_ != nullptr};
  if (makes_pictures()) return in;
  in.pad_rate_hz = clock_.rate_hz(frame.pad.reports);
  in.frames_per_second = clock_.frames_per_second();
  in.memory_mib = memory_mib();
  return in;
}

UiOutput WindowLoop::draw_panels(int width_px, int height_px) {
  const Theme& theme = theme_of(state_.theme);
  const ImVec2 window_px(static_cast<float>(width_px), static_cast<float>(height_px));
  UiInput in = ui_input();
  const Viewport viewport =
      scene_viewport(state_, in.timeline != nullptr, width_px, height_px, surface_->scale());
  in.labels = ensemble_->labels(show_->frame(), show_->cast(), camera_, viewport, state_, theme);
  gui_->begin(controls_.mouse(), makes_pictures() ? 1.0 / kPictureRateHz : 0.0);
  UiOutput out = draw_ui(in, theme, gui_->fonts(), surface_->scale(), state_);
  Ui ui{in, theme, gui_->fonts(), static_cast<float>(surface_->scale()), state_, out};
  draw_browser(ui, window_px);
  draw_calibration(ui, window_px);
  gui_->end();
  return out;
}

void WindowLoop::draw_browser(Ui& ui, const ImVec2& window_px) {
  if (!browser_.is_open()) return;
  if (const auto file = browser_.draw(ui, window_px)) chosen_file_ = *file;
}

void WindowLoop::draw_calibration(Ui& ui, const ImVec2& window_px) {
  if (!calibration_) return;
  std::vector<std::string> messages;
  calibration_state_ = calibration_->draw(ui, window_px, messages);
  for (std::string& message : messages) show_message(std::move(message));
}

void WindowLoop::keep_pictures(int width_px, int height_px, bool is_last) {
  const bool keeps_still = is_last && !options_.screenshot.empty();
  if (std::exchange(wants_screenshot_, false)) take_screenshot(width_px, height_px);
  if (options_.video.empty() && !keeps_still) return;
  if (!options_.video.empty() && !video_) {
    auto video = VideoWriter::open(options_.video, width_px, height_px, kPictureRateHz);
    if (!video) failure_ = video.error();
    if (video) video_ = std::move(*video);
  }
  if (failure_) return;
  const Pixels pixels = read_pixels(width_px, height_px);
  if (video_) failure_ = video_->add(pixels);
  if (keeps_still && !failure_) failure_ = write_png(options_.screenshot, pixels);
}

constexpr double kSlowMotion = 0.25;

void WindowLoop::run_actions(const UiOutput& out) {
  for (const Action action : out.actions) run_action(action);
  for (const std::string& command : out.commands) show_->command(command);
  if (out.seek_tick) show_->seek(*out.seek_tick);
  if (out.pace) show_->set_pace(*out.pace);
  if (out.is_looping) show_->set_looping(*out.is_looping);
  if (out.save_style) save_walkers_style(*out.save_style);
  if (out.dismisses_messages) messages_.clear();
  if (const auto file = std::exchange(chosen_file_, std::nullopt)) open_file(*file);
  if (calibration_ && calibration_state_ != CalibrationView::State::goes_on)
    end_calibration(calibration_state_);
}

void WindowLoop::run_action(Action action) {
  if (run_session_action(action) || run_view_action(action)) return;
  run_other_action(action);
}

bool WindowLoop::run_session_action(Action action) {
  switch (action) {
    case Action::pause:
      if (show_->pace() > 0.0) {
        pace_before_pause_ = show_->pace();
        show_->set_pace(0.0);
      } else {
        show_->set_pace(pace_before_pause_);
      }
      return true;
    case Action::step:
      step_once();
      return true;
    case Action::slow_motion:
      show_->set_pace(show_->pace() == kSlowMotion ? 1.0 : kSlowMotion);
      return true;
    case Action::reset:
      reset_session();
      return true;
    case Action::next_style:
      choose_style_after(1);
      return true;
    case Action::previous_style:
      choose_style_after(-1);
      return true;
    default:
      break;
  }
  if (action < Action::style_1 || action > Action::style_9) return false;
  const Cast& cast = show_->cast();
  const auto choices = style_choices(cast);
  const auto number = static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::style_1);
  if (number < choices.size()) choose_style(cast.styles[static_cast<std::size_t>(choices[number])]);
  return true;
}

bool WindowLoop::run_view_action(Action action) {
  switch (action) {
    case Action::next_walker:
      if (++state_.walker >= static_cast<int>(show_->cast().members.size())) state_.walker = -1;
      return true;
    case Action::follow:
      camera_.is_following = !camera_.is_following;
      return true;
    case Action::reset_camera:
      is_camera_new_ = true;
      return true;
    case Action::theme:
      state_.theme = state_.theme == ThemeName::dark ? ThemeName::light : ThemeName::dark;
      return true;
    case Action::trails:
      state_.has_trails = !state_.has_trails;
      return true;
    case Action::source:
      state_.has_source = !state_.has_source;
      return true;
    case Action::help:
      state_.is_help_open = !state_.is_help_open;
      return true;
    case Action::fullscreen: {
      const bool is_full = (SDL_GetWindowFlags(surface_->window()) & SDL_WINDOW_FULLSCREEN) != 0;
      SDL_SetWindowFullscreen(surface_->window(), is_full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
      return true;
    }
    default:
      break;
  }
  if (action < Action::panel_pad || action > Action::panel_loop) return false;
  toggle_panel(static_cast<Panel>(static_cast<int>(action) - static_cast<int>(Action::panel_pad)));
  return true;
}

void WindowLoop::run_other_action(Action action) {
  switch (action) {
    case Action::record:
      toggle_recording();
      break;
    case Action::screenshot:
      wants_screenshot_ = true;
      break;
    case Action::open_file:
      browser_.open();
      break;
    case Action::next_terrain:
      choose_next_terrain();
      break;
    case Action::calibrate:
      begin_calibration();
      break;
    case Action::back:
      go_back();
      break;
    case Action::quit:
      is_quitting_ = true;
      break;
    default:
      break;
  }
}

void WindowLoop::toggle_panel(Panel panel) {
  bool& is_open = state_.is_open[static_cast<std::size_t>(panel)];
  is_open = !is_open;
}

void WindowLoop::step_once() {
  if (show_->pace() > 0.0) {
    pace_before_pause_ = show_->pace();
    show_->set_pace(0.0);
  }
  show_->step();
}

void WindowLoop::reset_session() {
  if (show_->is_live()) {
    show_->command("reset");
  } else {
    show_->seek(0);
  }
}

void WindowLoop::choose_style(const std::string& name) {
  if (!show_->is_live()) {
    show_message("a playback keeps its own styles; Escape goes back to the live session");
  } else if (state_.walker >= 0) {
    show_->command(fmt::format("style {} {}", state_.walker + 1, name));
  } else {
    show_->command("style " + name);
  }
}

// Goes `steps` places on in the list, from the style of the chosen character or of the first.
void WindowLoop::choose_style_after(int steps) {
  const Cast& cast = show_->cast();
  const auto choices = style_choices(cast);
  const auto walker = static_cast<std::size_t>(std::max(state_.walker, 0));
  const auto index =
      static_cast<std::size_t>(std::max(show_->frame().walkers[walker].style_index, 0));
  if (choices.empty() || index >= cast.styles.size()) return;
  const auto name_of = [&cast](int choice) -> const std::string& {
    return cast.styles[static_cast<std::size_t>(choice)];
  };
  const auto count = static_cast<int>(choices.size());
  const auto now = std::ranges::find(choices, cast.styles[index], name_of) - choices.begin();
  choose_style(
      name_of(choices[static_cast<std::size_t>((static_cast<int>(now) + steps + count) % count)]));
}

void WindowLoop::go_back() {
  if (state_.is_help_open) {
    state_.is_help_open = false;
  } else if (browser_.is_open()) {
    browser_.close();
  } else if (calibration_) {
    end_calibration(CalibrationView::State::given_up);
  } else if (live_before_) {
    const SessionSpec live = *std::exchange(live_before_, std::nullopt);
    switch_to(live);
  }
}

void WindowLoop::save_walkers_style(const std::string& name) {
  const auto walker = static_cast<std::size_t>(std::max(state_.walker, 0));
  const auto& folders = show_->options().config_folders;
  const auto path = save_style(folders, name, show_->frame().walkers[walker].style);
  if (path) show_->add_config_folder(user_config_folder());  // the folder may be new
  show_message(path ? fmt::format("saved as {}; the next session can use it", *path)
                    : path.error().message);
}

constexpr std::size_t kMostRemarks = 200;
constexpr int kMostOfOneName = 100;

// A new name such as gaitpad-20240229-235959.hid in the working directory; empty if none is free.
std::string new_file(const char* ending) {
  const std::string name =
      fmt::format("gaitpad-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
  std::error_code error;
  for (int n = 1; n < kMostOfOneName; ++n) {
    const std::string path = n == 1 ? name + ending : fmt::format("{}-{}{}", name, n, ending);
    if (!std::filesystem::exists(path, error) && !std::filesystem::exists(path + ".part", error))
      return path;
  }
  return {};
}

void WindowLoop::show_message(std::string sentence) {
  if (sentence.empty()) return;
  if (result_.remarks.size() < kMostRemarks) result_.remarks.push_back(sentence);
  messages_.add(std::move(sentence), clock_.now_ns());
}

void WindowLoop::show_remarks() {
  for (std::string& remark : show_->take_remarks()) show_message(std::move(remark));
  const PadFrame& pad = show_->frame().pad;
  if (pad.untouched == 0 || std::exchange(is_untouched_told_, true)) return;
  const std::string name = show_->pad_name();
  show_message(untouched_warning(name.empty() ? "a pad" : name));
}

void WindowLoop::install_show(std::unique_ptr<Show> show) {
  show_ = std::move(show);
  ensemble_ = std::make_unique<Ensemble>(show_->cast());
  presses_.start_again();
  pace_before_pause_ = 1.0;
  is_camera_new_ = true;
  is_end_told_ = false;
  is_untouched_told_ = false;
  if (state_.walker >= static_cast<int>(show_->cast().members.size())) state_.walker = -1;
}

void WindowLoop::end_show() {
  const std::string recording = show_->options().live.record;
  const auto summary = show_->stop();
  show_remarks();
  if (!summary) {
    show_message(summary.error().message);
  } else if (!recording.empty()) {
    show_message("the recording " + recording + " is complete");
  }
  auto still = still_show(*show_);
  show_.reset();  // frees its pads
  install_show(std::move(still));
  is_camera_new_ = false;
}

bool WindowLoop::switch_to(const SessionSpec& next) {
  SessionSpec otherwise = show_->options();
  otherwise.live.record.clear();
  if (next.replay.trace.empty()) {
    auto start = Show::prepare(next);  // reads its files before the running show is ended
    if (!start) {
      show_message(start.error().message);
      return false;
    }
    end_show();
    return restart((*start)(), otherwise);
  }
  // A playback needs no pad, so the running session goes on until it is open.
  auto playback = Show::open(next);
  if (!playback) {
    show_message(playback.error().message);
    return false;
  }
  if (show_->is_live()) live_before_ = otherwise;
  end_show();
  install_show(std::move(*playback));
  return true;
}

// After end_show(): opens the next show, or else the one that ran before. If neither opens, nothing
// runs and the last state stays visible.
bool WindowLoop::restart(Result<std::unique_ptr<Show>> show, const SessionSpec& otherwise) {
  const bool is_begun = static_cast<bool>(show);
  if (!is_begun) {
    show_message(show.error().message);
    show = Show::open(otherwise);
    if (!show) show_message(show.error().message);
  }
  if (show) install_show(std::move(*show));
  return is_begun;
}

void WindowLoop::open_file(const std::string& path) {
  if (calibration_) return show_message("finish the calibration before opening a file");
  const auto kind = kind_of_file(path);
  if (!kind) return show_message(kind.error().message);
  const int count = static_cast<int>(show_->cast().members.size());
  SessionSpec next = with_file(show_->options(), path, *kind, state_.walker, count);
  if (makes_pictures()) return show_message("no file can be opened while pictures are made");
  if (!switch_to(next)) return;
  browser_.remember(path);
  const char* back = live_before_ && *kind == FileKind::recording ? "; Escape goes back" : "";
  show_message(fmt::format("opened {}{}", path, back));
}

// The next terrain of the configuration folders; the first one if the present one is from
// elsewhere.
void WindowLoop::choose_next_terrain() {
  if (calibration_) return;
  if (!show_->is_live()) return show_message("a playback keeps its own ground");
  if (makes_pictures())
    return show_message(
        "the ground cannot change while pictures are made; choose it with --terrain");
  SessionSpec next = show_->options();
  std::string& terrain = next.walk.terrain;
  const auto files = config_files(next.config_folders, "terrain");
  if (files.empty()) return show_message("no terrains were found");
  const std::string now = terrain.empty() ? "flat" : config_name(terrain);
  const auto at = std::ranges::find(files, now, config_name);
  const bool is_last = at == files.end() || at + 1 == files.end();
  terrain = is_last ? files.front() : *(at + 1);
  next.live.record.clear();
  if (switch_to(next)) show_message("on the ground " + config_name(terrain));
}

void WindowLoop::toggle_recording() {
  if (!show_->is_live()) return show_message("a playback runs: there is nothing to record");
  if (makes_pictures()) return show_message("no recording can be started while pictures are made");
  SessionSpec next = show_->options();
  const bool is_recorded = !next.live.record.empty();
  next.live.record = is_recorded ? "" : new_file(".hid");
  if (!is_recorded && next.live.record.empty())
    return show_message("no name is free for a recording");
  if (switch_to(next) && !is_recorded) show_message("recording to " + next.live.record);
}

void WindowLoop::begin_calibration() {
  if (calibration_) return;
  if (!show_->is_live() || makes_pictures())
    return show_message("sticks can be calibrated in a live session only");
  const SessionSpec before = show_->options();
  end_show();
  auto view = CalibrationView::start(
      {before.pad.wish, before.pad.map, before.config_folders, options_.calibration_folder});
  calibration_state_ = CalibrationView::State::goes_on;
  if (view) {
    calibration_ = std::move(*view);
  } else {
    show_message(view.error().message);
    restart(Show::open(show_->options()), show_->options());
  }
}

void WindowLoop::end_calibration(CalibrationView::State state) {
  calibration_.reset();  // frees the pad
  SessionSpec next = show_->options();
  // A calibration that was asked for would override the new one.
  if (state == CalibrationView::State::saved) next.pad.calibration.clear();
  restart(Show::open(next), show_->options());
}

void WindowLoop::take_screenshot(int width_px, int height_px) {
  const std::string path = new_file(".png");
  if (path.empty()) return show_message("no name is free for a picture");
  const auto problem = write_png(path, read_pixels(width_px, height_px));
  show_message(problem ? problem->message : "written to " + path);
}

}  // namespace

Result<WindowResult> run_window(const WindowOptions& options) {
  WindowLoop loop(options);
  if (auto problem = loop.open()) return *problem;
  return loop.run();
}

}  // namespace gaitpad
