// The pad is a function here. A request is GET_REPORT as hidraw carries it (Linux's hidraw.rst,
// HIDIOCGINPUT): the first byte is the report id, 0 where reports have none.
#include "drivers/present_state.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>

#include "tests/comes_true.h"

namespace gaitpad {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Packet = std::vector<std::uint8_t>;

// Answers each id as set; can be made to wait. Shared with the thread that asks.
struct FakePad {
  std::mutex mutex;
  std::array<Packet, 256> answers;
  std::vector<std::uint8_t> asked;
  std::size_t space = 0;  // of the last request
  std::atomic<bool> is_stuck = false;

  std::size_t answer(std::uint8_t id, std::span<std::uint8_t> bytes) {
    {
      const std::lock_guard lock(mutex);
      asked.push_back(id);
      space = bytes.size();
    }
    while (is_stuck) std::this_thread::sleep_for(1ms);
    const std::lock_guard lock(mutex);
    std::copy_n(answers[id].begin(), std::min(bytes.size(), answers[id].size()), bytes.begin());
    return answers[id].size();
  }
  void set(std::uint8_t id, Packet bytes) {
    const std::lock_guard lock(mutex);
    answers[id] = std::move(bytes);
  }
  std::vector<std::uint8_t> asked_for() {
    const std::lock_guard lock(mutex);
    return asked;
  }
};

class PresentStateTest : public testing::Test {
 protected:
  void TearDown() override { pad_->is_stuck = false; }
  PresentState state(bool is_numbered) {
    return PresentState(is_numbered, [pad = pad_](std::uint8_t id, std::span<std::uint8_t> bytes) {
      return pad->answer(id, bytes);
    });
  }
  static void wait(const PresentState& state, std::chrono::milliseconds timeout) {
    auto fds = state.poll_fds();
    ::poll(fds.data(), fds.size(), static_cast<int>(timeout.count()));
  }
  // The answer within that time; empty: none.
  static Packet taken(PresentState& state, std::chrono::milliseconds timeout = kPatience) {
    const auto end = Clock::now() + timeout;
    while (state.is_waiting() && Clock::now() < end) {
      wait(state, 10ms);
      const auto report = state.take_answer();
      if (!report.empty()) return Packet(report.begin(), report.end());
    }
    return {};
  }
  void wait_until_asked(PresentState& state, std::size_t count) {
    EXPECT_TRUE(comes_true([&] {
      EXPECT_TRUE(state.take_answer().empty());
      return pad_->asked_for().size() == count;
    }));
  }

