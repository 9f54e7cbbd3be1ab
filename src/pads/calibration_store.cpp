#include "pads/calibration_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "gaitpad/config_files.h"
#include "gaitpad/hash.h"
#include "hid/evdev_layout.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxKeyBytes = 48;  // longest part of a file's name between ids and
                                          // ending

// Empty if it cannot identify a pad: cheap pads have serial numbers of zeros or blanks, or one that
// is not UTF-8.
std::string usable_id(const std::string& unique_id) {
  const bool is_blank = unique_id.find_first_not_of("0:-. \t") == std::string::npos;
  return is_blank || !is_utf8(unique_id) ? "" : unique_id;
}

std::string text_hash(std::string_view text) {
  WordHash hash;
  for (const char c : text) hash.add(static_cast<unsigned char>(c));
  hash.add(static_cast<double>(text.size()));
  return fmt::format("{:08x}", static_cast<std::uint32_t>(hash.value()));
}

// The text as a part of a file's name, different for different texts: if characters were replaced,
// or if it looks like one of our own endings, a hash follows.
std::string file_key(std::string_view text) {
  std::string key(text.substr(0, kMaxKeyBytes));
  for (char& c : key) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '.' || c == '_' || c == '-';
    if (!is_plain) c = '-';
  }
  const bool is_ambiguous = text.starts_with("port-") || text.ends_with("-evdev");
  return key == text && !is_ambiguous ? key : key + "-" + text_hash(text);
}

std::string commented(const std::vector<std::string>& comments) {
  std::string text;
  for (const std::string& comment : comments)
    text += comment.empty() ? "#\n" : "# " + printable(comment) + "\n";
  return text;
}

}  // namespace

std::string user_calibration_folder() {
  const std::string folder = user_config_folder();
  return folder.empty() ? "" : folder + "/calibration";
}

CalibrationFile calibration_for(const DeviceInfo& device, bool has_factory_sticks) {
  CalibrationFile file;
  file.name = device.name;
  file.devices = {{device.vendor, device.product}};
  file.unique_id = usable_id(device.unique_id);
  if (file.unique_id.empty() && is_utf8(device.physical_path)) file.port = device.physical_path;
  const bool is_arranged = device.driver == "evdev" || device.driver == "sdl";
  // The kernel's driver has corrected the sticks of such a node (config/README.md).
  if (is_arranged && (device.version & kKernelCodesBit) != 0) {
    file.drivers = {"evdev", "sdl"};
  } else if (!is_arranged && has_factory_sticks) {
    file.drivers = {"hidraw", "usb"};
  }
  return file;
}

std::string calibration_path(const std::string& folder, const CalibrationFile& file) {
  const auto id = [](int number) { return number < 0 ? "any" : fmt::format("{:04x}", number); };
  const DevicePattern device = file.devices.empty() ? DevicePattern() : file.devices.front();
  std::string name = id(device.vendor) + "_" + id(device.product);
  if (!file.unique_id.empty()) {
    name += "-" + file_key(file.unique_id);
  } else if (!file.port.empty()) {
    name += "-port-" + file_key(file.port);
  }
  const bool is_for_evdev = std::ranges::count(file.drivers, "evdev") > 0;
  return folder + "/" + name + (is_for_evdev ? "-evdev" : "") + ".toml";
}

std::optional<Error> save_calibration(const std::string& path, const CalibrationFile& file,
                                      const std::vector<std::string>& comments) {
  const std::string text =
      commented(comments) + (comments.empty() ? "" : "\n") + calibration_text(file);
  // Checks now that the file can be read: otherwise the user would learn only in the next session
  // that the work is lost.
  if (auto again = parse_calibration(text, path); !again)
    return Error{"was not saved, since it could not be read back: " + again.error().message};
  return save_text(path, text);
}

// --- a stick today compared to its file

