#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>
#include <vector>

#include "drivers/posix.h"
#include "gaitpad/decode.h"
#include "gaitpad/keyboard.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;

struct Seen {
  std::int64_t time_ns;
  vec2 stick;
};

class KeyboardDeviceTest : public testing::Test {
 protected:
  void SetUp() override {
    device_ = value_of(open_keyboard(stick_));
    layout_ = value_of(pad_layout(device_->info(), {}));
  }
  // As the I/O thread: reads whenever there is something, for that long.
  std::vector<Seen> seen_for(int ms) {
    std::vector<Seen> all;
    const std::int64_t end_ns = now_ns() + ms * kMillisecond_ns;
    Report report;
    PadState state;
    while (now_ns() < end_ns) {
      while (device_->read(report) == Device::Status::report) {
        EXPECT_TRUE(decode(layout_, report, state));
        all.push_back({report.time_ns, vec2(state.axis[kLeftX], state.axis[kLeftY])});
      }
      std::vector<pollfd> fds(device_->poll_fds().begin(), device_->poll_fds().end());
      ::poll(fds.data(), fds.size(), 5);
      wakes_ += fds[0].revents != 0 || fds[1].revents != 0;
    }
    return all;
  }

  std::shared_ptr<KeyboardStick> stick_ = std::make_shared<KeyboardStick>();
  std::unique_ptr<Device> device_;
  PadLayout layout_;
  int wakes_ = 0;
};

TEST_F(KeyboardDeviceTest, IsAPadWithOneStickOnAVirtualBus) {
  EXPECT_TRUE(layout_.is_pad);
  EXPECT_EQ(device_->info().driver, "keyboard");
  EXPECT_EQ(device_->info().bus, BusType::virtual_bus);
  EXPECT_EQ(device_->info().vendor, 0);
  EXPECT_EQ(device_->info().product, 0);
  ASSERT_EQ(layout_.reports.size(), 1u);
  EXPECT_EQ(layout_.reports[0].axes.size(), 2u);
}

TEST_F(KeyboardDeviceTest, TellsItsRestOnceAndIsSilentThen) {
  const auto seen = seen_for(150);
  ASSERT_EQ(seen.size(), 1u);
  EXPECT_EQ(seen[0].stick, vec2(0.0));
  EXPECT_EQ(wakes_, 0);
}

TEST_F(KeyboardDeviceTest, ForwardIsReachedInASixthOfASecondWithoutALeap) {
  seen_for(20);
  const std::int64_t begin_ns = now_ns();
  stick_->steer(vec2(0.0, 1.0));
  const auto seen = seen_for(400);
  ASSERT_GT(seen.size(), 9u) << "a busy computer leaves some out";
  EXPECT_LE(seen.size(), 40u) << "250 a second for 0.15 s, then none";
  double before = 0.0;
  for (const Seen& s : seen) {
    EXPECT_EQ(s.stick.x, 0.0);
    EXPECT_GT(s.stick.y, before) << "changes alone";
    EXPECT_LE(s.stick.y - before, 0.016 / 0.15 + 1e-4);
    before = s.stick.y;
  }
  EXPECT_EQ(before, 1.0);
  const double took_s = static_cast<double>(seen.back().time_ns - begin_ns) * 1e-9;
  EXPECT_GT(took_s, 0.14);
  EXPECT_LT(took_s, 0.35);
}

TEST_F(KeyboardDeviceTest, GoesBackToTheExactMiddleAndQuicker) {
  stick_->steer(vec2(-1.0, 0.0));
  EXPECT_EQ(seen_for(300).back().stick, vec2(-1.0, 0.0));
  const std::int64_t begin_ns = now_ns();
  stick_->steer(vec2(0.0));
  const auto seen = seen_for(300);
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back().stick, vec2(0.0));
  EXPECT_FALSE(std::signbit(seen.back().stick.x));
  EXPECT_LE(seen.size(), 27u);
  EXPECT_GT(static_cast<double>(seen.back().time_ns - begin_ns) * 1e-9, 0.09);
}

TEST_F(KeyboardDeviceTest, ADiagonalIsNoLongerThanAStraightOne) {
  stick_->steer(vec2(1.0, 1.0));
  auto seen = seen_for(300);
  EXPECT_NEAR(seen.back().stick.x, std::sqrt(0.5), 1e-4);
  EXPECT_EQ(seen.back().stick.x, seen.back().stick.y);
  EXPECT_LE(glm::length(seen.back().stick), 1.0);
  stick_->steer(vec2(1.0, -1.0));
  for (const Seen& s : seen_for(400)) EXPECT_LE(glm::length(s.stick), 1.0 + 1e-4);
}

TEST_F(KeyboardDeviceTest, WhatIsNoPlaceIsTheMiddle) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const vec2& wanted : {vec2(nan, 1.0), vec2(1.0, nan), vec2(infinity, 0.0)}) {
    stick_->steer(wanted);
    EXPECT_EQ(stick_->wanted(), vec2(0.0));
  }
  stick_->steer(vec2(1e300, 1e300));
  EXPECT_LE(glm::length(stick_->wanted()), 1.0);
}

// After any sequence of requests it ends where the last one asked.
TEST_F(KeyboardDeviceTest, NoChangeIsMissedWhileItFallsAsleep) {
  std::atomic<bool> is_over{false};
  std::thread source([&] {
    for (int i = 0; i < 1500; ++i) {
      stick_->steer(vec2(i % 2 == 0 ? 0.02 : 0.0, 0.0));
      std::this_thread::sleep_for(std::chrono::microseconds(200 + i % 7 * 130));
    }
    stick_->steer(vec2(0.0, -0.5));
    is_over = true;
  });
  while (!is_over) seen_for(20);
  source.join();
  const auto seen = seen_for(200);
  ASSERT_FALSE(seen.empty());
  EXPECT_NEAR(seen.back().stick.y, -0.5, 1e-4);
}

}  // namespace
}  // namespace gaitpad
