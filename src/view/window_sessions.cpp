// One session or playback ends, another begins: files that are opened, recordings, calibration.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <utility>

#include "drivers/posix.h"
#include "gaitpad/config_files.h"
#include "view/window_loop.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMostRemarks = 200;
constexpr int kMostOfOneName = 100;

// gaitpad-20240229-235959.hid in the working directory; a name that is taken is never used again.
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

}  // namespace

void WindowLoop::say(std::string sentence) {
  if (sentence.empty()) return;
  if (result_.remarks.size() < kMostRemarks) result_.remarks.push_back(sentence);
  messages_.add(std::move(sentence), clock_.now_ns());
}

void WindowLoop::take_remarks() {
  for (std::string& remark : show_->take_remarks()) say(std::move(remark));
}

void WindowLoop::install(std::unique_ptr<Show> show) {
  show_ = std::move(show);
  ensemble_ = std::make_unique<Ensemble>(show_->cast());
  presses_.begin_anew();
  pace_before_pause_ = 1.0;
  is_camera_new_ = true;
  is_end_told_ = false;
  if (state_.walker >= static_cast<int>(show_->cast().members.size())) state_.walker = -1;
}

void WindowLoop::end_show() {
  const std::string recording = show_->options().live.record;
  const auto summary = show_->stop();
  take_remarks();
  if (!summary) {
    say(summary.error().message);
  } else if (!recording.empty()) {
    say("the recording " + recording + " is complete");
  }
  auto still = still_show(*show_);
  show_.reset();  // its pads are free from here on
  install(std::move(still));
  is_camera_new_ = false;
}

bool WindowLoop::switch_to(const SessionSpec& next) {
  SessionSpec otherwise = show_->options();
  otherwise.live.record.clear();
  if (next.replay.trace.empty()) {
    auto prepared = LiveSession::prepare(next);  // its files are read before what runs is ended
    if (!prepared) {
      say(prepared.error().message);
      return false;
    }
    end_show();
    return restart(open_live_show(*prepared), otherwise);
  }
  auto playback = Show::open(next);  // it needs no pad: what runs goes on until it is there
  if (!playback) {
    say(playback.error().message);
    return false;
  }
  if (show_->is_live()) live_before_ = otherwise;
  end_show();
  install(std::move(*playback));
  return true;
}

// After end_show(): the next one, or what ran before; where neither can be had, nothing runs and
// its last state stays.
bool WindowLoop::restart(Result<std::unique_ptr<Show>> show, const SessionSpec& otherwise) {
  const bool is_begun = static_cast<bool>(show);
  if (!is_begun) {
    say(show.error().message);
    show = Show::open(otherwise);
    if (!show) say(show.error().message);
  }
  if (show) install(std::move(*show));
  return is_begun;
}

void WindowLoop::open_file(const std::string& path) {
  if (calibration_) return say("the calibration is not done: open files afterwards");
  const auto kind = kind_of_file(path);
  if (!kind) return say(kind.error().message);
  const int count = static_cast<int>(show_->cast().members.size());
  SessionSpec next = with_file(show_->options(), path, *kind, state_.walker, count);
  if (makes_pictures()) return say("pictures are made of one session: open files without them");
  if (!switch_to(next)) return;
  browser_.remember(path);
  const char* back = live_before_ && *kind == FileKind::recording ? "; Escape goes back" : "";
  say(fmt::format("opened {}{}", path, back));
}

// The next of those that the configuration folders have; from one of elsewhere to the first.
void WindowLoop::turn_terrains() {
  if (calibration_) return;
  if (!show_->is_live()) return say("a recording is playing: it stays on its ground");
  if (makes_pictures())
    return say("pictures are made of one session: --terrain chooses the ground");
  SessionSpec next = show_->options();
  std::string& terrain = next.walk.terrain;
  const auto files = config_files(next.config_folders, "terrain");
  if (files.empty()) return say("no terrains were found");
  const std::string now = terrain.empty() ? "flat" : config_name(terrain);
  const auto at = std::ranges::find(files, now, config_name);
  const bool is_last = at == files.end() || at + 1 == files.end();
  terrain = is_last ? files.front() : *(at + 1);
  next.live.record.clear();
  if (switch_to(next)) say("on the ground " + config_name(terrain));
}

void WindowLoop::turn_recording() {
  if (!show_->is_live()) return say("a recording is playing: there is nothing to record");
  if (makes_pictures()) return say("pictures are made of one session: record without them");
  SessionSpec next = show_->options();
  const bool is_recorded = !next.live.record.empty();
  next.live.record = is_recorded ? "" : new_file(".hid");
  if (!is_recorded && next.live.record.empty()) return say("no name is free for a recording");
  if (switch_to(next) && !is_recorded) say("recording to " + next.live.record);
}

void WindowLoop::begin_calibration() {
  if (calibration_) return;
  if (!show_->is_live() || makes_pictures())
    return say("a recording is playing: calibrate in a live session");
  const SessionSpec before = show_->options();
  end_show();
  auto view = CalibrationView::start(
      {before.pad.wish, before.pad.map, before.config_folders, options_.calibration_folder});
  calibration_state_ = CalibrationView::State::goes_on;
  if (view) {
    calibration_ = std::move(*view);
  } else {
    say(view.error().message);
    restart(Show::open(show_->options()), show_->options());
  }
}

void WindowLoop::end_calibration(CalibrationView::State state) {
  calibration_.reset();  // the pad is free
  SessionSpec next = show_->options();
  // A file that was asked for would hide the new one.
  if (state == CalibrationView::State::saved) next.pad.calibration.clear();
  restart(Show::open(next), show_->options());
}

void WindowLoop::take_screenshot(int width_px, int height_px) {
  const std::string path = new_file(".png");
  if (path.empty()) return say("no name is free for a picture");
  const auto problem = write_png(path, read_pixels(width_px, height_px));
  say(problem ? problem->message : "written to " + path);
}

}  // namespace gaitpad
