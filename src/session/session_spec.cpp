#include "gaitpad/session_spec.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "base/ranges.h"
#include "files/stride_cache.h"
#include "gaitpad/config_files.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/motion_file.h"
#include "session/workers.h"

namespace gaitpad {
namespace {

constexpr double kMostHours = 1e6;  // greatest limit on a replay's length

std::vector<std::string> folders_of_lists(const SessionSpec& spec) {
  return spec.recording.empty() ? spec.config_folders : std::vector{spec.recording};
}

// Folders of the styles that no option names.
std::vector<std::string> style_folders(const SessionSpec& spec) {
  std::vector<std::string> folders = folders_of_lists(spec);
  const bool is_live = spec.replay.trace.empty();
  if (!is_live && !spec.replay.user_styles) std::erase(folders, user_config_folder());
  return folders;
}

// Loads the chosen files first, so that they override equal names in the folders of configuration.
// `remarks` gets a sentence on each unreadable file that no option names.
Result<std::vector<Style>> all_styles(const SessionSpec& spec, std::vector<int>& chosen,
                                      std::vector<std::string>& remarks) {
  std::vector<Style> styles;
  const auto load = [&styles](const std::string& path) -> std::optional<Error> {
    auto style = load_style(path);
    if (!style) return style.error();
    style->name = config_name(path);
    styles.push_back(std::move(*style));
    return std::nullopt;
  };
  for (const std::string& wanted : spec.walk.styles) {
    auto path = config_file(spec.config_folders, "styles", wanted);
    if (!path) return path.error();
    chosen.push_back(static_cast<int>(styles.size()));
    if (auto problem = load(*path)) return *problem;
  }
  if (chosen.empty()) {
    chosen.push_back(0);
    styles.emplace_back().name = "even";
  }
  for (const std::string& path : config_files(style_folders(spec), "styles")) {
    if (auto problem = load(path))
      remarks.push_back(problem->message + "; the session goes on without this style");
  }
  return styles;
}

Result<std::vector<Character>> all_characters(const SessionSpec& spec) {
  std::vector<Character> characters;
  for (const std::string& wanted : spec.walk.characters) {
    auto path = config_file(spec.config_folders, "characters", wanted);
    if (!path) return path.error();
    auto character = load_character(*path);
    if (!character) return character.error();
    characters.push_back(std::move(*character));
  }
  if (characters.empty()) characters.emplace_back();
  return characters;
}

template <class T>
const T& nth_or_last(const std::vector<T>& list, std::size_t n) {
  return list[std::min(n, list.size() - 1)];
}

Result<std::shared_ptr<const Terrain>> terrain_of(const SessionSpec& spec) {
  if (spec.walk.terrain.empty()) return flat_terrain();
  auto path = config_file(spec.config_folders, "terrain", spec.walk.terrain);
  if (!path) return path.error();
  auto terrain = load_terrain(*path);
  if (!terrain) return terrain.error();
  return std::shared_ptr<const Terrain>(std::make_shared<Terrain>(std::move(*terrain)));
}

// A live session's ticks have a deadline, so they wait for other threads only if one thread is too
// slow for the crowd.
int crowd_threads(const SessionSpec& spec) {
  constexpr int kAlone = 64, kAloneLive = 1000;
  const bool is_live = spec.replay.trace.empty();
  if (spec.walk.crowd.value_or(0) <= (is_live ? kAloneLive : kAlone)) return 1;
  return machine_threads();
}

Result<GaitCycle> cycle_of(const SessionSpec& spec) {
  if (is_built_in(spec)) return cached_clean_strides(procedural_gait(), stride_cache_folder());
  const auto path = motion_path(spec.config_folders, spec.walk.motion);
  if (!path) return path.error();
  auto motion = load_motion_source(*path);
  if (!motion) return motion.error();
  auto cycle = gait_cycle(*motion);
  if (!cycle) return cycle.error();
  return cached_clean_strides(std::move(*cycle), stride_cache_folder());
}

Result<WalkerConfig> walker_config(const Character& character, int style, const GaitCycle& cycle) {
  WalkerConfig walker{character, style, std::nullopt};
  if (character.skeleton.empty()) return walker;
  auto motion = load_motion_source(character.skeleton);
  if (!motion) return motion.error();
  auto own = cycle_on_skeleton(cycle, *motion);
  if (!own) return own.error();
  own = cached_clean_strides(std::move(*own), stride_cache_folder());
  if (!own) return own.error();
  walker.own_cycle = std::move(*own);
  return walker;
}

}  // namespace

std::optional<Error> check(const SessionSpec& spec) {
  struct Number {
    const char* name;
    std::optional<double> value;
    double least, most;
  };
  const Number numbers[] = {
      {"rate_hz", spec.rate_hz, kLeastRateHz, kMaxRateHz},
      {"walk.crowd", spec.walk.crowd, 0.0, kMaxFollowers},
      {"live.frame_ticks", spec.live.frame_ticks, 0.0, kMaxRateHz},
      {"live.stream_fps", spec.live.stream_fps, 1.0, kMaxRateHz},
      {"replay.max_hours", spec.replay.max_hours, 0.0, kMostHours},
      {"replay.fps", spec.replay.fps, 1.0, kMaxRateHz},
      {"replay.crowd_files", spec.replay.crowd_files, 0.0, kMaxFollowers},
  };
  const std::string what = "SessionSpec: ";
  for (const Number& number : numbers) {
    if (!number.value) continue;
    if (auto problem = range_problem(what + number.name, *number.value, number.least, number.most))
      return problem;
  }
  using Clock = SessionSpec::Live::Clock;
  const std::optional<Error> choices[] = {
      choice_problem(what + "walk.ik", spec.walk.ik.value_or(IkMode::robust), IkMode::robust),
      choice_problem(what + "walk.stick", spec.walk.stick, StickMeans::points),
      choice_problem(what + "walk.pace", spec.walk.pace.value_or(Pace::own), Pace::adult),
      choice_problem(what + "live.clock", spec.live.clock, Clock::by_hand),
      choice_problem(what + "replay.damage", spec.replay.damage, Damage::skip),
  };
  for (const auto& problem : choices) {
    if (problem) return problem;
  }
  const std::pair<const char*, const std::vector<std::string>*> lists[] = {
      {"walk.characters", &spec.walk.characters}, {"walk.styles", &spec.walk.styles}};
  for (const auto& [name, list] : lists) {
    const auto empty = std::ranges::find(*list, "");
    if (empty != list->end())
      return Error{fmt::format("{}{}[{}] is empty", what, name, empty - list->begin())};
  }
  return std::nullopt;
}

bool is_built_in(const SessionSpec& spec) {
  return spec.walk.motion.empty() || spec.walk.motion == "procedural";
}

Result<PadFiles> load_pad_files(const SessionSpec& spec) {
  auto files = load_pad_files(folders_of_lists(spec), spec.pad.map, spec.pad.calibration);
  // The devices of a recording have their own calibrations, or none.
  if (files && !spec.recording.empty()) files->calibration_folders.clear();
  return files;
}

Result<SimulationConfig> simulation_config(const SessionSpec& spec, int rate_hz) {
  if (auto problem = check(spec)) return *problem;
  SimulationConfig config;
  config.rate_hz = rate_hz;
  config.ik = spec.walk.ik.value_or(IkMode::robust);
  config.stick = spec.walk.stick;
  config.crowd = spec.walk.crowd.value_or(0);
  config.crowd_threads = crowd_threads(spec);
  config.shows_crowd = spec.walk.shows_crowd;
  auto terrain = terrain_of(spec);
  if (!terrain) return terrain.error();
  config.terrain = std::move(*terrain);
  std::vector<int> chosen_styles;
  auto styles = all_styles(spec, chosen_styles, config.remarks);
  if (!styles) return styles.error();
  config.styles = std::move(*styles);
  auto characters = all_characters(spec);
  if (!characters) return characters.error();
  auto cycle = cycle_of(spec);
  if (!cycle) return cycle.error();
  config.cycle = std::move(*cycle);
  if (is_built_in(spec)) {
    config.pace = spec.walk.pace.value_or(Pace::own);
  } else {
    config.pace = config.cycle.pace = spec.walk.pace.value_or(config.cycle.pace);
  }
  const std::size_t count = std::max(characters->size(), chosen_styles.size());
  for (std::size_t i = 0; i < count; ++i) {
    auto walker =
        walker_config(nth_or_last(*characters, i), nth_or_last(chosen_styles, i), config.cycle);
    if (!walker) return walker.error();
    config.walkers.push_back(std::move(*walker));
  }
  return config;
}

}  // namespace gaitpad
