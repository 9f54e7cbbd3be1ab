// The grammar of calibration files, reading and writing, and which file fits a device.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>

#include "base/text.h"
#include "files/toml_file.h"
#include "gaitpad/calibration.h"
#include "gaitpad/limbs.h"
#include "gaitpad/trace.h"
#include "hid/sdl_lines.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMaxDevices = 256;
constexpr std::size_t kMaxFolderFiles = 4096;
constexpr double kMaxMeasured = 100.0;  // limit on any measured number, far beyond what sticks show
constexpr std::string_view kShapeNames[] = {"radial", "axial", "both"};
// Names of the directions, by RawDirection.
constexpr std::string_view kDirectionNames[] = {"x", "-x", "y", "-y"};
constexpr std::string_view kDriverNames[] = {"hidraw", "usb", "evdev", "sdl"};

// The index of the key's value in `names`; none if the key is absent or its value unknown.
template <std::size_t N>
std::optional<int> read_word(TomlTable& table, std::string_view key, std::string_view what,
                             const std::string_view (&names)[N]) {
  const auto word = table.string(key);
  if (!word) return std::nullopt;
  const auto found = std::find(std::begin(names), std::end(names), *word);
  if (found != std::end(names)) return static_cast<int>(found - std::begin(names));
  table.reject(
      key, fmt::format("unknown {} {}; one of {}", what, in_quotes(*word), fmt::join(names, ", ")));
  return std::nullopt;
}

void read_frame(TomlTable& stick, StickFrame& frame) {
  const auto read = [&stick](std::string_view key, RawDirection& direction) {
    if (const auto found = read_word(stick, key, "direction", kDirectionNames))
      direction = static_cast<RawDirection>(*found);
  };
  read("right", frame.right);
  read("forward", frame.forward);
  if (is_along_x(frame.right) != is_along_x(frame.forward)) return;
  stick.reject(stick.has("right") ? "right" : "forward",
               fmt::format("right is {} and forward is {}: one must be an x, the other a y",
                           in_quotes(kDirectionNames[static_cast<int>(frame.right)]),
                           in_quotes(kDirectionNames[static_cast<int>(frame.forward)])));
}

void read_axis(TomlTable& stick, std::string_view key, AxisCalibration& axis) {
  auto table = stick.table(key);
  if (!table) return;
  axis.min = table->number("min", -1.0, 1.0).value_or(axis.min);
  axis.centre = table->number("centre", -1.0, 1.0).value_or(axis.centre);
  axis.max = table->number("max", -1.0, 1.0).value_or(axis.max);
  if (axis.centre - axis.min < kLeastHalfRange || axis.max - axis.centre < kLeastHalfRange) {
    stick.reject(key,
                 fmt::format("{}: min {}, centre {}, max {} are not in this order and {} apart",
                             in_quotes(key), axis.min, axis.centre, axis.max, kLeastHalfRange));
  }
}

StickMeasured read_measured(TomlTable table) {
  const auto number = [&table](std::string_view key) {
    return table.number(key, 0.0, kMaxMeasured);
  };
  return {number("sigma"), number("hysteresis"), number("drift_per_s"),
          number("circularity_error")};
}

void read_stick(TomlTable stick, StickCalibration& c, std::optional<StickMeasured>& measured) {
  read_frame(stick, c.frame);
  read_axis(stick, "x", c.x);
  read_axis(stick, "y", c.y);
  if (const auto shape = read_word(stick, "shape", "shape", kShapeNames))
    c.shape = static_cast<ZoneShape>(*shape);
  c.inner = stick.number("inner", 0.0, 0.9).value_or(c.inner);
  c.outer = stick.number("outer", 0.1, 1.0).value_or(c.outer);
  c.sideways = stick.number("sideways", 0.0, 0.5).value_or(c.sideways);
  c.curve = stick.number("curve", 0.0, 1.0).value_or(c.curve);
  c.filters_jumps = stick.boolean("filters_jumps").value_or(c.filters_jumps);
  if (c.outer - c.inner < kLeastZoneSpan) {
    stick.reject(stick.has("outer") ? "outer" : "inner",
                 fmt::format("the outer zone {} is not {} above the inner zone {}", c.outer,
                             kLeastZoneSpan, c.inner));
  }
  if (auto table = stick.table("measured")) measured = read_measured(*table);
}

void read_trigger(TomlTable& root, std::string_view key, TriggerCalibration& c) {
  auto table = root.table(key);
  if (!table) return;
  c.released = table->number("released", 0.0, 1.0).value_or(c.released);
  c.pressed = table->number("pressed", 0.0, 1.0).value_or(c.pressed);
  if (c.pressed - c.released < kLeastTriggerTravel) {
    table->reject(table->has("pressed") ? "pressed" : "released",
                  fmt::format("pressed {} is not {} above released {}", c.pressed,
                              kLeastTriggerTravel, c.released));
  }
}

