// Measures how often a pad reports a new position. Many pads send each position several times, so
// the rate of reports is not the rate of positions. It is measured while a stick moves, since at
// rest every sound stick repeats itself.
#pragma once
#include <cstdint>
#include <optional>

#include "gaitpad/math.h"

namespace gaitpad {

struct MovementRate {
  double report_hz = 0.0;     // reports a second
  double new_value_hz = 0.0;  // reports with another position than the one before
  // Share of reports that repeat a value, 0..1.
  double repeats() const noexcept { return 1.0 - new_value_hz / report_hz; }
};

class NewValueCount {
 public:
  // Takes the raw positions of both sticks from each report, in the order of time.
  void take(std::int64_t time_ns, const vec2& left, const vec2& right) noexcept;
  // Rates over all movements so far; none: no movement was long enough.
  std::optional<MovementRate> rate() const noexcept;

 private:
  // Positions that follow each other without a pause of more than 50 ms.
  struct Movement {
    std::int64_t time_ns = 0;
    std::int64_t reports = 0, values = 0;
    double travel = 0.0;
  };
  static void add(const Movement& movement, Movement& sum) noexcept;

  bool has_position_ = false;
  vec2 left_{0.0}, right_{0.0};
  std::int64_t changed_ns_ = 0;  // time of the last new position
  std::int64_t reports_ = 0;     // reports since then
  Movement running_, sum_;
};

}  // namespace gaitpad
