#include "tools/gaitpad/calibrate_print.h"

#include <fmt/format.h>

#include <optional>

#include "tools/gaitpad/report_print.h"

namespace gaitpad {
namespace {

constexpr const char* kSideNames[] = {"left", "right"};

std::string position(const std::optional<vec2>& p) {
  return p ? fmt::format("{:+.4f} {:+.4f}", p->x, p->y) : "not known";
}

std::string number(const std::optional<double>& value, const char* unit = "") {
  return value ? fmt::format("{:.4f}{}", *value, unit) : "not known";
}

void print_row(const char* what, const std::string& value, const std::string& from) {
  fmt::print("  {:<14}{:<18}{}\n", what, value, from);
}

void print_rest(const StickStatistics& s) {
  const std::string from = fmt::format("{} reports at rest in {:.1f} s", s.rest_samples, s.rest_s);
  print_row("centre", position(s.centre),
            fmt::format("{}, {} rest{}", from, s.rests.size(), s.rests.size() == 1 ? "" : "s"));
  if (!s.centre) return;
  print_row("noise", s.sigma ? fmt::format("{:.4f} {:.4f}", s.sigma->x, s.sigma->y) : "not known",
            s.is_sigma_hidden
                ? fmt::format("{}; hidden by the steps of {:.4f} {:.4f}", from, s.step_x, s.step_y)
                : from);
  print_row("hysteresis", number(s.hysteresis),
            s.hysteresis ? fmt::format("distance of the farthest of {} rests", s.rests.size())
                         : "needs two rests with a push between them");
  print_row("drift", number(s.drift_per_s, " /s"),
            s.wander > 0.0 ? fmt::format("wanders by {:.4f}", s.wander) : from);
}

void print_rim(const StickStatistics& s) {
  const auto range = [](const std::optional<double>& low, const std::optional<double>& high) {
    return fmt::format("{} .. {}", low ? fmt::format("{:.3f}", *low) : "?",
                       high ? fmt::format("{:.3f}", *high) : "?");
  };
  const std::string from =
      fmt::format("{} reports at the rim, {} of {} directions, {} turns", s.rim_samples,
                  filled_bins(s.outline), kCircularityBins, s.turns);
  print_row("left, right", range(s.min_x, s.max_x), from);
  print_row("back, forward", range(s.min_y, s.max_y), from);
  print_row("circularity",
            s.circularity_error ? fmt::format("{:.1f} %", *s.circularity_error) : "not known",
            s.circularity_error ? "0 is a circle of radius 1 about the raw middle"
                                : "needs whole turns along the rim");
}

void print_reports(const StickStatistics& s) {
  const std::string from = fmt::format("{} reports", s.samples);
  print_row("steps", fmt::format("{:.5f} {:.5f}", s.step_x, s.step_y), from);
  print_row("rate", s.rate_hz ? fmt::format("{:.1f} Hz", *s.rate_hz) : "not known",
            s.jitter_ms ? fmt::format("{}, jitter {:.2f} ms, {}", from, *s.jitter_ms,
                                      s.gaps ? fmt::format("{} gaps", *s.gaps) : "gaps not known")
                        : from);
  print_row("faults", fmt::format("{} jumps", s.jumps), fmt::format("{} times stuck", s.stuck));
}

void print_advice(const StickAdvice& a) {
  const StickCalibration& c = a.calibration;
  print_row("zones", fmt::format("{:.3f} .. {:.3f}", a.inner_zone, a.outer_zone),
            fmt::format("of the deflection {:.3f} .. {:.3f}, sideways {:.3f}", c.inner, c.outer,
                        c.sideways));
  if (!(c.frame == StickFrame{})) {
    constexpr const char* kRaw[] = {"x", "-x", "y", "-y"};
    print_row("axes", fmt::format("right = {}", kRaw[static_cast<int>(c.frame.right)]),
              fmt::format("forward = {}", kRaw[static_cast<int>(c.frame.forward)]));
  }
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
    fmt::print("\n{} stick: {}. {}\n", kSideNames[i], name_of(stick->advice.verdict),
               stick->advice.reason);
    print_rest(stick->statistics);
    print_rim(stick->statistics);
    print_reports(stick->statistics);
    if (stick->statistics.centre) print_advice(stick->advice);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& trigger = analysis.trigger[i];
    if (!trigger) continue;
    fmt::print("\n{} trigger: released {}, pressed {}, {} reports\n", kSideNames[i],
               number(trigger->released), number(trigger->pressed), trigger->samples);
  }
}

nlohmann::ordered_json analysis_json(const DeviceInfo& device, const PadAnalysis& analysis) {
  nlohmann::ordered_json sticks = nlohmann::ordered_json::object();
  nlohmann::ordered_json triggers = nlohmann::ordered_json::object();
  for (std::size_t i = 0; i < 2; ++i) {
    if (analysis.stick[i]) sticks[kSideNames[i]] = stick_json(*analysis.stick[i]);
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
