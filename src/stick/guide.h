// The guided calibration: which step is on, how far it is, what was learned. No screen, no device:
// the terminal and the window show it and feed it.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stick/stick_track.h"

namespace gaitpad {

enum class GuideStep : std::uint8_t {
  rest,   // let go, after pushes to different sides
  turn,   // full circles along the rim
  forward, right, back, left,  // pushes, held a moment
  triggers,
  done,
};

// One control's share of the running step.
struct GuideProgress {
  std::string control;  // "left stick", "right trigger"
  double done = 0.0;    // 0..1
  std::string text;     // `5 of 8 releases`, `41 of 48 directions`
};

class CalibrationGuide {
 public:
  explicit CalibrationGuide(const PadLayout& layout);

  // Takes the stick's and trigger's reports in; a step that is complete gives way to the next.
  void take(const Report& report);
  void unplugged() noexcept;  // what was seen is kept, the step goes on when reports come again

  GuideStep step() const noexcept { return step_; }
  std::string instruction() const;  // one sentence for the step
  std::vector<GuideProgress> progress() const;
  void skip();    // on to the next step, what was seen is kept
  void repeat();  // forgets what the step has seen and begins it again
  void back();    // to the step before, which begins again

  // What is known so far: all tracks (of skipped steps too), and how the axes lie. The frame is the
  // layout's own where no pushes were seen or they contradict each other.
  PadTracks tracks() const;
  StickFrame frame(int side) const noexcept;

 private:
  // ...
};

// The frame in which each push (raw, from rest) goes where it was asked for (unit vectors, +x right,
// +y forward); none where they contradict each other or do not tell both axes.
std::optional<StickFrame> frame_of_pushes(std::span<const vec2> pushes,
                                          std::span<const vec2> asked);

}  // namespace gaitpad
