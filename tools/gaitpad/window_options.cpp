#include "tools/gaitpad/window_options.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "gaitpad/config_files.h"
#include "pads/calibration_store.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {

bool makes_pictures(const WindowArguments& arguments) {
  return !arguments.screenshot.empty() || !arguments.video.empty();
}

#ifdef GAITPAD_HAS_WINDOW
namespace {

constexpr int kMaxFrames = 100'000'000;
constexpr double kMostTurn_deg = 360.0;

CLI::Validator ends_with(const std::string& ending) {
  return CLI::Validator(
      [ending](const std::string& path) {
        return path.ends_with(ending) ? std::string() : "the file's name ends with " + ending;
      },
      "FILE" + ending);
}

std::string known_panel(const std::string& name) {
  if (name == "none" || std::ranges::count(kPanelNames, name) > 0) return "";
  return fmt::format("\"{}\" is none of {}, none", name, fmt::join(kPanelNames, ", "));
}

std::vector<std::string> scene_part_names() {
  std::vector<std::string> names;
  for (const ScenePart& part : kSceneParts) names.emplace_back(part.name);
  return names;
}

}  // namespace

std::vector<CLI::Option*> add_window_options(CLI::App& command, WindowArguments& arguments) {
  return {
      command.add_option("--frames", arguments.frames, "end after this number of drawn frames")
          ->check(CLI::Range(1, kMaxFrames)),
      command
          .add_option("--screenshot", arguments.screenshot,
                      "write the last frame; each frame is then 1/60 s of the session")
          ->check(ends_with(".png")),
      command
          .add_option("--video", arguments.video,
                      "write all frames, 60 for each second of the session (needs ffmpeg)")
          ->check(ends_with(".mp4")),
      command.add_option("--theme", arguments.theme, "dark or light (default: the last one used)")
          ->check(CLI::IsMember({"dark", "light"})),
      command
          .add_option("--scale", arguments.scale, "size of text and lines (default: the display's)")
          ->check(CLI::Range(0.5, 4.0)),
      command
          .add_option(
              "--panels", arguments.panels,
              fmt::format("open only these panels: {}; or none", fmt::join(kPanelNames, ",")))
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(known_panel),
      command
          .add_option(
              "--hide", arguments.hidden,
              fmt::format("hide these in the scene: {}", fmt::join(scene_part_names(), ",")))
          ->delimiter(',')
          ->allow_extra_args(false)
          ->check(CLI::IsMember(scene_part_names())),
      command
          .add_option("--camera", arguments.camera_deg,
                      "YAW,PITCH in degrees: yaw from ahead of the walkers (90: from their left), "
                      "pitch above the horizon")
          ->delimiter(',')
          ->expected(2)
          ->check(CLI::Range(-kMostTurn_deg, kMostTurn_deg)),
      command.add_flag("--clean", arguments.is_clean,
                       "show only the scene, without tool bar, time line, panels and status line"),
  };
}

WindowOptions window_options(const WindowArguments& arguments, bool has_end) {
  WindowOptions options;
  options.frames = arguments.frames;
  options.screenshot = arguments.screenshot;
  options.video = arguments.video;
  options.scale = arguments.scale;
  if (!arguments.theme.empty())
    options.theme = arguments.theme == "light" ? ThemeName::light : ThemeName::dark;
  options.are_panels_given = !arguments.panels.empty();
  for (int i = 0; i < kPanels; ++i) {
    const auto panel = static_cast<Panel>(i);
    const std::string_view name = kPanelNames[static_cast<std::size_t>(i)];
    if (std::ranges::count(arguments.panels, name) > 0) options.panels.push_back(panel);
  }
  options.hidden = arguments.hidden;
  options.camera_deg = arguments.camera_deg;
  options.is_clean = arguments.is_clean;
  options.program = "gaitpad " GAITPAD_VERSION;
  options.calibration_folder = user_calibration_folder();
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    options.record_folder = std::string(home) + "/gaitpad";
  // A video driver that the user has chosen for SDL is kept.
  const char* driver = std::getenv("SDL_VIDEODRIVER");
  options.is_hidden =
      makes_pictures(arguments) && has_end && (driver == nullptr || *driver == '\0');
  const std::string folder = user_config_folder();
  if (makes_pictures(arguments) || folder.empty()) return options;
  options.layout_file = folder + "/window.toml";
  options.recent_file = folder + "/recent";
  return options;
}

int show_window(std::string_view command, WindowOptions options, RunEnd& end,
                WindowResult& result) {
  const auto module = window_module();
  if (!module) return fail(command, module.error().message);
  Progress progress(command);
  options.is_ended_from_outside = [&end] { return end.is_reached(); };
  options.show_progress = [&progress](double share) { progress.show(share); };
  auto shown = (*module)->run_window(options);
  progress.clear();
  if (!shown) return fail(command, shown.error().message);
  result = std::move(*shown);
  print_remarks(command, result.remarks);
  return result.is_cut_off ? end.cut_off_status() : 0;
}

#else

std::vector<CLI::Option*> add_window_options(CLI::App& command, WindowArguments& arguments) {
  const CLI::Validator never([](const std::string&) { return missing_window(); }, "");
  const std::string help = "not in this program: it was built without its window";
  std::vector<CLI::Option*> options = {
      command.add_option("--frames", arguments.frames, help),
      command.add_option("--screenshot", arguments.screenshot, help),
      command.add_option("--video", arguments.video, help),
      command.add_option("--theme", arguments.theme, help),
      command.add_option("--scale", arguments.scale, help),
      command.add_option("--panels", arguments.panels, help),
      command.add_option("--hide", arguments.hidden, help),
      command.add_option("--camera", arguments.camera_deg, help),
      command.add_flag("--clean", arguments.is_clean, help),
  };
  for (CLI::Option* option : options) option->check(never);
  return options;
}

#endif

}  // namespace gaitpad