// Reads "*" (any; -1) or exactly four hex digits.
bool read_id(std::string_view text, int& id) {
  if (text == "*") {
    id = -1;
    return true;
  }
  id = parse_number<std::uint16_t>(text, 16).value_or(0);
  return text.size() == 4 && parse_number<std::uint16_t>(text, 16);
}

void read_devices(TomlTable& root, std::vector<DevicePattern>& devices) {
  const auto texts = root.strings("devices", kMaxDevices);
  for (const std::string& text : texts.value_or(std::vector<std::string>())) {
    DevicePattern pattern;
    const std::size_t colon = text.find(':');
    const bool is_sound = colon != std::string::npos &&
                          read_id(std::string_view(text).substr(0, colon), pattern.vendor) &&
                          read_id(std::string_view(text).substr(colon + 1), pattern.product) &&
                          (pattern.vendor >= 0 || pattern.product < 0);
    if (!is_sound) {
      root.reject("devices", fmt::format("{} is not a device such as \"054c:09cc\", \"054c:*\" or "
                                         "\"*:*\"",
                                         in_quotes(text)));
      return;
    }
    devices.push_back(pattern);
  }
}

void read_drivers(TomlTable& root, std::vector<std::string>& drivers) {
  for (std::string& name : root.strings("drivers", std::size(kDriverNames)).value_or(drivers)) {
    if (std::find(std::begin(kDriverNames), std::end(kDriverNames), name) ==
        std::end(kDriverNames)) {
      root.reject("drivers", fmt::format("unknown driver {}; one of {}", in_quotes(name),
                                         fmt::join(kDriverNames, ", ")));
      return;
    }
    drivers.push_back(std::move(name));
  }
}

// Checks only the line's grammar: the device's controls are known when the file is used.
void read_mapping(TomlTable& root, std::string& mapping) {
  auto line = root.string("mapping");
  if (!line || line->empty()) return;
  if (!is_one_line(*line)) {
    root.reject("mapping", "\"mapping\" is more than one line");
    return;
  }
  const auto controls = sdl_controls(*line, ReportDescriptor(), "");
  if (!controls) {
    root.reject("mapping", controls.error().message);
    return;
  }
  mapping = std::move(*line);
}

Result<CalibrationFile> calibration_in(TomlFile& toml) {
  CalibrationFile file;
  TomlTable root = toml.root();
  file.name = root.string("name").value_or("");
  file.unique_id = root.string("unique_id").value_or("");
  file.port = root.string("port").value_or("");
  read_devices(root, file.devices);
  read_drivers(root, file.drivers);
  file.measured_on = root.string("measured_on").value_or("");
  read_mapping(root, file.mapping);
  Calibration& c = file.calibration;
  if (auto stick = root.table("left")) read_stick(*stick, c.left, file.measured[0]);
  if (auto stick = root.table("right")) read_stick(*stick, c.right, file.measured[1]);
  read_trigger(root, "left_trigger", c.left_trigger);
  read_trigger(root, "right_trigger", c.right_trigger);
  if (auto gyro = root.table("gyro")) {
    if (const auto bias =
            gyro->numbers("bias_rad_s", 3, 3, -kMostGyroBias_rad_s, kMostGyroBias_rad_s))
      file.gyro_bias_rad_s = {(*bias)[0], (*bias)[1], (*bias)[2]};
  }
  if (auto problem = toml.problem()) return *problem;
  return file;
}

std::string id_text(int id) { return id < 0 ? "*" : fmt::format("{:04x}", id); }

std::string key_text(std::string_view key, const std::string& value) {
  return value.empty() ? "" : fmt::format("{} = {}\n", key, toml_string(value));
}

std::string list_text(std::string_view key, const std::vector<std::string>& values) {
  if (values.empty()) return "";
  std::vector<std::string> quoted;
  for (const std::string& value : values) quoted.push_back(toml_string(value));
  return fmt::format("{} = [{}]\n", key, fmt::join(quoted, ", "));
}

std::string measured_text(std::string_view stick, const StickMeasured& m) {
  std::string text = fmt::format("\n[{}.measured]\n", stick);
  const auto add = [&text](std::string_view key, const std::optional<double>& number) {
    if (number) text += fmt::format("{} = {}\n", key, *number);
  };
  add("sigma", m.sigma);
  add("hysteresis", m.hysteresis);
  add("drift_per_s", m.drift_per_s);
  add("circularity_error", m.circularity_error);
  return text;
}

// Writes all numbers and the shape, even defaults, so that the file keeps its meaning if a default
// changes. Leaves out a frame that turns nothing and a filter that is off.
std::string stick_text(std::string_view name, const StickCalibration& c) {
  const auto axis = [](const AxisCalibration& a) {
    return fmt::format("{{ min = {}, centre = {}, max = {} }}", a.min, a.centre, a.max);
  };
  const auto direction = [](RawDirection d) { return kDirectionNames[static_cast<int>(d)]; };
  std::string frame;
  if (c.frame != StickFrame()) {
    frame = fmt::format("right = \"{}\"\nforward = \"{}\"\n", direction(c.frame.right),
                        direction(c.frame.forward));
  }
  return fmt::format(
      "\n[{}]\n{}x = {}\ny = {}\nshape = \"{}\"\ninner = {}\nouter = {}\nsideways = {}\n"
      "curve = {}\n{}",
      name, frame, axis(c.x), axis(c.y), kShapeNames[static_cast<int>(c.shape)], c.inner, c.outer,
      c.sideways, c.curve, c.filters_jumps ? "filters_jumps = true\n" : "");
}

