// The guided calibration: which step is on, how far it is, what was learned. No screen, no device:
// the terminal and the window show it and feed it. Its result depends on the reports and the times
// that it is told, and on nothing else.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stick/guide_watch.h"
#include "stick/stick_track.h"

namespace gaitpad {

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
