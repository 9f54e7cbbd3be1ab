// One frame of the window: the scene, what lies flat above it, and what is kept of it.
#include <SDL2/SDL.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "drivers/posix.h"
#include "view/drawing.h"
#include "view/window_loop.h"

namespace gaitpad {
namespace {

constexpr double kAside_rad = 1.1, kAbove_rad = 0.3;

// Of the whole program, in memory; 0: not known.
double memory_mib() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0.0;
  long all = 0, resident = 0;
  const bool is_read = std::fscanf(file, "%ld %ld", &all, &resident) == 2;
  std::fclose(file);
  if (!is_read) return 0.0;
  return static_cast<double>(resident) * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1048576.0;
}

}  // namespace

void WindowLoop::draw(bool is_last) {
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
  ensemble_->fill(show_->frame(), show_->history(), show_->share(now_ns()), show_->cast(), state_,
                  theme, content_);
  if (std::exchange(is_camera_new_, false)) see_anew();
  const double passed_s = makes_pictures() ? 1.0 / kPictureRateHz : clock_.passed_s();
  follow(camera_, ensemble_->focus_m(state_.walker), passed_s);
  ensemble_->stand_on_ground(camera_);
  const bool is_kept = !makes_still() || is_last || wants_screenshot_;
  if (is_kept && viewport.width > 0 && viewport.height > 0)
    scene_->draw(content_, camera_, theme, viewport, height_px, surface_->scale());
  obey(draw_panels(width_px, height_px));
  keep_pictures(width_px, height_px, is_last);
  surface_->show();
}

void WindowLoop::see_anew() {
  int width_px = 0, height_px = 0;
  surface_->size(width_px, height_px);
  const Viewport viewport =
      scene_viewport(state_, show_->timeline() != nullptr, width_px, height_px, surface_->scale());
  camera_ = Camera();
  if (ensemble_->is_on_uneven_ground()) {  // from the side: steps ahead hide no feet
    camera_.yaw_rad = kAside_rad;
    camera_.pitch_rad = kAbove_rad;
  }
  camera_.target_m = camera_.followed_m = ensemble_->focus_m(state_.walker);
  camera_.distance_m = ensemble_->distance_m(state_.walker, camera_, viewport);
}

// In pictures without what tells of the machine's speed.
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
  for (std::string& message : messages) say(std::move(message));
}

void WindowLoop::keep_pictures(int width_px, int height_px, bool is_last) {
  const bool keeps_still = is_last && !options_.screenshot.empty();
  if (std::exchange(wants_screenshot_, false)) take_screenshot(width_px, height_px);
  if (options_.video.empty() && !keeps_still) return;
  if (!options_.video.empty() && !video_) {
    // H.264 counts in pairs of pixels.
    auto video = VideoWriter::open(options_.video, width_px, height_px, kPictureRateHz);
    if (!video) failure_ = video.error();
    if (video) video_ = std::move(*video);
  }
  if (failure_) return;
  const Pixels pixels = read_pixels(width_px, height_px);
  if (video_) failure_ = video_->add(pixels);
  if (keeps_still && !failure_) failure_ = write_png(options_.screenshot, pixels);
}

}  // namespace gaitpad
