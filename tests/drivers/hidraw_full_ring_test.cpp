// The kernel keeps 63 reports (HIDRAW_BUFFER_SIZE of 64, less one) and drops what comes then.
#ifdef GAITPAD_HAS_HIDRAW
#include "drivers/hidraw_fixture.h"

namespace gaitpad {
namespace {

TEST_F(HidrawDriver, AReaderThatComesTooLateIsToldOnce) {
  const auto device = opened();
  read_in_a_row(*device, 100);  // from before the opening's end
  read_in_a_row(*device, 62);
  EXPECT_TRUE(device->take_remarks().empty());
  EXPECT_EQ(device->lost(), 0);
  read_in_a_row(*device, 63);
  EXPECT_EQ(device->take_remarks().size(), 1u);
  EXPECT_EQ(device->lost(), 1);
  read_in_a_row(*device, 200);
  EXPECT_TRUE(device->take_remarks().empty());
  EXPECT_EQ(device->lost(), 2) << "at least one each time";
}

TEST_F(HidrawDriver, APadThatIsSilentAfterAFullRingIsAskedForItsState) {
  const auto device = opened();
  EXPECT_EQ(device->read(report_), Status::nothing);
  set_present(Packet{0, 0x70, 0x80});
  EXPECT_EQ(device->poll_fds().size(), 1u);
  read_in_a_row(*device, 63, {0xff, 0x80});
  ASSERT_EQ(wait_and_read(*device, 5000), Status::report);
  EXPECT_EQ(bytes_of(report_), (Packet{0x70, 0x80}));
  EXPECT_EQ(report_.kind, ReportKind::input);
  expect_stamped_now();
  EXPECT_EQ(device->read(report_), Status::nothing);
  EXPECT_EQ(device->poll_fds().size(), 1u);
  EXPECT_EQ(asked(), std::vector<int>{0});
  EXPECT_EQ(device->lost(), 1);
}

TEST_F(HidrawDriver, ThePresentStateOfANumberedReportIsAskedForByItsId) {
  listing_.info.descriptor = kNumbered;
  const auto device = opened();
  set_present(Packet{1, 0x70, 0x80});
  read_in_a_row(*device, 63, {1, 0xff, 0x80});  // while it was opened
  ASSERT_EQ(wait_and_read(*device, 5000), Status::report);
  EXPECT_EQ(bytes_of(report_), (Packet{1, 0x70, 0x80}));
  EXPECT_EQ(asked(), std::vector<int>{1});
  EXPECT_EQ(device->lost(), 0);
}

TEST_F(HidrawDriver, APadThatGoesOnAfterAFullRingIsNotAsked) {
  const auto device = opened();
  set_present(Packet{0, 0x70, 0x80});
  read_in_a_row(*device, 63);
  send({5, 6});
  ASSERT_EQ(wait_and_read(*device, 1000), Status::report);
  EXPECT_EQ(wait_and_read(*device, 60), Status::nothing);
  EXPECT_TRUE(asked().empty());
}

TEST_F(HidrawDriver, ARefusedOrShortAnswerIsNoReport) {
  for (const std::optional<Packet>& answer : {std::optional<Packet>(), {Packet{0, 9}}}) {
    const auto device = opened();
    set_present(answer);
    read_in_a_row(*device, 63);
    EXPECT_EQ(wait_and_read(*device, 100), Status::nothing);
    EXPECT_EQ(device->poll_fds().size(), 1u);
    EXPECT_EQ(asked().size(), 1u);
    send({5, 6});
    EXPECT_EQ(wait_and_read(*device, 1000), Status::report);
  }
}

TEST_F(HidrawDriver, APadThatIsUnpluggedBeforeItsAnswerIsGone) {
  const auto device = opened();
  set_present(Packet{0, 0x70, 0x80});
  read_in_a_row(*device, 63);
  unplug();
  EXPECT_EQ(wait_and_read(*device, 1000), Status::gone);
}

}  // namespace
}  // namespace gaitpad
#endif  // GAITPAD_HAS_HIDRAW
