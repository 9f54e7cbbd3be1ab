#include "session/history.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

TickSample sample(std::int64_t tick, Stage stage = Stage::idle, Side swing = kLeftSide) {
  TickSample s;
  s.tick = tick;
  s.walker_count = 1;
  s.walkers[0].stage = stage;
  s.walkers[0].swing = swing;
  return s;
}

// Adds whole cycles of 40 ticks from tick `tick` on: roll right 5, flight left 15, roll left 5,
// flight right 15, each cycle beginning with the right foot's landing.
std::int64_t add_cycles(History& history, std::int64_t tick, int cycles) {
  for (int c = 0; c < cycles; ++c) {
    for (int i = 0; i < 40; ++i) {
      const bool is_roll = i % 20 < 5;
      const bool is_right = is_roll ? i < 20 : i >= 20;
      history.add(
          sample(tick++, is_roll ? Stage::roll : Stage::flight, is_right ? kRightSide : kLeftSide));
    }
  }
  return tick;
}
std::int64_t add_rest(History& history, std::int64_t tick, int ticks) {
  for (int i = 0; i < ticks; ++i) history.add(sample(tick++));
  return tick;
}

TEST(History, HoldsTheNewestInTheirOrder) {
  History history(4);
  for (int i = 0; i < 10; ++i) history.add(sample(i));
  ASSERT_EQ(history.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(history[i].tick, static_cast<std::int64_t>(6 + i));
}

TEST(History, BeginsAnewWhereATickDoesNotFollow) {
  History history(8);
  for (const std::int64_t tick : {0, 1, 2}) history.add(sample(tick));
  history.add(sample(7));
  ASSERT_EQ(history.size(), 1u);
  EXPECT_EQ(history[0].tick, 7);
  // The same tick does not follow the newest one, so the history begins anew.
  history.add(sample(7));
  EXPECT_EQ(history.size(), 1u);
  TickSample other = sample(8);
  other.walker_count = 2;
  history.add(other);
  EXPECT_EQ(history.size(), 1u);
}

TEST(History, EvenOneOfNoRoomHoldsASample) {
  History history(0);
  history.add(sample(0));
  history.add(sample(1));
  ASSERT_EQ(history.size(), 1u);
  EXPECT_EQ(history[0].tick, 1);
}

TEST(History, CyclesRunFromOneLandingOfTheRightFootToAnother) {
  History history;
  std::int64_t tick = add_rest(history, 0, 10);
  tick = add_cycles(history, tick, 3);
  history.add(sample(tick, Stage::roll, kRightSide));  // the fourth landing ends the third cycle
  const History::Span two = history.newest_cycles(0, 2);
  EXPECT_EQ(two.begin, 50u);
  EXPECT_EQ(two.end, 130u);
  EXPECT_EQ(history.newest_cycles(0, 2).begin, 50u);
  EXPECT_EQ(history.newest_cycles(0, 3).begin, 10u);
  EXPECT_EQ(history.newest_cycles(0, 4).begin, history.size());
}

TEST(History, ARestIsInNoCycle) {
  History history;
  std::int64_t tick = add_cycles(history, add_rest(history, 0, 5), 3);
  tick = add_rest(history, tick, 30);
  add_cycles(history, tick, 1);
  const History::Span two = history.newest_cycles(0, 2);  // the last two cycles before the rest
  EXPECT_EQ(two.begin, 5u);
  EXPECT_EQ(two.end, 85u);
}

TEST(History, WhoIsNotThereHasNoCycles) {
  History history;
  EXPECT_EQ(history.newest_cycles(0, 1).begin, 0u);
  add_cycles(history, 0, 4);
  for (const int walker : {-1, 1, 99}) {
    EXPECT_EQ(history.newest_cycles(walker, 1).begin, history.size());
  }
  EXPECT_EQ(history.newest_cycles(0, 0).begin, history.size());
}

}  // namespace
}  // namespace gaitpad
