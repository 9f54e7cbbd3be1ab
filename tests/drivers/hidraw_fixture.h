// The hidraw driver over a stand-in for hidapi, whose functions take the library's place in this
// program (they are in hidraw_driver_test.cpp). A pseudo-terminal is the node, so that descriptors,
// poll() and hanging up are real; what a read gives can be scripted. A real hidraw is in the rig.
#pragma once
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/driver_entries.h"
#include "tests/value_of.h"

namespace gaitpad {

using Packet = std::vector<std::uint8_t>;

namespace stand_in {

struct ScriptedRead {
  Packet bytes;
  int error = -1;  // -1: none, the bytes are read; else -1 is returned with this errno
};
inline std::deque<ScriptedRead> script;  // empty: the node itself is read
inline std::vector<int> timeouts;        // of the reads
inline ScriptedRead failure(int error) { return {.bytes = {}, .error = error}; }
inline int descriptors_per_opening = 1;
inline std::optional<Packet> firmware;  // feature report 0x20
// Input report by request, the id first; asked for by a thread of the driver's.
inline struct PresentReport {
  std::mutex mutex;
  std::optional<Packet> answer;
  std::vector<int> asked;  // ids
} present;

}  // namespace stand_in

// X and Y of 8 bits, no report id.
inline const Packet kDescriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x09, 0x30,
                                   0x09, 0x31, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75,
                                   0x08, 0x95, 0x02, 0x81, 0x02, 0xc0};
// The same in report 1.
inline const Packet kNumbered = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x85, 0x01,
                                 0x09, 0x30, 0x09, 0x31, 0x15, 0x00, 0x26, 0xff,
                                 0x00, 0x75, 0x08, 0x95, 0x02, 0x81, 0x02, 0xc0};

using Status = Device::Status;
using namespace stand_in;

class HidrawDriver : public testing::Test {
 protected:
  void SetUp() override {
    script.clear();
    timeouts.clear();
    descriptors_per_opening = 1;
    firmware.reset();
    set_present(std::nullopt);
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
  // All that the driver has written, once there is that much or half a second is over.
  Packet written(std::size_t size) {
    Packet bytes(4096);
    std::size_t count = 0;
    for (int i = 0; i < 500 && count < size; ++i) {
      const ssize_t more = ::read(pad_, bytes.data() + count, bytes.size() - count);
      if (more > 0)
        count += static_cast<std::size_t>(more);
      else
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    bytes.resize(count);
    return bytes;
  }
  static void set_present(std::optional<Packet> answer) {
    const std::lock_guard lock(present.mutex);
    present.answer = std::move(answer);
    present.asked.clear();
  }
  static std::vector<int> asked() {
    const std::lock_guard lock(present.mutex);
    return present.asked;
  }
  // Reads this many reports in a row, then `nothing`.
  void read_in_a_row(Device& device, int count, const Packet& bytes = {1, 2}) {
    for (int i = 0; i < count; ++i) script.push_back({.bytes = bytes});
    for (int i = 0; i < count; ++i) EXPECT_EQ(device.read(report_), Status::report);
    EXPECT_EQ(device.read(report_), Status::nothing);
  }
  // As the I/O thread does it, that long or until there is a report.
  Status wait_and_read(Device& device, int timeout_ms) {
    Status status = Status::nothing;
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(timeout_ms);
    while (status == Status::nothing && std::chrono::steady_clock::now() < end) {
      std::vector<pollfd> fds(device.poll_fds().begin(), device.poll_fds().end());
      if (::poll(fds.data(), fds.size(), 10) > 0) status = device.read(report_);
    }
    return status;
  }
  std::unique_ptr<Device> opened() { return value_of(open_hidraw_device(listing_, Detach::never)); }
  // A model whose motors and firmware are known.
  void use(std::uint16_t vendor, std::uint16_t product) {
    listing_.info.vendor = vendor;
    listing_.info.product = product;
  }
  void expect_stamped_now() const {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    EXPECT_NEAR(static_cast<double>(report_.time_ns), now.tv_sec * 1e9 + now.tv_nsec, 1e9);
  }
  static bool is_ready(const Device& device, int timeout_ms) {
    pollfd fd = device.poll_fds().front();
    return ::poll(&fd, 1, timeout_ms) > 0;
  }
  static Packet bytes_of(const Report& report) {
    return Packet(report.bytes.begin(), report.bytes.begin() + report.size);
  }

  int pad_ = -1, keep_open_ = -1;
  DeviceListing listing_;
  Report report_;
};

}  // namespace gaitpad
