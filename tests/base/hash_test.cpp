#include "gaitpad/hash.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <set>

namespace gaitpad {
namespace {

std::uint64_t hash_of(std::initializer_list<double> values) {
  WordHash hash;
  for (double v : values) hash.add(v);
  return hash.value();
}

// The words come from a computation in Python's whole numbers.
TEST(WordHash, GivesTheValuesOfItsDefinition) {
  EXPECT_EQ(hash_of({}), 0xcbf29ce484222325ull);
  EXPECT_EQ(hash_of({1.0}), 0xc293bd4c44920a93ull);
  EXPECT_EQ(hash_of({1.0, -0.5, 3e8}), 0xcf0b23a21b7a0e01ull);
}

TEST(WordHash, TellsBitsApartThatCompareEqual) { EXPECT_NE(hash_of({0.0}), hash_of({-0.0})); }

TEST(WordHash, TheOrderAndTheCountMatter) {
  EXPECT_NE(hash_of({1.0, 2.0}), hash_of({2.0, 1.0}));
  EXPECT_NE(hash_of({0.0}), hash_of({0.0, 0.0}));
}

// Each step can be undone, so words that differ in one place can never meet again.
TEST(WordHash, WordsThatDifferInOneBitDiffer) {
  std::set<std::uint64_t> seen = {hash_of({0.25, 0.25, 0.25})};
  for (int bit = 0; bit < 64; ++bit) {
    const double other =
        std::bit_cast<double>(std::bit_cast<std::uint64_t>(0.25) ^ (std::uint64_t{1} << bit));
    EXPECT_TRUE(seen.insert(hash_of({0.25, other, 0.25})).second) << "bit " << bit;
  }
}

}  // namespace
}  // namespace gaitpad
