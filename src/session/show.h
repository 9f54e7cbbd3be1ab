// The common interface of the sessions that a window shows: live ones, and traces on a time line.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/live.h"
#include "gaitpad/result.h"
#include "session/history.h"
#include "session/playback.h"

namespace gaitpad {

inline constexpr int kPictureRateHz = 60;  // frames per second of the session in pictures

// The time line of a playback.
struct Timeline {
  std::int64_t tick = 0, ticks = 0;
  std::span<const PlaybackMark> marks;
  double pace = 1.0;
  bool is_looping = false, is_computing = false;
};

class Show {
 public:
  static Result<std::unique_ptr<Show>> open(const SessionSpec& spec);
  // Opening in two parts, so that a running show ends only if the next one can be opened: prepare()
  // reads the files; the function that it returns opens the show and is called once.
  using Start = std::function<Result<std::unique_ptr<Show>>()>;
  static Result<Start> prepare(const SessionSpec& spec);
  virtual ~Show() = default;
  Show(const Show&) = delete;
  Show& operator=(const Show&) = delete;

  virtual const Cast& cast() const noexcept = 0;
  virtual const SessionFrame& frame() const noexcept = 0;
  const History& history() const noexcept { return history_; }
  const SessionSpec& options() const noexcept { return options_; }
  // Applies to shows that are opened with these options later.
  void add_config_folder(const std::string& folder);
  void set_stick(StickMeans means) noexcept { options_.walk.stick = means; }
  bool is_live() const noexcept { return options_.replay.trace.empty(); }

  // Takes over the new state; call once for each drawn frame. `passed_s`: wall time since the last
  // call, by which a playback advances.
  virtual void update(double passed_s) = 0;
  // Computes 1 / kPictureRateHz seconds of the session at once, for a picture.
  virtual void update_for_picture() = 0;
  // Says that the state of the last update() was displayed, or will not be displayed.
  virtual void end_frame(FrameEnd) {}
  // Fraction for drawing one tick in the past: 0 at WalkerFrame::before, 1 at pose.
  virtual double share(std::int64_t now_ns) const noexcept = 0;

  double pace() const noexcept { return pace_; }  // The pace; 0: paused.
  virtual void set_pace(double pace) = 0;
  virtual void step() = 0;  // Runs one tick while the show is paused.

  // Live sessions only; otherwise without effect.
  virtual void steer(const vec2&) {}
  virtual void command(std::string_view) {}
  virtual void add_style(const Style&) {}
  virtual void rumble() {}
  virtual std::optional<Error> end_recording() { return std::nullopt; }
  // True if the recording that plays as the pad has ended.
  virtual bool has_ended() const noexcept { return false; }
  virtual const LiveStatus* status() { return nullptr; }
  // Playback only.
  virtual const Timeline* timeline() { return nullptr; }
  virtual void seek(std::int64_t) {}
  virtual void set_looping(bool) {}

  virtual std::string pad_name() const = 0;  // Name of the driving pad; empty: there is none.
  virtual std::vector<std::string> take_remarks() = 0;
  virtual Result<RunSummary> stop() = 0;  // Ends the show.

 protected:
  explicit Show(SessionSpec options) : options_(std::move(options)) {}
  SessionSpec options_;
  History history_;
  double pace_ = 1.0;
};

// Shows the present state of another show; nothing runs.
std::unique_ptr<Show> still_show(Show& show);

}  // namespace gaitpad
