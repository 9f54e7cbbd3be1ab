#include "drivers/pads/packet_sender.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>

#include "tests/comes_true.h"

namespace gaitpad {
namespace {

using namespace std::chrono_literals;

OutPacket packet(std::uint8_t value, std::chrono::milliseconds repeat = 0ms) {
  OutPacket p;
  p.bytes[0] = value;
  p.size = 2;
  p.repeat = repeat;
  return p;
}

// Receives the packets; blocks the writer while it is closed.
class Sink {
 public:
  PacketSender::Write write() {
    return [this](const OutPacket& packet) {
      std::unique_lock lock(mutex_);
      ++entered_;
      changed_.notify_all();
      changed_.wait(lock, [this] { return is_open_; });
      got_.push_back(packet.bytes[0]);
      changed_.notify_all();
      return is_working.load();
    };
  }
  void open(bool is_open) {
    const std::lock_guard lock(mutex_);
    is_open_ = is_open;
    changed_.notify_all();
  }
  bool waits_for_entered(std::size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, kPatience, [&] { return entered_ >= count; });
  }
  std::vector<std::uint8_t> wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, kPatience, [&] { return got_.size() >= count; });
    return got_;
  }
  std::vector<std::uint8_t> got() { return wait_for(0); }
  std::atomic<bool> is_working = true;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t entered_ = 0;
  std::vector<std::uint8_t> got_;
  bool is_open_ = true;
};

// As in hidraw_driver, the target of the writes lives as long as the thread.
std::unique_ptr<PacketSender> sender_to(const std::shared_ptr<Sink>& sink) {
  return PacketSender::create(
      [sink, write = sink->write()](const OutPacket& packet) { return write(packet); });
}

TEST(PacketSender, SendsWhatWaitsBeforeItEnds) {
  for (int i = 0; i < 20; ++i) {
    const auto sink = std::make_shared<Sink>();
    auto sender = sender_to(sink);
    EXPECT_TRUE(sender->send(packet(7)));
    sender.reset();
    EXPECT_EQ(sink->wait_for(1), (std::vector<std::uint8_t>{7}));
  }
}

TEST(PacketSender, APadThatTakesNothingHoldsNobodyUpAndGetsTheNewestPacketThatWaits) {
  const auto sink = std::make_shared<Sink>();
  sink->open(false);
  auto sender = sender_to(sink);
  sender->send(packet(0));
  ASSERT_TRUE(sink->waits_for_entered(1));
  for (std::uint8_t i = 1; i < 100; ++i) EXPECT_TRUE(sender->send(packet(i)));
  sender.reset();
  EXPECT_TRUE(sink->got().empty()) << "the sender is gone, and nothing has left yet";
  sink->open(true);  // unblocks the writer, so that the thread ends
  EXPECT_EQ(sink->wait_for(2), (std::vector<std::uint8_t>{0, 99}));
}

TEST(PacketSender, RepeatsUntilAnotherPacketFollows) {
  const auto sink = std::make_shared<Sink>();
  const auto sender = sender_to(sink);
  sender->send(packet(1, 5ms));
  EXPECT_GE(sink->wait_for(3).size(), 3u);
  sender->send(packet(0));
  EXPECT_TRUE(comes_true([&] { return sink->got().back() == 0; }));
  const std::size_t count = sink->got().size();
  std::this_thread::sleep_for(30ms);
  EXPECT_EQ(sink->got().size(), count);
}

TEST(PacketSender, TellsThatPacketsDoNotLeaveAndStopsRepeatingThem) {
  const auto sink = std::make_shared<Sink>();
  sink->is_working = false;
  const auto sender = sender_to(sink);
  EXPECT_TRUE(sender->send(packet(1, 1ms)));
  sink->wait_for(1);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(sink->got().size(), 1u);
  EXPECT_TRUE(comes_true([&] { return !sender->send(packet(2)); }));
}

}  // namespace
}  // namespace gaitpad
