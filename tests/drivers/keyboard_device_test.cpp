#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <thread>
#include <vector>

#include "gaitpad/decode.h"
#include "gaitpad/keyboard.h"
#include "system/clock.h"
#include "tests/comes_true.h"
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
  // Reads like the I/O thread for `ms`, or until the stick is at `until`.
  std::vector<Seen> seen_for(int ms, std::optional<vec2> until = std::nullopt) {
    std::vector<Seen> all;
    const std::int64_t end_ns = now_ns() + ms * kMillisecond_ns;
    Report report;
    PadState state;
    do {
      while (device_->read(report) == Device::Status::report) {
        EXPECT_TRUE(decode(layout_, report, state));
        all.push_back({report.time_ns, vec2(state.axis[kLeftX], state.axis[kLeftY])});
      }
      std::vector<pollfd> fds(device_->poll_fds().begin(), device_->poll_fds().end());
      ::poll(fds.data(), fds.size(), 5);
      wakes_ += fds[0].revents != 0 || fds[1].revents != 0;
      if (until && !all.empty() && glm::distance(all.back().stick, *until) < 1e-4) break;
    } while (now_ns() < end_ns);
    return all;
  }
  // Reports until the stick has arrived; then it is silent.
  std::vector<Seen> steered(const vec2& wanted, const vec2& place) {
    stick_->steer(wanted);
    auto seen = seen_for(60'000, place);
    // A last count may still come, on a busy machine later than the one before it.
    for (const Seen& s : seen_for(30)) seen.push_back(s);
    EXPECT_EQ(seen_for(30).size(), 0u);
    EXPECT_FALSE(seen.empty());
    if (seen.empty()) seen.push_back({});
    return seen;
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

// Time stamps measure the durations, so that a late thread does not matter: a step covers the time
// since the last step, at most 16 ms.
TEST_F(KeyboardDeviceTest, ForwardIsReachedIn150MillisecondsAndTheExactMiddleIn100) {
  seen_for(20);
  for (const auto& [wanted, whole_s] : {std::pair(vec2(0.0, 1.0), 0.15), {vec2(0.0), 0.10}}) {
    double before = 1.0 - wanted.y;
    std::int64_t before_ns = 0;
    const auto seen = steered(wanted, wanted);
    EXPECT_LE(static_cast<double>(seen.size()), 250.0 * whole_s + 2.0) << "250 a second, then none";
    for (const Seen& s : seen) {
      const double step = std::abs(s.stick.y - before);
      const double time_s = 1e-9 * static_cast<double>(s.time_ns - before_ns);
      const double most = std::min(time_s, 0.016) / whole_s;
      EXPECT_EQ(s.stick.x, 0.0);
      EXPECT_GT(step, 0.0) << "changes alone";
      if (before_ns != 0 && &s != &seen.back()) {
        EXPECT_NEAR(step, most, 1e-4);
      }
      EXPECT_LE(step, most + 1e-4);
      before = s.stick.y;
      before_ns = s.time_ns;
    }
    EXPECT_EQ(seen.back().stick, wanted);
    EXPECT_FALSE(std::signbit(seen.back().stick.x) || std::signbit(seen.back().stick.y));
  }
}

TEST_F(KeyboardDeviceTest, ADiagonalIsNoLongerThanAStraightOne) {
  const double part = std::sqrt(0.5);
  const auto seen = steered(vec2(1.0, 1.0), vec2(part, part));
  EXPECT_EQ(seen.back().stick.x, seen.back().stick.y);
  EXPECT_LE(glm::length(seen.back().stick), 1.0);
  for (const Seen& s : steered(vec2(1.0, -1.0), vec2(part, -part)))
    EXPECT_LE(glm::length(s.stick), 1.0 + 1e-4);
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

// After any sequence of requests the stick ends at the last one.
TEST_F(KeyboardDeviceTest, NoChangeIsMissedWhileItFallsAsleep) {
  std::atomic<bool> is_over{false};
  std::thread source([&] {
    for (int i = 0; i < 500; ++i) {
      stick_->steer(vec2(i % 2 == 0 ? 0.02 : 0.0, 0.0));
      std::this_thread::sleep_for(std::chrono::microseconds(200 + i % 7 * 130));
    }
    stick_->steer(vec2(0.0, -0.5));
    is_over = true;
  });
  vec2 last(0.0);
  EXPECT_TRUE(comes_true([&] {
    for (const Seen& s : seen_for(20)) last = s.stick;
    return is_over && glm::distance(last, vec2(0.0, -0.5)) < 1e-4;
  }));
  source.join();
}

}  // namespace
}  // namespace gaitpad
