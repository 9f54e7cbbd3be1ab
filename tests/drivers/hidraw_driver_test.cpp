#ifdef GAITPAD_HAS_HIDRAW
// The hidraw driver over a stand-in for hidapi: the functions here replace the library in this
// program. The node is a pseudo-terminal, so that descriptors, poll() and hanging up are real;
// results of reads can be scripted. The real hidraw is tested in the rig.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <hidapi/hidapi.h>
#include <linux/hidraw.h>
#include <poll.h>
#include <stdarg.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <deque>
#include <filesystem>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/driver_rows.h"
#include "tests/comes_true.h"
#include "tests/folders.h"
#include "tests/value_of.h"

namespace {

using Packet = std::vector<std::uint8_t>;

struct ScriptedRead {
  Packet bytes;
  int error = -1;  // -1: the read returns the bytes; otherwise it fails with this errno
};
std::deque<ScriptedRead> script;  // the results of the next reads; empty: read the node itself
std::vector<int> timeouts;        // the timeouts that reads were called with
ScriptedRead failure(int error) { return {.bytes = {}, .error = error}; }
std::atomic<int> openings{0}, opening_now{0}, openings_at_once{0};
std::chrono::milliseconds opening_time{0};
int descriptors_per_opening = 1;
std::optional<Packet> firmware;  // content of feature report 0x20
// The input report that the pad returns on request; it begins with the id.
std::optional<Packet> present;
std::vector<int> asked;  // ids of the reports that were asked for
std::mutex noting;       // guards notes of two threads that open at once
void note(std::vector<int>& numbers, int number) {
  const std::lock_guard lock(noting);
  numbers.push_back(number);
}

}  // namespace

struct hid_device_ {
  std::vector<int> fds;
};

