#include "view/window.h"

#include <SDL2/SDL.h>
#include <epoxy/gl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
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
#include "draw/video.h"
#include "drivers/process_memory.h"
#include "gaitpad/config_files.h"
#include "pads/unseen_pad.h"
#include "scene/scene.h"
#include "session/file_kind.h"
#include "session/script.h"
#include "session/show.h"
#include "session/undo.h"
#include "system/clock.h"
#include "system/whole_file.h"
#include "view/controls.h"
#include "view/ensemble.h"
#include "view/file_browser.h"
#include "view/frame_clock.h"
#include "view/gui.h"
#include "view/layout.h"
#include "view/pad_dialog.h"
#include "view/surface.h"
#include "view/tooltips.h"
#include "view/widgets.h"

namespace gaitpad {
namespace {

// Errors and remarks for the user, each shown for some seconds, newest last.
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

constexpr int kIcon_px = 64;
constexpr std::int64_t kChange_ns = 5'000'000'000;  // time that the last change stays visible
// Time between two searches for the system's pads.
constexpr std::int64_t kPadHint_ns = 3'000'000'000;

double distance_to(const vec2& place, const vec2& a, const vec2& b) {
  const vec2 along = b - a;
  const double share = std::clamp(glm::dot(place - a, along) / glm::dot(along, along), 0.0, 1.0);
  return glm::distance(place, a + share * along);
}

// Draws a walking figure on a dark disc; a pixel's colour follows from its distance to six bones.
void set_window_icon(SDL_Window* window) {
  constexpr std::pair<vec2, vec2> kBones[] = {{{33, 21}, {30, 37}}, {{30, 37}, {40, 45}},
                                              {{40, 45}, {41, 55}}, {{30, 37}, {24, 46}},
                                              {{24, 46}, {16, 52}}, {{33, 23}, {43, 33}}};
  SDL_Surface* icon =
      SDL_CreateRGBSurfaceWithFormat(0, kIcon_px, kIcon_px, 32, SDL_PIXELFORMAT_RGBA32);
  if (icon == nullptr) return;
  for (int y = 0; y < kIcon_px; ++y) {
    auto* row =
        static_cast<std::uint8_t*>(icon->pixels) + static_cast<std::ptrdiff_t>(y) * icon->pitch;
    for (int x = 0; x < kIcon_px; ++x) {
      const vec2 at(x + 0.5, y + 0.5);
      double away = glm::distance(at, vec2(35, 13)) - 3.0;  // distance to the head
      for (const auto& [a, b] : kBones) away = std::min(away, distance_to(at, a, b));
      const double figure = std::clamp(3.4 - away, 0.0, 1.0);
      const double disc = std::clamp(31.5 - glm::distance(at, vec2(32, 32)), 0.0, 1.0);
      const auto byte = [](double v) { return static_cast<std::uint8_t>(v * 255.0 + 0.5); };
      row[4 * x] = byte(0.12 + figure * 0.22);
      row[4 * x + 1] = byte(0.15 + figure * 0.56);
      row[4 * x + 2] = byte(0.19 + figure * 0.72);
      row[4 * x + 3] = byte(disc);
    }
  }
  SDL_SetWindowIcon(window, icon);
  SDL_FreeSurface(icon);
}

// A frame's least time with a software rasterizer, which leaves processor time to the session.
constexpr double kSoftwareFrame_s = 1.0 / 30.0;
// A frame's least time if the display does not limit the rate.
constexpr double kFrame_s = 1.0 / 120.0;
constexpr double kUnseenFrame_s = 0.1;     // a frame's least time while the window is
                                           // minimized
constexpr double kOrbitMouse_rad = 0.006;  // the camera's turn per pixel of the mouse, at
                                           // scale 1
constexpr double kOrbitStick_rad_s = 1.8;
// Smaller deflections of the right stick do not move the camera.
constexpr double kStickRest = 0.02;
constexpr std::int64_t kMessage_ns = 15'000'000'000;

// Runs the window: opens it, draws frames, executes the user's requests, and closes it.
class WindowLoop {
 public:
  explicit WindowLoop(const WindowOptions& options);
  ~WindowLoop();
  std::optional<Error> open();
  Result<WindowResult> run();

 private:
  // The steps of a frame, in order.
  bool makes_pictures() const noexcept;
  bool makes_still() const noexcept;  // whether only the last frame is kept
  bool draw_frame();                  // False after the last frame.
  void wait_for_display();
  bool is_ended();
  std::optional<Error> picture_problem() const;
  void show_progress() const;
  bool is_modal() const noexcept { return browser_.is_open() || pad_dialog_ != nullptr; }
  void handle_events();
  void follow_requests(UserRequests requests);
  void add_button_actions(std::vector<Action>& wanted);
  bool navigates(Action action);
  void move_camera(const UserRequests& requests);
  void call_script();
  void apply_layout(const UiState& layout);
  void fail_without_display();
  void remember_layout();
  Result<WindowResult> result();

  // The contents of a frame.
  void update_show();
  void draw_window(bool is_last);
  UiOutput draw_panels(int width_px, int height_px, bool is_drawn);
  UiInput ui_input();
  const LiveStatus* shown_status();
  void draw_browser(Ui& ui, const ImVec2& window_px);
  void draw_pad_dialog(Ui& ui, const ImVec2& window_px);
  void reset_camera(const Viewport& viewport);
  Framing wanted_framing(const Viewport& viewport) const;
  void turn_to_risers(double passed_s);
  void set_type_size(double size);
  double scale() const { return surface_->scale() * state_.type_size; }
  bool has_walked() const;
  void keep_pictures(int width_px, int height_px, bool is_last);

