// The GameCube adapter (SDL's SDL_hidapi_gamecube.c) behind a driver that opens it once.
#include "drivers/shared_pads.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <deque>

#include "drivers/pads/pads_of_devices.h"
#include "drivers/scripted_port.h"

namespace gaitpad {
namespace {

using Status = Device::Status;

struct Adapter {  // declared first, because it has to outlive the pads
  std::deque<Packet> packets;
  std::vector<Packet> sent;
  bool is_gone = false, is_closed = false;
};

class AdapterPackets final : public PacketSource {
 public:
  explicit AdapterPackets(Adapter& adapter) : adapter_(adapter) {}
  ~AdapterPackets() override { adapter_.is_closed = true; }
  std::span<const pollfd> poll_fds() const noexcept override { return {}; }
  Status read(Report& packet) noexcept override {
    if (adapter_.packets.empty()) return adapter_.is_gone ? Status::gone : Status::nothing;
    packet = {};
    packet.size = static_cast<std::uint16_t>(adapter_.packets.front().size());
    std::copy(adapter_.packets.front().begin(), adapter_.packets.front().end(),
              packet.bytes.begin());
    adapter_.packets.pop_front();
    return Status::report;
  }
  bool send(const OutPacket& packet) noexcept override {
    adapter_.sent.push_back(bytes_of(packet));
    return true;
  }
  std::int64_t lost() const noexcept override { return 0; }

 private:
  Adapter& adapter_;
};

class SharedPads : public testing::Test {
 protected:
  SharedPads() {
    DeviceListing listing;
    listing.info.vendor = 0x057e;
    listing.info.product = 0x0337;
    listing.info.physical_path = "usb-1/input0";
    const auto pads = split_pads(listing);
    auto device = std::make_shared<SharedDevice>(std::make_unique<AdapterPackets>(adapter_));
    one_ = open_shared_pad(device, pads.at(0).info);
    two_ = open_shared_pad(device, pads.at(1).info);
  }
  // A packet arrives: the first two plugs have these types, and their sticks this X.
  void arrive(std::uint8_t one, std::uint8_t two, std::uint8_t x) {
    Packet packet(37);
    packet[0] = 0x21;
    packet[1] = one;
    packet[1 + 9] = two;
    packet[1 + 3] = packet[1 + 9 + 3] = x;
    adapter_.packets.push_back(packet);
  }
  // True if the pad has a packet to read.
  static bool is_rung(const Device& pad) {
    pollfd bell = pad.poll_fds().back();
    return ::poll(&bell, 1, 0) == 1;
  }

  Adapter adapter_;
  std::unique_ptr<Device> one_, two_;
  Report report_;
};

TEST_F(SharedPads, EachTakesEveryPacket) {
  EXPECT_EQ(adapter_.sent.front(), (Packet{0x13, 0x00})) << "hidraw refuses an id alone";
  for (const std::uint8_t x : {10, 20, 30}) arrive(0x14, 0x14, x);
  for (const int x : {10, 20, 30}) {
    ASSERT_EQ(one_->read(report_), Status::report);
    EXPECT_EQ(report_.bytes[4], x);
  }
  EXPECT_EQ(one_->read(report_), Status::nothing);
  EXPECT_FALSE(is_rung(*one_));
  EXPECT_TRUE(is_rung(*two_)) << "its packets came with a read of the other pad";
  for (const int x : {10, 20, 30}) {
    ASSERT_EQ(two_->read(report_), Status::report);
    EXPECT_EQ(report_.bytes[13], x);
  }
  EXPECT_EQ(two_->read(report_), Status::nothing);
  EXPECT_FALSE(is_rung(*two_));
}

TEST_F(SharedPads, APlugIsFilledAndEmptiedByItself) {
  arrive(0x14, 0x04, 0);
  EXPECT_EQ(one_->read(report_), Status::report);
  EXPECT_EQ(report_.kind, ReportKind::input);
  ASSERT_EQ(two_->read(report_), Status::report);
  EXPECT_EQ(report_.kind, ReportKind::removed);
  arrive(0x14, 0x14, 0);
  ASSERT_EQ(two_->read(report_), Status::report);
  EXPECT_EQ(report_.kind, ReportKind::added);
}

TEST_F(SharedPads, APadThatNobodyReadsLosesItsOldestPackets) {
  for (int i = 0; i < 200; ++i) {
    arrive(0x14, 0x14, static_cast<std::uint8_t>(i));
    ASSERT_EQ(one_->read(report_), Status::report);
  }
  ASSERT_EQ(two_->read(report_), Status::report);
  EXPECT_EQ(report_.bytes[13], 200 - 64);
  EXPECT_EQ(two_->lost(), 200 - 64);
  EXPECT_EQ(one_->lost(), 0);
}

TEST_F(SharedPads, TheDeviceIsClosedWithItsLastPad) {
  arrive(0x14, 0x14, 0);
  EXPECT_EQ(one_->read(report_), Status::report);
  EXPECT_TRUE(one_->rumble({1, 0}));
  EXPECT_EQ(adapter_.sent.back(), (Packet{0x11, 1, 0, 0, 0}));
  one_.reset();
  EXPECT_EQ(adapter_.sent.back(), (Packet{0x11, 0, 0, 0, 0})) << "a closed pad is still";
  EXPECT_FALSE(adapter_.is_closed);
  adapter_.is_gone = true;
  EXPECT_EQ(two_->read(report_), Status::report) << "what came before the end";
  EXPECT_EQ(two_->read(report_), Status::gone);
  two_.reset();
  EXPECT_TRUE(adapter_.is_closed);
}

}  // namespace
}  // namespace gaitpad
