#include "paper/source.h"

#include <algorithm>
#include <cassert>

#include "gaitpad/config_files.h"
#include "gaitpad/motion_file.h"

namespace gaitpad {

const FigureStyles& styles_of_5a() {
  static const FigureStyles kStyles = {"even", "stiff_hip", "stiff_knee"};
  return kStyles;
}

const FigureStyles& styles_of_5b() {
  static const FigureStyles kStyles = {"limp_left", "limp_left_hip", "limp_left_knee"};
  return kStyles;
}

const Style& style_of(const PaperSource& source, const std::string& name) {
  const auto found = std::ranges::find(source.styles, name, &Style::name);
  assert(found != source.styles.end());
  return *found;
}

Result<PaperSource> load_paper_source(const std::string& motion_file,
                                      const std::vector<std::string>& config_folders) {
  PaperSource source;
  source.is_adult = motion_file.empty() || motion_file == "procedural";
  source.motion = source.is_adult ? "procedural" : motion_file;
  if (source.is_adult) {
    source.frames = procedural_motion();
    source.cycle = procedural_gait();
  } else {
    const auto path = motion_path(config_folders, motion_file);
    if (!path) return path.error();
    auto motion = load_motion_source(*path);
    if (!motion) return motion.error();
    auto cycle = gait_cycle(*motion);
    if (!cycle) return cycle.error();
    source.frames = std::move(*motion);
    source.cycle = std::move(*cycle);
  }
  for (const FigureStyles& figure : {styles_of_5a(), styles_of_5b()}) {
    for (const std::string& name : {figure.red, figure.green, figure.blue}) {
      auto path = config_file(config_folders, "styles", name);
      if (!path) return path.error();
      auto style = load_style(*path);
      if (!style) return style.error();
      style->name = name;
      source.styles.push_back(std::move(*style));
    }
  }
  return source;
}

}  // namespace gaitpad