  // The user's requests.
  void run_actions(const UiOutput& out);
  void run_action(Action action);
  bool is_read_only();  // True in a playback; tells the user that it cannot be changed.
  void choose_style(const std::string& name);
  void choose_style_number(std::size_t number);  // `number` counts from 0 in the session's list.
  void choose_style_after(int steps);
  void toggle_pause();
  void toggle_full_screen();
  void step_once();
  void reset_session();
  void toggle_stick();
  void aim_stick();
  void go_back();
  void save_walkers_style(const std::string& name);

  // Changes of the show.
  void send_command(const std::string& command);  // Sends a change that the user made and can undo.
  void send_again(const std::vector<std::string>& commands, const char* what);
  void say_change(std::string what);
  void show_message(std::string sentence);
  void show_remarks();
  void install_show(std::unique_ptr<Show> show);
  void end_show();  // Ends the session; its last state stays visible.
  bool switch_to(const SessionSpec& next);
  bool restart(Result<std::unique_ptr<Show>> show, const SessionSpec& otherwise);
  void open_file(const std::string& path);
  void choose_next_terrain();
  void toggle_recording();
  void end_recording();
  void begin_calibration();
  using PadDialogStart = Result<std::unique_ptr<PadDialog>>(const PadDialogOptions&);
  void begin_pad_dialog(PadDialogStart& start);
  void end_pad_dialog(PadDialog::State state);
  void take_screenshot(int width_px, int height_px);

  WindowOptions options_;
  WindowResult result_;
  std::optional<Error> failure_;  // why the window has to end; none: it goes on

  // Each member uses only those before it, so they are destroyed in a valid order.
  std::unique_ptr<WindowSurface> surface_;
  std::unique_ptr<Gui> gui_;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<VideoWriter> video_;
  std::unique_ptr<PadDialog> pad_dialog_;  // while it is open, there is no show
  std::unique_ptr<Show> show_;
  std::unique_ptr<Ensemble> ensemble_;
  // During a playback: how to start the previous live session again.
  std::optional<SessionSpec> live_before_;

