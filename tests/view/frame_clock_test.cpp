// Tests when frames begin, on a display that takes one frame at each refresh.
#include "view/frame_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

constexpr std::int64_t kMs = 1'000'000;

// Takes a picture at the first refresh after it is ready; then the next frame can be drawn.
struct Display {
  double period_ns;
  std::int64_t refresh_ns(std::int64_t ready_ns) const {
    return static_cast<std::int64_t>(std::ceil(static_cast<double>(ready_ns) / period_ns) *
                                     period_ns);
  }
};

struct Seen {
  std::int64_t worst_age_ns = 0;  // age of a frame's state when the display takes it
  int missed = 0;                 // number of refreshes without a new frame
};

// Draws `frames` frames; `work` gives the time of each. Frames before the pacer has measured the
// display are not counted.
template <class Work>
Seen draw(FramePacer& pacer, const Display& display, int frames, const Work& work) {
  Seen seen;
  std::int64_t free_ns = 100 * kMs;
  for (int i = 0; i < frames; ++i) {
    const std::int64_t begin_ns = pacer.begin_ns(free_ns);
    EXPECT_GE(begin_ns, free_ns);
    const std::int64_t ready_ns = begin_ns + work(i);
    pacer.note_work(work(i));
    const std::int64_t taken_ns = display.refresh_ns(ready_ns + 1);
    if (i > FramePacer::kMeasured + 1) {
      seen.worst_age_ns = std::max(seen.worst_age_ns, taken_ns - begin_ns);
      seen.missed += static_cast<double>(taken_ns - free_ns) > 1.5 * display.period_ns;
    }
    free_ns = taken_ns + 50'000;
  }
  return seen;
}

TEST(FramePacer, BeginsAsLateAsTheWorkAllows) {
  FramePacer pacer;
  const Seen seen = draw(pacer, {1e9 / 60.0}, 900, [](int) { return 4 * kMs; });
  EXPECT_LE(seen.worst_age_ns, 4 * kMs + FramePacer::kMargin_ns + kMs / 2)
      << "work and margin; without the pacer 16.6 ms";
  EXPECT_EQ(seen.missed, 0);
}

TEST(FramePacer, MissesOneRefreshWhenTheWorkGrowsAndNoMoreAfterIt) {
  FramePacer pacer;
  const Seen seen =
      draw(pacer, {1e9 / 60.0}, 900, [](int i) { return i < 400 ? 3 * kMs : 9 * kMs; });
  EXPECT_LE(seen.missed, 1);
}

TEST(FramePacer, KeepsEveryRefreshWithWorkThatVaries) {
  FramePacer pacer;
  const Seen seen =
      draw(pacer, {1e9 / 144.0}, 3000, [](int i) { return kMs + i * 7919 % 13 * kMs / 10; });
  EXPECT_LE(seen.missed, 3000 / FramePacer::kCycle + 1);
}

TEST(FramePacer, DoesNotDelayWhereTheDisplayDoesNotLimitTheFrames) {
  FramePacer pacer;
  std::int64_t free_ns = kMs;
  for (int i = 0; i < 200; ++i, free_ns += kMs / 2) EXPECT_EQ(pacer.begin_ns(free_ns), free_ns);
}

TEST(FramePacer, DoesNotDelayFramesThatTakeLongerThanTheDisplaysPeriod) {
  FramePacer pacer;
  std::int64_t free_ns = kMs;
  for (int i = 0; i < 200; ++i, free_ns += 20 * kMs) {
    EXPECT_EQ(pacer.begin_ns(free_ns), free_ns);
    pacer.note_work(19 * kMs);
  }
}

TEST(FramePacer, FollowsAnotherDisplay) {
  FramePacer pacer;
  draw(pacer, {1e9 / 60.0}, 300, [](int) { return 2 * kMs; });
  pacer.start_again();
  const Seen seen = draw(pacer, {1e9 / 144.0}, 300, [](int) { return 2 * kMs; });
  EXPECT_EQ(seen.missed, 0);
  EXPECT_LE(seen.worst_age_ns, 2 * kMs + FramePacer::kMargin_ns + kMs / 2);
}

}  // namespace
}  // namespace gaitpad