  std::shared_ptr<FakePad> pad_ = std::make_shared<FakePad>();
};

TEST_F(PresentStateTest, AfterAMissTheSilentPadsAnswerIsTheReport) {
  PresentState present = state(false);
  present.heard(Packet{9, 9});
  EXPECT_FALSE(present.is_waiting());
  EXPECT_TRUE(present.take_answer().empty());
  pad_->set(0, {0, 3, 4});
  const auto begin = Clock::now();
  present.missed();
  EXPECT_EQ(taken(present), (Packet{3, 4}));
  EXPECT_GE(Clock::now() - begin, 30ms);
  EXPECT_EQ(pad_->asked_for(), (std::vector<std::uint8_t>{0}));
  EXPECT_EQ(pad_->space, 3u) << "not a byte more than a report of this pad with its id";
  EXPECT_FALSE(present.is_waiting());
}

TEST_F(PresentStateTest, IdsThatWereSeenAndFellSilentAreAskedFor) {
  PresentState present = state(true);
  present.heard(Packet{1, 5, 5});
  present.heard(Packet{2, 6});
  present.heard(Packet{7, 7, 7, 7});
  pad_->set(1, {1, 8, 8});
  pad_->set(7, {7, 1, 2, 3});
  present.missed();
  present.heard(Packet{2, 7});
  EXPECT_EQ(taken(present), (Packet{1, 8, 8}));
  EXPECT_EQ(taken(present), (Packet{7, 1, 2, 3}));
  EXPECT_EQ(pad_->asked_for(), (std::vector<std::uint8_t>{1, 7}));
}

TEST_F(PresentStateTest, APadThatGoesOnIsNotAsked) {
  PresentState present = state(false);
  present.heard(Packet{9, 9});
  present.missed();
  present.heard(Packet{9, 8});
  EXPECT_FALSE(present.is_waiting());
  std::this_thread::sleep_for(60ms);
  EXPECT_TRUE(present.take_answer().empty());
  EXPECT_TRUE(pad_->asked_for().empty());
}

TEST_F(PresentStateTest, AnAnswerThatAReportHasOvertakenIsDropped) {
  PresentState present = state(false);
  present.heard(Packet{9, 9});
  pad_->set(0, {0, 3, 4});
  pad_->is_stuck = true;
  present.missed();
  wait_until_asked(present, 1);
  present.heard(Packet{5, 5});
  pad_->is_stuck = false;
  std::this_thread::sleep_for(50ms);
  EXPECT_TRUE(present.take_answer().empty());
}

TEST_F(PresentStateTest, AnAnswerFromBeforeTheNextMissIsDroppedAndThePadAskedAgain) {
  PresentState present = state(false);
  present.heard(Packet{9, 9});
  pad_->set(0, {0, 3, 4});
  pad_->is_stuck = true;
  present.missed();
  wait_until_asked(present, 1);
  pad_->is_stuck = false;
  std::this_thread::sleep_for(20ms);  // the answer is there and was not taken yet
  present.heard(Packet{5, 5});
  pad_->set(0, {0, 6, 7});
  present.missed();
  EXPECT_EQ(taken(present), (Packet{6, 7}));
  EXPECT_EQ(pad_->asked_for().size(), 2u);
}

TEST_F(PresentStateTest, ASecondMissWaitsForTheFirstOnesRequest) {
  PresentState present = state(false);
  present.heard(Packet{9, 9});
  pad_->set(0, {0, 3, 4});
  pad_->is_stuck = true;
  present.missed();
  wait_until_asked(present, 1);
  present.missed();
  EXPECT_TRUE(taken(present, 100ms).empty());
  EXPECT_EQ(pad_->asked_for().size(), 1u) << "never two requests at a time";
  pad_->is_stuck = false;
  EXPECT_EQ(taken(present), (Packet{3, 4}));
  EXPECT_EQ(pad_->asked_for().size(), 2u);
}

TEST_F(PresentStateTest, WhatIsNoStateOfThisPadIsNotHandedOn) {
  const std::vector<Packet> garbage = {{},        {1},       {1, 2},    {1, 2, 3, 4},
                                       {2, 2, 3}, {0, 2, 3}, {1, 0, 0}, Packet(2000, 1)};
  for (const Packet& answer : garbage) {
    PresentState present = state(true);
    present.heard(Packet{1, 5, 5});
    pad_->set(1, answer);
    present.missed();
    EXPECT_TRUE(taken(present).empty()) << answer.size() << " bytes";
    EXPECT_FALSE(present.is_waiting());
  }
  EXPECT_EQ(pad_->asked_for().size(), garbage.size()) << "once each";
  PresentState present = state(false);
  present.heard(Packet{5, 5});
  pad_->set(0, {3, 4, 5});
  present.missed();
  EXPECT_TRUE(taken(present).empty()) << "there are no ids, so there must be a 0";
}

TEST_F(PresentStateTest, ZerosAreBelievedOfAPadThatReportsThem) {
  PresentState present = state(true);
  present.heard(Packet{1, 0, 0});
  present.heard(Packet{1, 5, 5});
  pad_->set(1, {1, 0, 0});
  present.missed();
  EXPECT_EQ(taken(present), (Packet{1, 0, 0}));
}

TEST_F(PresentStateTest, APadThatNeverAnswersHoldsNobodyUp) {
  pad_->is_stuck = true;
  {
    PresentState present = state(false);
    present.heard(Packet{9, 9});
    present.missed();
    wait_until_asked(present, 1);
    EXPECT_TRUE(taken(present, 50ms).empty());
  }
  EXPECT_TRUE(pad_->is_stuck) << "it is gone, and the pad has still not answered";
}

TEST_F(PresentStateTest, APadThatRefusesOnlyAfterASecondIsNotAskedAgain) {
  PresentState present = state(true);
  present.heard(Packet{1, 5, 5});
  present.heard(Packet{2, 5, 5});
  pad_->is_stuck = true;
  present.missed();
  wait_until_asked(present, 1);
  std::this_thread::sleep_for(1100ms);
  pad_->is_stuck = false;
  EXPECT_TRUE(taken(present, 100ms).empty());
  for (int i = 0; i < 2; ++i) {
    present.missed();
    EXPECT_TRUE(taken(present, 100ms).empty());
    EXPECT_FALSE(present.is_waiting());
  }
  EXPECT_EQ(pad_->asked_for(), (std::vector<std::uint8_t>{1}));
}

TEST_F(PresentStateTest, OfAPadWithEveryIdNotAllAreAskedFor) {
  PresentState present = state(true);
  for (int id = 0; id < 256; ++id) present.heard(Packet{static_cast<std::uint8_t>(id), 1});
  present.missed();
  EXPECT_TRUE(taken(present, 300ms).empty());
  EXPECT_LE(pad_->asked_for().size(), 16u);
}

TEST_F(PresentStateTest, WithoutAWayToAskOrAReportNothingIsAsked) {
  PresentState without(false, nullptr);
  without.heard(Packet{9, 9});
  without.missed();
  EXPECT_FALSE(without.is_waiting());
  PresentState present = state(false);
  present.heard(Packet{});
  present.missed();
  EXPECT_FALSE(present.is_waiting());
}

}  // namespace
}  // namespace gaitpad
