#include "gaitpad/pad_configuration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <utility>

#include "gaitpad/config_files.h"
#include "gaitpad/driver_registry.h"
#include "hid/sdl_lines.h"
#include "pads/calibration_store.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace {

constexpr double kLeastFactoryRange = 0.25;  // least distance from the centre to either end, raw

Result<CalibrationFile> calibration_of(const PadFiles& files, const TraceDevice& device,
                                       const std::string& origin) {
  // --calibration is for the user's pad; it would distort the keyboard's stick.
  if (files.calibration && device.info.driver != kKeyboardDriver) return *files.calibration;
  if (!device.calibration.empty())
    return parse_calibration(device.calibration, origin + ": calibration");
  auto found = find_calibration(files.calibration_folders, identity_of(device.info));
  if (!found.problems.empty()) return Error{found.problems.front()};
  return std::move(found.file);
}

// A calibration's mapping replaces the controls that config/pads names; the rest of that entry
// stays. If the entry replaces the descriptor, SDL's numbers do not fit it: the mapping is ignored.
Result<PadLayout> layout_with(const PadFiles& files, DeviceInfo info, const std::string& mapping) {
  const PadOverride* own = find_override(files.overrides, info);
  if (mapping.empty() || (own && !own->replacement.descriptor.empty()))
    return pad_layout(info, files.overrides);
  PadOverrides rest;
  if (own) {
    rest.push_back(*own);
    rest.back().order.reset();
    rest.back().controls = {};
  }
  info.mapping = mapping;
  return pad_layout(info, rest);
}

// Some pads answer with nonsense: a range that no stick has is ignored.
void take_factory_axis(const FactoryAxis& own, AxisCalibration& axis) {
  if (!std::isfinite(own.min) || !std::isfinite(own.centre) || !std::isfinite(own.max)) return;
  const double min = std::max(own.min, -1.0), max = std::min(own.max, 1.0);
  if (own.centre - min < kLeastFactoryRange || max - own.centre < kLeastFactoryRange) return;
  axis = {min, own.centre, max};
}

void take_factory_sticks(const FactorySticks& own, Calibration& calibration) {
  take_factory_axis(own.left_x, calibration.left.x);
  take_factory_axis(own.left_y, calibration.left.y);
  take_factory_axis(own.right_x, calibration.right.x);
  take_factory_axis(own.right_y, calibration.right.y);
}

// True if the file is for the pad's axes as they are, without a mapping or a turned frame: factory
// sticks are numbers for such axes.
bool has_own_axes(const CalibrationFile& file) {
  const Calibration& c = file.calibration;
  return file.mapping.empty() && c.left.frame == StickFrame() && c.right.frame == StickFrame();
}

// The part of a calibration that a recording keeps. The devices that the file was for do not matter
// there.
CalibrationFile recorded_calibration(const CalibrationFile& file) {
  CalibrationFile own;
  if (file.name.size() <= kMaxTraceTextBytes) own.name = file.name;
  own.mapping = file.mapping;
  own.calibration = canonical(file.calibration);
  return own;
}

CalibrationFile calibration_in_force(const PadFiles& files, const DeviceInfo& info,
                                     const std::optional<FactorySticks>& factory,
                                     std::vector<std::string>& remarks) {
  if (files.calibration) return *files.calibration;
  std::vector<std::string> folders = files.calibration_folders;
  if (!files.user_calibrations.empty()) folders.insert(folders.begin(), files.user_calibrations);
  FoundCalibration found = find_calibration(folders, identity_of(info));
  for (const std::string& problem : found.problems)
    remarks.push_back(problem + "; pads go on without this calibration");
  const CalibrationFile& file = found.file;
  const bool is_for_this_one = !file.unique_id.empty() || !file.port.empty();
  if (factory && !is_for_this_one && has_own_axes(file))
    take_factory_sticks(*factory, found.file.calibration);
  return std::move(found.file);
}

// True if the driver names the controls: SDL has already applied its lines and the user's to what
// its driver reads.
bool names_its_controls(const DeviceInfo& info) { return info.driver == "sdl"; }

// The user's line or SDL's, if config/pads has no entry for the pad. Empty also if a recording
// cannot hold the line or if it does not fit the descriptor.
std::string sdl_line_of(const PadFiles& files, const DeviceInfo& info) {
  if (names_its_controls(info)) return info.mapping;
  DeviceInfo mapped = info;
  if (info.mapping.empty() && find_override(files.overrides, info) != nullptr) return {};
  if (std::string own = fitting_mapping(files.mappings, info); !own.empty())
    mapped.mapping = std::move(own);
  else if (info.mapping.empty())
    mapped.mapping = sdl_mapping_of(info);
  if (mapped.mapping.size() > kMaxTraceTextBytes) return {};
  return pad_layout(mapped, files.overrides) ? mapped.mapping : std::string();
}

}  // namespace

DeviceIdentity identity_of(const DeviceInfo& info) {
  return {info.vendor, info.product, info.unique_id, info.physical_path, info.driver};
}

std::string user_mapping_file() {
  const std::string folder = user_config_folder();
  return folder.empty() ? "" : folder + "/gamecontrollerdb.txt";
}

