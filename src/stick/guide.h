// The guided calibration: it asks for releases, turns and pushes, watches for them, and keeps the
// tracks. It has no screen and no device: the terminal and the window show it and feed it reports.
// Its result depends on these reports and the times of its ticks alone.
//
// First the watches over one stick or trigger. They count how long a position held, so pads that
// report changes only and pads that stream look the same; and they use means, so noise and single
// wrong reports do not count. Positions are raw.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gaitpad/math.h"
#include "stick/outline.h"
#include "stick/stick_track.h"

namespace gaitpad {

inline constexpr std::int64_t kMillisecondNs = 1'000'000;

// Measures for how long the position has stood still; it may wander slowly, within 0.04.
class StillWatch {
 public:
  void hold(const vec2& raw, std::int64_t duration_ns) noexcept;
  // Time for which the stick has stood still, a multiple of 0.1 s.
  std::int64_t still_ns() const noexcept { return still_ns_; }
  // Mean position over the time in which it stood still.
  const vec2& mean() const noexcept { return mean_; }

 private:
  vec2 sum_{0.0};  // sum of the positions in the running tenth of a second, times nanoseconds
  std::int64_t sum_ns_ = 0;
  vec2 mean_{0.0};
  std::int64_t still_ns_ = 0;
};

// Raw distance from the rest beyond which a control counts as pushed.
inline constexpr double kHalfWay = 0.5;

inline constexpr int kWantedReleases = 6, kWantedSides = 3;
// Wanted number if the stick rests off its middle, where a thumb may hold it.
inline constexpr int kWantedReleasesAside = 10;
// Wanted time of rest at the end, which shows drift.
inline constexpr std::int64_t kWantedRestNs = 2500 * kMillisecondNs;

// Counts releases: the stick was away from its rest, then stood still there for half a second, or
// was near it for one and a half (a stick that wanders at rest).
class ReleaseWatch {
 public:
  void hold(const vec2& raw, std::int64_t duration_ns);
  void restart();        // forgets the releases but not where the stick rests
  void lose() noexcept;  // unplugged: the running release does not count

  int count() const noexcept { return static_cast<int>(rests_.size()); }
  int wanted() const noexcept;     // Number of releases that are wanted.
  bool is_aside() const noexcept;  // True if the stick rests off the raw middle.
  int sides() const noexcept;      // Number of sides (of four) from which it was let go.
  bool is_away() const noexcept { return is_away_; }
  // Time of rest since the last release.
  std::int64_t rested_ns() const noexcept { return near_ns_; }
  // Once true, stays true: the player may go on to the other stick.
  bool is_complete() const noexcept { return is_complete_; }
  // The stick stands still, but too far out to be at rest.
  bool is_held() const noexcept;
  // The median of the rests, else where the stick first stood; none: not seen at rest.
  std::optional<vec2> rest() const noexcept { return rest_; }
  // Raw distance from the rest beyond which the stick counts as pushed out in the other steps: 0.5,
  // or 0.6 of the farthest place that it reached if that is less.
  double rim() const noexcept;

 private:
  bool is_back() const noexcept;
  void add_release();

  StillWatch still_;
  std::vector<vec2> rests_;
  // Sides from which it was let go, by the raw axes: right, front, left, back.
  std::array<bool, 4> sides_{};
  std::optional<vec2> rest_;
  vec2 away_{0.0};            // position from the rest where the stick was last seen away
  double reach_ = 0.0;        // greatest distance from the rest, raw, without spikes
  std::int64_t away_ns_ = 0;  // time for which it has been away without a break
  std::int64_t near_ns_ = 0;  // time since it was away, without spikes
  vec2 near_sum_{0.0};        // sum of its positions over that time, times nanoseconds
  bool is_away_ = false, is_complete_ = false;
};

inline constexpr int kTurnBins = kCircularityBins;
inline constexpr double kWantedTurns = 2.0;

// Counts full circles along the rim.
class TurnWatch {
 public:
  void add_position(const vec2& from_rest, double rim) noexcept;
  void restart() noexcept { *this = TurnWatch(); }
  void lose() noexcept { anchor_rad_.reset(); }

  int filled() const noexcept;
  // Greatest radius in the direction `to` and the bins beside it; 0: none was seen.
  double radius_towards(const vec2& to) const noexcept;
  // Number of turns, in either direction.
  double turns() const noexcept { return travelled_rad_ / (2.0 * kPi); }
  bool is_complete() const noexcept { return filled() == kTurnBins && turns() >= kWantedTurns; }
  // Unit vector to the middle of the longest run of directions that were not seen; none if all
  // were.
  std::optional<vec2> missing() const noexcept;

 private:
  double least_radius() const noexcept;

  double rim_ = 0.0;
  // Greatest radius, raw; bin k is centred on k times 7.5 degrees.
  std::array<double, kTurnBins> radius_{};
  std::optional<double> anchor_rad_;
  double travelled_rad_ = 0.0;
};

// Detects pushes: beyond the rim for a quarter of a second, then back near the rest.
class PushWatch {
 public:
  enum class State : std::uint8_t { waiting, out, held };
  void hold(const vec2& from_rest, double rim, std::int64_t duration_ns) noexcept;
  void restart() noexcept;  // Begins again; a push that is already out does not count.
  void lose() noexcept { *this = PushWatch(); }

