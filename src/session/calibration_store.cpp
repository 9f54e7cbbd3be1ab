#include "session/calibration_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "base/hash.h"
#include "base/toml_scan.h"
#include "session/user_files.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxKeyBytes = 48;           // of a file's name, between ids and ending
constexpr std::uint16_t kKernelArranged = 0x8000;  // of the version on evdev: config/README.md

// Cheap pads have a serial number of zeros or blanks, or one that no text can hold.
std::string usable_id(const std::string& unique_id) {
  const bool is_blank = unique_id.find_first_not_of("0:-. \t") == std::string::npos;
  return is_blank || line_of_invalid_utf8(unique_id) != 0 ? "" : unique_id;
}

std::string text_hash(std::string_view text) {
  WordHash hash;
  for (const char c : text) hash.add(static_cast<unsigned char>(c));
  hash.add(static_cast<double>(text.size()));
  return fmt::format("{:08x}", static_cast<std::uint32_t>(hash.value()));
}

// Fit for a file's name, and never the same for two texts: what was changed, or could be taken for
// one of our own endings, is followed by a hash.
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
  for (const std::string& comment : comments) {
    std::string line = comment;
    const bool is_utf8 = line_of_invalid_utf8(line) == 0;
    for (char& c : line) {
      const auto byte = static_cast<unsigned char>(c);
      if (byte < 0x20 || byte == 0x7f || (byte >= 0x80 && !is_utf8)) c = '?';
    }
    text += line.empty() ? "#\n" : "# " + line + "\n";
  }
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
  if (file.unique_id.empty() && line_of_invalid_utf8(device.physical_path) == 0)
    file.port = device.physical_path;
  const bool is_arranged = device.driver == "evdev" || device.driver == "sdl";
  if (is_arranged && (device.version & kKernelArranged) != 0) {
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
  // A file that could not be read back would be lost work, and told only at the next game.
  if (auto again = parse_calibration(text, path); !again)
    return Error{"was not saved, since it could not be read back: " + again.error().message};
  return save_text(path, text);
}

}  // namespace gaitpad
