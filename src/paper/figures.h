// The paper's figures, drawn from values that the code computes when it runs.
#pragma once
#include <string>
#include <vector>

#include "draw/picture.h"
#include "paper/study.h"

namespace gaitpad {

struct Figure {
  std::string name;  // name of the files: `figure5a` gives figure5a.png and figure5a.csv
  Surface picture;
  std::string csv;
};

// The height of a foot, its gradient, the bands, and the three targets of the flight.
Figure figure_2(const PaperSource& source);
// Table I: the poses at the starts of the four stages of a stride, the planted points, and arrows
// to the next pose.
Figure figure_3(Study& study);
// A chain of four links: configurations, and the first two angles over the iterations.
Figure figure_4();
// One stride of three characters and of the data, trails of the feet, joint angles. Named
// `figure5a` in robust mode and `figure5a_paper` in paper mode.
Figure figure_5a(Study& study, IkMode mode);
Figure figure_5b(Study& study, IkMode mode);

std::vector<Figure> all_figures(Study& study);

// Writes NAME.png and NAME.csv of each figure and claims.json: all of them or none.
std::optional<Error> write_figures(const std::string& folder, const std::vector<Figure>& figures,
                                   const std::string& claims_json);

}  // namespace gaitpad
