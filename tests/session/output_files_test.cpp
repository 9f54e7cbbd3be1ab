#include <gtest/gtest.h>

#include <filesystem>

#include "session/walk_export.h"
#include "tests/own_folder.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

class OutputFolder : public testing::Test {
 protected:
  std::string text(const std::string& name) const { return text_in(folder_ / name); }
  void write_and_publish(const std::string& content) {
    auto files = OutputFiles::open(folder_.string());
    ASSERT_TRUE(files);
    auto stream = files->add("a.txt");
    ASSERT_TRUE(stream);
    **stream << content;
    EXPECT_FALSE(files->publish());
  }

  OwnFolder own_;
  const fs::path folder_ = own_.path / "deep";
};

TEST_F(OutputFolder, IsMadeAndHoldsWhatWasPublished) {
  write_and_publish("one");
  EXPECT_EQ(text("a.txt"), "one");
  EXPECT_EQ(entries_in(folder_), 1);
}

TEST_F(OutputFolder, KeepsTheOldFileUntilTheNewOneIsPublished) {
  write_and_publish("one");
  {
    auto files = OutputFiles::open(folder_.string());
    ASSERT_TRUE(files);
    **files->add("a.txt") << "two";
    EXPECT_EQ(text("a.txt"), "one");
  }
  EXPECT_EQ(text("a.txt"), "one");
  EXPECT_EQ(entries_in(folder_), 1) << "a temporary file stayed behind";
  write_and_publish("three");
  EXPECT_EQ(text("a.txt"), "three");
}

TEST_F(OutputFolder, AScratchFileKeepsWhatIsWrittenAndIsNeverSeen) {
  auto files = OutputFiles::open(folder_.string());
  ASSERT_TRUE(files);
  auto one = files->scratch(), two = files->scratch();
  ASSERT_TRUE(one && two);
  *one << "one";
  *two << "two";
  EXPECT_EQ(entries_in(folder_), 0);
  one->seekg(0);
  std::string back;
  *one >> back;
  EXPECT_EQ(back, "one");
}

TEST_F(OutputFolder, WhereAFileStandsIsRefused) {
  write_and_publish("one");
  const auto files = OutputFiles::open((folder_ / "a.txt" / "below").string());
  ASSERT_FALSE(files);
  EXPECT_NE(files.error().message.find("a.txt/below"), std::string::npos);
  EXPECT_FALSE(OutputFiles::open((folder_ / "a.txt").string()));
}

TEST_F(OutputFolder, AFullDiskIsToldAtPublishing) {
  fs::create_directories(folder_);
  auto files = OutputFiles::open(folder_.string());
  ASSERT_TRUE(files);
  auto stream = files->add("a.txt");
  ASSERT_TRUE(stream);
  (*stream)->setstate(std::ios::badbit);
  EXPECT_TRUE(files->publish());
  EXPECT_FALSE(fs::exists(folder_ / "a.txt"));
}

}  // namespace
}  // namespace gaitpad