namespace {

// A change that is larger than its threshold is reported. The thresholds are larger than the
// differences between two measurements of one stick (tests/stick: range within 1 %, sigma within 15
// %, circularity within 0.5 points).

constexpr double kCentreShare = 0.5;   // movement of the centre, as a share of the inner zone
constexpr double kReachChange = 0.03;  // change of the reach, raw
constexpr double kNoiseFactor = 1.5;   // growth of the noise: factor on its sigma ...
// ... and difference of sigma, raw: half a step of 10 bits.
constexpr double kLeastNoiseChange = 0.001;
constexpr double kHysteresisChange = 0.01;  // change of the hysteresis, raw
constexpr double kCircularityChange = 2.0;  // change of the circularity error, percent
// Change of the drift, raw a second; such a drift crosses the least inner zone in 25 s.
constexpr double kDriftChange = 0.002;

// One stick as it was measured then and now.
struct StickPair {
  std::string_view name;
  const StickCalibration &then, &now;
  StickMeasured before, today;
  std::vector<std::string>& told;

  template <typename... Args>
  void tell(fmt::format_string<Args...> sentence, Args&&... args) {
    told.push_back(fmt::format("{} stick: ", name) +
                   fmt::format(sentence, std::forward<Args>(args)...));
  }
};

// The inner zone of a file is a fraction of the centred, ranged deflection; noise is raw.
double inner_zone_raw(const StickCalibration& c) {
  const double reach = std::min(
      {c.x.max - c.x.centre, c.x.centre - c.x.min, c.y.max - c.y.centre, c.y.centre - c.y.min});
  return c.inner * reach;
}

void compare_centre(StickPair& stick) {
  const auto& [name, then, now, before, today, told] = stick;
  const double moved = std::hypot(now.x.centre - then.x.centre, now.y.centre - then.y.centre);
  const double zone = inner_zone_raw(then);
  if (!today.sigma || !(moved > kCentreShare * zone)) return;
  stick.tell(
      "the centre has moved by {:.3f}, from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f}): {} the inner "
      "zone of {:.3f}, {}",
      moved, then.x.centre, then.y.centre, now.x.centre, now.y.centre,
      moved > zone ? "beyond" : "more than half of", zone,
      moved > zone ? "so the pad walks by itself" : "so it may soon walk by itself");
}

void compare_reach(StickPair& stick) {
  const auto& [name, then, now, before, today, told] = stick;
  // There is no value if the stick was not turned along its rim.
  if (!today.circularity_error) return;
  const struct {
    std::string_view direction;
    double before, now, half_range;
  } ends[] = {
      {"to the right", then.x.max, now.x.max, then.x.max - then.x.centre},
      {"to the left", -then.x.min, -now.x.min, then.x.centre - then.x.min},
      {"forward", then.y.max, now.y.max, then.y.max - then.y.centre},
      {"back", -then.y.min, -now.y.min, then.y.centre - then.y.min},
  };
  for (const auto& end : ends) {
    if (!(std::fabs(end.now - end.before) > kReachChange)) continue;
    const bool is_short = end.before - end.now > (1.0 - then.outer) * end.half_range;
    stick.tell("it reaches {:.3f} {}, {:.3f} in the file: {}", end.now, end.direction, end.before,
               end.now > end.before ? "full deflection comes before the rim"
               : is_short           ? "full deflection is not reached there any more"
                                    : "full deflection is still reached, but barely");
  }
}

void compare_rest(StickPair& stick) {
  const auto& [name, then, now, before, today, told] = stick;
  const double zone = inner_zone_raw(then);
  const bool is_covered = 3.0 * today.sigma.value_or(0.0) + today.hysteresis.value_or(0.0) <= zone;
  const std::string verdict = fmt::format("the inner zone of {:.3f} {}", zone,
                                          is_covered ? "covers it" : "is too small for it");
  if (before.sigma && today.sigma) {
    const double more = *today.sigma, less = *before.sigma;
    const bool is_other = more > kNoiseFactor * less || less > kNoiseFactor * more;
    if (is_other && std::fabs(more - less) > kLeastNoiseChange) {
      stick.tell("its noise at rest is {:.4f} (sigma), {:.4f} in the file: {}", more, less,
                 verdict);
    }
  }
  if (before.hysteresis && today.hysteresis &&
      std::fabs(*today.hysteresis - *before.hysteresis) > kHysteresisChange) {
    stick.tell("the places to which it returns lie {:.3f} apart, {:.3f} in the file: {}",
               *today.hysteresis, *before.hysteresis, verdict);
  }
  if (before.drift_per_s && today.drift_per_s &&
      std::fabs(*today.drift_per_s - *before.drift_per_s) > kDriftChange) {
    stick.tell("at rest it drifts by {:.4f} a second, {:.4f} in the file: {}", *today.drift_per_s,
               *before.drift_per_s,
               *today.drift_per_s > *before.drift_per_s ? "no dead zone cures that"
                                                        : "it is steadier now");
  }
}

void compare_roundness(StickPair& stick) {
  const auto& [name, then, now, before, today, told] = stick;
  if (!before.circularity_error || !today.circularity_error) return;
  const double error = *today.circularity_error, old = *before.circularity_error;
  if (!(std::fabs(error - old) > kCircularityChange)) return;
  stick.tell("its circularity error is {:.1f} %, {:.1f} % in the file: {}", error, old,
             error > old ? "the directions differ more in how far it reaches"
                         : "it is closer to a circle now");
}

}  // namespace

