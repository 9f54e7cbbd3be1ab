#include "system/whole_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>
#include <vector>

#include "tests/own_folder.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

class Files : public testing::Test {
 protected:
  std::string text_of(const std::string& name) const {
    return value_of(file_text(own_.at(name), 100));
  }
  OwnFolder own_;
};

TEST_F(Files, ReadingIsBounded) {
  own_.write("a", std::string(100, 'x'));
  own_.write("b", std::string(101, 'x'));
  EXPECT_EQ(text_of("a").size(), 100u);
  EXPECT_EQ(file_text(own_.at("b"), 100).error().message, own_.at("b") + ": larger than 100 bytes");
  EXPECT_EQ(file_text(own_.at("no"), 1).error().message, own_.at("no") + ": no such file");
  const std::string fifo = own_.at("fifo");
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_EQ(file_text(fifo, 1).error().message, fifo + ": not a regular file (a FIFO)");
}

TEST_F(Files, WhatTheKernelMakesUpAndDevicesAreNotRead) {
  EXPECT_EQ(file_text("/dev/null", 1).error().message, "/dev/null: not a regular file (a device)");
  EXPECT_EQ(file_text("/proc/self/maps", 1).error().message,
            "/proc/self/maps: not a regular file (the kernel makes it up)");
}

// 4194304 is beyond the largest process number that Linux gives.
TEST_F(Files, WhatAKilledProcessLeftIsRemovedByTheNextOne) {
  const std::string own = std::to_string(::getpid());
  own_.write(".a.toml.4194305", "half");
  own_.write(".a.toml.4194305.old", "half");
  own_.write(".a.toml.4194305.0123456789abcdef", "half");
  own_.write(".a.toml." + own + "0000000", "no process number");
  own_.write(".b.toml.4194305", "of another file");
  own_.write(".a.toml.1", "of a process that runs");
  EXPECT_FALSE(save_text(own_.at("a.toml"), "whole"));
  EXPECT_EQ(own_.entries(), 4);
  EXPECT_FALSE(write_file(own_.at("b.toml"), "whole"));
  EXPECT_EQ(own_.entries(), 4) << "b.toml came, its temporary file went";
}

TEST_F(Files, WritingReplacesTheFileAndLeavesNothingBeside) {
  EXPECT_FALSE(write_file(own_.at("a"), "one"));
  EXPECT_FALSE(write_file(own_.at("a"), "two"));
  EXPECT_EQ(text_of("a"), "two");
  EXPECT_EQ(own_.entries(), 1);
  EXPECT_FALSE(write_file(own_.at("new/folder/b"), "three"));
  EXPECT_EQ(text_of("new/folder/b"), "three");
  EXPECT_EQ(write_file(own_.at("new"), "four")->message,
            own_.at("new") + ": cannot be written: Is a directory");
  EXPECT_EQ(own_.entries(), 2);
}

// If the name contained only the process id, another user could put a link there beforehand.
TEST_F(Files, TemporaryNamesCannotBeGuessed) {
  const std::string one = temporary_beside(own_.at("a")), other = temporary_beside(own_.at("a"));
  EXPECT_NE(one, other);
  EXPECT_EQ(fs::path(one).parent_path(), fs::path(own_.at("a")).parent_path());
  EXPECT_GE(one.size(), own_.at("a").size() + 2 + 16) << one;
}

TEST_F(Files, ANewFileIsThereOncePublishedAndElseLeavesNothing) {
  own_.write("a", "before");
  {
    auto file = value_of(NewFile::create(own_.at("a")));
    EXPECT_FALSE(file.write("half"));
    EXPECT_EQ(text_of("a"), "before");
  }
  EXPECT_EQ(own_.entries(), 1);
  auto file = value_of(NewFile::create(own_.at("a")));
  EXPECT_FALSE(file.write("who"));
  EXPECT_FALSE(file.write("le"));
  EXPECT_FALSE(file.publish());
  EXPECT_EQ(text_of("a"), "whole");
  EXPECT_EQ(own_.entries(), 1);
}

TEST_F(Files, AKilledProcessLeavesNothing) {
  const pid_t child = ::fork();
  if (child == 0) {
    auto file = NewFile::create(own_.at("a"));
    if (file && !file->write("half")) ::raise(SIGKILL);
    ::_exit(1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  const int unnamed = ::open(own_.path.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
  if (unnamed < 0) GTEST_SKIP() << "this file system has no files without a name";
  ::close(unnamed);
  EXPECT_EQ(own_.entries(), 0);
}

TEST_F(Files, ATooLargeFileIsRefusedBeforeItIsRead) {
  own_.write("large");
  // A file of 1 TB without content: reading it would take minutes.
  fs::resize_file(own_.at("large"), std::uintmax_t{1} << 40);
  EXPECT_EQ(file_text(own_.at("large"), 1000).error().message,
            own_.at("large") + ": larger than 1000 bytes");
}

TEST_F(Files, AFoldersLockIsHeldByOneAtATime) {
  std::atomic<int> holders{0}, most{0};
  std::vector<std::jthread> threads;
  for (int i = 0; i < 8; ++i) {
    threads.emplace_back([&] {
      const auto lock = FolderLock::wait(own_.at("new/file"));
      most = std::max<int>(most, ++holders);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      --holders;
    });
  }
  threads.clear();
  EXPECT_EQ(most, 1);
}

TEST_F(Files, SavingKeepsWhatStoodThereAndFollowsLinks) {
  fs::create_symlink("real", own_.at("link"));
  EXPECT_FALSE(save_text(own_.at("link"), "one"));
  EXPECT_FALSE(save_text(own_.at("link"), "two"));
  EXPECT_EQ(text_of("real"), "two");
  EXPECT_EQ(text_of("real.old"), "one");
  EXPECT_TRUE(fs::is_symlink(own_.at("link")));
  EXPECT_EQ(own_.entries(), 3);
  fs::create_symlink("ring", own_.at("ring"));
  EXPECT_TRUE(saving_problem(own_.at("ring")));
  EXPECT_TRUE(save_text(own_.at("ring"), "three"));
}

}  // namespace
}  // namespace gaitpad
