// What the window shows: a live session, or a trace on a time line, behind one interface.
#pragma once
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
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

inline constexpr int kPictureRateHz =
    60;  // frames per second of the session, in pictures and videos

struct ShowOptions {
  LiveOptions live;
  std::string trace;  // played back; empty: a live session
  Damage damage = Damage::refuse;
  bool is_rate_given =
      false;  // live.rate_hz was asked for, so a trace with another rate is an error
};

class Show {
 public:
  static Result<std::unique_ptr<Show>> open(const ShowOptions& options);
  // Why these options cannot be opened, as far as the files show; checked before a running show is
  // ended for them.
  static std::optional<Error> problem(const ShowOptions& options);
  virtual ~Show() = default;
  Show(const Show&) = delete;
  Show& operator=(const Show&) = delete;

  virtual const Cast& cast() const noexcept = 0;
  virtual const SessionFrame& frame() const noexcept = 0;
  const History& history() const noexcept { return history_; }
  const ShowOptions& options() const noexcept { return options_; }
  // Used by shows that are opened with these options later.
  void add_config_folder(const std::string& folder);
  bool is_live() const noexcept { return options_.trace.empty(); }

  // Takes over what is new; call it once for each drawn frame. `passed_s`: wall time since the last
  // call, by which a playback advances.
  virtual void update(double passed_s) = 0;
  // The same for pictures: computes 1 / kPictureRateHz seconds of the session now.
  virtual void update_for_picture() = 0;
  // Where the moment to draw, one tick ago, lies between WalkerFrame::before (0) and pose (1).
  virtual double share(std::int64_t now_ns) const noexcept = 0;

  double pace() const noexcept { return pace_; }  // 0: paused
  virtual void set_pace(double pace) = 0;
  virtual void step() = 0;  // one tick, while paused

  // Live only; otherwise without effect.
  virtual void steer(const vec2&) {}
  virtual void command(std::string_view) {}
  virtual bool has_ended() const noexcept { return false; }  // of a recording that plays as the pad
  virtual const LiveStatus* status() { return nullptr; }
  // Playback only.
  virtual const UiTimeline* timeline() { return nullptr; }
  virtual void seek(std::int64_t) {}
  virtual void set_looping(bool) {}

  virtual std::string pad_name() const = 0;  // of the pad that steers; empty: none
  virtual std::vector<std::string> take_remarks() = 0;
  // Ends the show; returns one summary for each character.
  virtual Result<std::vector<nlohmann::ordered_json>> stop() = 0;

 protected:
  explicit Show(ShowOptions options) : options_(std::move(options)) {}
  ShowOptions options_;
  History history_;
  double pace_ = 1.0;
};

// Used by open().
Result<std::unique_ptr<Show>> open_live_show(const ShowOptions& options);
Result<std::unique_ptr<Show>> open_playback_show(const ShowOptions& options);
// Shows the present state of another show while nothing runs.
std::unique_ptr<Show> still_show(Show& show);

}  // namespace gaitpad