std::vector<std::string> changes_since(const CalibrationFile& then, const CalibrationFile& now) {
  std::vector<std::string> told;
  const Calibration &c = then.calibration, &d = now.calibration;
  const StickCalibration* sticks[2][2] = {{&c.left, &d.left}, {&c.right, &d.right}};
  for (std::size_t side = 0; side < 2; ++side) {
    if (!now.measured[side]) continue;
    StickPair stick{side == 0 ? "left" : "right",
                    *sticks[side][0],
                    *sticks[side][1],
                    then.measured[side].value_or(StickMeasured()),
                    *now.measured[side],
                    told};
    if (stick.then.frame != stick.now.frame) {
      stick.tell("its axes differ from the file: was another pad calibrated?");
      continue;
    }
    compare_centre(stick);
    compare_reach(stick);
    compare_rest(stick);
    compare_roundness(stick);
  }
  return told;
}

std::vector<ComparedNumber> compared_numbers(const CalibrationFile& a, const CalibrationFile& b,
                                             std::size_t side) {
  const CalibrationFile* files[] = {&a, &b};
  std::vector<ComparedNumber> numbers;
  const auto add = [&](const char* label, auto value) {
    numbers.push_back({label, {}});
    ComparedNumber& number = numbers.back();
    for (std::size_t i = 0; i < 2; ++i) {
      const Calibration& c = files[i]->calibration;
      const std::optional<double> found =
          value(side == 0 ? c.left : c.right, files[i]->measured[side].value_or(StickMeasured()));
      number.values[i] = found ? fmt::format("{:.4f}", std::round(*found * 1e4) / 1e4 + 0.0) : "-";
    }
  };
  using Stick = const StickCalibration&;
  using Measured = const StickMeasured&;
  using Value = std::optional<double>;
  add("centre x", [](Stick c, Measured) -> Value { return c.x.centre; });
  add("centre y", [](Stick c, Measured) -> Value { return c.y.centre; });
  add("reach left", [](Stick c, Measured) -> Value { return c.x.centre - c.x.min; });
  add("reach right", [](Stick c, Measured) -> Value { return c.x.max - c.x.centre; });
  add("reach back", [](Stick c, Measured) -> Value { return c.y.centre - c.y.min; });
  add("reach forward", [](Stick c, Measured) -> Value { return c.y.max - c.y.centre; });
  add("inner zone", [](Stick c, Measured) -> Value { return inner_zone_raw(c); });
  add("outer zone (share)", [](Stick c, Measured) -> Value { return c.outer; });
  add("sideways zone (share)", [](Stick c, Measured) -> Value { return c.sideways; });
  add("noise (sigma)", [](Stick, Measured m) -> Value { return m.sigma; });
  add("hysteresis", [](Stick, Measured m) -> Value { return m.hysteresis; });
  add("drift a second", [](Stick, Measured m) -> Value { return m.drift_per_s; });
  add("circularity error (%)", [](Stick, Measured m) -> Value { return m.circularity_error; });
  add("jumps filtered (0, 1)", [](Stick c, Measured) -> Value { return c.filters_jumps; });
  return numbers;
}

}  // namespace gaitpad
