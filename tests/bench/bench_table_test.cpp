#include "bench/bench_table.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

struct Measured {
  Work peer, crowd;
  std::vector<BenchRow> rows;
};

// A crowd whose characters take `ns` each, compared with a peer of 100 ns, with a bound of 500 ns.
Measured crowd_of(double ns) {
  Measured m;
  m.peer.name = "playback";
  m.peer.label = "playback";
  m.crowd.name = "crowd";
  m.crowd.label = "10 characters";
  m.crowd.over = "playback";
  m.crowd.most_ns = 500.0;
  m.rows = {{nullptr, {100.0}}, {nullptr, {ns}}};
  return m;
}

std::vector<std::string> lines_of(Measured& m) {
  m.rows[0].work = &m.peer;
  m.rows[1].work = &m.crowd;
  return bench_lines(m.rows, list_of(m.rows, "a processor"), 1, 15);
}

TEST(BenchTable, ARowStandsBelowItsHeadingWithRatioAndBound) {
  Measured met = crowd_of(400.0);
  const auto lines = lines_of(met);
  ASSERT_EQ(lines.size(), 5u);
  EXPECT_TRUE(lines[0].starts_with("a processor, "));
  EXPECT_NE(lines[0].find(", core 1; medians over 15 rounds"), std::string::npos);
  EXPECT_EQ(lines[1], "bare playback of the skeleton");
  EXPECT_EQ(lines[3], "a character in a crowd, ticks of 1/60 s");
  EXPECT_NE(lines[4].find("10 characters"), std::string::npos);
  EXPECT_NE(lines[4].find("400 ns"), std::string::npos);
  EXPECT_NE(lines[4].find("4.00 x"), std::string::npos);
  EXPECT_NE(lines[4].find("500 ns met"), std::string::npos);
}

TEST(BenchTable, AMissedBoundIsSaid) {
  Measured slow = crowd_of(600.0);
  EXPECT_NE(lines_of(slow)[4].find("500 ns MISSED"), std::string::npos);
}

// AVX-512 holds 16 floats, AVX2 eight.
TEST(BenchTable, LanesAreNamedByTheirInstructions) {
  EXPECT_EQ(lanes_text(16), "16 lanes (AVX-512)");
  EXPECT_EQ(lanes_text(8), "8 lanes (AVX2)");
  EXPECT_EQ(lanes_text(4), "4 lanes (128 bits)");
}

}  // namespace
}  // namespace gaitpad
