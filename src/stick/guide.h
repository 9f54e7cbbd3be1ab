// What the guide watches one stick or trigger for: standing still, releases, turns, pushes. It goes
// by how long a position held, so a pad that reports changes only and one that streams look the
// same, and by means, so noise and single wrong reports do not count. Positions are raw.
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

// For how long the position has stood still. It may wander slowly, within 0.04.
class StillWatch {
 public:
  void hold(const vec2& raw, std::int64_t duration_ns) noexcept;
  std::int64_t still_ns() const noexcept { return still_ns_; }  // in whole tenths of a second
  const vec2& mean() const noexcept { return mean_; }           // while it stood still

 private:
  vec2 sum_{0.0};  // of the running tenth, times nanoseconds
  std::int64_t sum_ns_ = 0;
  vec2 mean_{0.0};
  std::int64_t still_ns_ = 0;
};

inline constexpr double kHalfWay = 0.5;  // from rest; beyond it a control is pushed out

inline constexpr int kWantedReleases = 6, kWantedSides = 3;
inline constexpr std::int64_t kWantedRestNs = 2500 * kMillisecondNs;  // for drift, at the end

// A release: it was away from where it rests, then stood still there for half a second, or was
// there for one and a half (a stick that wanders at rest).
class ReleaseWatch {
 public:
  void hold(const vec2& raw, std::int64_t duration_ns);
  void restart();        // releases are forgotten, where it rests is not
  void lose() noexcept;  // unplugged: the running one does not count

  int count() const noexcept { return static_cast<int>(rests_.size()); }
  int sides() const noexcept;  // quarters that it was let go from
  bool is_away() const noexcept { return is_away_; }
  std::int64_t rested_ns() const noexcept { return near_ns_; }  // since the last release
  // Stays so, whatever the other stick still needs.
  bool is_complete() const noexcept { return is_complete_; }
  // It stands still, but too far out to be at rest.
  bool is_held() const noexcept;
  // The median of the rests, else where it stood when it was first seen; none: not seen at rest.
  std::optional<vec2> rest() const noexcept { return rest_; }
  // What counts as pushed out in the other steps, as a distance from rest: half of the way, less
  // where the stick was never seen to reach far.
  double rim() const noexcept;

 private:
  bool is_back() const noexcept;
  void add_release();

  StillWatch still_;
  std::vector<vec2> rests_;
  std::array<bool, 4> sides_{};  // right, front, left, back, of raw axes
  std::optional<vec2> rest_;
  vec2 away_{0.0};            // from rest, where it was last seen away
  double reach_ = 0.0;        // the farthest of these, spikes left out
  std::int64_t away_ns_ = 0;  // without a break
  std::int64_t near_ns_ = 0;  // since it was away, spikes left out
  vec2 near_sum_{0.0};        // meanwhile, times nanoseconds
  bool is_away_ = false, is_complete_ = false;
};

inline constexpr int kTurnBins = kCircularityBins;
inline constexpr double kWantedTurns = 2.0;

// Full circles along the rim.
class TurnWatch {
 public:
  void take(const vec2& from_rest, double rim) noexcept;
  void restart() noexcept { *this = TurnWatch(); }
  void lose() noexcept { anchor_rad_.reset(); }

  int filled() const noexcept;
  double turns() const noexcept { return travelled_rad_ / (2.0 * kPi); }  // either way
  bool is_complete() const noexcept { return filled() == kTurnBins && turns() >= kWantedTurns; }
  // The middle of the greatest gap, unit length; none without gaps.
  std::optional<vec2> missing() const noexcept;

 private:
  double least_radius() const noexcept;

  double rim_ = 0.0;
  std::array<double, kTurnBins> radius_{};  // greatest; bin k is centred on k times 7.5 degrees
  std::optional<double> anchor_rad_;
  double travelled_rad_ = 0.0;
};

// A push: beyond the rim for a quarter of a second, then back near the rest.
class PushWatch {
 public:
  enum class State : std::uint8_t { waiting, out, held };
  void hold(const vec2& from_rest, double rim, std::int64_t duration_ns) noexcept;
  void restart() noexcept;  // what is out now does not count
  void lose() noexcept { *this = PushWatch(); }

  State state() const noexcept;
  // The mean while it was out, from rest. Once each.
  std::optional<vec2> take_push() noexcept;

