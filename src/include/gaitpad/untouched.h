// Notices a calibrated stick that moves untouched: its output begins although the stick hardly
// moved in the second before, and no push follows.
//
//   gaitpad::UntouchedWatch watch;
//   if (watch.take(time_ns, calibration, raw, stick_position(calibration, raw))) ...  // each tick
//
// For the loop: noexcept, no heap.
#pragma once
#include <array>
#include <cstdint>
#include <string>

#include "gaitpad/calibration.h"

namespace gaitpad {

class UntouchedWatch {
 public:
  // Takes the raw position and the calibrated one, in the order of time, at each tick or report.
  // True a quarter of a second after the output has begun untouched.
  bool take(std::int64_t time_ns, const StickCalibration& calibration, const vec2& raw,
            const vec2& position) noexcept;

 private:
  struct Part {  // an interval of an eighth of a second
    vec2 sum{0.0};
    double count = 0.0;
  };
  static constexpr std::int64_t kParts = 8;
  void move_on(std::int64_t part) noexcept;
  bool was_moved(double zone) const noexcept;

  std::array<Part, kParts> parts_{};
  // Numbers of the first and of the present part; -1: none yet.
  std::int64_t first_part_ = -1, part_ = -1;
  // Times of the first and of the last report of the output that is being judged.
  std::int64_t began_ns_ = 0, last_ns_ = 0;
  std::int64_t pushed_ns_ = 0;  // time for which it has been far out
  // The last raw position, and the one before the output that is judged.
  vec2 raw_{0.0}, from_{0.0};
  bool is_out_ = false, is_judging_ = false;
};

// The sentence `PAD: a stick began to move untouched; this measures it: gaitpad calibrate`.
std::string untouched_warning(const std::string& pad);

}  // namespace gaitpad
