// Every file of tests/data/pads: a `# = ` line before a report says the state after it: axes that
// are not 0 (to 0.01), then `buttons` and the pressed ones. Adding a pad to the tests is adding a
// file.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <sstream>

#include "gaitpad/decode.h"
#include "gaitpad/trace.h"
#include "tests/hid/made_pads.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

struct Expected {
  std::array<float, kAxisCount> axis{};
  std::uint32_t buttons = 0;
};

Expected expected_of(const std::string& text) {
  Expected e;
  std::istringstream in(text);
  bool in_buttons = false;
  for (std::string word; in >> word;) {
    if (word == "buttons") {
      in_buttons = true;
    } else if (in_buttons) {
      const auto it = std::find(kButtonNames.begin(), kButtonNames.end(), word);
      if (it == kButtonNames.end()) ADD_FAILURE() << "no button " << word;
      e.buttons |= 1u << (it - kButtonNames.begin());
    } else {
      const auto it = std::find(kAxisNames.begin(), kAxisNames.end(), word);
      if (it == kAxisNames.end()) ADD_FAILURE() << "no axis " << word;
      in >> e.axis[static_cast<std::size_t>(it - kAxisNames.begin())];
    }
  }
  return e;
}

std::vector<Expected> all_expected(const std::string& path) {
  std::vector<Expected> all;
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("# =", 0) == 0) all.push_back(expected_of(line.substr(3)));
  }
  return all;
}

void check_pad(const std::string& path, const PadOverrides& overrides) {
  SCOPED_TRACE(path);
  const auto trace = read_trace(path);
  ASSERT_TRUE(trace) << trace.error().message;
  const auto layout = pad_layout(trace->devices[0].info, overrides);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_TRUE(layout->is_pad);
  const auto expected = all_expected(path);
  ASSERT_EQ(expected.size(), trace->events.size());
  PadState state;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_TRUE(decode(*layout, report_of(*trace, trace->events[i]), state)) << "report " << i;
    for (int a = 0; a < kAxisCount; ++a) {
      EXPECT_NEAR(state.axis[a], expected[i].axis[a], 0.01)
          << "report " << i << " " << kAxisNames[a];
    }
    EXPECT_EQ(names_of(state.buttons), names_of(expected[i].buttons)) << "report " << i;
  }
}

TEST(GoldenPads, EveryReportDecodesAsThePadsMakerMeantIt) {
  const PadOverrides overrides = shipped_pads();
  int pads = 0;
  for (const std::string& path : files_in(kGoldenPads, ".hid")) {
    check_pad(path, overrides);
    ++pads;
  }
  EXPECT_GE(pads, 12);
}

}  // namespace
}  // namespace gaitpad
