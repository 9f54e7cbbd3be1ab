// What the window shows: a live session, or a trace on a time line, behind one face.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/live.h"
#include "gaitpad/result.h"
#include "session/playback.h"
#include "view/history.h"
#include "view/ui.h"

namespace gaitpad {

inline constexpr int kPictureRateHz = 60;  // frames a second of the session, in pictures and videos

class Show {
 public:
  static Result<std::unique_ptr<Show>> open(const SessionSpec& options);
  // The same in two parts: reads the files; the function that it returns, called once, opens the
  // show.
  using Start = std::function<Result<std::unique_ptr<Show>>()>;
  static Result<Start> prepare(const SessionSpec& spec);
  virtual ~Show() = default;
  Show(const Show&) = delete;
  Show& operator=(const Show&) = delete;

  virtual const Cast& cast() const noexcept = 0;
  virtual const SessionFrame& frame() const noexcept = 0;
  const History& history() const noexcept { return history_; }
  const SessionSpec& options() const noexcept { return options_; }
  // For shows that are opened with these options from now on.
  void add_config_folder(const std::string& folder);
  bool is_live() const noexcept { return options_.replay.trace.empty(); }

  // Takes in what has come, once a drawn frame. `passed_s`: of the wall's time since the last call;
  // a playback goes on by it.
  virtual void look(double passed_s) = 0;
  // The same for pictures: 1 / kPictureRateHz of the session, computed here and now.
  virtual void look_for_picture() = 0;
  // How far between WalkerFrame::before (0) and pose (1) the moment to be drawn is: one tick ago.
  virtual double share(std::int64_t now_ns) const noexcept = 0;

  double pace() const noexcept { return pace_; }  // 0: stands still
  virtual void set_pace(double pace) = 0;
  virtual void step() = 0;  // one tick, while it stands still

  // Live only; nothing happens else.
  virtual void steer(const vec2&) {}
  virtual void command(std::string_view) {}
  virtual bool has_ended() const noexcept { return false; }  // a recording that is the pad
  virtual const LiveStatus* status() { return nullptr; }
  // Playback only.
  virtual const UiTimeline* timeline() { return nullptr; }
  virtual void seek(std::int64_t) {}
  virtual void set_looping(bool) {}

  virtual std::string pad_name() const = 0;  // of the driving pad, empty: none
  virtual std::vector<std::string> take_remarks() = 0;
  // Ends it.
  virtual Result<RunSummary> stop() = 0;

 protected:
  explicit Show(SessionSpec options) : options_(std::move(options)) {}
  SessionSpec options_;
  History history_;
  double pace_ = 1.0;
};

// The two kinds, for open().
Result<std::unique_ptr<Show>> open_live_show(const SessionSpec& options);
Result<std::unique_ptr<Show>> open_live_show(
    const std::shared_ptr<LiveSession::Prepared>& prepared);
Result<std::unique_ptr<Show>> open_playback_show(const SessionSpec& options);
// What another one shows now, while nothing runs.
std::unique_ptr<Show> still_show(Show& show);

}  // namespace gaitpad
