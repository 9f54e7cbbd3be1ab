#include "drivers/pads/packet_sender.h"

#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <mutex>

namespace gaitpad {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

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
    return [this](std::span<const std::uint8_t> bytes) {
      std::unique_lock lock(mutex_);
      ++entered_;
      changed_.notify_all();
      changed_.wait(lock, [this] { return is_open_; });
      got_.push_back(bytes[0]);
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
    return changed_.wait_for(lock, 10s, [&] { return entered_ >= count; });
  }
  std::vector<std::uint8_t> wait_for(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, 10s, [&] { return got_.size() >= count; });
    return got_;
  }
  std::atomic<bool> is_working = true;

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t entered_ = 0;
  std::vector<std::uint8_t> got_;
  bool is_open_ = true;
};

TEST(PacketSender, SendsWhatWaitsBeforeItEnds) {
  for (int i = 0; i < 100; ++i) {
    Sink sink;
    auto sender = PacketSender::create(sink.write());
    EXPECT_TRUE(sender->send(packet(7)));
    sender.reset();
    EXPECT_EQ(sink.wait_for(1), (std::vector<std::uint8_t>{7}));
  }
}

TEST(PacketSender, OfPacketsThatWaitTheNewestIsSent) {
  Sink sink;
  sink.open(false);
  const auto sender = PacketSender::create(sink.write());
  sender->send(packet(1));
  ASSERT_TRUE(sink.waits_for_entered(1));
  for (std::uint8_t i = 2; i < 9; ++i) sender->send(packet(i));
  sink.open(true);
  EXPECT_EQ(sink.wait_for(2), (std::vector<std::uint8_t>{1, 8}));
}

TEST(PacketSender, RepeatsUntilAnotherPacketFollows) {
  Sink sink;
  const auto sender = PacketSender::create(sink.write());
  sender->send(packet(1, 5ms));
  EXPECT_GE(sink.wait_for(3).size(), 3u);
  sender->send(packet(0));
  while (sink.wait_for(1).back() != 0) std::this_thread::sleep_for(1ms);
  const std::size_t count = sink.wait_for(1).size();
  std::this_thread::sleep_for(30ms);
  EXPECT_EQ(sink.wait_for(1).size(), count);
}

TEST(PacketSender, APadThatTakesNothingHoldsNobodyUp) {
  const auto sink = std::make_shared<Sink>();
  sink->open(false);
  // Like hidraw_driver: the target of the writes lives as long as the thread.
  auto sender = PacketSender::create(
      [sink, write = sink->write()](std::span<const std::uint8_t> bytes) { return write(bytes); });
  const auto begin = Clock::now();
  sender->send(packet(0));
  ASSERT_TRUE(sink->waits_for_entered(1));
  for (std::uint8_t i = 1; i < 100; ++i) EXPECT_TRUE(sender->send(packet(i)));
  sender.reset();
  EXPECT_LT(Clock::now() - begin, 2s);
  sink->open(true);  // the thread ends
  EXPECT_EQ(sink->wait_for(2), (std::vector<std::uint8_t>{0, 99}));
}

TEST(PacketSender, TellsThatPacketsDoNotLeaveAndStopsRepeatingThem) {
  Sink sink;
  sink.is_working = false;
  const auto sender = PacketSender::create(sink.write());
  EXPECT_TRUE(sender->send(packet(1, 1ms)));
  sink.wait_for(1);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(sink.wait_for(1).size(), 1u);
  EXPECT_FALSE(sender->send(packet(2)));
}

}  // namespace
}  // namespace gaitpad
