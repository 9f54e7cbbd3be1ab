// Contrast by WCAG 2.1, computed from the colours: 4.5 for text (all of it is small), 3 for marks
// of a control and its state.
#include "draw/theme.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace gaitpad {
namespace {

double linear(double channel) {
  return channel <= 0.03928 ? channel / 12.92 : std::pow((channel + 0.055) / 1.055, 2.4);
}
double luminance(const Colour& c) {
  return 0.2126 * linear(c.red) + 0.7152 * linear(c.green) + 0.0722 * linear(c.blue);
}
double contrast(const Colour& a, const Colour& b) {
  const double one = luminance(a) + 0.05, other = luminance(b) + 0.05;
  return std::max(one, other) / std::min(one, other);
}

struct Named {
  std::string name;
  Colour colour;
};

class Contrast : public testing::TestWithParam<ThemeName> {
 protected:
  const Theme& theme = theme_of(GetParam());
  const std::vector<Named> backs = {
      {"bar", theme.bar}, {"panel", theme.panel}, {"card", theme.card}, {"plot", theme.plot}};
  // Text of selected buttons and rows.
  const std::vector<Named> chosen = {
      {"chosen button", mixed(theme.panel, theme.accent, kChosenShare)},
      {"chosen on the bar", mixed(theme.bar, theme.accent, kChosenShare)},
      {"chosen row", mixed(theme.plot, theme.accent, kChosenShare)}};

  void expect(const Named& front, const Named& back, double least) const {
    EXPECT_GE(contrast(front.colour, back.colour), least) << front.name << " on " << back.name;
  }
};

TEST_P(Contrast, EveryTextCanBeRead) {
  std::vector<Named> texts = {{"text", theme.text}, {"secondary", theme.secondary},
                              {"tick", theme.tick}, {"good", theme.good},
                              {"bad", theme.bad},   {"warning", theme.warning},
                              {"left", theme.left}, {"right", theme.right}};
  for (const Named& text : texts)
    for (const Named& back : backs) expect(text, back, 4.5);
  // The numbers above graphs.
  for (std::size_t i = 0; i < theme.series.size(); ++i) {
    const Named series{"series " + std::to_string(i + 1), theme.series[i]};
    expect(series, {"panel", theme.panel}, 4.5);
    expect(series, {"plot", theme.plot}, 4.5);
  }
  for (const Named& back : chosen) {
    expect(texts[0], back, 4.5);
    expect(texts[1], back, 4.5);
  }
  expect(texts[0], {"a button", theme.frame}, 4.5);
  expect({"white", rgb(0xffffff)}, {"the most important button", theme.accent}, 4.5);
  // Letters in the stage chart.
  for (const Colour& leg : {theme.left, theme.right})
    expect(texts[0], {"a stage", mixed(theme.plot, leg, 0.55)}, 4.5);
}

TEST_P(Contrast, EveryControlAndItsStateCanBeSeen) {
  for (const Named& back : backs) {
    expect({"a control's edge", theme.edge}, back, 3.0);
    expect({"the scroll bar", mixed(back.colour, theme.secondary, kScrollShare)}, back, 3.0);
    expect({"a chosen button's edge", theme.left}, back, 3.0);
  }
  expect({"the most important button", theme.accent}, {"panel", theme.panel}, 3.0);
  expect({"a slider's knob", theme.left}, {"its groove", theme.frame}, 3.0);
  expect({"a changed slider", theme.warning}, {"panel", theme.panel}, 3.0);
  expect({"the record sign", theme.bad}, {"a button", theme.frame}, 3.0);
}

INSTANTIATE_TEST_SUITE_P(Themes, Contrast, testing::Values(ThemeName::dark, ThemeName::light),
                         [](const auto& info) {
                           return info.param == ThemeName::dark ? "dark" : "light";
                         });

}  // namespace
}  // namespace gaitpad
