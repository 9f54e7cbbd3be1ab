#include "system/child_process.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <cerrno>
#include <chrono>
#include <string_view>
#include <thread>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

class Child : public testing::Test {
 protected:
  // Runs these lines of sh.
  void start(const std::string& lines) {
    const auto error = child_.start({"sh", "-c", lines});
    ASSERT_FALSE(error) << error->message;
  }
  bool write(std::string_view text) {
    return child_.write({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  OwnFolder own_;
  ChildProcess child_;
};

TEST_F(Child, GetsItsInputAndItsLastLineIsKept) {
  start("cat > '" + own_.at("input") + "'; echo first; echo 'the last ' >&2; exit 3");
  EXPECT_TRUE(child_.has_input());
  EXPECT_TRUE(write("one "));
  EXPECT_TRUE(write("two"));
  child_.wait_for_end();
  EXPECT_FALSE(child_.has_input());
  EXPECT_EQ(text_in(own_.at("input")), "one two");
  EXPECT_EQ(child_.exit_status(), 3);
  EXPECT_EQ(child_.last_line(), "the last");
}

// Without protection SIGPIPE would end this program.
TEST_F(Child, OneThatReadsNoMoreEndsTheWriting) {
  start("exit 0");
  const std::string block(1 << 16, 'x');
  int blocks = 0;
  while (write(block) && blocks < 100) ++blocks;
  EXPECT_LT(blocks, 100);
  child_.wait_for_end();
  EXPECT_EQ(child_.exit_status(), 0);
  EXPECT_EQ(child_.last_line(), "");
}

TEST_F(Child, IsInAProcessGroupOfItsOwn) {
  start("read pid name state parent group rest < /proc/$$/stat; echo $$ $group");
  child_.wait_for_end();
  const std::string line = child_.last_line();
  const std::size_t blank = line.find(' ');
  ASSERT_NE(blank, std::string::npos) << line;
  EXPECT_EQ(line.substr(0, blank), line.substr(blank + 1));
}

TEST_F(Child, ASignalThatIsBlockedHereIsNotBlockedThere) {
  sigset_t terminate, before;
  sigemptyset(&terminate);
  sigaddset(&terminate, SIGTERM);
  ::pthread_sigmask(SIG_BLOCK, &terminate, &before);
  start("kill -TERM $$; exit 1");
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  child_.wait_for_end();
  EXPECT_EQ(child_.exit_status(), std::nullopt);
  EXPECT_EQ(child_.ending_signal(), SIGTERM);
}

TEST_F(Child, DoesNotOutliveItsObject) {
  std::string number;
  {
    ChildProcess child;
    const std::string file = own_.at("number");
    ASSERT_FALSE(child.start({"sh", "-c", "echo $$ > '" + file + "'; exec sleep 100"}));
    while (text_in(file).empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    number = text_in(file);
  }
  EXPECT_EQ(::kill(std::stoi(number), 0), -1);
  EXPECT_EQ(errno, ESRCH);
}

TEST_F(Child, AMissingProgramIsNamed) {
  EXPECT_EQ(child_.start({"no-such-program"})->message,
            "no-such-program does not start: No such file or directory");
  EXPECT_FALSE(is_in_path("no-such-program"));
  EXPECT_TRUE(is_in_path("sh"));
}

}  // namespace
}  // namespace gaitpad