  UiState state_;
  UiState remembered_;  // the state that the layout file holds
  std::optional<ThemeName> applied_theme_;
  Camera camera_;
  bool is_camera_new_ = true;
  SceneContent content_;
  Controls controls_;
  ButtonPresses presses_;
  std::vector<SDL_Keycode> keys_;  // the keys that were pressed since the last frame
  NavigationInput navigation_;
  FileBrowser browser_;
  Messages messages_;
  UndoList undo_;
  std::string change_;  // the last change and the characters that it concerns
  std::int64_t change_ns_ = 0;
  std::vector<std::string> style_summaries_;  // what each of the show's styles does, in a line
  std::string finished_recording_;            // the recording that a message offers to replay
  std::string pad_hint_;
  std::int64_t pad_hint_ns_ = 0;
  FrameClock clock_;
  FramePacer pacer_;
  bool is_paced_ = false;  // the display limits the rate of frames
  LiveStatus picture_status_;
  double pace_before_pause_ = 1.0;
  std::optional<std::string> chosen_file_;  // the file that was chosen in the browser in this frame
  PadDialog::State pad_dialog_state_ = PadDialog::State::goes_on;
  bool wants_screenshot_ = false, is_quitting_ = false;
  // The user was told that the session has ended, that the pad was not touched.
  bool is_end_told_ = false, is_untouched_told_ = false;
  bool is_camera_moved_ = false;  // the user moved the camera, so it no longer turns by itself
  std::optional<int> aimed_deg_;  // the last heading that was sent to the session
  std::int64_t aimed_tick_ = 0;
  bool has_walked_ = false;  // a character has walked since the show began
};

WindowLoop::WindowLoop(const WindowOptions& options)
    : options_(options), browser_(options.recent_file) {
  // Without a pad the keyboard steers. For pictures the session's clock is that of the frames.
  options_.session.live.keyboard = true;
  if (const std::string& record = options_.session.live.record; !record.empty())
    options_.record_folder = std::filesystem::path(record).parent_path();
  if (makes_pictures()) options_.session.live.clock = SessionSpec::Live::Clock::by_hand;
}

WindowLoop::~WindowLoop() {
  show_.reset();  // stops the session's threads before SDL stops
  if (surface_ == nullptr || !surface_->is_lost()) return;
  // Closing anything on a lost display could wait without end, so leave it to the program's end.
  static_cast<void>(pad_dialog_.release());
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

// Applies the stored layout, changed by the options of this start.
void WindowLoop::apply_layout(const UiState& layout) {
  state_ = remembered_ = layout;
  if (options_.theme) state_.theme = *options_.theme;
  state_.is_clean = options_.is_clean;
  if (makes_pictures()) state_.type_size = 1.0;  // pictures have the size that --scale gives
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
  // Checks the files before anything is opened.
  if (auto problem = picture_problem()) return problem;
  auto start = Show::prepare(options_.session);
  if (!start) return start.error();
  auto surface = WindowSurface::open({"gaitpad", options_.width, options_.height, options_.scale,
                                      options_.without_display, options_.is_hidden});
  if (!surface) return surface.error();
  surface_ = std::move(*surface);
  set_window_icon(surface_->window());
  auto scene = Scene::create(makes_still() ? Scene::Quality::high : Scene::Quality::automatic);
  if (!scene) return scene.error();
  scene_ = std::move(*scene);
  gui_ = std::make_unique<Gui>(*surface_);
  if (state_.type_size != 1.0) gui_->set_scale(scale());
  auto show = (*start)();
  if (!show) return show.error();
  install_show(std::move(*show));
  show_message(std::move(layout.remark));
  if (makes_pictures()) return std::nullopt;
  const bool keeps_time = SDL_GL_GetSwapInterval() != 0 && !scene_->is_software();
  clock_.set_least(scene_->is_software() ? kSoftwareFrame_s : keeps_time ? 0.0 : kFrame_s);
  is_paced_ = keeps_time;
  return std::nullopt;
}

Result<WindowResult> WindowLoop::run() {
  while (!failure_ && draw_frame()) {
  }
  if (video_ && !failure_ && !result_.is_cut_off) failure_ = video_->finish();
  video_.reset();
  return result();
}

// The error if a picture or video could not be written, found before anything is drawn.
std::optional<Error> WindowLoop::picture_problem() const {
  if (!options_.screenshot.empty()) {
    if (auto problem = saving_problem(options_.screenshot)) return problem;
  }
  return options_.video.empty() ? std::nullopt : VideoWriter::problem_of(options_.video);
}

// A driver may return from the swap of buffers at once and block the next drawing call instead.
// Draw and finish here, so that this wait ends before the newest reports are taken.
void WindowLoop::wait_for_display() {
  if (!is_paced_ || result_.frames == 0 || surface_->is_lost()) return;
  surface_->begin();
  glClear(GL_COLOR_BUFFER_BIT);
  glFinish();
  sleep_until(pacer_.begin_ns(now_ns()));
}

bool WindowLoop::draw_frame() {
  wait_for_display();
  clock_.begin_frame(now_ns());
  call_script();
  handle_events();
  follow_requests(controls_.take_requests());
  if (options_.take_commands)
    for (const std::string& command : options_.take_commands()) show_->command(command);
  update_show();
  const bool is_last = is_ended();
  if (result_.is_cut_off) return false;
  show_progress();
  const bool is_seen = (SDL_GetWindowFlags(surface_->window()) & SDL_WINDOW_MINIMIZED) == 0;
  const bool is_drawn = !surface_->is_lost() && (is_seen || makes_pictures());
  if (is_drawn) draw_window(is_last);
  if (is_drawn && result_.first_frame_ns == 0) result_.first_frame_ns = now_ns();
  show_->end_frame(is_drawn ? FrameEnd::handed_over : FrameEnd::not_shown);
  if (surface_->is_lost()) fail_without_display();
  ++result_.frames;
  if (!is_seen) {
    SDL_Delay(static_cast<Uint32>(kUnseenFrame_s * 1e3));
    pacer_.start_again();
  }
  clock_.wait_for_next();
  return !is_last;
}

bool WindowLoop::is_ended() {
  if (is_quitting_) return true;
  if (options_.is_ended_from_outside && options_.is_ended_from_outside()) {
    result_.is_cut_off = makes_pictures();
    return true;
  }
  if (options_.frames > 0) return result_.frames + 1 >= options_.frames;
  const Timeline* timeline = show_->timeline();
  return makes_pictures() && timeline != nullptr && timeline->tick + 1 >= timeline->ticks;
}

void WindowLoop::show_progress() const {
  if (!options_.show_progress || !makes_pictures()) return;
  const Timeline* timeline = show_->timeline();
  if (options_.frames > 0) {
    options_.show_progress(static_cast<double>(result_.frames) / options_.frames);
  } else if (timeline != nullptr) {
    options_.show_progress(static_cast<double>(timeline->tick) /
                           static_cast<double>(timeline->ticks));
  }
}

void WindowLoop::fail_without_display() {
  if (!failure_) failure_ = Error{"the display is lost: the window and its session end"};
}

void WindowLoop::call_script() {
  if (!options_.script) return;
  options_.script({result_.frames, show_->frame(), show_->cast(), state_, camera_, show_->pace(),
                   !show_->is_live(), browser_.is_open(), pad_dialog_ != nullptr,
                   show_->options().live.record, messages_.sentences()});
}

void WindowLoop::handle_events() {
  for (SDL_Event event; !surface_->is_lost() && SDL_PollEvent(&event) != 0;) {
    gui_->handle_event(event);
    TakenInput taken = gui_->taken_input();
    taken.navigates = !state_.memory.focus.empty();
    taken.is_modal = is_modal();
    controls_.handle_event(event, taken);
    if (event.type == SDL_DROPFILE) SDL_free(event.drop.file);
    const bool is_moved =
        event.type == SDL_WINDOWEVENT && (event.window.event == SDL_WINDOWEVENT_MOVED ||
                                          event.window.event == SDL_WINDOWEVENT_DISPLAY_CHANGED);
    if (is_moved && surface_->follow_display()) set_type_size(state_.type_size);
  }
}

void WindowLoop::follow_requests(UserRequests requests) {
  navigation_ = {};
  if (show_->is_live() && !makes_pictures()) add_button_actions(requests.actions);
  for (const Action action : requests.actions) {
    const bool is_always = action == Action::back || action == Action::quit ||
                           action == Action::screenshot || action == Action::fullscreen;
    if (is_always || !is_modal()) run_action(action);
  }
  for (const std::string& file : requests.files) open_file(file);
  if (is_modal()) controls_.release_all();
  show_->steer(controls_.walk());
  move_camera(requests);
  keys_ = std::move(requests.keys);
  navigation_.steps += requests.navigation.steps;
  navigation_.sideways += requests.navigation.sideways;
  navigation_.press |= requests.navigation.press;
}

// A recording that plays as the pad steers and moves the camera, but its buttons cannot record,
// open, calibrate or quit: its last press may be the one that ended the recording.
void WindowLoop::add_button_actions(std::vector<Action>& wanted) {
  std::vector<Action> pressed;
  presses_.add_new_presses(show_->frame(), pressed);
  if (is_recording(show_->options().pad.selector.pad)) {
    std::erase_if(pressed, [](Action action) {
      return action == Action::record || action == Action::screenshot ||
             action == Action::open_file || action == Action::calibrate || action == Action::quit;
    });
  }
  if (!state_.memory.focus.empty())
    std::erase_if(pressed, [this](Action a) { return navigates(a); });
  wanted.insert(wanted.end(), pressed.begin(), pressed.end());
}

// While the pad navigates the panels, its D-pad and lower button have no other effect.
bool WindowLoop::navigates(Action action) {
  const int button = info_of(action).button;
  navigation_.steps += (button == kButtonDpadDown) - (button == kButtonDpadUp);
  navigation_.sideways += (button == kButtonDpadRight) - (button == kButtonDpadLeft);
  navigation_.press |= button == kButtonA;
  return button == kButtonA || (button >= kButtonDpadUp && button <= kButtonDpadRight);
}

void WindowLoop::move_camera(const UserRequests& requests) {
  const double rad = kOrbitMouse_rad / scale();
  is_camera_moved_ = is_camera_moved_ || requests.orbit_px != vec2(0.0);
  orbit(camera_, -requests.orbit_px.x * rad, requests.orbit_px.y * rad);
  if (requests.pan_px != vec2(0.0)) {
    int width_px = 0, height_px = 0;
    surface_->size(width_px, height_px);
    pan(camera_, requests.pan_px, height_px);
  }
  if (requests.dolly != 1.0) dolly(camera_, requests.dolly);
  if (!show_->is_live() || makes_pictures()) return;
  const vec2& stick = show_->frame().stick.right;
  if (glm::length(stick) < kStickRest) return;
  const double angle_rad = kOrbitStick_rad_s * clock_.passed_s();
  is_camera_moved_ = true;
  orbit(camera_, -stick.x * angle_rad, stick.y * angle_rad);
}

void WindowLoop::update_show() {
  if (makes_pictures()) {
    show_->update_for_picture();
  } else {
    show_->update(clock_.passed_s());
    messages_.forget_before(clock_.now_ns() - kMessage_ns);
    if (messages_.sentences().empty()) finished_recording_.clear();
  }
  show_remarks();
  if (!show_->has_ended() || std::exchange(is_end_told_, true) || makes_pictures()) return;
  show_message("Recording finished. Keep walking with W A S D.");
}

void WindowLoop::remember_layout() {
  if (options_.layout_file.empty()) return;
  // Options of this start are not stored.
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
  if (result_.is_cut_off) {
    result_.remarks.emplace_back("it was ended before its last frame; no picture was written");
  } else {
    for (const std::string& path : {options_.screenshot, options_.video}) {
      if (!path.empty()) result_.remarks.push_back("written to " + path);
    }
  }
  if (const LiveStatus* status = show_->status()) result_.status = *status;
  result_.summary = std::move(*summary);
  result_.frames_per_second = clock_.mean_frames_per_second();
  return std::move(result_);
}

constexpr double kAside_rad = 1.1, kAbove_rad = 0.3, kAboveCrowd_rad = 0.36;
// On uneven ground the camera stands where it sees the risers: behind the walkers on the way up,
// ahead of them on the way down. It changes sides in about two seconds.
constexpr double kBehind_rad = 2.05, kLeastRise_m = 0.1, kTurn_per_s = 1.1;

void WindowLoop::draw_window(bool is_last) {
  int width_px = 0, height_px = 0;
  surface_->size(width_px, height_px);
  const Theme& theme = theme_of(state_.theme);
  if (applied_theme_ != state_.theme) gui_->apply(theme);
  applied_theme_ = state_.theme;
  // For a still picture only the kept frames are drawn.
  const bool is_drawn = !makes_still() || is_last || wants_screenshot_;
  if (is_drawn) {
    surface_->begin();
    glViewport(0, 0, width_px, height_px);
    glClearColor(static_cast<float>(theme.window.red), static_cast<float>(theme.window.green),
                 static_cast<float>(theme.window.blue), 1.0f);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  }

  const Viewport viewport =
      scene_viewport(state_, show_->timeline() != nullptr, width_px, height_px, scale());
  ensemble_->look_from(camera_.eye_m());
  ensemble_->fill(show_->frame(), show_->history(), show_->share(now_ns()), show_->cast(), state_,
                  theme, content_);
  if (std::exchange(is_camera_new_, false)) reset_camera(viewport);
  const double passed_s = makes_pictures() ? 1.0 / kPictureRateHz : clock_.passed_s();
  follow(camera_, ensemble_->focus_m(-1), passed_s);
  approach(camera_, wanted_framing(viewport), passed_s);
  turn_to_risers(passed_s);
  aim_stick();
  ensemble_->stand_on_ground(camera_);
  if (is_drawn && viewport.width > 0 && viewport.height > 0)
    scene_->draw(content_, camera_, theme, viewport, height_px, scale());
  run_actions(draw_panels(width_px, height_px, is_drawn));
  if (!is_drawn) return;
  keep_pictures(width_px, height_px, is_last);
  if (is_paced_) {
    glFinish();
    pacer_.note_work(now_ns() - clock_.now_ns());
  }
  surface_->show();
}

// Frames all characters beside the panels. Zooming in moves the target to the selected character.
Framing WindowLoop::wanted_framing(const Viewport& viewport) const {
  Framing wanted = ensemble_->framing(camera_, viewport, state_, scale());
  const double zoomed = std::clamp(2.0 * (1.0 - camera_.distance_m / camera_.framed_m), 0.0, 1.0);
  if (state_.walker >= 0)
    wanted.target_m = glm::mix(wanted.target_m, ensemble_->focus_m(state_.walker), zoomed);
  return wanted;
}

void WindowLoop::reset_camera(const Viewport& viewport) {
  camera_ = Camera();
  is_camera_moved_ = false;
  // A view from the side, in which steps ahead hide no feet.
  if (ensemble_->is_on_uneven_ground()) {
    const bool is_upward = ensemble_->rise_ahead_m(state_.walker) > kLeastRise_m;
    camera_.yaw_rad = is_upward ? kBehind_rad : kAside_rad;
    camera_.pitch_rad = kAbove_rad;
  }
  if (ensemble_->has_crowd()) camera_.pitch_rad = kAboveCrowd_rad;
  if (options_.camera_deg.size() == 2) {
    camera_.yaw_rad = options_.camera_deg[0] * kDegree;
    camera_.pitch_rad = options_.camera_deg[1] * kDegree;
  }
  show(camera_, ensemble_->framing(camera_, viewport, state_, scale()), ensemble_->focus_m(-1));
}

void WindowLoop::turn_to_risers(double passed_s) {
  // A pointing stick is relative to the camera: if the camera turned by itself, so would the
  // walkers.
  const bool is_free = !is_camera_moved_ && camera_.is_following && options_.camera_deg.empty() &&
                       show_->options().walk.stick == StickMeans::steers;
  if (!is_free || !ensemble_->is_on_uneven_ground()) return;
  const double rise_m = ensemble_->rise_ahead_m(state_.walker);
  if (std::abs(rise_m) < kLeastRise_m) return;
  const double wanted_rad = rise_m > 0.0 ? kBehind_rad : kAside_rad;
  const double share = std::min(kTurn_per_s * passed_s, 1.0);
  orbit(camera_, (wanted_rad - camera_.yaw_rad) * share, 0.0);
}

void WindowLoop::set_type_size(double size) {
  state_.type_size = std::clamp(size, kLeastTypeSize, kMostTypeSize);
  gui_->set_scale(scale());
  applied_theme_.reset();
}

// True if a character walks; then the hint on walking is no longer needed.
bool WindowLoop::has_walked() const {
  const SessionFrame& frame = show_->frame();
  for (int w = 0; w < frame.walker_count; ++w) {
    if (frame.walkers[static_cast<std::size_t>(w)].walk.stage != Stage::idle) return true;
  }
  return false;
}

// For pictures, leaves out the values that depend on the machine's speed.
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
  const Timeline* timeline = show_->timeline();
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
             .style_summaries = style_summaries_,
             .finished_recording = finished_recording_,
             .can_leave = live_before_.has_value(),
             .navigation = navigation_,
             .keys = keys_,
             .is_modal = is_modal()};
  has_walked_ = has_walked_ || has_walked();
  const LiveStatus* status = show_->is_live() ? show_->status() : nullptr;
  const bool has_pad = status != nullptr && status->pads.plugged > status->pads.unplugged;
  if (show_->is_live() && !has_walked_) {
    in.hint = has_pad ? "Push the left stick, or W A S D; F1: keys"
                      : "W A S D or plug a pad in; F1: keys";
    if (!has_pad && !makes_pictures()) {
      if (pad_hint_ns_ + kPadHint_ns < clock_.now_ns()) {
        pad_hint_ns_ = clock_.now_ns();
        pad_hint_ = unseen_pad();
      }
      in.pad_hint = pad_hint_;
    }
  }
  if (makes_pictures()) return in;
  if (clock_.now_ns() < change_ns_ + kChange_ns) in.change = change_;
  in.can_rumble = has_pad && !is_recording(show_->options().pad.selector.pad);
  in.pad_rate_hz = clock_.rate_hz(frame.pad.reports);
  in.frames_per_second = clock_.frames_per_second();
  if (state_.is_open[static_cast<std::size_t>(Panel::loop)])
    in.memory_mib = static_cast<double>(resident_bytes()) / 1048576.0;
  return in;
}

UiOutput WindowLoop::draw_panels(int width_px, int height_px, bool is_drawn) {
  const Theme& theme = theme_of(state_.theme);
  const ImVec2 window_px(static_cast<float>(width_px), static_cast<float>(height_px));
  UiInput in = ui_input();
  const Viewport viewport =
      scene_viewport(state_, in.timeline != nullptr, width_px, height_px, scale());
  in.labels = ensemble_->labels(show_->frame(), show_->cast(), camera_, viewport, state_, theme);
  gui_->begin(controls_.mouse(), makes_pictures() ? 1.0 / kPictureRateHz : 0.0);
  UiOutput out = draw_ui(in, theme, gui_->fonts(), scale(), state_);
  Ui ui{in, theme, gui_->fonts(), static_cast<float>(scale()), state_, out};
  draw_browser(ui, window_px);
  draw_pad_dialog(ui, window_px);
  move_focus(in, state_.memory);
  if (is_drawn) gui_->end();
  if (!is_drawn) gui_->end_undrawn();
  return out;
}

void WindowLoop::draw_browser(Ui& ui, const ImVec2& window_px) {
  if (!browser_.is_open()) return;
  if (const auto file = browser_.draw(ui, window_px)) chosen_file_ = *file;
}

void WindowLoop::draw_pad_dialog(Ui& ui, const ImVec2& window_px) {
  if (!pad_dialog_) return;
  std::vector<std::string> messages;
  pad_dialog_state_ = pad_dialog_->draw(ui, window_px, messages);
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
  Pixels pixels = read_pixels(width_px, height_px);
  if (video_) failure_ = video_->add(pixels);
  if (keeps_still && !failure_) failure_ = write_png(options_.screenshot, std::move(pixels));
}

constexpr double kSlowMotion = 0.25;

void WindowLoop::run_actions(const UiOutput& out) {
  for (const Action action : out.actions) run_action(action);
  for (const std::string& command : out.commands) send_command(command);
  if (out.type_size) set_type_size(*out.type_size);
  if (out.rumbles) show_->rumble();
  if (out.seek_tick) show_->seek(*out.seek_tick);
  if (out.pace) show_->set_pace(*out.pace);
  if (out.is_looping) show_->set_looping(*out.is_looping);
  if (out.save_style) save_walkers_style(*out.save_style);
  if (out.dismisses_messages) messages_.clear();
  if (out.replays) open_file(std::exchange(finished_recording_, {}));
  if (const auto file = std::exchange(chosen_file_, std::nullopt)) open_file(*file);
  if (pad_dialog_ && pad_dialog_state_ != PadDialog::State::goes_on)
    end_pad_dialog(pad_dialog_state_);
}

void WindowLoop::run_action(Action action) {
  using Loop = WindowLoop;
  static constexpr std::pair<Action, void (*)(Loop&)> kRuns[] = {
      {Action::pause, [](Loop& l) { l.toggle_pause(); }},
      {Action::step, [](Loop& l) { l.step_once(); }},
      {Action::slow_motion,
       [](Loop& l) { l.show_->set_pace(l.show_->pace() == kSlowMotion ? 1.0 : kSlowMotion); }},
      {Action::reset, [](Loop& l) { l.reset_session(); }},
      {Action::stick, [](Loop& l) { l.toggle_stick(); }},
      {Action::next_style, [](Loop& l) { l.choose_style_after(1); }},
      {Action::previous_style, [](Loop& l) { l.choose_style_after(-1); }},
      {Action::undo, [](Loop& l) { l.send_again(l.undo_.undo(), "undone"); }},
      {Action::redo, [](Loop& l) { l.send_again(l.undo_.redo(), "done again"); }},
      {Action::next_terrain, [](Loop& l) { l.choose_next_terrain(); }},
      {Action::next_walker,
       [](Loop& l) {
         const int count = static_cast<int>(l.show_->cast().members.size());
         if (++l.state_.walker >= count) l.state_.walker = -1;
       }},
      {Action::record, [](Loop& l) { l.toggle_recording(); }},
      {Action::screenshot, [](Loop& l) { l.wants_screenshot_ = true; }},
      {Action::open_file, [](Loop& l) { l.browser_.open(l.show_->options().config_folders); }},
      {Action::calibrate, [](Loop& l) { l.begin_calibration(); }},
      {Action::follow, [](Loop& l) { l.camera_.is_following = !l.camera_.is_following; }},
      {Action::reset_camera, [](Loop& l) { l.is_camera_new_ = true; }},
      {Action::theme,
       [](Loop& l) {
         const bool is_dark = l.state_.theme == ThemeName::dark;
         l.state_.theme = is_dark ? ThemeName::light : ThemeName::dark;
       }},
      {Action::trails, [](Loop& l) { l.state_.has_trails = !l.state_.has_trails; }},
      {Action::source, [](Loop& l) { l.state_.has_source = !l.state_.has_source; }},
      {Action::navigate,
       [](Loop& l) { l.state_.memory.focus = l.state_.memory.focus.empty() ? "play" : ""; }},
      {Action::help, [](Loop& l) { l.state_.is_help_open = !l.state_.is_help_open; }},
      {Action::fullscreen, [](Loop& l) { l.toggle_full_screen(); }},
      {Action::quit, [](Loop& l) { l.is_quitting_ = true; }},
      {Action::back, [](Loop& l) { l.go_back(); }},
  };
  const auto number_from = [action](Action first) {
    return static_cast<std::size_t>(action) - static_cast<std::size_t>(first);
  };
  if (action >= Action::style_1 && action <= Action::style_9)
    return choose_style_number(number_from(Action::style_1));
  if (action >= Action::first_panel && action < action_of(kPanels)) {
    bool& is_open = state_.is_open[number_from(Action::first_panel)];
    is_open = !is_open;
    return;
  }
  const auto found = std::ranges::find(kRuns, action, [](const auto& run) { return run.first; });
  assert(found != std::end(kRuns));
  found->second(*this);
}

void WindowLoop::toggle_pause() {
  if (show_->pace() > 0.0) pace_before_pause_ = show_->pace();
  show_->set_pace(show_->pace() > 0.0 ? 0.0 : pace_before_pause_);
}

void WindowLoop::toggle_full_screen() {
  const bool is_full = (SDL_GetWindowFlags(surface_->window()) & SDL_WINDOW_FULLSCREEN) != 0;
  SDL_SetWindowFullscreen(surface_->window(), is_full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
}

void WindowLoop::step_once() {
  if (show_->pace() > 0.0) toggle_pause();
  show_->step();
}

void WindowLoop::reset_session() {
  if (show_->is_live()) {
    show_->command("reset");
  } else {
    show_->seek(0);
  }
}

void WindowLoop::toggle_stick() {
  if (is_read_only()) return;
  const bool points = show_->options().walk.stick == StickMeans::steers;
  show_->set_stick(points ? StickMeans::points : StickMeans::steers);
  aimed_deg_.reset();
  if (points) aim_stick();
  if (!points) show_->command("stick steers");
  say_change(points ? "the stick points, seen from the camera" : "the stick steers");
}

constexpr int kMostAims_per_s = 20;

// If the stick points, tells the session the camera's heading in whole degrees, by commands, so
// that a replay needs no camera. A heading from a script holds until the camera turns.
void WindowLoop::aim_stick() {
  const std::int64_t tick = show_->frame().tick;
  const bool points = show_->is_live() && show_->options().walk.stick == StickMeans::points;
  if (!points || pad_dialog_ || tick < 0) return;
  const double heading_deg = std::remainder(camera_.yaw_rad / kDegree + 180.0, 360.0);
  const int aim_deg = static_cast<int>(std::lround(heading_deg));
  const bool is_soon = tick < aimed_tick_ + show_->cast().rate_hz / kMostAims_per_s;
  if (aimed_deg_ && (*aimed_deg_ == aim_deg || is_soon)) return;
  show_->command(fmt::format("stick points {}", aim_deg));
  aimed_deg_ = aim_deg;
  aimed_tick_ = tick;
}

bool WindowLoop::is_read_only() {
  if (show_->is_live()) return false;
  show_message("Playback is read-only; Esc returns to live.");
  return true;
}

void WindowLoop::choose_style(const std::string& name) {
  if (is_read_only()) return;
  send_command(state_.walker >= 0 ? fmt::format("style {} {}", state_.walker + 1, name)
                                  : "style " + name);
}

void WindowLoop::choose_style_number(std::size_t number) {
  const Cast& cast = show_->cast();
  const auto choices = style_choices(cast);
  if (number < choices.size()) choose_style(cast.styles[static_cast<std::size_t>(choices[number])]);
}

// Moves by `steps` in the list, from the style of the selected or first character.
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

void WindowLoop::send_command(const std::string& command) {
  undo_.add(command, show_->frame(), show_->cast());
  show_->command(command);
  const auto parsed = parsed_command(command);
  if (!parsed) return;
  const std::size_t count = show_->cast().members.size();
  std::string whom = fmt::format("character {}", parsed->walker);
  if (parsed->walker == 0)
    whom = count == 1 ? "the character" : fmt::format("all {} characters", count);
  switch (parsed->verb) {
    case Command::Verb::style:
      return say_change(fmt::format("style {} for {}", parsed->name, whom));
    case Command::Verb::set:
    case Command::Verb::gait:
      return say_change(
          fmt::format("{} {:g} for {}", words_of_key(parsed->name), parsed->value, whom));
    case Command::Verb::release:
      return say_change(fmt::format("{} by the stick for {}", words_of_key(parsed->name), whom));
    case Command::Verb::stick:
      return say_change(fmt::format("everything by the stick for {}", whom));
    case Command::Verb::ik:
      return say_change(fmt::format("the {} solver for everybody", parsed->name));
    default:
      return;
  }
}

void WindowLoop::send_again(const std::vector<std::string>& commands, const char* what) {
  if (is_read_only()) return;
  if (commands.empty()) return say_change(fmt::format("nothing can be {}", what));
  for (const std::string& command : commands) show_->command(command);
  state_.memory.pending.clear();
  say_change(fmt::format("{}: {}", what, fmt::join(commands, ", ")));
}

void WindowLoop::say_change(std::string what) {
  change_ = std::move(what);
  change_ns_ = clock_.now_ns();
}

void WindowLoop::go_back() {
  if (is_menu_open()) {
    close_menus();
  } else if (!state_.memory.focus.empty()) {
    state_.memory.focus.clear();
  } else if (state_.is_help_open) {
    state_.is_help_open = false;
  } else if (browser_.is_open()) {
    browser_.close();
  } else if (pad_dialog_) {
    end_pad_dialog(PadDialog::State::ended);
  } else if (live_before_) {
    const SessionSpec live = *std::exchange(live_before_, std::nullopt);
    switch_to(live);
  }
}

void WindowLoop::save_walkers_style(const std::string& name) {
  const auto walker = static_cast<std::size_t>(std::max(state_.walker, 0));
  const auto& folders = show_->options().config_folders;
  const StyleValues& values = show_->frame().walkers[walker].style;
  const auto path = save_style(folders, name, values);
  if (!path) return show_message(path.error().message);
  show_->add_config_folder(user_config_folder());  // saving may have created this folder
  show_message("saved as " + *path);
  if (!show_->is_live()) return;
  Style style;
  static_cast<StyleValues&>(style) = values;
  style.name = config_name(*path);
  show_->add_style(style);
  style_summaries_.resize(show_->cast().styles.size());
  choose_style(style.name);
  state_.memory.style_name.fill('\0');
}

constexpr std::size_t kMostRemarks = 200;
constexpr int kMostOfOneName = 100;

// A free name such as gaitpad-20240229-235959.hid in the folder; empty if none is free.
std::string new_file(const std::string& folder, const char* ending) {
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  const std::string name =
      std::filesystem::path(folder) /
      fmt::format("gaitpad-{:%Y%m%d-%H%M%S}", fmt::localtime(std::time(nullptr)));
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
  has_walked_ = false;
  aimed_deg_.reset();
  state_.overlaid.clear();
  undo_.clear();
  style_summaries_.clear();
  for (const std::string& style : show_->cast().styles) {
    const auto path = config_file(show_->options().config_folders, "styles", style);
    style_summaries_.push_back(path ? config_summary(*path) : "");
  }
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
  show_.reset();  // the session frees its pads for the dialog
  install_show(std::move(still));
  is_camera_new_ = false;
}

bool WindowLoop::switch_to(const SessionSpec& next) {
  SessionSpec otherwise = show_->options();
  otherwise.live.record.clear();
  if (next.replay.trace.empty()) {
    // Reads the files of the new show while the old one still runs.
    auto start = Show::prepare(next);
    if (!start) {
      show_message(start.error().message);
      return false;
    }
    end_show();
    return restart((*start)(), otherwise);
  }
  // A playback needs no pad, so the running session continues until the playback is open. The
  // recording says whether its stick steers or points.
  SessionSpec recorded = next;
  recorded.walk.stick = StickMeans::steers;
  auto playback = Show::open(recorded);
  if (!playback) {
    show_message(playback.error().message);
    return false;
  }
  if (show_->is_live()) live_before_ = otherwise;
  end_show();
  install_show(std::move(*playback));
  return true;
}

// Called after end_show(): opens the next show or, if that fails, the previous one. If both fail,
// nothing runs and the last state stays visible.
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
  if (pad_dialog_) return show_message("finish what the pad is used for before opening a file");
  const auto kind = kind_of_file(path);
  if (!kind) return show_message(kind.error().message);
  const int count = static_cast<int>(show_->cast().members.size());
  SessionSpec next = with_file(show_->options(), path, *kind, state_.walker, count);
  if (makes_pictures()) return show_message("no file can be opened while pictures are made");
  if (!switch_to(next)) return;
  browser_.remember(path);
  const char* back = live_before_ && *kind == FileKind::recording ? "; Esc returns to live" : "";
  show_message(fmt::format("opened {}{}", path, back));
}

// Chooses the next terrain of the configuration folders; the first one if the present one is not in
// them.
void WindowLoop::choose_next_terrain() {
  if (pad_dialog_) return;
  if (is_read_only()) return;
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
  if (is_read_only()) return;
  if (makes_pictures()) return show_message("no recording can be started while pictures are made");
  SessionSpec next = show_->options();
  if (!next.live.record.empty()) return end_recording();
  next.live.record = new_file(options_.record_folder, ".hid");
  if (next.live.record.empty()) return show_message("no name is free for a recording");
  // A recording begins with a new session, which keeps the styles of the previous one.
  const auto styles = [this] {
    return opposite_of("style " + show_->cast().styles.front(), show_->frame(), show_->cast());
  };
  const std::vector<std::string> before = styles();
  if (!switch_to(next)) return;
  if (const auto now = styles(); now != before)
    for (const std::string& command : before) show_->command(command);
  show_message("recording to " + next.live.record);
}

// Ends the recording; the session continues.
void WindowLoop::end_recording() {
  const std::string path = show_->options().live.record;
  if (auto problem = show_->end_recording()) return show_message(problem->message);
  show_remarks();
  finished_recording_ = path;
  show_message("the recording " + path + " is complete");
}

void WindowLoop::begin_calibration() {
  if (pad_dialog_) return;
  if (!show_->is_live() || makes_pictures())
    return show_message("sticks can be calibrated in a live session only");
  end_show();
  begin_pad_dialog(start_calibration);
}

void WindowLoop::begin_pad_dialog(PadDialogStart& start) {
  const SessionSpec& spec = show_->options();
  auto dialog = start({spec.pad.selector, spec.pad.map, spec.config_folders,
                       options_.calibration_folder, options_.program});
  pad_dialog_state_ = PadDialog::State::goes_on;
  if (dialog) {
    pad_dialog_ = std::move(*dialog);
  } else {
    show_message(dialog.error().message);
    restart(Show::open(spec), spec);
  }
}

// Opens the next dialog or continues the session.
void WindowLoop::end_pad_dialog(PadDialog::State state) {
  pad_dialog_.reset();  // the dialog frees its pad for the session
  if (state == PadDialog::State::wants_map) return begin_pad_dialog(start_mapping);
  if (state == PadDialog::State::wants_test) return begin_pad_dialog(start_self_test);
  SessionSpec next = show_->options();
  // A calibration given by an option would override the new one.
  if (state == PadDialog::State::calibrated) next.pad.calibration.clear();
  restart(Show::open(next), show_->options());
}

void WindowLoop::take_screenshot(int width_px, int height_px) {
  const std::string path = new_file(options_.record_folder, ".png");
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
