#include "pads/traced_pad.h"

#include <gtest/gtest.h>

#include "gaitpad/trace.h"
#include "tests/made_pad.h"
#include "tests/own_folder.h"

namespace gaitpad {
namespace {

// Writes a recording of a pad whose left stick goes from its middle to the right and back, half a
// second each.
std::string recording_of(const OwnFolder& folder, const std::string& name, const DeviceInfo& info) {
  TraceWriter writer;
  TraceDevice device;
  device.info = info;
  writer.device(device, TraceWriter::Index::left_out);
  for (int i = 0; i < 150; ++i) {
    const std::uint8_t x = i / 50 == 1 ? 0xff : 0x80;
    const std::uint8_t bytes[] = {x, 0x80, 0x80, 0x80, 0x08, 0};
    writer.event(ReportKind::input, 10'000 * i, 0, bytes);
  }
  return folder.write(name, writer.text());
}

class TracedPad : public testing::Test {
 protected:
  OwnFolder folder_;
  std::vector<std::string> remarks_;
  Result<GuidedPad> traced(const std::vector<std::string>& paths) {
    return traced_pad(paths, Damage::refuse, {}, remarks_);
  }
};

TEST_F(TracedPad, SeveralRecordingsOfOnePadAreOneTrack) {
  const std::string a = recording_of(folder_, "a.hid", made_pad());
  const auto once = traced({a}), twice = traced({a, a});
  ASSERT_TRUE(once && twice);
  EXPECT_EQ(once->info.name, made_pad().name);
  const auto reports = [](const GuidedPad& pad) {
    std::size_t count = 0;
    for (const auto& piece : pad.tracks.stick[0]) count += piece.size();
    return count;
  };
  EXPECT_EQ(reports(*once), 150u);
  EXPECT_EQ(reports(*twice), 300u);
  EXPECT_EQ(twice->tracks.stick[0].size(), 2u) << "what is between them was not seen";
  EXPECT_TRUE(remarks_.empty());
}

TEST_F(TracedPad, RecordingsOfTwoKindsOfPadAreRefusedByName) {
  DeviceInfo other = made_pad();
  other.product = 2;
  const auto pad =
      traced({recording_of(folder_, "a.hid", made_pad()), recording_of(folder_, "b.hid", other)});
  ASSERT_FALSE(pad);
  EXPECT_NE(pad.error().message.find("b.hid: Example Walk Pad (1209:0002) is not the pad of"),
            std::string::npos)
      << pad.error().message;
}

TEST_F(TracedPad, PushesTeachTheAxesOrSayWhyTheyCannot) {
  auto pad = traced({recording_of(folder_, "a.hid", made_pad())});
  ASSERT_TRUE(pad);
  EXPECT_FALSE(learn_frames({"right", "forward"}, *pad, remarks_));
  ASSERT_EQ(remarks_.size(), 2u) << "one push of two, by each stick";
  EXPECT_NE(remarks_[0].find("was pushed and held 1 of 2 times"), std::string::npos) << remarks_[0];
  EXPECT_NE(remarks_[1].find("0 of 2"), std::string::npos) << remarks_[1];
  EXPECT_TRUE(pad->frame[0] == StickFrame{});
}

}  // namespace
}  // namespace gaitpad
