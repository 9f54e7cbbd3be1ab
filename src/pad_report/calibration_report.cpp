#include "pad_report/calibration_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/text.h"
#include "gaitpad/limbs.h"

namespace gaitpad {
namespace {

constexpr const char* kUnknown = " not known";

// Adds a row: a label, one value or those of x and y, and their source.
void add_row(std::string& text, const char* label, const std::string& value,
             const std::string& from) {
  text += fmt::format("  {:<18}  {:<20}  {}\n", label, value, from);
}

std::string pair_text(const std::optional<vec2>& p, bool is_signed) {
  if (!p) return kUnknown;
  return is_signed ? fmt::format("{:>+9.4f}{:>+9.4f}", p->x, p->y)
                   : fmt::format("{:>9.4f}{:>9.4f}", p->x, p->y);
}
std::string pair_text(const std::optional<double>& x, const std::optional<double>& y) {
  const auto end = [](const std::optional<double>& v) {
    return v ? fmt::format("{:>+9.4f}", *v) : "        ?";
  };
  return x || y ? end(x) + end(y) : kUnknown;
}

void add_rest(std::string& text, const StickStatistics& s) {
  const std::string from = fmt::format("{} reports at rest in {:.1f} s", s.rest_samples, s.rest_s);
  add_row(text, "centre", pair_text(s.centre, true),
          fmt::format("{}, {} rest{}", from, s.rests.size(), s.rests.size() == 1 ? "" : "s"));
  if (!s.centre) return;
  add_row(text, "noise (sigma)", pair_text(s.sigma, false),
          s.is_sigma_hidden ? from + ", hidden by the steps" : from);
  add_row(text, "hysteresis", s.hysteresis ? fmt::format("{:>9.4f}", *s.hysteresis) : kUnknown,
          s.hysteresis ? fmt::format("between the farthest two of {} rests", s.rests.size())
                       : "needs two rests with a push between them");
  const std::string trend = s.drift_per_s ? fmt::format("{:>9.4f} a second", *s.drift_per_s) : "";
  add_row(text, "drift",
          trend.empty()          ? kUnknown
          : *s.drift_per_s > 0.0 ? trend
                                 : "     none",
          from);
  if (s.wander > 0.0)
    add_row(text, "wander", fmt::format("{:>9.4f} a second", s.wander),
            fmt::format("{:.1f} s without hands on it", seconds_of(s.hands_off)));
  if (s.displaced > 0) {
    add_row(text, "displaced rests", fmt::format("{:>9}", s.displaced),
            fmt::format("up to {:.3f} off the centre", s.displaced_by));
  }
}

double reach_in(const Outline& outline, int direction) {
  return outline.radius[static_cast<std::size_t>(direction)];
}

void add_rim(std::string& text, const StickStatistics& s) {
  const std::string from =
      fmt::format("{} reports at the rim, {} of {} directions, {} whole turn{}", s.rim_samples,
                  filled_bins(s.outline), kCircularityBins, s.turns, s.turns == 1 ? "" : "s");
  add_row(text, "reach right, front", pair_text(s.max_x, s.max_y), from);
  add_row(text, "reach left, back", pair_text(s.min_x, s.min_y), from);
  if (const auto worst = worst_direction(s.outline)) {
    add_row(text, "least reach", fmt::format("{:>9.4f}", reach_in(s.outline, *worst)),
            fmt::format("{} degrees from the right", degrees_of(*worst)));
  }
  add_row(text, "circularity error",
          s.circularity_error ? fmt::format("{:>9.1f} %", *s.circularity_error) : kUnknown,
          s.circularity_error ? "0 is a circle of radius 1 about the raw middle"
                              : "needs whole turns along the rim");
}

void add_reports(std::string& text, const StickStatistics& s) {
  const std::string from = fmt::format("{} reports", s.samples);
  const double finest = std::min(s.step_x, s.step_y);
  if (finest > 0.0) {
    add_row(text, "step", fmt::format("{:>9.5f}{:>9.5f}", s.step_x, s.step_y),
            fmt::format("{:.0f} from end to end", 2.0 / finest));
  }
  add_row(text, "rate", s.rate_hz ? fmt::format("{:>9.1f} Hz", *s.rate_hz) : kUnknown,
          s.jitter_ms ? fmt::format("{}, jitter {:.2f} ms", from, *s.jitter_ms) : from);
  if (s.moving) {
    add_row(text, "new values", fmt::format("{:>9.1f} Hz", s.moving->new_value_hz),
            fmt::format("while it moved, {:.0f} % of {:.0f} reports a second repeat the one before",
                        100.0 * s.moving->repeats(), s.moving->report_hz));
  }
  const std::string gaps = s.gap_count ? fmt::format("{}", *s.gap_count) : "not known";
  add_row(text, "gaps, jumps, stuck",
          fmt::format("{:>9}, {}, {}", gaps, s.jump_count, s.stuck_count), from);
  if (s.drop_out_count > 0) {
    add_row(text, "drop-outs", fmt::format("{:>9}", s.drop_out_count),
            fmt::format("{:.0f} ms in all", 1e3 * s.drop_out_s));
  }
}

void add_advice(std::string& text, const StickAnalysis& stick) {
  const StickAdvice& a = stick.advice;
  const StickCalibration& c = a.calibration;
  add_row(text, "inner zone", fmt::format("{:>9.3f}", a.inner_zone),
          fmt::format("{:.3f} of the deflection", c.inner));
  if (a.has_range) {
    add_row(text, "outer zone", fmt::format("{:>9.3f}", a.outer_zone),
            fmt::format("{:.3f} of the deflection, sideways zone {:.3f}", c.outer, c.sideways));
  } else {
    add_row(text, "outer zone", kUnknown, "");
  }
  if (c.frame == StickFrame{}) return;
  constexpr const char* kRaw[] = {"x", "-x", "y", "-y"};
  add_row(text, "axes",
          fmt::format("right = {}, forward = {}", kRaw[static_cast<int>(c.frame.right)],
                      kRaw[static_cast<int>(c.frame.forward)]),
          "");
}

template <typename T>
nlohmann::ordered_json value_or_null(const std::optional<T>& value) {
  return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

nlohmann::ordered_json stick_json(const StickAnalysis& stick) {
  const StickStatistics& s = stick.statistics;
  const auto part = [](const std::optional<vec2>& v, int i) {
    return v ? nlohmann::ordered_json((*v)[i]) : nlohmann::ordered_json(nullptr);
  };
  const bool is_known = s.centre.has_value();
  const std::optional<int> worst = worst_direction(s.outline);
  return {{"centre_x", part(s.centre, 0)},
          {"centre_y", part(s.centre, 1)},
          {"sigma_x", part(s.sigma, 0)},
          {"sigma_y", part(s.sigma, 1)},
          {"hysteresis", value_or_null(s.hysteresis)},
          {"min_x", value_or_null(s.min_x)},
          {"max_x", value_or_null(s.max_x)},
          {"min_y", value_or_null(s.min_y)},
          {"max_y", value_or_null(s.max_y)},
          {"circularity_error", value_or_null(s.circularity_error)},
          {"drift_per_s", value_or_null(s.drift_per_s)},
          {"rate_hz", value_or_null(s.rate_hz)},
          {"inner_zone", is_known ? nlohmann::ordered_json(stick.advice.inner_zone) : nullptr},
          {"outer_zone", is_known && stick.advice.has_range
                             ? nlohmann::ordered_json(stick.advice.outer_zone)
                             : nullptr},
          {"verdict", name_of(stick.advice.verdict)},
          {"reason", stick.advice.reason},
          {"samples", s.samples},
          {"sigma_hidden_by_steps", s.is_sigma_hidden},
          {"wander", s.wander},
          {"rest_samples", s.rest_samples},
          {"rests", s.rests.size()},
          {"rim_samples", s.rim_samples},
          {"turns", s.turns},
          {"step_x", s.step_x},
          {"step_y", s.step_y},
          {"jitter_ms", value_or_null(s.jitter_ms)},
          {"new_values_hz", s.moving ? nlohmann::ordered_json(s.moving->new_value_hz) : nullptr},
          {"repeats", s.moving ? nlohmann::ordered_json(s.moving->repeats()) : nullptr},
          {"gaps", value_or_null(s.gap_count)},
          {"jumps", s.jump_count},
          {"stuck", s.stuck_count},
          {"drop_outs", s.drop_out_count},
          {"drop_out_s", s.drop_out_s},
          {"displaced_rests", s.displaced},
          {"displaced_by", s.displaced_by},
          {"hands_off_s", seconds_of(s.hands_off)},
          {"least_reach", worst ? nlohmann::ordered_json(reach_in(s.outline, *worst)) : nullptr},
          {"least_reach_deg",
           worst ? nlohmann::ordered_json(360.0 * *worst / kOutlineDirections) : nullptr}};
}

}  // namespace

std::string analysis_text(const DeviceInfo& device, const PadAnalysis& analysis) {
  std::string text =
      fmt::format("{} ({:04x}:{:04x})\n", printable(device.name), device.vendor, device.product);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis.stick[i];
    if (!stick) continue;
    text +=
        fmt::format("\n{} stick: {}. {}\n  {:<18}  {:>9}{:>9}\n", kSideNames[i],
                    name_of(stick->advice.verdict), stick->advice.reason, "", "x right", "y front");
    add_rest(text, stick->statistics);
    add_rim(text, stick->statistics);
    add_reports(text, stick->statistics);
    if (stick->statistics.centre) add_advice(text, *stick);
  }
  if (analysis.trigger[0] || analysis.trigger[1]) text += "\n";
  const auto number = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "not known";
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& trigger = analysis.trigger[i];
    if (!trigger) continue;
    text += fmt::format("{} trigger: released {}, pressed {}, {} reports\n", kSideNames[i],
                        number(trigger->released), number(trigger->pressed), trigger->samples);
  }
  return text +
         "\nPositions and lengths are raw: fractions of half the axis' range, from its middle.\n";
}

