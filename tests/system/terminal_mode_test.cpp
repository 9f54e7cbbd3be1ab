// Cases that change standard input run in a process of their own, on a pseudo-terminal.
#include "system/terminal_mode.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <memory>

#include "system/descriptors.h"

namespace gaitpad {
namespace {

using testing::ExitedWithCode;

struct PseudoTerminal {
  PseudoTerminal() {
    ::grantpt(keyboard.get());
    ::unlockpt(keyboard.get());
    screen = OwnedFd(::open(::ptsname(keyboard.get()), O_RDWR | O_NOCTTY | O_CLOEXEC));
  }
  OwnedFd keyboard{::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)};
  OwnedFd screen;
};

tcflag_t shows_lines() {
  termios mode{};
  ::tcgetattr(0, &mode);
  return mode.c_lflag & (ICANON | ECHO);
}

TEST(TerminalMode, ItsSizeIsKnownAndNothingElseHasOne) {
  const PseudoTerminal terminal;
  if (terminal.screen.get() < 0) GTEST_SKIP() << "this machine has no pseudo-terminals";
  const winsize window = {.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
  ::ioctl(terminal.screen.get(), TIOCSWINSZ, &window);
  const auto size = terminal_size(terminal.screen.get());
  ASSERT_TRUE(size);
  EXPECT_EQ(size->columns, 80u);
  EXPECT_EQ(size->rows, 24u);
  EXPECT_TRUE(is_terminal(terminal.screen.get()));
  const OwnedFd file(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  EXPECT_FALSE(terminal_size(file.get()));
  EXPECT_FALSE(is_terminal(file.get()));
}

TEST(TerminalMode, SingleKeysArriveAtOnceAndTheModeIsPutBack) {
  const PseudoTerminal terminal;
  if (terminal.screen.get() < 0) GTEST_SKIP() << "this machine has no pseudo-terminals";
  const auto use_keys = [&terminal] {
    ::dup2(terminal.screen.get(), 0);
    const tcflag_t before = shows_lines();
    auto mode = std::make_unique<SingleKeyMode>(SingleKeyMode::Earlier::count);
    if (!mode->is_terminal() || shows_lines() != 0) ::_exit(1);
    if (::write(terminal.keyboard.get(), "k", 1) != 1) ::_exit(2);
    char key = 0;
    if (read_ready(0, {&key, 1}) != 1u || key != 'k') ::_exit(3);
    mode = nullptr;
    ::_exit(before == (ICANON | ECHO) && shows_lines() == before ? 0 : 4);
  };
  EXPECT_EXIT(use_keys(), ExitedWithCode(0), "");
}

// The process ends by the signal; its mode is looked at from outside.
TEST(TerminalMode, QuittingPutsTheModeBack) {
  const PseudoTerminal terminal;
  if (terminal.screen.get() < 0) GTEST_SKIP() << "this machine has no pseudo-terminals";
  const auto quit = [&terminal] {
    ::dup2(terminal.screen.get(), 0);
    const SingleKeyMode mode(SingleKeyMode::Earlier::forgotten);
    ::raise(SIGQUIT);
    ::_exit(1);
  };
  EXPECT_EXIT(quit(), testing::KilledBySignal(SIGQUIT), "");
  termios mode{};
  ASSERT_EQ(::tcgetattr(terminal.screen.get(), &mode), 0);
  EXPECT_EQ(mode.c_lflag & (ICANON | ECHO), tcflag_t{ICANON | ECHO});
}

TEST(TerminalMode, AFileInPlaceOfATerminalIsLeftAlone) {
  const auto use_file = [] {
    ::dup2(::open("/dev/null", O_RDONLY), 0);
    const SingleKeyMode mode(SingleKeyMode::Earlier::count);
    ::_exit(mode.is_terminal() ? 1 : 0);
  };
  EXPECT_EXIT(use_file(), ExitedWithCode(0), "");
}

TEST(TerminalMode, AClosedStandardDescriptorIsHeldAndCannotBeUsed) {
  const auto hold = [] {
    ::close(0);
    ::close(1);
    hold_standard_descriptors();
    char byte = 0;
    const bool is_held = ::fcntl(0, F_GETFD) >= 0 && ::fcntl(1, F_GETFD) >= 0;
    const bool is_used = ::read(0, &byte, 1) >= 0 || ::write(1, "x", 1) >= 0;
    ::_exit(is_held && !is_used ? 0 : 1);
  };
  EXPECT_EXIT(hold(), ExitedWithCode(0), "");
}

}  // namespace
}  // namespace gaitpad
