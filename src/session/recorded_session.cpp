#include "session/recorded_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "base/text.h"
#include "gaitpad/config_files.h"
#include "gaitpad/motion_file.h"
#include "session/script.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr const char* kStylesFolder = "styles";
constexpr std::string_view kStyles = "styles/";

std::string held_name(const std::string& path, const std::vector<std::string>& folders) {
  std::string name = name_in_folders(path, folders);
  if (name.empty()) name = fs::absolute(path).lexically_normal().relative_path().string();
  return name;
}

// Path of the file with an entry for the device; empty if no file has one.
std::string pad_file_of(const PadOverrides& overrides, const DeviceInfo& info) {
  const PadOverride* own = find_override(overrides, info);
  return own == nullptr ? "" : own->origin.substr(0, own->origin.rfind(':'));
}

bool is_saved_later(const TraceFile& file) {
  return file.tick >= 0 && file.name.starts_with(kStyles);
}

}  // namespace

RecordedSession recorded_session(const SessionSpec& spec, Pace pace,
                                 const std::vector<InputFile>& walk_files,
                                 const std::vector<InputFile>& pad_files,
                                 const PadOverrides& overrides) {
  const std::vector<std::string>& folders = spec.config_folders;
  RecordedSession session;
  session.pace = pace;
  const auto add = [&](std::string_view key, const Result<std::string>& path) {
    if (path) session.options.push_back(fmt::format("{} {}", key, held_name(*path, folders)));
  };
  const SessionSpec::Walk& walk = spec.walk;
  if (!is_built_in(spec)) add("motion", motion_path(folders, walk.motion));
  for (const std::string& name : walk.characters)
    add("character", config_file(folders, "characters", name));
  for (const std::string& name : walk.styles) add("style", config_file(folders, "styles", name));
  if (!walk.terrain.empty()) add("terrain", config_file(folders, "terrain", walk.terrain));
  if (walk.ik == IkMode::paper) session.options.emplace_back("ik paper");
  if (walk.crowd.value_or(0) > 0) session.options.push_back(fmt::format("crowd {}", *walk.crowd));
  if (!spec.pad.map.empty()) add("map", spec.pad.map);

  const auto held = [&folders](const InputFile& file) {
    return TraceFile{held_name(file.path, folders), file.bytes};
  };
  for (const InputFile& file : walk_files) session.files.push_back(held(file));
  std::vector<std::pair<std::string, TraceFile>> of_pads;
  for (const InputFile& file : pad_files) {
    if (file.path == spec.pad.map) {
      session.files.push_back(held(file));
    } else {
      of_pads.emplace_back(file.path, held(file));
    }
  }
  session.pad_file = [of_pads, overrides](const DeviceInfo& info) -> const TraceFile* {
    const auto found = std::ranges::find(of_pads, pad_file_of(overrides, info),
                                         &std::pair<std::string, TraceFile>::first);
    return found == of_pads.end() ? nullptr : &found->second;
  };
  return session;
}

Result<SessionSpec> with_recorded(const SessionSpec& spec, const Trace& trace) {
  SessionSpec full = spec;
  if (trace.files.empty()) return full;
  full.recording = trace.path;
  for (const std::string& option : trace.options) {
    std::string_view value = option;
    const std::string_view key = take_word(value);
    value = trimmed(value, " ");
    // A name cannot lead out of the recording.
    const fs::path inside = (fs::path("/") / value).lexically_normal().relative_path();
    const std::string path = fmt::format("{}/{}", trace.path, inside.string());
    if (key == "motion" && spec.walk.motion.empty()) full.walk.motion = path;
    if (key == "character" && spec.walk.characters.empty()) full.walk.characters.push_back(path);
    if (key == "style" && spec.walk.styles.empty()) full.walk.styles.push_back(path);
    if (key == "terrain" && spec.walk.terrain.empty()) full.walk.terrain = path;
    if (key == "ik" && value == "paper" && !spec.walk.ik) full.walk.ik = IkMode::paper;
    if (key == "crowd" && !spec.walk.crowd) {
      full.walk.crowd = parse_number<int>(value).value_or(-1);
      if (*full.walk.crowd < 0 || *full.walk.crowd > kMaxFollowers)
        return Error{fmt::format("{}: {} is no crowd of 0 to {}", trace.path, in_quotes(value),
                                 kMaxFollowers)};
    }
    if (key == "map" && spec.pad.map.empty()) full.pad.map = path;
  }
  return full;
}

