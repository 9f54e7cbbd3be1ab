#include "system/growing_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <cerrno>
#include <filesystem>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

class Growing : public testing::Test {
 protected:
  OwnFolder own_;
  const std::string path_ = own_.at("a");
};

TEST_F(Growing, ReplacesWhatAnEndedProcessLeftAndIsReadWhileItGrows) {
  own_.write("a", "left by another process");
  GrowingFile file;
  ASSERT_EQ(file.create(path_), 0);
  EXPECT_EQ(file.append("one "), 0);
  EXPECT_EQ(text_in(path_), "one ");
  EXPECT_EQ(file.append("two"), 0);
  EXPECT_EQ(text_in(path_), "one two");
}

TEST_F(Growing, IsHeldByOneAtATime) {
  GrowingFile second;
  {
    GrowingFile first;
    ASSERT_EQ(first.create(path_), 0);
    ASSERT_EQ(first.append("first"), 0);
    EXPECT_EQ(second.create(path_), EWOULDBLOCK);
    EXPECT_EQ(text_in(path_), "first");
  }
  EXPECT_EQ(second.create(path_), 0);
}

TEST_F(Growing, APieceThatDoesNotFitIsCutOffAgain) {
  GrowingFile file;
  ASSERT_EQ(file.create(path_), 0);
  ASSERT_EQ(file.append("12345678"), 0);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{10, before.rlim_max};
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  ::setrlimit(RLIMIT_FSIZE, &limit);
  const int problem = file.append("90abcdef");
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  EXPECT_EQ(problem, EFBIG);
  EXPECT_EQ(text_in(path_), "12345678");
}

TEST_F(Growing, IsNotMadeThroughALinkNorInAMissingFolder) {
  own_.write("other", "whole");
  std::filesystem::create_symlink("other", path_);
  EXPECT_EQ(GrowingFile().create(path_), ELOOP);
  EXPECT_EQ(text_in(own_.at("other")), "whole");
  EXPECT_EQ(GrowingFile().create(own_.at("none/a")), ENOENT);
}

}  // namespace
}  // namespace gaitpad