  State state() const noexcept;
  bool was_short() const noexcept { return was_short_; }  // the last push was not held long enough
  // The mean position (from rest) while it was out; each push is returned once.
  std::optional<vec2> take_push() noexcept;

 private:
  enum class Zone : std::uint8_t { unknown, in, between, out };
  Zone zone_ = Zone::unknown;
  std::int64_t zone_ns_ = 0, out_ns_ = 0;
  bool is_armed_ = true;  // the control was released since the step began
  bool was_short_ = false;
  vec2 sum_{0.0};
  std::optional<vec2> push_;
};

enum class GuideStep : std::uint8_t {
  rest,     // pushed to several sides and let go, then left alone
  turn,     // full circles along the rim
  forward,  // a push that is held a moment, like the next three
  right,
  back,
  left,
  triggers,
  done,
};
// Name of a step: "rest", "turning", "push forward" ...
const char* name_of(GuideStep step) noexcept;

// One control's progress in the running step.
struct GuideProgress {
  std::string control;  // name of the control: "left stick", "right trigger"
  double done = 0.0;    // share of the step that is done, 0..1
  std::string text;     // `5 of 6 releases`, `41 of 48 directions, 1.5 of 2 turns; not yet: ...`
  vec2 raw{0.0};        // the present position; x for a trigger
};

// Reports that are kept: a quarter of an hour at 2 kHz. A full guide ignores further reports.
inline constexpr std::int64_t kMaxGuideReports = 2'000'000;

class CalibrationGuide {
 public:
  // `layout` must outlive the guide. Without sticks it is done at once.
  explicit CalibrationGuide(const PadLayout& layout);

  // Adds a report. The next step begins when all controls have completed this one; at the end
  // reports are ignored.
  void take_report(const Report& report);
  // Tells the time while no report comes: most pads report changes only and send nothing while a
  // stick is held still.
  void tick(std::int64_t now_ns);
  void unplugged() noexcept;  // keeps what was seen; the step goes on with the next report

  GuideStep step() const noexcept { return steps_[index_]; }
  // The steps for which the pad has controls, then `done`.
  std::span<const GuideStep> steps() const noexcept { return steps_; }
  std::size_t index() const noexcept { return index_; }  // Index of the present step in steps().
  std::string instruction() const;                       // One sentence for the step.
  std::vector<GuideProgress> progress() const;
  bool is_full() const noexcept { return reports_ >= kMaxGuideReports; }

  void skip();    // Goes to the next step and keeps what was seen.
  void repeat();  // Begins the step again.
  void back();    // Begins the step before this one again.

  // The tracks so far (also of skipped steps, raw as the layout has them) and the sticks' frames. A
  // frame is the layout's own if there were no pushes or they contradict each other.
  PadTracks tracks() const;
  StickFrame frame(int side) const;

 private:
  struct Stick {
    int side = 0;  // side of the control: 0 left, 1 right
    ReleaseWatch release;
    TurnWatch turn;
    PushWatch push;
    // Raw positions, from the rest, of the pushes forward, right, back, left.
    std::array<std::optional<vec2>, 4> pushed;
    std::string advice;        // what was wrong with the last push; empty: nothing
    bool turns_again = false;  // asks for another turn: the pushes went farther
  };
  struct Trigger {
    int side = 0;
    PushWatch push;
    StillWatch level;
    std::optional<double> released;  // the lowest level that was seen
    bool is_done = false;
  };
  struct StepTracks {
    GuideStep step = GuideStep::rest;
    bool continues = false;  // follows the step before without a break in the reports
    std::int64_t reports = 0;
    PadTracks tracks;
  };

  void advance(std::int64_t now_ns);
  void hold(Stick& stick, std::int64_t duration_ns);
  void hold(Trigger& trigger, std::int64_t duration_ns);
  void take_push(Stick& stick, const vec2& push);
  vec2 raw(const Stick& stick) const noexcept;
  vec2 from_rest(const Stick& stick) const noexcept;
  bool is_complete() const noexcept;
  void finish_step();
  void turn_again();
  void drop_step() noexcept;
  GuideProgress rest_progress(const Stick& stick) const;
  GuideProgress turn_progress(const Stick& stick) const;
  GuideProgress push_progress(const Stick& stick) const;
  GuideProgress trigger_progress(const Trigger& trigger) const;

  std::vector<GuideStep> steps_;
  std::size_t index_ = 0;
  std::vector<Stick> sticks_;
  std::vector<Trigger> triggers_;

  PadTracker tracker_;  // tracks of the running step
  std::vector<StepTracks> finished_steps_;
  // Reports kept in all steps, and in the running step.
  std::int64_t reports_ = 0, running_reports_ = 0;
  // The running step's tracks will follow the last finished step's without a break.
  bool continues_ = false;
  bool is_cut_ = true;         // the reports were interrupted since the last one
  bool has_position_ = false;  // of the controls: a report has come since the pad was plugged in
  std::int64_t time_ns_ = 0;
};

// The frame in which each push (raw, from rest) goes in the direction that was asked for (unit, +x
// right, +y forward); none if the pushes contradict each other or do not show both axes. A push
// between two axes is ignored.
std::optional<StickFrame> frame_of_pushes(std::span<const vec2> pushes,
                                          std::span<const vec2> asked);

}  // namespace gaitpad
