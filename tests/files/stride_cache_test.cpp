// Cached strides have the same bits as solved ones, even if files are damaged.
#include "files/stride_cache.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <functional>

#include "files/made_strides.h"
#include "gaitpad/clean_strides.h"
#include "strides/solver_input.h"
#include "tests/own_folder.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

std::vector<double> numbers_of(const GaitCycle& cycle) {
  std::vector<double> numbers;
  for_each_number(*cycle.strides, [&numbers](double number) { numbers.push_back(number); });
  return numbers;
}

// A walk that differs from the built-in one.
GaitCycle loaded_cycle() {
  GaitCycle cycle = procedural_gait();
  cycle.samples[7].leg[1].angles[kKneeX] += 1e-12;
  return cycle;
}

class StrideCache : public testing::Test {
 protected:
  std::vector<double> loaded(const GaitCycle& cycle = loaded_cycle()) const {
    return numbers_of(value_of(cached_clean_strides(cycle, cache())));
  }
  std::string cache() const { return folder_.at("cache"); }
  fs::path only_file() const { return fs::directory_iterator(cache())->path(); }

  static const std::vector<double>& solved() {
    static const auto numbers = numbers_of(value_of(with_clean_strides(loaded_cycle())));
    return numbers;
  }

  OwnFolder folder_;
};

TEST_F(StrideCache, GivesTheSameBitsAsSolvingAndKeepsEachCycleApart) {
  EXPECT_EQ(loaded(), solved());
  ASSERT_EQ(entries_in(cache()), 1);
  const auto written = fs::last_write_time(only_file());
  EXPECT_EQ(loaded(), solved());
  EXPECT_EQ(entries_in(cache()), 1);
  EXPECT_EQ(fs::last_write_time(only_file()), written);
  GaitCycle other = loaded_cycle();
  other.samples[5].leg[0].angles[kKneeX] += 1e-12;
  const auto second = loaded(other);
  EXPECT_EQ(entries_in(cache()), 2);
  other.name = "renamed";  // the name does not belong to the cache's key
  EXPECT_EQ(loaded(other), second);
  EXPECT_EQ(entries_in(cache()), 2);
}

TEST_F(StrideCache, SolvesAgainAndMendsWhereAFileIsDamaged) {
  loaded();
  const fs::path file = only_file();
  const std::string whole = text_in(file);
  const auto flipped = [&whole](std::size_t at) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 1);
    return bytes;
  };
  const std::string damaged[] = {whole.substr(0, whole.size() / 2), whole + "x",
                                 flipped(0),  // a file of another version
                                 flipped(8),  // a file for another input
                                 flipped(whole.size() / 2)};
  for (const std::string& bytes : damaged) {
    std::ofstream(file, std::ios::binary) << bytes;
    EXPECT_EQ(loaded(), solved());
    EXPECT_EQ(text_in(file), whole);
  }
}

TEST_F(StrideCache, DoesWithoutAFolder) {
  const std::string file = folder_.write("file");
  EXPECT_EQ(numbers_of(value_of(cached_clean_strides(loaded_cycle(), file + "/in"))), solved());
  EXPECT_EQ(numbers_of(value_of(cached_clean_strides(loaded_cycle(), ""))), solved());
}

TEST_F(StrideCache, DeletesTheOldestOfManyFilesAndNothingElse) {
  for (int i = 0; i < 70; ++i) {
    const fs::path old = folder_.write("cache/" + std::to_string(i) + ".strides");
    fs::last_write_time(old, fs::file_time_type::clock::now() - std::chrono::hours(100 - i));
  }
  folder_.write("cache/notes.txt");
  loaded();
  EXPECT_EQ(entries_in(cache()), 64 + 1);
  EXPECT_FALSE(fs::exists(folder_.at("cache/6.strides")));
  EXPECT_TRUE(fs::exists(folder_.at("cache/7.strides")));
  EXPECT_TRUE(fs::exists(folder_.at("cache/notes.txt")));
}

// Compares bits: the built-in strides were solved while gaitpad was built.
TEST_F(StrideCache, BuiltInStridesAreThoseThatSolvingGivesAndAreNotKeptAgain) {
  const GaitCycle cycle = procedural_gait();
  std::vector<double> made;
  for (const std::uint64_t bits : made_strides()) made.push_back(std::bit_cast<double>(bits));
  std::vector<double> expected = solver_input(cycle);
  const auto solved_now = numbers_of(value_of(with_clean_strides(cycle)));
  expected.insert(expected.end(), solved_now.begin(), solved_now.end());
  ASSERT_EQ(made.size(), expected.size());
  EXPECT_EQ(std::memcmp(made.data(), expected.data(), made.size() * sizeof(double)), 0);
  EXPECT_EQ(loaded(cycle), solved_now);
  EXPECT_FALSE(fs::exists(cache()));
}

TEST_F(StrideCache, KeepsNoErrors) {
  GaitCycle cycle = procedural_gait();
  cycle.name = "odd.bvh";
  cycle.stride_m = -1.0;
  for (int i = 0; i < 2; ++i)
    EXPECT_EQ(cause_of(cached_clean_strides(cycle, cache())),
              "odd.bvh: stride_m is -1, outside [0.001, 1000]");
  EXPECT_FALSE(fs::exists(cache()));
}

TEST(StrideCacheFolder, IsTheUsersAndMayBeOff) {
  const Environment own("GAITPAD_CACHE", nullptr), home("HOME", "/home/someone");
  {
    const Environment xdg("XDG_CACHE_HOME", "/var/mine");
    EXPECT_EQ(stride_cache_folder(), "/var/mine/gaitpad/strides");
    const Environment off("GAITPAD_CACHE", "off");
    EXPECT_EQ(stride_cache_folder(), "");
  }
  const Environment xdg("XDG_CACHE_HOME", nullptr);
  EXPECT_EQ(stride_cache_folder(), "/home/someone/.cache/gaitpad/strides");
  const Environment homeless("HOME", nullptr);
  EXPECT_EQ(stride_cache_folder(), "");
}

}  // namespace
}  // namespace gaitpad
