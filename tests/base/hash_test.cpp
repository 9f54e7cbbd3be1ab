#include "gaitpad/hash.h"

#include <gtest/gtest.h>

#include <initializer_list>

namespace gaitpad {
namespace {

std::uint64_t hash_of(std::initializer_list<double> values) {
  WordHash hash;
  for (double v : values) hash.add(v);
  return hash.value();
}

// The expected values were computed with Python's integers.
TEST(WordHash, GivesTheValuesOfItsDefinition) {
  EXPECT_EQ(hash_of({}), 0xcbf29ce484222325ull);
  EXPECT_EQ(hash_of({1.0}), 0xc293bd4c44920a93ull);
  EXPECT_EQ(hash_of({1.0, -0.5, 3e8}), 0xcf0b23a21b7a0e01ull);
}

TEST(WordHash, TellsBitsApartThatCompareEqual) { EXPECT_NE(hash_of({0.0}), hash_of({-0.0})); }

}  // namespace
}  // namespace gaitpad
