#include "tools/gaitpad/calibrate_print.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "tools/gaitpad/calibrate_live.h"
#include "tools/gaitpad/report_print.h"

namespace gaitpad {
namespace {

constexpr const char* kUnknown = " not known";

// A label, one value or that of x and of y, and what it is from.
void print_row(const char* what, const std::string& value, const std::string& from) {
  fmt::print("  {:<18}{:<20}{}\n", what, value, from);
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

void print_rest(const StickStatistics& s) {
  const std::string from = fmt::format("{} reports at rest in {:.1f} s", s.rest_samples, s.rest_s);
  print_row("centre", pair_text(s.centre, true),
            fmt::format("{}, {} rest{}", from, s.rests.size(), s.rests.size() == 1 ? "" : "s"));
  if (!s.centre) return;
  print_row("noise (sigma)", pair_text(s.sigma, false),
            s.is_sigma_hidden ? from + ", hidden by the steps" : from);
  print_row("hysteresis", s.hysteresis ? fmt::format("{:>9.4f}", *s.hysteresis) : kUnknown,
            s.hysteresis ? fmt::format("between the farthest two of {} rests", s.rests.size())
                         : "needs two rests with a push between them");
  const std::string trend = s.drift_per_s ? fmt::format("{:>9.4f} a second", *s.drift_per_s) : "";
  print_row("drift", trend.empty() ? kUnknown : *s.drift_per_s > 0.0 ? trend : "     none", from);
  if (s.wander > 0.0)
    print_row("wander", fmt::format("{:>9.4f}", s.wander), "slow excursions at rest, sigma");
}

void print_rim(const StickStatistics& s) {
  const std::string from =
      fmt::format("{} reports at the rim, {} of {} directions, {} whole turn{}", s.rim_samples,
                  filled_bins(s.outline), kCircularityBins, s.turns, s.turns == 1 ? "" : "s");
  print_row("reach right, front", pair_text(s.max_x, s.max_y), from);
  print_row("reach left, back", pair_text(s.min_x, s.min_y), from);
  print_row("circularity error",
            s.circularity_error ? fmt::format("{:>9.1f} %", *s.circularity_error) : kUnknown,
            s.circularity_error ? "0 is a circle of radius 1 about the raw middle"
                                : "needs whole turns along the rim");
}

void print_reports(const StickStatistics& s) {
  const std::string from = fmt::format("{} reports", s.samples);
  const double finest = std::min(s.step_x, s.step_y);
  if (finest > 0.0) {
    print_row("step", fmt::format("{:>9.5f}{:>9.5f}", s.step_x, s.step_y),
              fmt::format("{:.0f} from end to end", 2.0 / finest));
  }
  print_row("rate", s.rate_hz ? fmt::format("{:>9.1f} Hz", *s.rate_hz) : kUnknown,
            s.jitter_ms ? fmt::format("{}, jitter {:.2f} ms", from, *s.jitter_ms) : from);
  const std::string gaps = s.gaps ? fmt::format("{}", *s.gaps) : "not known";
  print_row("gaps, jumps, stuck", fmt::format("{:>9}, {}, {}", gaps, s.jumps, s.stuck), from);
}

void print_advice(const StickAdvice& a) {
  const StickCalibration& c = a.calibration;
  print_row("inner zone", fmt::format("{:>9.3f}", a.inner_zone),
            fmt::format("{:.3f} of the deflection", c.inner));
  print_row("outer zone", fmt::format("{:>9.3f}", a.outer_zone),
            fmt::format("{:.3f} of the deflection, sideways zone {:.3f}", c.outer, c.sideways));
  if (c.frame == StickFrame{}) return;
  constexpr const char* kRaw[] = {"x", "-x", "y", "-y"};
  print_row("axes",
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
          {"outer_zone", is_known ? nlohmann::ordered_json(stick.advice.outer_zone) : nullptr},
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
          {"gaps", value_or_null(s.gaps)},
          {"jumps", s.jumps},
          {"stuck", s.stuck}};
}

}  // namespace

void print_analysis(const DeviceInfo& device, const PadAnalysis& analysis) {
  fmt::print("{} ({:04x}:{:04x})\n", printable(device.name), device.vendor, device.product);
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis.stick[i];
    if (!stick) continue;
    fmt::print("\n{} stick: {}. {}\n  {:<18}{:>9}{:>9}\n", kSideNames[i],
               name_of(stick->advice.verdict), stick->advice.reason, "", "x right", "y front");
    print_rest(stick->statistics);
    print_rim(stick->statistics);
    print_reports(stick->statistics);
    if (stick->statistics.centre) print_advice(stick->advice);
  }
  if (analysis.trigger[0] || analysis.trigger[1]) fmt::print("\n");
  const auto number = [](const std::optional<double>& value) {
    return value ? fmt::format("{:.3f}", *value) : "not known";
  };
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& trigger = analysis.trigger[i];
    if (!trigger) continue;
    fmt::print("{} trigger: released {}, pressed {}, {} reports\n", kSideNames[i],
               number(trigger->released), number(trigger->pressed), trigger->samples);
  }
  fmt::print(
      "\nPositions and lengths are raw: fractions of half the axis' range, from its middle.\n");
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

}  // namespace gaitpad
