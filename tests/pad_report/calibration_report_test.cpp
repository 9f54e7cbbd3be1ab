#include "pad_report/calibration_report.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

DeviceInfo pad() {
  DeviceInfo info;
  info.name = "Pad\x1b";
  info.vendor = 0x1209;
  info.product = 0x000a;
  return info;
}

// A left stick that was seen at rest and at its rim, and the number of reports.
PadAnalysis analysis() {
  PadAnalysis analysis;
  StickAnalysis& stick = analysis.stick[0].emplace();
  StickStatistics& s = stick.statistics;
  s.samples = 500;
  s.rest_samples = 120;
  s.rest_s = 1.5;
  s.centre = vec2(0.02, -0.01);
  s.sigma = vec2(0.002, 0.003);
  s.max_x = 0.98;
  s.turns = 1;
  s.circularity_error = 4.25;
  s.rate_hz = 250.0;
  stick.advice.verdict = Verdict::worn;
  stick.advice.reason = "It drifts.";
  stick.advice.inner_zone = 0.05;
  return analysis;
}

// The line that begins with this label.
std::string line_of(const std::string& text, const std::string& label) {
  const std::size_t begin = text.find("  " + label);
  return begin == text.npos ? "none" : text.substr(begin, text.find('\n', begin) - begin);
}

TEST(CalibrationReport, NamesThePadInPrintableLettersAndEachSticksVerdict) {
  const std::string text = analysis_text(pad(), analysis());
  EXPECT_EQ(text.rfind("Pad\\x1b (1209:000a)\n\nleft stick: worn. It drifts.\n", 0), 0u) << text;
  EXPECT_EQ(text.find("right stick"), text.npos);
}

TEST(CalibrationReport, EachRowHasItsValuesAndTheirSource) {
  const std::string text = analysis_text(pad(), analysis());
  EXPECT_EQ(line_of(text, "centre"),
            "  centre                +0.0200  -0.0100    120 reports at rest in 1.5 s, 0 rests");
  EXPECT_EQ(line_of(text, "circularity error"),
            "  circularity error         4.2 %           0 is a circle of radius 1 about the raw "
            "middle");
  EXPECT_EQ(line_of(text, "rate"), "  rate                    250.0 Hz          500 reports");
}

TEST(CalibrationReport, AValueThatWasNotMeasuredIsSaidToBeUnknown) {
  const std::string text = analysis_text(pad(), analysis());
  EXPECT_NE(line_of(text, "hysteresis").find("not known"), std::string::npos) << text;
  EXPECT_NE(line_of(text, "reach right, front").find("+0.9800        ?"), std::string::npos)
      << text;
  EXPECT_NE(line_of(text, "outer zone").find("not known"), std::string::npos) << text;
}

TEST(CalibrationReport, JsonHasTheSameValuesAndNullForUnknownOnes) {
  const auto json = analysis_json(pad(), analysis());
  EXPECT_EQ(json["device"]["vendor"], 0x1209);
  EXPECT_TRUE(json["sticks"]["right"].is_null());
  const auto& left = json["sticks"]["left"];
  EXPECT_EQ(left["centre_y"], -0.01);
  EXPECT_EQ(left["inner_zone"], 0.05);
  EXPECT_EQ(left["verdict"], "worn");
  EXPECT_EQ(left["rate_hz"], 250.0);
  EXPECT_TRUE(left["hysteresis"].is_null());
  EXPECT_TRUE(left["outer_zone"].is_null());
  EXPECT_TRUE(json["triggers"].empty());
}

TEST(CalibrationReport, TriggersFollowTheSticks) {
  PadAnalysis both = analysis();
  both.trigger[1] = TriggerStatistics{.samples = 40, .released = 0.0, .pressed = std::nullopt};
  EXPECT_NE(analysis_text(pad(), both)
                .find("\nright trigger: released 0.000, pressed not known, 40 reports\n"),
            std::string::npos);
  const auto json = analysis_json(pad(), both);
  EXPECT_EQ(json["triggers"]["right"]["released"], 0.0);
  EXPECT_TRUE(json["triggers"]["right"]["pressed"].is_null());
}

TEST(CalibrationReport, AStarMarksTheNumbersThatDiffer) {
  ComparedFiles files;
  files.names = {"before.toml", "after.toml"};
  files.numbers[0] = {{"centre", {"0.0100", "0.0200"}}, {"reach", {"0.9", "0.9"}}};
  const std::string text = comparison_text(files);
  EXPECT_EQ(text.rfind("left stick\n", 0), 0u);
  EXPECT_NE(text.find("\n\nright stick\n"), text.npos);
  EXPECT_NE(text.find("0.0200  *\n"), text.npos);
  EXPECT_NE(text.find("0.9\n"), text.npos);
}

}  // namespace
}  // namespace gaitpad