nlohmann::ordered_json analysis_json(const DeviceInfo& device, const PadAnalysis& analysis) {
  nlohmann::ordered_json sticks = nlohmann::ordered_json::object();
  nlohmann::ordered_json triggers = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < 2; ++i) {
    sticks[kSideNames[i]] = analysis.stick[i] ? stick_json(*analysis.stick[i]) : nullptr;
    if (!analysis.trigger[i]) continue;
    triggers[kSideNames[i]] = {{"released", value_or_null(analysis.trigger[i]->released)},
                               {"pressed", value_or_null(analysis.trigger[i]->pressed)},
                               {"samples", analysis.trigger[i]->samples}};
  }
  return {{"device",
           {{"name", device.name},
            {"bus", static_cast<int>(device.bus)},
            {"vendor", device.vendor},
            {"product", device.product},
            {"unique_id", device.unique_id},
            {"driver", device.driver}}},
          {"sticks", sticks},
          {"triggers", triggers}};
}

std::string comparison_text(const ComparedFiles& files) {
  std::string text;
  for (std::size_t side = 0; side < 2; ++side) {
    text += fmt::format("{}{} stick\n  {:<24}{:>16}  {:>16}\n", side == 0 ? "" : "\n",
                        kSideNames[side], "", files.names[0], files.names[1]);
    for (const ComparedNumber& number : files.numbers[side]) {
      text += fmt::format("  {:<24}{:>16}  {:>16}{}\n", number.label, number.values[0],
                          number.values[1], number.values[0] == number.values[1] ? "" : "  *");
    }
  }
  return text;
}

}  // namespace gaitpad