std::vector<InputFile> held_files(const Trace& trace) {
  std::vector<InputFile> files;
  for (const TraceFile& file : trace.files) {
    if (!is_saved_later(file)) files.push_back({file.name, file.bytes});
  }
  return files;
}

std::string name_in_folders(const std::string& path, const std::vector<std::string>& folders) {
  const fs::path place = fs::absolute(path).lexically_normal();
  for (const std::string& folder : folders) {
    const fs::path rest = place.lexically_relative(fs::absolute(folder).lexically_normal());
    if (rest.empty() || *rest.begin() == "..") continue;
    std::error_code ignored;
    const auto first = std::ranges::find_if(folders, [&](const std::string& other) {
      return fs::exists(fs::path(other) / rest, ignored);
    });
    if (first != folders.end() && *first == folder) return rest.string();
  }
  return {};
}

std::uint64_t bytes_hash(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  return hash;
}

namespace {

// Names of the styles that characters walk in, zones have, or the recording's commands choose.
std::set<std::string, std::less<>> named_styles(const Trace& trace,
                                                const SimulationConfig& config) {
  std::set<std::string, std::less<>> styles;
  for (const WalkerConfig& walker : config.walkers)
    styles.insert(config.styles[static_cast<std::size_t>(walker.style)].name);
  for (const TerrainZone& zone : config.terrain->zones) styles.insert(zone.style);
  for (const TraceEvent& event : trace.events) {
    if (event.kind != ReportKind::command) continue;
    const char* text = reinterpret_cast<const char*>(trace.bytes.data()) + event.first_byte;
    const auto command = parsed_command({text, event.size});
    if (command && command->verb == Command::Verb::style) styles.emplace(command->name);
  }
  return styles;
}

}  // namespace

std::vector<UsedFile> used_files(const std::vector<const InputFile*>& read, const Trace& trace,
                                 const SimulationConfig& config, const PadOverrides& overrides) {
  const auto styles = named_styles(trace, config);
  std::set<std::string, std::less<>> pads;
  for (const TraceDevice& device : trace.devices) pads.insert(pad_file_of(overrides, device.info));
  std::vector<UsedFile> used;
  for (const InputFile* file : read) {
    const fs::path folder = fs::path(file->path).parent_path().filename();
    const bool is_spare = (folder == kStylesFolder && config.crowd == 0 &&
                           !styles.contains(config_name(file->path))) ||
                          (folder == "pads" && !pads.contains(file->path));
    if (!is_spare) used.push_back({file->path, bytes_hash(file->bytes)});
  }
  return used;
}

std::vector<std::string> left_out_styles(const SessionSpec& spec, const Trace& trace,
                                         const SimulationConfig& config) {
  std::vector<std::string> sentences;
  if (!spec.recording.empty() || spec.replay.user_styles) return sentences;
  const auto named = named_styles(trace, config);
  for (const std::string& path : config_files({user_config_folder()}, kStylesFolder)) {
    const std::string name = config_name(path);
    if (!named.contains(name) || std::ranges::count(config.styles, name, &Style::name) > 0)
      continue;
    sentences.push_back(
        fmt::format("{} is a style of your own ({}), which a replay reads with --user-styles alone",
                    in_quotes(name), path));
  }
  return sentences;
}

Result<std::vector<StyleChange>> style_changes(const Trace& trace, std::vector<Style> styles) {
  std::vector<StyleChange> changes;
  for (const TraceFile& file : trace.files) {
    if (!is_saved_later(file)) continue;
    const InputFiles own(trace.path, {{file.name, file.bytes}});
    auto style = load_style(trace.path + "/" + file.name);
    if (!style) return style.error();
    style->name = config_name(file.name);
    const auto same = std::ranges::find(styles, style->name, &Style::name);
    if (same != styles.end()) {
      *same = std::move(*style);
    } else {
      styles.push_back(std::move(*style));
    }
    changes.push_back({file.tick, std::make_shared<const std::vector<Style>>(styles)});
  }
  return changes;
}

}  // namespace gaitpad