Result<std::size_t> save_mappings(const std::string& path, const std::vector<std::string>& lines) {
  if (path.empty()) return Error{"neither XDG_CONFIG_HOME nor HOME names a folder"};
  const auto lock = FolderLock::wait(path);
  if (!lock) return lock.error();
  std::vector<std::string> own;
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored)) {
    const auto text = file_text(path, kMaxMappingFileBytes);
    if (!text) return text.error();
    own = mapping_lines(*text);
  }
  std::string text = "# Lines of SDL's controller data base, kept by gaitpad\n";
  const std::vector<std::string> all = merged_mappings(lines, own);
  for (const std::string& line : all) text += line + "\n";
  if (auto problem = write_file(path, text)) return *problem;
  return all.size();
}

namespace {

void add_mappings(const std::string& path, PadFiles& files) {
  std::error_code ignored;
  if (path.empty() || !std::filesystem::exists(path, ignored)) return;
  const auto text = file_text(path, kMaxMappingFileBytes);
  if (!text) {
    files.mapping_problem = text.error().message + "; its mappings are not used";
    return;
  }
  std::vector<std::string> lines = mapping_lines(*text);
  std::move(lines.begin(), lines.end(), std::back_inserter(files.mappings));
}

// The files have SDL's names, so that a line works in every program.
void load_mappings(PadFiles& files) {
  if (const char* lines = std::getenv("SDL_GAMECONTROLLERCONFIG"))
    files.mappings = mapping_lines(lines);
  if (const char* path = std::getenv("SDL_GAMECONTROLLERCONFIG_FILE")) add_mappings(path, files);
  add_mappings(user_mapping_file(), files);
}

}  // namespace

Result<PadFiles> load_pad_files(const std::vector<std::string>& config_folders,
                                const std::string& map, const std::string& calibration) {
  // A replay is the same on every machine, so the user's own files do not count.
  std::vector<std::string> folders = config_folders;
  std::erase(folders, user_config_folder());
  PadFiles files;
  if (!map.empty()) {
    auto own = load_pad_file(map);
    if (!own) return own.error();
    files.overrides = std::move(*own);
  }
  for (const std::string& path : config_files(folders, "pads")) {
    auto file = load_pad_file(path);
    if (!file) return file.error();
    std::move(file->begin(), file->end(), std::back_inserter(files.overrides));
  }
  if (!calibration.empty()) {
    auto file = load_calibration_file(calibration);
    if (!file) return file.error();
    files.calibration = std::move(*file);
    files.calibration->calibration = canonical(files.calibration->calibration);
  }
  for (const std::string& folder : folders)
    files.calibration_folders.push_back(folder + "/calibration");
  files.user_calibrations = user_calibration_folder();
  load_mappings(files);
  return files;
}

Result<PadConfig> pad_config(const PadFiles& files, const DeviceInfo& info,
                             const CalibrationFile& calibration, const std::string& origin) {
  if (auto problem = check(calibration)) return Error{origin + ": " + problem->message};
  auto layout = layout_with(files, info, calibration.mapping);
  if (!layout) return Error{origin + ": " + layout.error().message};
  PadConfig pad;
  pad.is_usable = layout->is_pad;
  pad.streams = layout->streams;
  pad.is_fallback = info.driver == kKeyboardDriver;
  pad.layout = std::make_shared<const PadLayout>(std::move(*layout));
  pad.calibration = calibration.calibration;
  return pad;
}

Result<PadConfig> pad_config(const PadFiles& files, const TraceDevice& device,
                             const std::string& origin) {
  const auto calibration = calibration_of(files, device, origin);
  if (!calibration) return calibration.error();
  return pad_config(files, device.info, *calibration, origin);
}

Result<std::vector<PadConfig>> pad_configs(const PadFiles& files,
                                           const std::vector<TraceDevice>& devices,
                                           const std::string& source) {
  std::vector<PadConfig> pads;
  for (const TraceDevice& device : devices) {
    auto pad = pad_config(files, device, fmt::format("{}: device {}", source, device.index));
    if (!pad) return pad.error();
    pads.push_back(std::move(*pad));
  }
  return pads;
}

RecordedDevice recorded_device(const PadFiles& files, const DeviceInfo& info,
                               const std::optional<FactorySticks>& factory,
                               std::vector<std::string>& remarks) {
  RecordedDevice recorded;
  if (!files.mapping_problem.empty()) remarks.push_back(files.mapping_problem);
  recorded.calibration = recorded_calibration(calibration_in_force(files, info, factory, remarks));
  if (names_its_controls(info)) recorded.calibration.mapping.clear();
  const std::string& mapping = recorded.calibration.mapping;
  DeviceInfo& kept = recorded.device.info;
  kept = info;
  kept.mapping = mapping.empty() ? sdl_line_of(files, info) : mapping;
  recorded.device.calibration = calibration_text(recorded.calibration);
  for (std::string* text : {&kept.driver, &kept.name, &kept.unique_id, &kept.physical_path})
    text->resize(std::min(text->size(), kMaxTraceTextBytes));
  return recorded;
}

}  // namespace gaitpad
