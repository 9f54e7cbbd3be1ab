#include "gaitpad/untouched.h"

#include <algorithm>

namespace gaitpad {

namespace {

constexpr std::int64_t kPart_ns = 125'000'000, kJudged_ns = 250'000'000, kPush_ns = 40'000'000;
// Shares of the inner zone, which is 5.5 sigma or more: noise moves a single report by less than
// kNoise and the mean over an eighth of a second by far less than kMoved.
constexpr double kNoise = 0.4, kMoved = 0.35;
// In a push the stick is this many inner zones from where it began for kPush_ns; a jump is shorter.
constexpr double kPushedOnce = 1.0;

// The inner zone in raw units, by the shortest half range.
double zone_of(const StickCalibration& c) noexcept {
  return c.inner * std::min({c.x.centre - c.x.min, c.x.max - c.x.centre, c.y.centre - c.y.min,
                             c.y.max - c.y.centre});
}

}  // namespace

// Fills the parts since the last report: without reports the last position holds.
void UntouchedWatch::move_on(std::int64_t part) noexcept {
  if (part_ < 0) first_part_ = part_ = part;
  if (part - part_ > kParts) part_ = part - kParts;
  while (part_ < part) {
    Part& next = parts_[static_cast<std::size_t>(++part_ % kParts)];
    next = {raw_, 1.0};
  }
}

bool UntouchedWatch::was_moved(double zone) const noexcept {
  vec2 sum(0.0), least(4.0), most(-4.0);
  double count = 0.0;
  for (const Part& part : parts_) {
    if (part.count == 0.0) continue;
    sum += part.sum;
    count += part.count;
    least = glm::min(least, part.sum / part.count);
    most = glm::max(most, part.sum / part.count);
  }
  return glm::length(most - least) > kMoved * zone ||
         glm::length(raw_ - sum / std::max(count, 1.0)) > kNoise * zone;
}

bool UntouchedWatch::take(std::int64_t time_ns, const StickCalibration& calibration,
                          const vec2& raw, const vec2& position) noexcept {
  move_on(time_ns / kPart_ns);
  const bool is_out = position != vec2(0.0), has_begun = is_out && !is_out_;
  if (has_begun && !is_judging_ && part_ - first_part_ > kParts &&
      !was_moved(zone_of(calibration))) {
    is_judging_ = true;
    began_ns_ = time_ns;
    pushed_ns_ = 0;
    from_ = raw_;
  }
  if (is_judging_ && glm::length(raw - from_) > kPushedOnce * zone_of(calibration))
    pushed_ns_ += std::clamp<std::int64_t>(time_ns - last_ns_, 0, kPush_ns);
  Part& now = parts_[static_cast<std::size_t>(part_ % kParts)];
  now.sum += raw;
  now.count += 1.0;
  raw_ = raw;
  last_ns_ = time_ns;
  is_out_ = is_out;
  if (!is_judging_ || time_ns - began_ns_ < kJudged_ns) return false;
  is_judging_ = false;
  return pushed_ns_ < kPush_ns;
}

std::string untouched_warning(const std::string& pad) {
  return pad + ": a stick began to move untouched; this measures it: gaitpad calibrate";
}

}  // namespace gaitpad
