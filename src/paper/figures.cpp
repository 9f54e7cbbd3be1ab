#include "paper/figures.h"

#include "session/walk_export.h"

namespace gaitpad {

std::vector<Figure> all_figures(Study& study) {
  std::vector<Figure> figures;
  figures.push_back(figure_2(study.source()));
  figures.push_back(figure_3(study));
  figures.push_back(figure_4());
  for (const IkMode mode : {IkMode::robust, IkMode::paper}) {
    figures.push_back(figure_5a(study, mode));
    figures.push_back(figure_5b(study, mode));
  }
  return figures;
}

std::optional<Error> write_figures(const std::string& folder, const std::vector<Figure>& figures,
                                   const std::string& claims_json) {
  auto files = OutputFiles::open(folder);
  if (!files) return files.error();
  const auto add = [&files](const std::string& name,
                            const std::string& bytes) -> std::optional<Error> {
    auto stream = files->add(name);
    if (!stream) return stream.error();
    **stream << bytes;
    return std::nullopt;
  };
  for (const Figure& figure : figures) {
    const std::string png = png_of(figure.picture.get());
    if (png.empty()) return Error{figure.name + ".png: cannot be drawn: cairo has no memory"};
    if (auto problem = add(figure.name + ".png", png)) return problem;
    if (auto problem = add(figure.name + ".csv", figure.csv)) return problem;
  }
  if (auto problem = add("claims.json", claims_json)) return problem;
  return files->publish();
}

}  // namespace gaitpad
