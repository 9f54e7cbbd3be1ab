#include "view/show.h"

#include <algorithm>

#include "gaitpad/simulation.h"
#include "session/script.h"

namespace gaitpad {

Result<std::unique_ptr<Show>> Show::open(const ShowOptions& options) {
  return options.trace.empty() ? open_live_show(options) : open_playback_show(options);
}

std::optional<Error> Show::problem(const ShowOptions& options) {
  if (!options.trace.empty()) {
    const auto playback = open_playback_show(options);
    return playback ? std::nullopt : std::optional(playback.error());
  }
  const auto config = simulation_config(options.live.session, {}, "", options.live.rate_hz);
  if (!config) return config.error();
  const auto simulation = Simulation::create(*config);
  if (!simulation) return simulation.error();
  const auto script = script_for(*simulation, options.live.session.script);
  if (!script) return script.error();
  return std::nullopt;
}

void Show::add_config_folder(const std::string& folder) {
  std::vector<std::string>& folders = options_.live.session.config_folders;
  if (std::ranges::count(folders, folder) == 0) folders.push_back(folder);
}

}  // namespace gaitpad
