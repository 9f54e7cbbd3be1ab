#include "base/latest.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

namespace gaitpad {
namespace {

TEST(Latest, NothingIsNewBeforeTheFirst) {
  Latest<int> latest;
  bool is_new = true;
  EXPECT_EQ(latest.read(is_new), 0);
  EXPECT_FALSE(is_new);
}

TEST(Latest, IsNewOnceAndStays) {
  Latest<int> latest;
  latest.writable() = 7;
  latest.publish();
  bool is_new = false;
  EXPECT_EQ(latest.read(is_new), 7);
  EXPECT_TRUE(is_new);
  EXPECT_EQ(latest.read(is_new), 7);
  EXPECT_FALSE(is_new);
}

TEST(Latest, OnlyTheLastOfSeveralIsSeen) {
  Latest<int> latest;
  for (int i = 1; i <= 5; ++i) {
    latest.writable() = i;
    latest.publish();
  }
  bool is_new = false;
  EXPECT_EQ(latest.read(is_new), 5);
}

TEST(Latest, WhatIsBeingWrittenIsNotSeen) {
  Latest<int> latest;
  latest.writable() = 1;
  latest.publish();
  latest.writable() = 2;
  bool is_new = false;
  EXPECT_EQ(latest.read(is_new), 1);
  latest.publish();
  EXPECT_EQ(latest.read(is_new), 2);
}

struct Value {
  std::array<std::uint64_t, 64> copies{};  // 64 copies of one number, so that a torn value shows
};

TEST(Latest, IsNeverTornAndNeverOlderBetweenTwoThreads) {
  // Number of values that the reader must see; on a busy machine the number that it sees within two
  // seconds.
  constexpr int kSeen = 50'000, kLeast = 100;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  Latest<Value> latest;
  std::atomic<bool> is_enough{false};
  std::uint64_t written = 0;
  std::thread writer([&] {
    while (!is_enough.load(std::memory_order_relaxed)) {
      latest.writable().copies.fill(++written);
      latest.publish();
      if (written % 64 == 0) std::this_thread::yield();
    }
  });
  std::uint64_t before = 0, torn = 0, older = 0, same_though_new = 0;
  for (int seen = 0; seen < kLeast || (seen < kSeen && std::chrono::steady_clock::now() < end);) {
    bool is_new = false;
    const Value& value = latest.read(is_new);
    const std::uint64_t number = value.copies[0];
    for (const std::uint64_t copy : value.copies) torn += copy != number;
    older += number < before;
    same_though_new += is_new && number == before;
    seen += is_new;
    if (!is_new) std::this_thread::yield();
    before = number;
  }
  is_enough = true;
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(older, 0u);
  EXPECT_EQ(same_though_new, 0u);
  bool is_new = false;
  EXPECT_EQ(latest.read(is_new).copies[0], written) << "the last one is always there";
}

}  // namespace
}  // namespace gaitpad
