#include "view/show.h"

#include <algorithm>

#include "gaitpad/simulation.h"
#include "session/script.h"

namespace gaitpad {

Result<std::unique_ptr<Show>> Show::open(const SessionSpec& options) {
  return options.replay.trace.empty() ? open_live_show(options) : open_playback_show(options);
}

Result<Show::Start> Show::prepare(const SessionSpec& spec) {
  if (spec.replay.trace.empty()) {
    auto prepared = LiveSession::prepare(spec);
    if (!prepared) return prepared.error();
    return Start([prepared = *prepared] { return open_live_show(prepared); });
  }
  auto opened = open_playback_show(spec);
  if (!opened) return opened.error();
  auto show = std::make_shared<std::unique_ptr<Show>>(std::move(*opened));
  return Start([show] { return Result(std::move(*show)); });
}

void Show::add_config_folder(const std::string& folder) {
  std::vector<std::string>& folders = options_.config_folders;
  if (std::ranges::count(folders, folder) == 0) folders.push_back(folder);
}

}  // namespace gaitpad
