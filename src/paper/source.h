// What the figures are drawn from: a motion, its stride, the styles of figure 5.
#pragma once
#include <string>
#include <vector>

#include "gaitpad/gait_cycle.h"
#include "gaitpad/result.h"
#include "gaitpad/style.h"

namespace gaitpad {

struct PaperSource {
  std::string motion;     // `procedural` or the file as it was named
  bool is_adult = false;  // the built-in curve of an adult: some claims have numbers for it alone
  Motion frames;          // the motion as it stands in the file
  GaitCycle cycle;        // its best stride
  std::vector<Style> styles;
};

// `motion_file` empty or `procedural`: the built-in one. Styles come from the folders of
// config_files.h; one that a figure needs and that is nowhere is an error.
Result<PaperSource> load_paper_source(const std::string& motion_file,
                                      const std::vector<std::string>& config_folders);

// By its name; there is one for each of figure5_styles().
const Style& style_of(const PaperSource& source, const std::string& name);

// Red, green and blue of figure 5 (a) and (b).
struct FigureStyles {
  std::string red, green, blue;
};
const FigureStyles& styles_of_5a();
const FigureStyles& styles_of_5b();

}  // namespace gaitpad
