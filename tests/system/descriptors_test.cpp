#include "system/descriptors.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <array>
#include <cerrno>
#include <string>

#include "system/clock.h"

namespace gaitpad {
namespace {

struct Pipe {
  Pipe() {
    std::array<int, 2> ends{};
    EXPECT_EQ(::pipe2(ends.data(), O_CLOEXEC), 0);
    out = OwnedFd(ends[0]);
    in = OwnedFd(ends[1]);
  }
  OwnedFd out, in;
};

bool is_readable(int fd) {
  pollfd ready = {fd, POLLIN, 0};
  return ::poll(&ready, 1, 0) == 1;
}

TEST(Descriptors, ReadingTellsNothingYetFromTheEnd) {
  Pipe pipe;
  std::array<char, 8> bytes{};
  EXPECT_EQ(read_ready(pipe.out.get(), bytes), std::nullopt);
  EXPECT_EQ(write_all(pipe.in.get(), "walk"), 0);
  ASSERT_EQ(read_ready(pipe.out.get(), bytes), 4u);
  EXPECT_EQ(std::string(bytes.data(), 4), "walk");
  EXPECT_EQ(read_ready(pipe.out.get(), bytes), std::nullopt);
  pipe.in = OwnedFd();
  EXPECT_EQ(read_ready(pipe.out.get(), bytes), 0u);
}

TEST(Descriptors, AFailedWriteTellsItsCause) {
  const Pipe pipe;
  EXPECT_EQ(write_all(pipe.out.get(), "walk"), EBADF) << "this end is read";
  EXPECT_EQ(write_all(-1, ""), 0) << "nothing is to be written";
}

TEST(Descriptors, AnOwnedOneIsClosedOnce) {
  Pipe pipe;
  const int fd = pipe.out.get();
  OwnedFd other = std::move(pipe.out);
  EXPECT_EQ(pipe.out.get(), -1);
  EXPECT_EQ(other.get(), fd);
  other = OwnedFd();
  EXPECT_EQ(::fcntl(fd, F_GETFD), -1);
}

TEST(Descriptors, ABellIsReadableFromItsRingToItsClearing) {
  Bell bell;
  EXPECT_FALSE(is_readable(bell.fd()));
  bell.ring();
  bell.ring();
  EXPECT_TRUE(is_readable(bell.fd()));
  bell.clear();
  EXPECT_FALSE(is_readable(bell.fd()));
}

TEST(Descriptors, ATimerComesAtItsTimeAndIsTakenOnce) {
  Timer timer;
  EXPECT_FALSE(timer.take());
  timer.set(now_ns() + 3'600'000'000'000);
  EXPECT_FALSE(is_readable(timer.fd()));
  const std::int64_t time_ns = now_ns() + 2'000'000;
  timer.set(time_ns);
  sleep_until(time_ns + 1'000'000);
  EXPECT_TRUE(is_readable(timer.fd()));
  EXPECT_TRUE(timer.take());
  EXPECT_FALSE(timer.take());
}

}  // namespace
}  // namespace gaitpad
