#include "check/check_report.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

CheckResult result(bool is_met, std::string verdict, std::vector<std::string> details = {}) {
  CheckResult result;
  result.is_met = is_met;
  result.verdict = std::move(verdict);
  result.details = std::move(details);
  return result;
}

TEST(Tap, AMetResultIsOneLine) {
  EXPECT_EQ(tap_result(3, {"walks/round"}, result(true, "as expected", {"a detail"}), false),
            "ok 3 - walks/round.hid\n");
}

// TAP 14: a `#` would begin a directive, and a backslash escapes.
TEST(Tap, ADirectiveInANameIsEscaped) {
  EXPECT_EQ(tap_result(1, {"a # TODO \\b"}, result(true, ""), false),
            "ok 1 - a \\# TODO \\\\b.hid\n");
}

TEST(Tap, AFailureHasItsReasonAsYaml) {
  EXPECT_EQ(tap_result(2, {"a"}, result(false, "a \"b\"", {"tick 7"}), false),
            "not ok 2 - a.hid\n  ---\n  message: \"a \\\"b\\\"\"\n  details:\n    - \"tick 7\"\n"
            "  ...\n");
}

TEST(Tap, AnUpdateSaysWhatChanged) {
  EXPECT_EQ(tap_result(1, {"a"}, result(true, "renewed", {"steps: 8 -> 9"}), true),
            "ok 1 - a.hid\n# renewed\n# steps: 8 -> 9\n");
}

TEST(Junit, CountsTestsFailuresAndSeconds) {
  JunitReport report;
  CheckResult slow = result(true, "");
  slow.seconds = 1.25;
  report.add({"a"}, slow);
  report.add({"b"}, result(false, "differs"));
  EXPECT_NE(report.text().find("tests=\"2\" failures=\"1\" errors=\"0\" time=\"1.250\""),
            std::string::npos);
  EXPECT_NE(report.text().find("name=\"a.hid\" time=\"1.250\"/>"), std::string::npos);
}

// XML 1.0, section 2.2: no control characters, and no character that is not Unicode.
TEST(Junit, TextsAreValidXml) {
  JunitReport report;
  report.add({"<a&b>"}, result(false, "\"c\"\x01\xff", {"\xc3\xa4"}));
  EXPECT_NE(report.text().find("&lt;a&amp;b&gt;.hid"), std::string::npos);
  EXPECT_NE(report.text().find("message=\"&quot;c&quot;??\">\xc3\xa4&#10;</failure>"),
            std::string::npos);
}

TEST(Shard, PartsAreCountedFromOne) {
  EXPECT_EQ(parse_shard("2/8")->index, 2);
  EXPECT_EQ(parse_shard("2/8")->total, 8);
  for (const char* wrong : {"", "0/3", "4/3", "1", "1/", "/1", "1/2/3", "-1/2", "1/100001", "a/b"})
    EXPECT_FALSE(parse_shard(wrong)) << wrong;
}

TEST(Shard, PartsTogetherAreAllEachOnce) {
  std::vector<CheckedTrace> all;
  for (int i = 0; i < 10; ++i) all.push_back({std::to_string(i)});
  std::vector<int> seen(all.size());
  for (int part = 1; part <= 3; ++part)
    for (const CheckedTrace& trace : part_of(all, {part, 3})) ++seen[std::stoi(trace.path)];
  EXPECT_EQ(seen, std::vector<int>(10, 1));
}

TEST(PicturePath, StaysInItsFolder) {
  EXPECT_EQ(picture_path("out", {"../walks/round"}), "out/walks/round.png");
  EXPECT_EQ(picture_path("out", {"/walks/./a/../round"}), "out/walks/round.png");
}

}  // namespace
}  // namespace gaitpad
