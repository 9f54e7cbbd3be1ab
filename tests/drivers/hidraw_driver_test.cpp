#ifdef GAITPAD_HAS_HIDRAW
#include <hidapi/hidapi.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <iterator>

#include "drivers/hidraw_fixture.h"

using namespace gaitpad::stand_in;

struct hid_device_ {
  std::vector<int> fds;
};

extern "C" {

hid_device* hid_open_path(const char* path) {
  auto device = std::make_unique<hid_device>();
  for (int i = 0; i < descriptors_per_opening; ++i) {
    const int fd = ::open(path, O_RDWR | O_CLOEXEC | O_NOCTTY);
    if (fd < 0) return nullptr;
    device->fds.push_back(fd);
  }
  return device.release();
}
void hid_close(hid_device* device) {
  if (!device) return;
  for (const int fd : device->fds) ::close(fd);
  delete device;
}
// As hidapi 0.13.1: an error number only where a call failed.
int hid_read_timeout(hid_device* device, unsigned char* data, size_t length, int milliseconds) {
  timeouts.push_back(milliseconds);
  if (!script.empty()) {
    const ScriptedRead now = script.front();
    script.pop_front();
    if (now.error >= 0) return errno = now.error, -1;
    const std::size_t size = std::min(length, now.bytes.size());
    std::copy_n(now.bytes.begin(), size, data);
    return static_cast<int>(size);
  }
  if (milliseconds >= 0) {
    pollfd ready{.fd = device->fds.front(), .events = POLLIN, .revents = 0};
    const int count = ::poll(&ready, 1, milliseconds);
    if (count <= 0) return count;
    if ((ready.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0) return -1;
  }
  return static_cast<int>(::read(device->fds.front(), data, length));
}
int hid_write(hid_device* device, const unsigned char* data, size_t length) {
  return static_cast<int>(::write(device->fds.front(), data, length));
}
int hid_get_feature_report(hid_device*, unsigned char* data, size_t length) {
  if (data[0] != 0x20 || !firmware) return errno = EPIPE, -1;
  std::copy_n(firmware->begin(), std::min(length, firmware->size()), data);
  return static_cast<int>(std::min(length, firmware->size()));
}
int hid_get_input_report(hid_device*, unsigned char* data, size_t length) {
  const std::lock_guard lock(present.mutex);
  present.asked.push_back(data[0]);
  if (!present.answer) return errno = EPIPE, -1;
  std::copy_n(present.answer->begin(), std::min(length, present.answer->size()), data);
  return static_cast<int>(std::min(length, present.answer->size()));
}

}  // extern "C"

namespace gaitpad {
namespace {

TEST_F(HidrawDriver, HandsOnTheBytesAsTheyCame) {
  const auto device = opened();
  EXPECT_EQ(device->info().driver, "hidraw");
  EXPECT_EQ(device->info().descriptor, kDescriptor);
  EXPECT_EQ(device->read(report_), Status::nothing);
  send({0x12, 0x34});
  ASSERT_TRUE(is_ready(*device, 1000));
  EXPECT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(bytes_of(report_), (Packet{0x12, 0x34}));
  EXPECT_EQ(report_.kind, ReportKind::input);
  expect_stamped_now();
  EXPECT_EQ(device->read(report_), Status::nothing);
  EXPECT_EQ(device->lost(), 0);
}

TEST_F(HidrawDriver, WaitsOnTheLibrarysOwnDescriptor) {
  const auto device = opened();
  ASSERT_EQ(device->poll_fds().size(), 1u);
  struct stat mine {
  }, node{};
  ASSERT_EQ(::fstat(device->poll_fds()[0].fd, &mine), 0);
  ASSERT_EQ(::stat(listing_.node.c_str(), &node), 0);
  EXPECT_EQ(mine.st_rdev, node.st_rdev);
  EXPECT_NE(device->poll_fds()[0].fd, keep_open_);
  EXPECT_FALSE(is_ready(*device, 20));
}

TEST_F(HidrawDriver, LooksEveryMillisecondWhereTheDescriptorCannotBeTold) {
  descriptors_per_opening = 2;
  const auto device = opened();
  ASSERT_TRUE(is_ready(*device, 1000));
  EXPECT_EQ(device->read(report_), Status::nothing);
  send({1, 2});
  for (int i = 0; i < 1000 && device->read(report_) != Status::report; ++i)
    ASSERT_TRUE(is_ready(*device, 1000));
  EXPECT_EQ(bytes_of(report_), (Packet{1, 2}));
  unplug();
  ASSERT_TRUE(is_ready(*device, 1000));
  EXPECT_EQ(device->read(report_), Status::gone);
}

TEST_F(HidrawDriver, UnpluggingIsTold) {
  const auto device = opened();
  unplug();
  ASSERT_TRUE(is_ready(*device, 1000));
  EXPECT_EQ(device->read(report_), Status::gone);
  EXPECT_EQ(device->read(report_), Status::gone);
  EXPECT_EQ(device->lost(), 0);
}

TEST_F(HidrawDriver, WhatCameBeforeUnpluggingIsReadFirst) {
  const auto device = opened();
  unplug();
  script = {failure(0), {.bytes = {1, 1}}, {.bytes = {2, 2}}, failure(EIO)};
  EXPECT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(bytes_of(report_), (Packet{2, 2}));
  EXPECT_EQ(device->read(report_), Status::gone);
  EXPECT_EQ(timeouts, (std::vector<int>{0, -1, -1, -1}));
}

TEST_F(HidrawDriver, AFailureIsNoUnplugging) {
  const auto device = opened();
  for (const int error : {EINTR, EAGAIN}) {
    script = {failure(error)};
    EXPECT_EQ(device->read(report_), Status::nothing);
  }
  EXPECT_EQ(device->lost(), 0);
  script = {failure(EIO), failure(ENODEV), failure(EPROTO), {.bytes = {5, 6}}};
  for (int i = 0; i < 3; ++i) EXPECT_EQ(device->read(report_), Status::nothing);
  EXPECT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(device->lost(), 3);
}

TEST_F(HidrawDriver, ASourceThatOnlyFailsIsGivenUpAndNamed) {
  const auto device = opened();
  int calls = 0;
  do script = {failure(EPROTO)};
  while (device->read(report_) == Status::nothing && ++calls < 1000);
  EXPECT_EQ(calls, 63);
  EXPECT_EQ(device->take_remarks(),
            std::vector<std::string>{listing_.node + ": cannot be read: Protocol error"});
  EXPECT_TRUE(device->take_remarks().empty());
}

TEST_F(HidrawDriver, AReportThatIsTooLongIsRefusedAndCounted) {
  const auto device = opened();
  script = {{.bytes = Packet(kMaxReportBytes + 1, 1)},
            {.bytes = Packet(16384, 2)},
            {.bytes = Packet(kMaxReportBytes, 3)}};
  EXPECT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(report_.size, kMaxReportBytes);
  EXPECT_EQ(report_.bytes[kMaxReportBytes - 1], 3);
  EXPECT_EQ(device->lost(), 2);
}

TEST_F(HidrawDriver, AFloodOfRefusedPacketsLeavesOtherPadsTheirTurn) {
  const auto device = opened();
  for (int i = 0; i < 1000; ++i) script.push_back({.bytes = Packet(2000, 0)});
  EXPECT_EQ(device->read(report_), Status::nothing);
  EXPECT_GT(script.size(), 900u);
}

TEST_F(HidrawDriver, MotorsRunAndStopWhenTheDeviceIsClosed) {
  use(0x054c, 0x09cc);
  listing_.info.descriptor = kNumbered;
  listing_.kernel_driver = "sony";
  auto device = opened();
  EXPECT_TRUE(device->rumble({.strong = 0xc000, .weak = 0x4000}));
  Packet on = written(32);
  ASSERT_EQ(on.size(), 32u);
  EXPECT_EQ(Packet(on.begin(), on.begin() + 6), (Packet{0x05, 0x01, 0, 0, 0x40, 0xc0}));
  device.reset();
  const Packet off = written(32);
  ASSERT_EQ(off.size(), 32u);
  EXPECT_EQ(Packet(off.begin(), off.begin() + 6), (Packet{0x05, 0x01, 0, 0, 0, 0}));
}

TEST_F(HidrawDriver, WhereReportsHaveNoIdTheKernelGetsAZeroInFront) {
  use(0x054c, 0x09cc);
  const auto device = opened();
  EXPECT_TRUE(device->rumble({.strong = 0x8000, .weak = 0}));
  const Packet on = written(33);
  ASSERT_EQ(on.size(), 33u);
  EXPECT_EQ(Packet(on.begin(), on.begin() + 3), (Packet{0x00, 0x05, 0x01}));
}

TEST_F(HidrawDriver, APlainPadHasNoMotors) {
  const auto device = opened();
  EXPECT_FALSE(device->rumble({.strong = 0x8000, .weak = 0}));
  EXPECT_FALSE(device->factory_sticks());
  EXPECT_TRUE(device->take_remarks().empty());
}

TEST_F(HidrawDriver, TheModelIsAskedThroughFeatureReports) {
  firmware = Packet(64, 0);
  (*firmware)[0] = 0x20;
  (*firmware)[45] = 0x03;  // 3.0: the new motors
  use(0x054c, 0x0ce6);
  listing_.info.descriptor = kNumbered;
  const auto device = opened();
  EXPECT_TRUE(device->rumble({.strong = 0x8000, .weak = 0}));
  const Packet on = written(48);
  ASSERT_EQ(on.size(), 48u);
  EXPECT_EQ(on[1], 0x02);
  EXPECT_EQ(on[39], 0x04);
}

TEST_F(HidrawDriver, NothingStaysOpen) {
  use(0x054c, 0x09cc);
  const auto count = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), {});
  };
  const auto before = count();
  for (int i = 0; i < 20; ++i) {
    descriptors_per_opening = 1 + i % 2;
    const auto device = opened();
    device->rumble({.strong = 1, .weak = 1});
    read_in_a_row(*device, 63, Packet(64, 1));
    EXPECT_EQ(wait_and_read(*device, 45), Status::nothing);
  }
  for (int i = 0; i < 1000 && count() != before; ++i)  // the threads end a little later
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_EQ(count(), before);
}

TEST(HidrawOpening, ErrorsAreOneSentenceAboutTheNode) {
  DeviceListing listing;
  listing.node = "/dev/hidraw_none";
  auto device = open_hidraw_device(listing, Detach::never);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message, "/dev/hidraw_none: No such file or directory");
  listing.node = GAITPAD_SOURCE_DIR;
  device = open_hidraw_device(listing, Detach::never);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message, listing.node + ": is no device node");
  listing.node = "/dev/null";  // no descriptor to be had
  device = open_hidraw_device(listing, Detach::never);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message, "/dev/null: its report descriptor cannot be read");
}

}  // namespace
}  // namespace gaitpad
#endif  // GAITPAD_HAS_HIDRAW
