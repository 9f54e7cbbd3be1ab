#include "stick/pad_analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "gaitpad/limbs.h"
#include "stick/outline.h"

namespace gaitpad {

namespace {

// The limits of a calibration file, with a little room for rounding.
constexpr double kLeastJudgedHalfRange = 0.1001, kGreatestCentre = 0.89;
constexpr double kGreatestInner = 0.89, kLeastSpan = 0.0501, kGreatestOuter = 0.95;

constexpr double kLeastInner = 0.05;  // least inner zone, raw; good sticks return within 5 %
// Assumed hysteresis, raw, of a stick that was released only once.
constexpr double kAssumedHysteresis = 0.05;
// Two-dimensional noise exceeds 5.5 sigma once in four million reports, and less than once in
// 20,000 if the measured sigma is 15 % too small.
constexpr double kSigmasOfRest = 5.5;
// Distance of full output from the rim in sigmas: one report in 300,000 is not full.
constexpr double kSigmasOfRim = 4.5;
// Bounds of the sideways zone: above 0.14 a full push 57 degrees off the side gives less than 0.96.
constexpr double kLeastSideways = 0.11, kGreatestSideways = 0.14;
constexpr double kSigmasOfForward = 4.0;
constexpr double kSpreadOfDisplaced = 1.1;
// In sigmas of the wander, which is measured within one second and grows within a minute.
constexpr double kSigmasOfWander = 5.0;

// Limits beyond which no calibration helps.
// Greatest useful inner zone, raw: beyond it a third of the stick's way does nothing.
constexpr double kUselessZone = 0.3;
constexpr double kUselessReach = 0.5;  // least useful reach, raw, from the centre
// Greatest useful sigma, raw: a tenth of the least useful reach.
constexpr double kUselessSigma = 0.05;
// Fastest useful drift, raw a second: a faster one leaves a zone of 0.1 within a minute.
constexpr double kUselessDrift = 0.002;
// Greatest useful wander, raw in a second: a greater one leaves any zone within a minute.
constexpr double kUselessWander = 0.029;
// Least rest from which a drift is believed if the stick was released only once.
constexpr double kDriftSure_s = 5.0;
// Least report rate: slower reports do not show whether the stick moves by itself.
constexpr double kLeastRate_hz = 22.5;
constexpr int kFewestDirections = 44;  // fewest directions of 48; the unseen ones may be weak
constexpr int kUselessDropOuts = 2;
// Jumps a minute that pass the filter, beyond which a stick is useless.
constexpr double kUselessPassing = 0.2;
constexpr int kUselessStuck = 2;  // a single frozen time may be a lost report
// Beyond these a stick is worn: two or three times what new ones show.
constexpr double kWornHysteresis = 0.06, kWornSigma = 0.01, kWornCentre = 0.12, kWornReach = 0.8;
constexpr double kWornWander = 0.01;
// Least noise of a worn stick, in steps: less comes from the steps.
constexpr double kWornSteps = 1.5;
constexpr int kWornJumps = 3;
// A thumb or a finger that lies on a stick holds it aside, while its range stays symmetric. After
// kSureRests rests this is no accident.
constexpr double kHeldCentre = 0.1, kSymmetric = 0.05;
constexpr std::size_t kSureRests = 14;

struct Side {
  const char* name;
  std::optional<double> reach;  // smallest reach, raw, from the centre
  int direction;                // direction of that reach in the outline
};
std::array<Side, 4> sides_of(const StickStatistics& s) {
  const vec2 centre = s.centre.value_or(vec2(0.0));
  const auto from = [](const std::optional<double>& end, double middle) {
    return end ? std::optional(std::fabs(*end - middle)) : std::nullopt;
  };
  constexpr int kQuarter = kOutlineDirections / 4;
  return {Side{"left", from(s.min_x, centre.x), 2 * kQuarter},
          Side{"right", from(s.max_x, centre.x), 0},
          Side{"back", from(s.min_y, centre.y), 3 * kQuarter},
          Side{"front", from(s.max_y, centre.y), kQuarter}};
}

double reach_in(const Outline& outline, int direction) noexcept {
  return outline.radius[static_cast<std::size_t>(direction)];
}

// Reasons for which a side counts as short: sentences about each side, and the worst of all
// directions, that reaches less far than `least`. If the worst direction is beside a side, its
// number replaces the side's, because the picture shows it.
std::vector<std::string> short_sides(const StickStatistics& s, double least) {
  constexpr int kBeside = kOutlineDirections / 16;
  std::optional<int> worst = worst_direction(s.outline);
  if (worst && reach_in(s.outline, *worst) >= least) worst.reset();
  std::vector<std::string> reasons;
  for (const Side& side : sides_of(s)) {
    if (!side.reach || *side.reach >= least) continue;
    const int off = worst ? std::abs(side.direction - *worst) : kOutlineDirections / 2;
    if (std::min(off, kOutlineDirections - off) <= kBeside) continue;
    reasons.push_back(fmt::format("to the {} it reaches only {:.2f}", side.name, *side.reach));
  }
  if (worst)
    reasons.push_back(fmt::format("to the {} it reaches only {:.2f}", direction_text(*worst),
                                  reach_in(s.outline, *worst)));
  return reasons;
}

// Whether the stick's range was seen to all four sides.
bool is_turned(const StickStatistics& s) noexcept {
  return s.min_x && s.max_x && s.min_y && s.max_y;
}

vec2 middle_of_range(const StickStatistics& s) noexcept {
  return 0.5 * vec2(*s.min_x + *s.max_x, *s.min_y + *s.max_y);
}
// The distance of the stick's rest from the middle of its range; 0 if one of them is not known.
double off_middle(const StickStatistics& s) noexcept {
  return s.centre && is_turned(s) ? glm::length(*s.centre - middle_of_range(s)) : 0.0;
}
// Whether something may have held the stick aside at every rest.
bool may_be_held(const StickStatistics& s) noexcept {
  return off_middle(s) >= kHeldCentre && glm::length(middle_of_range(s)) <= kSymmetric &&
         s.rests.size() < kSureRests;
}

// Number of jumps that the median of three reports removes.
std::int64_t single_jumps(const StickStatistics& s) noexcept {
  return s.jump_count - s.long_jump_count;
}

double share_of_jumps(const StickStatistics& s) noexcept {
  return static_cast<double>(s.jump_count) /
         static_cast<double>(std::max<std::int64_t>(s.samples, 1));
}
// The times a minute at which two jumps come within three reports, which the median of three lets
// through: 2 share^2 of the reports.
double passing_jumps(const StickStatistics& s) noexcept {
  const double share = share_of_jumps(s);
  return 2.0 * share * share * 60.0 * s.rate_hz.value_or(250.0);
}

double greatest_sigma(const StickStatistics& s) noexcept {
  return s.sigma ? std::max(s.sigma->x, s.sigma->y) : 0.0;
}
double step_of(const StickStatistics& s) noexcept { return std::max(s.step_x, s.step_y); }
double hysteresis_of(const StickStatistics& s) noexcept {
  return s.hysteresis.value_or(kAssumedHysteresis);
}

AxisCalibration axis_of(double centre, const std::optional<double>& min,
                        const std::optional<double>& max) noexcept {
  AxisCalibration axis;
  axis.centre = std::clamp(centre, -kGreatestCentre, kGreatestCentre);
  axis.min = std::clamp(min.value_or(-1.0), -1.0, axis.centre - kLeastJudgedHalfRange);
  axis.max = std::clamp(max.value_or(1.0), axis.centre + kLeastJudgedHalfRange, 1.0);
  return axis;
}

double least_half(const AxisCalibration& axis) noexcept {
  return std::min(axis.centre - axis.min, axis.max - axis.centre);
}
double least_half(const StickCalibration& c) noexcept {
  return std::min(least_half(c.x), least_half(c.y));
}

// The smallest deflection, after centre and range, over the directions of the outline that were
// seen; 1 if there are none.
double least_deflection(const Outline& outline, const StickCalibration& c) noexcept {
  double least = 1.0;
  for (int k = 0; k < kOutlineDirections; ++k) {
    if (outline.radius[static_cast<std::size_t>(k)] <= 0.0) continue;
    const vec2 p = point_of(outline, k);
    const auto ranged = [](const AxisCalibration& axis, double raw) {
      const double off = raw - axis.centre;
      return off / (off < 0.0 ? axis.centre - axis.min : axis.max - axis.centre);
    };
    const double x = ranged(c.x, p.x), y = ranged(c.y, p.y);
    least = std::min(least, std::sqrt(x * x + y * y));
  }
  return least;
}

void add_zones(const StickStatistics& s, StickAdvice& advice) noexcept {
  StickCalibration& c = advice.calibration;
  const double half = least_half(c), sigma = greatest_sigma(s);
  advice.inner_zone = std::max(kLeastInner, 3.0 * sigma + hysteresis_of(s));
  // The formula of `inner_zone` covers too little of the noise if the hysteresis is small. It
  // ignores wander, and displaced rests, which may be 10 % farther off on sides that were not seen.
  // A single one may come from a thumb, but a wide zone is better than a character that walks by
  // itself.
  const double away = 0.5 * hysteresis_of(s) + kSpreadOfDisplaced * s.displaced_by;
  const double rest =
      std::max(advice.inner_zone, away + kSigmasOfRest * sigma + kSigmasOfWander * s.wander);
  c.inner = std::min(rest / half, kGreatestInner);
  const double margin = (kSigmasOfRim * sigma + step_of(s)) / half;
  // If noise leaves hardly any rim beyond the inner zone, the verdict says so.
  c.outer =
      std::clamp(least_deflection(s.outline, c) - margin, c.inner + kLeastSpan, kGreatestOuter);
  advice.outer_zone = c.outer * half;
  const double sigma_x = s.sigma ? s.sigma->x : 0.0;
  const double astray = 0.5 * hysteresis_of(s) + kSigmasOfForward * sigma_x;
  c.sideways = std::clamp(astray / (least_half(c.x) * c.outer), kLeastSideways, kGreatestSideways);
  c.filters_jumps = single_jumps(s) > 0;
}

using Reasons = std::vector<std::string>;

std::string displaced_text(const StickStatistics& s) {
  return fmt::format("after {} release{} it stayed {} {:.2f} off its centre", s.displaced,
                     s.displaced == 1 ? "" : "s", s.displaced == 1 ? "about" : "up to",
                     s.displaced_by);
}

std::string stuck_text(const StickStatistics& s) {
  return fmt::format("its value stuck {} while it moved",
                     s.stuck_count == 1 ? "once" : fmt::format("{} times", s.stuck_count));
}

Reasons reasons_to_replace(const StickStatistics& s, const StickAdvice& advice) {
  Reasons reasons;
  const double drift = s.drift_per_s.value_or(0.0);
  // A short rest alone may have been a thumb that lay on the stick.
  const bool is_sure = s.rests.size() > 1 || s.rest_s >= kDriftSure_s;
  if (drift > kUselessDrift && is_sure) {
    reasons.push_back(fmt::format(
        "it drifts by {:.3f} a second while nobody touches it, which no dead zone cures", drift));
  }
  if (s.wander > kUselessWander) {
    reasons.push_back(fmt::format(
        "it wanders by {:.3f} a second while nobody touches it, which no dead zone cures",
        s.wander));
  }
  if (advice.inner_zone > kUselessZone) {
    reasons.push_back(
        fmt::format("it would need a dead zone of {:.0f} %", 100.0 * advice.inner_zone));
  }
  if (greatest_sigma(s) > kUselessSigma) {
    reasons.push_back(fmt::format("its noise is {:.3f}", greatest_sigma(s)));
  }
  for (std::string& reason : short_sides(s, s.unpressed ? 0.0 : kUselessReach))
    reasons.push_back(std::move(reason));
  if (s.displaced > 1 && s.displaced_by > kUselessZone) {
    reasons.push_back(displaced_text(s));
  }
  if (s.drop_out_count >= kUselessDropOuts) {
    reasons.push_back(fmt::format("it lost contact {} times, for {:.0f} ms in all",
                                  s.drop_out_count, 1e3 * s.drop_out_s));
  }
  if (s.long_jump_count >= kWornJumps) {
    reasons.push_back(
        fmt::format("it jumped away for two or three reports {} times, which no filter takes out",
                    s.long_jump_count));
  }
  if (passing_jumps(s) > kUselessPassing) {
    reasons.push_back(
        fmt::format("it jumped {} times, in {:.1f} % of its reports, too often to "
                    "filter: two jumps together pass",
                    s.jump_count, 100.0 * share_of_jumps(s)));
  }
  if (s.stuck_count >= kUselessStuck) {
    reasons.push_back(stuck_text(s));
  }
  return reasons;
}

Reasons missing_data(const StickStatistics& s) {
  if (s.rate_hz && *s.rate_hz < kLeastRate_hz) {
    return {fmt::format(
        "it reports only {:.0f} times a second, which shows neither noise nor faults", *s.rate_hz)};
  }
  if (!s.centre) return {"it was never seen at rest, so its centre is not known"};
  std::string unseen;
  for (const Side& side : sides_of(s)) {
    if (!side.reach) unseen += fmt::format("{}{}", unseen.empty() ? "" : ", ", side.name);
  }
  const int seen = filled_bins(s.outline);
  if (unseen.empty() && seen < kFewestDirections) {
    return {fmt::format("its rim was seen in only {} of {} directions: turn it more slowly", seen,
                        kCircularityBins)};
  }
  if (unseen.empty() && s.unpressed) {
    return {
        fmt::format("it was not pressed to its rim to the {}: turn it once more, and hold a push "
                    "there if it goes no farther",
                    direction_text(*s.unpressed))};
  }
  if (unseen.empty() && may_be_held(s)) {
    return {
        fmt::format("it rested {:.2f} off the middle of its range, as if a thumb lay on it: "
                    "once more, hands off",
                    glm::length(*s.centre))};
  }
  if (unseen.empty()) return {};
  if (seen == 0) return {"it was never turned to the rim"};
  return {fmt::format("its rim was not seen to the {}", unseen)};
}

Reasons signs_of_wear(const StickStatistics& s) {
  Reasons reasons;
  if (s.hysteresis && *s.hysteresis > kWornHysteresis) {
    reasons.push_back(
        fmt::format("let go from different sides it rests up to {:.3f} apart", *s.hysteresis));
  }
  if (s.displaced > 1) reasons.push_back(displaced_text(s));
  const double sigma = greatest_sigma(s);
  if (sigma > std::max(kWornSigma, kWornSteps * step_of(s))) {
    reasons.push_back(fmt::format("its noise at rest is {:.3f}", sigma));
  }
  const double off = glm::length(s.centre.value_or(vec2(0.0)));
  if (off > kWornCentre) {
    reasons.push_back(fmt::format("it rests {:.2f} off the middle of its range", off));
  }
  for (std::string& reason : short_sides(s, kWornReach)) reasons.push_back(std::move(reason));
  if (s.drift_per_s.value_or(0.0) > 0.0) {
    reasons.push_back(
        fmt::format("it drifts by {:.4f} a second at rest, so calibrate it again now and then",
                    *s.drift_per_s));
  }
  if (s.wander > kWornWander) {
    reasons.push_back(
        fmt::format("it wanders by {:.3f} at rest, so its dead zone is wider", s.wander));
  }
  if (single_jumps(s) >= kWornJumps) {
    reasons.push_back(fmt::format(
        "it jumped for a single report {} times, so its reports are filtered", single_jumps(s)));
  }
  return reasons;
}

std::string good_text(const StickStatistics& s) {
  std::string text = fmt::format("its noise is {:.4f}{}", greatest_sigma(s),
                                 s.is_sigma_hidden ? " (hidden by its steps)" : "");
  if (s.hysteresis && *s.hysteresis < 0.0005) {
    text += ", it comes back to one place";
  } else if (s.hysteresis) {
    text += fmt::format(", it comes back within {:.3f}", *s.hysteresis);
  }
  if (const auto worst = worst_direction(s.outline))
    text +=
        fmt::format(" and it reaches {:.2f} or more to every side", reach_in(s.outline, *worst));
  return text;
}

// `opening` and the reasons as one sentence with a capital letter.
std::string sentence(std::string_view opening, const Reasons& reasons) {
  std::string text(opening);
  for (std::size_t i = 0; i < reasons.size(); ++i) {
    text += i == 0 ? "" : i + 1 < reasons.size() ? ", " : " and ";
    text += reasons[i];
  }
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z')
    text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

void judge(const StickStatistics& s, StickAdvice& advice) {
  const Reasons faults = reasons_to_replace(s, advice), missing = missing_data(s),
                wear = signs_of_wear(s);
  const bool is_slow = s.rate_hz && *s.rate_hz < kLeastRate_hz;
  if (s.centre && !is_slow && !faults.empty()) {
    advice.verdict = Verdict::replace;
    advice.reason = sentence("", faults);
  } else if (!missing.empty()) {
    advice.verdict = Verdict::unknown;
    advice.reason = sentence("too little was seen: ", missing);
  } else if (!wear.empty()) {
    advice.verdict = Verdict::worn;
    advice.reason = sentence("", wear) + "; calibration makes up for it";
  } else {
    advice.verdict = Verdict::good;
    advice.reason = sentence("", {good_text(s)});
  }
  const bool is_blamed = advice.verdict == Verdict::replace || advice.verdict == Verdict::worn;
  const bool looks_held =
      s.wander > kWornWander || s.drift_per_s.value_or(0.0) > 0.0 || off_middle(s) >= kHeldCentre;
  if (is_blamed && looks_held) advice.reason += "; or a thumb lay on it: once more, hands off";
  if (s.stuck_count > 0 && s.stuck_count < kUselessStuck) advice.reason += "; " + stuck_text(s);
  if (advice.verdict == Verdict::good && single_jumps(s) > 0)
    advice.reason += "; it jumped for a single report, so its reports are filtered";
  if (s.displaced == 1) {
    advice.reason += "; " + displaced_text(s) +
                     ", which the inner zone covers: measure again if a thumb may have lain on it";
  }
  if (s.centre && !s.hysteresis) {
    advice.reason += fmt::format(
        "; it was not seen let go between two rests, so a spread of {:.2f} is assumed for the "
        "inner zone",
        kAssumedHysteresis);
  }
}

}  // namespace

const char* name_of(Verdict verdict) noexcept {
  switch (verdict) {
    case Verdict::good:
      return "good";
    case Verdict::worn:
      return "worn";
    case Verdict::replace:
      return "replace";
    case Verdict::unknown:
      break;
  }
  return "unknown";
}

StickAdvice stick_advice(const StickStatistics& statistics, const StickFrame& frame) {
  StickAdvice advice;
  StickCalibration& c = advice.calibration;
  c.frame = frame;
  if (statistics.centre) {
    c.x = axis_of(statistics.centre->x, statistics.min_x, statistics.max_x);
    c.y = axis_of(statistics.centre->y, statistics.min_y, statistics.max_y);
    add_zones(statistics, advice);
    advice.has_centre = !may_be_held(statistics);
    advice.has_range = advice.has_centre && is_turned(statistics) && !statistics.unpressed;
  } else {
    advice.inner_zone = c.inner;
    advice.outer_zone = c.outer;
  }
  judge(statistics, advice);
  return advice;
}

// A spring does not return a trigger to the same place each time, and a finger does not always
// press to the end: 2 % of the travel is left out at either end. Less than a quarter of the range
// is no travel.
TriggerCalibration trigger_advice(const TriggerStatistics& statistics) noexcept {
  constexpr double kSlack = 0.02, kLeastTravel = 0.25;
  const TriggerCalibration plain;
  const double low = std::clamp(statistics.released.value_or(plain.released), 0.0, 1.0);
  const double high = std::clamp(statistics.pressed.value_or(plain.pressed), 0.0, 1.0);
  if (!(high - low >= kLeastTravel)) return plain;
  const double slack = kSlack * (high - low);
  return {statistics.released ? low + slack : plain.released,
          statistics.pressed ? high - slack : plain.pressed};
}

namespace {

StickAnalysis stick_analysis(std::vector<StickTrack> tracks, const vec2& step,
                             const StickFrame& frame) {
  StickAnalysis analysis;
  analysis.tracks = in_frame(frame, std::move(tracks));
  analysis.statistics = stick_statistics(analysis.tracks, step);
  return analysis;
}

// Gives both sticks the timing of the one that moved, because they come in the same reports:
// repeated values of a resting stick may look like lost reports.
void share_timing(StickStatistics& a, StickStatistics& b) noexcept {
  const StickStatistics& best = a.rate_hz.value_or(0.0) >= b.rate_hz.value_or(0.0) ? a : b;
  const bool is_silent_at_rest = (a.rate_hz && !a.gap_count) || (b.rate_hz && !b.gap_count);
  const auto rate_hz = best.rate_hz, jitter_ms = best.jitter_ms;
  const auto gaps = is_silent_at_rest ? std::nullopt : best.gap_count;
  for (StickStatistics* s : {&a, &b}) {
    s->rate_hz = rate_hz;
    s->jitter_ms = jitter_ms;
    s->gap_count = gaps;
  }
}

vec2 step_in_frame(const PadLayout& layout, int side, const StickFrame& frame) {
  const PadAxis x = side == 0 ? kLeftX : kRightX, y = side == 0 ? kLeftY : kRightY;
  return glm::abs(in_frame(frame, vec2(declared_step(layout, x), declared_step(layout, y))));
}

// Takes the new centre and inner zone of a stick whose range is not known, and keeps the range of
// the earlier calibration if it surrounds the new centre.
void update_centre(const StickCalibration& advice, StickCalibration& calibration) {
  const auto take = [](double centre, AxisCalibration& axis) {
    constexpr double kLeastHalfRange = 0.25;
    if (centre - axis.min < kLeastHalfRange || axis.max - centre < kLeastHalfRange) axis = {};
    axis.centre = centre;
  };
  const bool is_same_frame = advice.frame == calibration.frame;
  if (!is_same_frame) calibration = StickCalibration{};
  calibration.frame = advice.frame;
  take(advice.x.centre, calibration.x);
  take(advice.y.centre, calibration.y);
  calibration.inner = advice.inner;
  calibration.sideways = advice.sideways;
  calibration.filters_jumps = advice.filters_jumps;
  calibration.outer = std::max(calibration.outer, calibration.inner + 0.05);
}

// Rounded for readers of the file: 0.00001 is a third of a step of 16 bits.
double readable(double value) noexcept { return std::round(value * 1e5) / 1e5 + 0.0; }

void make_readable(StickCalibration& c) noexcept {
  for (AxisCalibration* axis : {&c.x, &c.y})
    for (double* number : {&axis->min, &axis->centre, &axis->max}) *number = readable(*number);
  for (double* number : {&c.inner, &c.outer, &c.sideways}) *number = readable(*number);
}

TriggerCalibration readable(const TriggerCalibration& trigger) noexcept {
  return {readable(trigger.released), readable(trigger.pressed)};
}

std::optional<double> readable(const std::optional<double>& value) noexcept {
  return value ? std::optional(readable(*value)) : std::nullopt;
}

StickMeasured measured(const StickStatistics& s) {
  const auto worse = [](const vec2& v) { return std::max(v.x, v.y); };
  StickMeasured measured;
  if (s.sigma) measured.sigma = readable(worse(*s.sigma));
  measured.hysteresis = readable(s.hysteresis);
  measured.drift_per_s = readable(s.drift_per_s);
  measured.circularity_error = readable(s.circularity_error);
  return measured;
}

void take_stick(const StickAnalysis& stick, StickCalibration& calibration) {
  if (stick.advice.has_range) {
    calibration = stick.advice.calibration;
  } else {
    update_centre(stick.advice.calibration, calibration);
  }
  make_readable(calibration);
}

}  // namespace

PadAnalysis analysis_of(const PadLayout& layout, const PadTracks& tracks,
                        const std::array<StickFrame, 2>& frames) {
  PadAnalysis analysis;
  for (int side = 0; side < 2; ++side) {
    const auto i = static_cast<std::size_t>(side);
    if (has_stick(layout, side)) {
      analysis.stick[i] =
          stick_analysis(tracks.stick[i], step_in_frame(layout, side, frames[i]), frames[i]);
    }
    if (has_trigger(layout, side)) analysis.trigger[i] = trigger_statistics(tracks.trigger[i]);
  }
  auto& [left, right] = analysis.stick;
  if (left && right) share_timing(left->statistics, right->statistics);
  for (std::size_t i = 0; i < 2; ++i) {
    if (auto& stick = analysis.stick[i]) stick->advice = stick_advice(stick->statistics, frames[i]);
  }
  return analysis;
}

bool has_a_centre(const PadAnalysis& analysis) noexcept {
  return std::ranges::any_of(analysis.stick,
                             [](const auto& stick) { return stick && stick->advice.has_centre; });
}

bool is_known(const PadAnalysis& analysis, std::size_t side) noexcept {
  const auto& stick = analysis.stick[side];
  return stick && stick->advice.has_centre && stick->advice.verdict != Verdict::unknown;
}

bool is_useful(const PadAnalysis& analysis) noexcept {
  return is_known(analysis, 0) || is_known(analysis, 1);
}

std::string why_useless(const PadAnalysis& analysis) {
  std::string text = "no stick is known well enough to be calibrated";
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis.stick[i];
    if (!stick || is_known(analysis, i)) continue;
    const Reasons missing = missing_data(stick->statistics);
    text += fmt::format("; {}: {}", kSideNames[i],
                        missing.empty() ? stick->advice.reason : missing.front());
  }
  return text;
}

void take_advice(const PadAnalysis& analysis, CalibrationFile& file) {
  StickCalibration* const sticks[] = {&file.calibration.left, &file.calibration.right};
  TriggerCalibration* const triggers[] = {&file.calibration.left_trigger,
                                          &file.calibration.right_trigger};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis.stick[i];
    if (is_known(analysis, i)) {
      take_stick(*stick, *sticks[i]);
      file.measured[i] = measured(stick->statistics);
    }
    if (analysis.trigger[i] && analysis.trigger[i]->pressed)
      *triggers[i] = readable(trigger_advice(*analysis.trigger[i]));
  }
}

CalibrationFile seen_today(const PadAnalysis& analysis, const CalibrationFile& then) {
  CalibrationFile now;
  now.calibration = then.calibration;
  take_advice(analysis, now);
  StickCalibration* const sticks[] = {&now.calibration.left, &now.calibration.right};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis.stick[i];
    if (!stick || is_known(analysis, i) || !stick->advice.has_centre) continue;
    take_stick(*stick, *sticks[i]);
    now.measured[i] = measured(stick->statistics);
  }
  return now;
}

}  // namespace gaitpad
