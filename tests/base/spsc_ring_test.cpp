#include "base/spsc_ring.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <thread>

namespace gaitpad {
namespace {

TEST(SpscRing, GivesBackInOrder) {
  SpscRing<int> ring(4);
  EXPECT_EQ(ring.front(), nullptr);
  for (int i : {1, 2, 3}) EXPECT_TRUE(ring.push(i));
  int item = 0;
  for (int i : {1, 2, 3}) {
    ASSERT_TRUE(ring.pop(item));
    EXPECT_EQ(item, i);
  }
  EXPECT_FALSE(ring.pop(item));
}

TEST(SpscRing, HoldsAllOfItsCapacityAndRefusesOneMore) {
  SpscRing<int> ring(8);
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(8));
  ASSERT_NE(ring.front(), nullptr);
  EXPECT_EQ(*ring.front(), 0) << "nothing was overwritten";
  ring.pop();
  EXPECT_TRUE(ring.push(8));
  EXPECT_FALSE(ring.push(9));
}

TEST(SpscRing, TheOldestStaysInPlaceUntilItIsTaken) {
  SpscRing<int> ring(2);
  ring.push(1);
  const int* oldest = ring.front();
  ring.push(2);
  EXPECT_EQ(ring.front(), oldest);
  EXPECT_EQ(*oldest, 1);
}

TEST(SpscRing, RunsAroundManyTimes) {
  SpscRing<int> ring(4);
  int written = 0, read = 0;
  for (int round = 0; round < 1000; ++round) {
    for (int i = 0; i <= round % 4; ++i) ASSERT_TRUE(ring.push(written++));
    int item = 0;
    while (ring.pop(item)) ASSERT_EQ(item, read++);
  }
  EXPECT_EQ(read, written);
}

// Larger than a word, so that a reader that is too early sees a torn item.
struct Item {
  std::uint64_t number = 0;
  std::array<std::uint64_t, 15> copies{};
};

Item numbered(std::uint64_t number) {
  Item item;
  item.number = number;
  item.copies.fill(number * 0x9e3779b97f4a7c15u);
  return item;
}

// A ring of 16 is often full or empty while the items pass, one of 4096 rarely.
void pass_items(std::size_t capacity, std::uint64_t items) {
  SpscRing<Item> ring(capacity);
  std::uint64_t found_full = 0, found_empty = 0;
  std::thread writer([&] {
    for (std::uint64_t i = 0; i < items;) {
      if (ring.push(numbered(i))) {
        ++i;
      } else {
        ++found_full;
        std::this_thread::yield();
      }
    }
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t next = 0; next < items;) {
    const Item* item = ring.front();
    if (item == nullptr) {
      ++found_empty;
      std::this_thread::yield();
      continue;
    }
    wrong += item->number != next || item->copies != numbered(next).copies;
    ring.pop();
    ++next;
  }
  writer.join();
  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(ring.front(), nullptr);
  if (capacity <= 16) {
    EXPECT_GT(found_full + found_empty, 0u);
  }
}

TEST(SpscRing, ItemsPassWholeAndInOrderBetweenTwoThreads) {
  pass_items(16, 5'000);
  pass_items(4096, 200'000);
}

}  // namespace
}  // namespace gaitpad