 private:
  enum class Zone : std::uint8_t { unknown, in, between, out };
  Zone zone_ = Zone::unknown;
  std::int64_t zone_ns_ = 0, out_ns_ = 0;
  bool is_armed_ = true;  // it has been let go since the step began
  vec2 sum_{0.0};
  std::optional<vec2> push_;
};

// The guided calibration: which step is on, how far it is, what was learned. No screen, no device:
// the terminal and the window show it and feed it. Its result depends on the reports and the times
// that it is told, and on nothing else.

enum class GuideStep : std::uint8_t {
  rest,     // let go, after pushes to different sides, then left alone
  turn,     // full circles along the rim
  forward,  // a push, held a moment, like the next three
  right,
  back,
  left,
  triggers,
  done,
};
const char* name_of(GuideStep step) noexcept;  // "rest", "turning", "push forward" ...

// One control's share of the running step.
struct GuideProgress {
  std::string control;  // "left stick", "right trigger"
  double done = 0.0;    // 0..1
  std::string text;     // `5 of 6 releases`, `41 of 48 directions, 1.5 of 2 turns; not yet: ...`
  vec2 raw{0.0};        // where it is now; a trigger: x
};

// Reports that are kept, a quarter of an hour of a pad with 2 kHz; a guide that is full takes no
// more in.
inline constexpr std::int64_t kMaxGuideReports = 2'000'000;

class CalibrationGuide {
 public:
  // `layout` outlives it. A pad without sticks is done at once.
  explicit CalibrationGuide(const PadLayout& layout);

  // Takes the stick's and trigger's reports in; a step that all its controls have completed gives
  // way to the next. Done, it takes nothing more.
  void take(const Report& report);
  // Silence up to now: most pads report changes only, so what is held sends nothing.
  void tick(std::int64_t now_ns);
  void unplugged() noexcept;  // what was seen is kept, the step goes on when reports come again

  GuideStep step() const noexcept { return steps_[index_]; }
  // Those that the pad has controls for, `done` at the end.
  std::span<const GuideStep> steps() const noexcept { return steps_; }
  std::size_t index() const noexcept { return index_; }  // of step() in them
  std::string instruction() const;                       // one sentence for the step
  std::vector<GuideProgress> progress() const;
  bool is_full() const noexcept { return reports_ >= kMaxGuideReports; }

  void skip();    // on to the next step, what was seen is kept
  void repeat();  // forgets what the step has seen and begins it again
  void back();    // to the step before, which begins again

  // What is known so far: all tracks (of skipped steps too, raw as the layout has them), and how
  // the axes lie. The frame is the layout's own where no pushes were seen or they contradict each
  // other.
  PadTracks tracks() const;
  StickFrame frame(int side) const;

 private:
  struct Stick {
    int side = 0;  // 0 left, 1 right
    ReleaseWatch release;
    TurnWatch turn;
    PushWatch push;
    std::array<std::optional<vec2>, 4> pushed;  // forward, right, back, left: raw, from rest
    std::string advice;                         // what was wrong with the last push, empty: nothing
  };
  struct Trigger {
    int side = 0;
    PushWatch push;
    StillWatch level;
    std::optional<double> released;  // the lowest that it was seen at
    bool is_done = false;
  };
  struct Piece {  // of a step that is over
    GuideStep step = GuideStep::rest;
    bool continues = false;  // the piece before, without unplugging or a dropped one between them
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
  void drop_step() noexcept;
  GuideProgress rest_progress(const Stick& stick) const;
  GuideProgress turn_progress(const Stick& stick) const;
  GuideProgress push_progress(const Stick& stick) const;
  GuideProgress trigger_progress(const Trigger& trigger) const;

  std::vector<GuideStep> steps_;
  std::size_t index_ = 0;
  std::vector<Stick> sticks_;
  std::vector<Trigger> triggers_;

  PadTracker tracker_;  // of the running step
  std::vector<Piece> pieces_;
  std::int64_t reports_ = 0, running_reports_ = 0;  // kept: all, in the running step
  bool continues_ = false;                          // of the running step's piece
  bool is_cut_ = true;                              // since the last report
  bool is_placed_ = false;                          // where the controls are is known
  std::int64_t time_ns_ = 0;
};

// The frame in which each push (raw, from rest) goes where it was asked for (unit vectors, +x
// right, +y forward); none where they contradict each other or do not tell both axes. A push
// between two axes tells nothing.
std::optional<StickFrame> frame_of_pushes(std::span<const vec2> pushes,
                                          std::span<const vec2> asked);

}  // namespace gaitpad