std::string gyro_text(const std::optional<TurnRates>& bias_rad_s) {
  if (!bias_rad_s) return "";
  return fmt::format("\n[gyro]\nbias_rad_s = [{}]\n", fmt::join(*bias_rad_s, ", "));
}

std::string trigger_text(std::string_view name, const TriggerCalibration& c) {
  if (c == TriggerCalibration()) return "";
  return fmt::format("\n[{}]\nreleased = {}\npressed = {}\n", name, c.released, c.pressed);
}

// Paths of the folder's *.toml files, sorted, so that the choice does not depend on the file
// system.
Result<std::vector<std::string>> toml_files(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code code;
  std::filesystem::directory_iterator entry(folder, code), end;
  if (code == std::errc::no_such_file_or_directory) return paths;
  for (; !code && entry != end; entry.increment(code)) {
    if (entry->path().extension() != ".toml") continue;
    paths.push_back(entry->path().string());
    if (paths.size() > kMaxFolderFiles) {
      return Error{fmt::format("{}: more than {} files", folder, kMaxFolderFiles)};
    }
  }
  if (code) return Error{fmt::format("{}: {}", folder, code.message())};
  std::sort(paths.begin(), paths.end());
  return paths;
}

}  // namespace

Result<CalibrationFile> load_calibration_file(const std::string& path) {
  auto toml = TomlFile::load(path);
  if (!toml) return toml.error();
  return calibration_in(*toml);
}

Result<CalibrationFile> parse_calibration(std::string_view text, const std::string& name,
                                          int first_line) {
  auto toml = TomlFile::parse(text, name, first_line);
  if (!toml) return toml.error();
  return calibration_in(*toml);
}

std::string calibration_text(const CalibrationFile& file) {
  std::vector<std::string> devices;
  for (const DevicePattern& d : file.devices)
    devices.push_back(id_text(d.vendor) + ":" + id_text(d.product));
  std::string text = key_text("name", file.name) + key_text("unique_id", file.unique_id) +
                     key_text("port", file.port) + list_text("devices", devices) +
                     list_text("drivers", file.drivers) +
                     key_text("measured_on", file.measured_on) + key_text("mapping", file.mapping);
  const Calibration& c = file.calibration;
  const StickCalibration* sticks[] = {&c.left, &c.right};
  for (int side = 0; side < 2; ++side) {
    text += stick_text(kSideNames[side], *sticks[side]);
    if (file.measured[side]) text += measured_text(kSideNames[side], *file.measured[side]);
  }
  return text + trigger_text("left_trigger", c.left_trigger) +
         trigger_text("right_trigger", c.right_trigger) + gyro_text(file.gyro_bias_rad_s);
}

int calibration_fit(const CalibrationFile& file, const DeviceIdentity& device) {
  constexpr int kPortBonus = 3, kUniqueIdFit = 7;
  if (!file.unique_id.empty() && file.unique_id != device.unique_id) return 0;
  if (!file.port.empty() && file.port != device.port) return 0;
  const std::string& driver = device.driver.empty() ? "hidraw" : device.driver;
  if (!file.drivers.empty() && std::ranges::count(file.drivers, driver) == 0) return 0;
  int fit = 0;
  for (const DevicePattern& pattern : file.devices) {
    if (pattern.vendor >= 0 && pattern.vendor != device.vendor) continue;
    if (pattern.product >= 0 && pattern.product != device.product) continue;
    fit = std::max(fit, 1 + (pattern.vendor >= 0) + (pattern.product >= 0));
  }
  if (!file.unique_id.empty() && (fit > 0 || file.devices.empty())) {
    fit = kUniqueIdFit;
  } else if (fit > 0 && !file.port.empty()) {
    fit += kPortBonus;
  }
  return fit > 0 ? 2 * fit + (file.drivers.empty() ? 0 : 1) : 0;
}

FoundCalibration find_calibration(std::span<const std::string> folders,
                                  const DeviceIdentity& device) {
  FoundCalibration found;
  found.file.name = "unknown stick";
  int best_fit = 0;
  for (const std::string& folder : folders) {
    auto paths = toml_files(folder);
    if (!paths) {
      found.problems.push_back(paths.error().message);
      continue;
    }
    for (const std::string& path : *paths) {
      auto file = load_calibration_file(path);
      if (!file) {
        found.problems.push_back(file.error().message);
        continue;
      }
      const int fit = calibration_fit(*file, device);
      if (fit <= best_fit) continue;
      best_fit = fit;
      found.file = std::move(*file);
    }
  }
  return found;
}

}  // namespace gaitpad