extern "C" {

hid_device* hid_open_path(const char* path) {
  ++openings;
  // As in hidapi, the text of the last error is freed and set here.
  if (opening_now++ > 0) ++openings_at_once;
  std::this_thread::sleep_for(opening_time);
  --opening_now;
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
// Like hidapi 0.13.1: errno is only set if a call failed.
int hid_read_timeout(hid_device* device, unsigned char* data, size_t length, int milliseconds) {
  note(timeouts, milliseconds);
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
int hid_send_feature_report(hid_device*, const unsigned char*, size_t length) {
  return static_cast<int>(length);
}
// Replaces the kernel's ioctl(): a pseudo-terminal has no HIDIOCGINPUT.
int ioctl(int fd, unsigned long request, ...) {
  va_list arguments;
  va_start(arguments, request);
  void* argument = va_arg(arguments, void*);
  va_end(arguments);
  const std::size_t length = _IOC_SIZE(request);
  if (request != static_cast<unsigned long>(HIDIOCGINPUT(length)))
    return static_cast<int>(::syscall(SYS_ioctl, fd, request, argument));
  auto* data = static_cast<unsigned char*>(argument);
  note(asked, data[0]);
  if (!present) return errno = EPIPE, -1;
  std::copy_n(present->begin(), std::min(length, present->size()), data);
  return static_cast<int>(std::min(length, present->size()));
}

}  // extern "C"

namespace gaitpad {
namespace {

using namespace std::chrono_literals;
using Status = Device::Status;

// A descriptor of X and Y with 8 bits each, without report id.
const Packet kDescriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x09, 0x30, 0x09, 0x31, 0x15,
                            0x00, 0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02, 0xc0};
// A descriptor of X and Y with 8 bits each in report 1.
const Packet kNumbered = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x85, 0x01, 0x09, 0x30, 0x09, 0x31,
                          0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02, 0xc0};

class HidrawDriver : public testing::Test {
 protected:
  void SetUp() override {
    script.clear();
    timeouts.clear();
    openings = 0;
    descriptors_per_opening = 1;
    firmware.reset();
    present.reset();
    asked.clear();
    pad_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (pad_ < 0 || ::grantpt(pad_) != 0 || ::unlockpt(pad_) != 0)
      GTEST_SKIP() << "there is no pseudo-terminal here";
    std::array<char, 128> name{};
    ASSERT_EQ(::ptsname_r(pad_, name.data(), name.size()), 0);
    listing_.node = name.data();
    keep_open_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios raw{};
    ::tcgetattr(keep_open_, &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(keep_open_, TCSANOW, &raw);
    ::fcntl(pad_, F_SETFL, O_NONBLOCK);
    listing_.info.bus = BusType::usb;
    listing_.info.name = "Pad";
    listing_.info.descriptor = kDescriptor;
  }
  void TearDown() override {
    unplug();
    if (keep_open_ >= 0) ::close(keep_open_);
  }
  void unplug() {
    if (pad_ >= 0) ::close(pad_);
    pad_ = -1;
  }
  void send(const Packet& report) {
    ASSERT_EQ(::write(pad_, report.data(), report.size()), static_cast<ssize_t>(report.size()));
  }
  // Waits until the driver has written `size` bytes, and returns them.
  Packet written(std::size_t size) {
    Packet bytes(4096);
    std::size_t count = 0;
    comes_true([&] {
      const ssize_t more = ::read(pad_, bytes.data() + count, bytes.size() - count);
      if (more > 0) count += static_cast<std::size_t>(more);
      return count >= size;
    });
    bytes.resize(count);
    return bytes;
  }
  // Reads this many reports in a row, then `nothing`.
  void read_in_a_row(Device& device, int count, const Packet& bytes = {1, 2}) {
    for (int i = 0; i < count; ++i) script.push_back({.bytes = bytes});
    for (int i = 0; i < count; ++i) EXPECT_EQ(device.read(report_), Status::report);
    EXPECT_EQ(device.read(report_), Status::nothing);
  }
  std::unique_ptr<Device> opened() {
    auto device = value_of(open_hidraw_device(listing_, Detach::never));
    const std::lock_guard lock(noting);
    timeouts.clear();
    return device;
  }
  // Uses a pad with these ids, whose motors and firmware are known.
  void use(std::uint16_t vendor, std::uint16_t product) {
    listing_.info.vendor = vendor;
    listing_.info.product = product;
  }
  static std::int64_t now_ns() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return now.tv_sec * 1'000'000'000 + now.tv_nsec;
  }
  void expect_stamped_in_the_test() const {
    EXPECT_GE(report_.time_ns, begin_ns_);
    EXPECT_LE(report_.time_ns, now_ns());
  }
  static bool is_ready(const Device& device, int timeout_ms) {
    pollfd fd = device.poll_fds().front();
    return ::poll(&fd, 1, timeout_ms) > 0;
  }
  static Packet bytes_of(const Report& report) {
    return Packet(report.bytes.begin(), report.bytes.begin() + report.size);
  }

  const std::int64_t begin_ns_ = now_ns();
  int pad_ = -1, keep_open_ = -1;
  DeviceListing listing_;
  Report report_;
};

TEST_F(HidrawDriver, HandsOnTheBytesAsTheyCame) {
  const auto device = opened();
  EXPECT_EQ(device->info().driver, "hidraw");
  EXPECT_EQ(device->info().descriptor, kDescriptor);
  EXPECT_EQ(device->read(report_), Status::nothing);
  send({0x12, 0x34});
  ASSERT_TRUE(is_ready(*device, 60000));
  EXPECT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(bytes_of(report_), (Packet{0x12, 0x34}));
  EXPECT_EQ(report_.kind, ReportKind::input);
  expect_stamped_in_the_test();
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
  ASSERT_TRUE(is_ready(*device, 60000));
  EXPECT_EQ(device->read(report_), Status::nothing);
  send({1, 2});
  for (int i = 0; i < 1000 && device->read(report_) != Status::report; ++i)
    ASSERT_TRUE(is_ready(*device, 60000));
  EXPECT_EQ(bytes_of(report_), (Packet{1, 2}));
  unplug();
  ASSERT_TRUE(is_ready(*device, 60000));
  EXPECT_EQ(device->read(report_), Status::gone);
}

TEST_F(HidrawDriver, UnpluggingIsTold) {
  const auto device = opened();
  unplug();
  ASSERT_TRUE(is_ready(*device, 60000));
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

// The report is a Steam Controller's battery message.
TEST_F(HidrawDriver, ARecorderGetsWhatTheModelRefusesToo) {
  use(0x28de, 0x1102);
  listing_.info.descriptor = {0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00, 0x26, 0xff,
                              0x00, 0x75, 0x08, 0x95, 0x40, 0x09, 0x01, 0x81, 0x02, 0xc0};
  const auto device = opened();
  const Packet battery = {1, 0, 4, 0x0b}, state = {1, 0, 1, 0x3c};
  script = {{.bytes = battery}, {.bytes = state}};
  EXPECT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(bytes_of(report_), state);
  device->hand_on_raw();
  script = {{.bytes = battery}, {.bytes = state}};
  EXPECT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(bytes_of(report_), battery);
  EXPECT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(bytes_of(report_), state);
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

// Reading and rumble use one open device.
TEST_F(HidrawDriver, APadIsOpenedOnce) {
  use(0x054c, 0x0ce6);
  const auto device = opened();
  EXPECT_TRUE(device->rumble({0x4000, 0x4000}));
  EXPECT_FALSE(written(48).empty());
  EXPECT_EQ(openings, 1);
}

// Two streams would share the library's text of the last error, which is not thread-safe.
TEST_F(HidrawDriver, TwoThreadsDoNotOpenAtOnce) {
  openings_at_once = 0;
  opening_time = 20ms;
  std::unique_ptr<Device> first;
  std::thread other([this, &first] { first = opened(); });
  const auto second = opened();
  other.join();
  opening_time = 0ms;
  EXPECT_EQ(openings, 2);
  EXPECT_EQ(openings_at_once, 0);
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
  (*firmware)[45] = 0x03;  // version 3.0, which has the new motors
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
  for (int i = 0; i < 6; ++i) {
    descriptors_per_opening = 1 + i % 2;
    const auto device = opened();
    device->rumble({.strong = 1, .weak = 1});
    read_in_a_row(*device, 63, Packet(64, 1));
  }
  // The threads end a little after the device.
  EXPECT_TRUE(comes_true([&] { return count() == before; }));
}

TEST(HidrawOpening, ErrorsAreOneSentenceAboutTheNode) {
  DeviceListing listing;
  listing.node = "/dev/hidraw_none";
  auto device = open_hidraw_device(listing, Detach::never);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message, "/dev/hidraw_none: No such file or directory");
  listing.node = kSourceFolder;
  device = open_hidraw_device(listing, Detach::never);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message, listing.node + ": is no device node");
  listing.node = "/dev/null";  // a node that has no descriptor
  device = open_hidraw_device(listing, Detach::never);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message, "/dev/null: its report descriptor cannot be read");
}

// ---- The kernel keeps 63 reports (HIDRAW_BUFFER_SIZE of 64, less one) and drops further ones

TEST_F(HidrawDriver, AReaderThatComesTooLateIsToldOnce) {
  const auto device = opened();
  read_in_a_row(*device, 100);  // reports from before the device was open
  read_in_a_row(*device, 62);
  EXPECT_TRUE(device->take_remarks().empty());
  EXPECT_EQ(device->lost(), 0);
  read_in_a_row(*device, 63);
  EXPECT_EQ(device->take_remarks().size(), 1u);
  EXPECT_EQ(device->lost(), 1);
  read_in_a_row(*device, 200);
  EXPECT_TRUE(device->take_remarks().empty());
  EXPECT_EQ(device->lost(), 2) << "one each time";
}

// ---- At the opening

TEST_F(HidrawDriver, APadThatRestsWhenItIsOpenedIsAskedForItsState) {
  present = Packet{0, 0x70, 0x80};
  const auto device = opened();
  ASSERT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(bytes_of(report_), (Packet{0x70, 0x80}));
  expect_stamped_in_the_test();
  EXPECT_EQ(device->read(report_), Status::nothing);
  EXPECT_EQ(asked, std::vector<int>{0});
}

TEST_F(HidrawDriver, ANumberedReportIsAskedForByItsId) {
  listing_.info.descriptor = kNumbered;
  present = Packet{1, 0x70, 0x80};
  const auto device = opened();
  ASSERT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(bytes_of(report_), (Packet{1, 0x70, 0x80}));
  EXPECT_EQ(asked, std::vector<int>{1});
}

TEST_F(HidrawDriver, APadThatReportsWhenItIsOpenedIsNotAsked) {
  send({5, 6});
  const auto device = opened();
  ASSERT_EQ(device->read(report_), Status::report);
  EXPECT_EQ(bytes_of(report_), (Packet{5, 6}));
  EXPECT_TRUE(asked.empty());
}

// Answers that are no state: zeros, too short, another report's.
TEST_F(HidrawDriver, AnAnswerThatIsNoStateIsDropped) {
  listing_.info.descriptor = kNumbered;
  for (const Packet& answer : {Packet{1, 0, 0}, Packet{1, 0x70}, Packet{2, 0x70, 0x80}}) {
    present = answer;
    const auto device = opened();
    EXPECT_EQ(device->read(report_), Status::nothing);
  }
}

TEST_F(HidrawDriver, OverBluetoothNothingIsAskedAtTheOpening) {
  listing_.info.bus = BusType::bluetooth;
  present = Packet{0, 0x70, 0x80};
  const auto device = opened();
  EXPECT_EQ(device->read(report_), Status::nothing);
  EXPECT_TRUE(asked.empty());
}

}  // namespace
}  // namespace gaitpad
#endif  // GAITPAD_HAS_HIDRAW
