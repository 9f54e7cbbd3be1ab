#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <iterator>
#include <optional>

#include "base/toml_file.h"
#include "stick/calibration.h"

namespace gaitpad {

namespace {

constexpr double kLeastHalfRange = 0.1;  // raw, from the centre to either end
constexpr double kLeastZoneSpan = 0.05;  // from the inner to the outer zone
constexpr std::size_t kMaxDevices = 256;
constexpr std::size_t kMaxFolderFiles = 4096;
constexpr std::string_view kShapeNames[] = {"radial", "axial", "both"};

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

void read_shape(TomlTable& stick, ZoneShape& shape) {
  const auto name = stick.string("shape");
  if (!name) return;
  const auto found = std::find(std::begin(kShapeNames), std::end(kShapeNames), *name);
  if (found == std::end(kShapeNames)) {
    stick.reject("shape",
                 fmt::format("unknown shape {}; one of radial, axial, both", in_quotes(*name)));
    return;
  }
  shape = static_cast<ZoneShape>(found - std::begin(kShapeNames));
}

void read_stick(TomlTable stick, StickCalibration& c) {
  read_axis(stick, "x", c.x);
  read_axis(stick, "y", c.y);
  read_shape(stick, c.shape);
  c.inner = stick.number("inner", 0.0, 0.9).value_or(c.inner);
  c.outer = stick.number("outer", 0.1, 1.0).value_or(c.outer);
  c.sideways = stick.number("sideways", 0.0, 0.5).value_or(c.sideways);
  c.curve = stick.number("curve", 0.0, 1.0).value_or(c.curve);
  if (c.outer - c.inner < kLeastZoneSpan) {
    stick.reject(stick.has("outer") ? "outer" : "inner",
                 fmt::format("the outer zone {} is not {} above the inner zone {}", c.outer,
                             kLeastZoneSpan, c.inner));
  }
}

// "*" or exactly four hex digits.
bool read_id(std::string_view text, int& id) {
  if (text == "*") {
    id = -1;
    return true;
  }
  const auto end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, id, 16);
  return text.size() == 4 && text[0] != '-' && result.ec == std::errc() && result.ptr == end;
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

Result<CalibrationFile> calibration_in(TomlFile& toml) {
  CalibrationFile file;
  TomlTable root = toml.root();
  file.name = root.string("name").value_or("");
  file.unique_id = root.string("unique_id").value_or("");
  file.port = root.string("port").value_or("");
  read_devices(root, file.devices);
  if (auto stick = root.table("left")) read_stick(*stick, file.calibration.left);
  if (auto stick = root.table("right")) read_stick(*stick, file.calibration.right);
  if (auto problem = toml.problem()) return *problem;
  return file;
}

std::string id_text(int id) { return id < 0 ? "*" : fmt::format("{:04x}", id); }

std::string string_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string stick_text(std::string_view name, const StickCalibration& c) {
  const auto axis = [](const AxisCalibration& a) {
    return fmt::format("{{ min = {}, centre = {}, max = {} }}", a.min, a.centre, a.max);
  };
  return fmt::format(
      "\n[{}]\nx = {}\ny = {}\nshape = \"{}\"\ninner = {}\nouter = {}\nsideways = {}\ncurve = {}\n",
      name, axis(c.x), axis(c.y), kShapeNames[static_cast<int>(c.shape)], c.inner, c.outer,
      c.sideways, c.curve);
}

// Names of the folder's *.toml files, sorted, so that the choice does not hang on the file system.
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

Result<Calibration> load_calibration(const std::string& path) {
  auto file = load_calibration_file(path);
  if (!file) return file.error();
  return file->calibration;
}

Result<CalibrationFile> parse_calibration(std::string_view text, const std::string& name,
                                          int first_line) {
  auto toml = TomlFile::parse(text, name, first_line);
  if (!toml) return toml.error();
  return calibration_in(*toml);
}

std::string calibration_text(const CalibrationFile& file) {
  std::string text;
  if (!file.name.empty()) text += fmt::format("name = {}\n", string_text(file.name));
  if (!file.unique_id.empty()) text += fmt::format("unique_id = {}\n", string_text(file.unique_id));
  if (!file.port.empty()) text += fmt::format("port = {}\n", string_text(file.port));
  if (!file.devices.empty()) {
    text += "devices = [";
    for (std::size_t i = 0; i < file.devices.size(); ++i) {
      text += fmt::format("{}\"{}:{}\"", i ? ", " : "", id_text(file.devices[i].vendor),
                          id_text(file.devices[i].product));
    }
    text += "]\n";
  }
  return text + stick_text("left", file.calibration.left) +
         stick_text("right", file.calibration.right);
}

int calibration_fit(const CalibrationFile& file, const DeviceIdentity& device) {
  constexpr int kPortBonus = 3, kUniqueIdFit = 7;
  if (!file.unique_id.empty() && file.unique_id != device.unique_id) return 0;
  if (!file.port.empty() && file.port != device.port) return 0;
  int fit = 0;
  for (const DevicePattern& pattern : file.devices) {
    if (pattern.vendor >= 0 && pattern.vendor != device.vendor) continue;
    if (pattern.product >= 0 && pattern.product != device.product) continue;
    fit = std::max(fit, 1 + (pattern.vendor >= 0) + (pattern.product >= 0));
  }
  if (!file.unique_id.empty() && (fit > 0 || file.devices.empty())) return kUniqueIdFit;
  return fit > 0 && !file.port.empty() ? fit + kPortBonus : fit;
}

Result<CalibrationFile> find_calibration(std::span<const std::string> folders,
                                         const DeviceIdentity& device) {
  CalibrationFile best;
  best.name = "unknown stick";
  int best_fit = 0;
  for (const std::string& folder : folders) {
    auto paths = toml_files(folder);
    if (!paths) return paths.error();
    for (const std::string& path : *paths) {
      auto file = load_calibration_file(path);
      if (!file) return file.error();
      const int fit = calibration_fit(*file, device);
      if (fit <= best_fit) continue;
      best_fit = fit;
      best = std::move(*file);
    }
  }
  return best;
}

}  // namespace gaitpad
