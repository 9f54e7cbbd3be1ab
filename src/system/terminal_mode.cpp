#include "system/terminal_mode.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <iterator>

namespace gaitpad {
namespace {

// Used by the signal handlers, which are installed while a SingleKeyMode exists.
termios mode_before, mode_of_keys;
bool is_in_use = false;
constexpr int kHandledSignals[] = {SIGTSTP, SIGQUIT};
struct sigaction actions_before[2];

void put_back_and_obey(int signal) {
  const int error = errno;
  ::tcsetattr(0, TCSANOW, &mode_before);
  if (signal == SIGTSTP) {
    ::kill(::getpid(), SIGSTOP);  // stops the process; the call returns when it is continued
    ::tcsetattr(0, TCSANOW, &mode_of_keys);
  } else {
    ::signal(signal, SIG_DFL);
    ::raise(signal);  // the signal is delivered when the handler has returned
  }
  errno = error;
}

void handle_signals() noexcept {
  struct sigaction action = {};
  action.sa_handler = &put_back_and_obey;
  action.sa_flags = SA_RESTART;
  for (std::size_t i = 0; i < std::size(kHandledSignals); ++i)
    ::sigaction(kHandledSignals[i], &action, &actions_before[i]);
}

}  // namespace

void hold_standard_descriptors() noexcept {
  for (int fd = 0; fd <= 2; ++fd) {
    if (::fcntl(fd, F_GETFD) < 0)
      static_cast<void>(::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY));
  }
}

bool is_terminal(int fd) noexcept { return ::isatty(fd) == 1; }

std::optional<TerminalSize> terminal_size(int fd) noexcept {
  winsize window = {};
  if (::ioctl(fd, TIOCGWINSZ, &window) != 0) return std::nullopt;
  return TerminalSize{window.ws_col, window.ws_row};
}

SingleKeyMode::SingleKeyMode(Earlier earlier) {
  assert(!is_in_use);
  if (::tcgetattr(0, &mode_before) != 0) return;
  mode_of_keys = mode_before;
  mode_of_keys.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  mode_of_keys.c_cc[VMIN] = 1;
  mode_of_keys.c_cc[VTIME] = 0;
  handle_signals();
  is_terminal_ = is_in_use = true;
  ::tcsetattr(0, earlier == Earlier::count ? TCSANOW : TCSAFLUSH, &mode_of_keys);
}

SingleKeyMode::~SingleKeyMode() {
  if (!is_terminal_) return;
  ::tcsetattr(0, TCSANOW, &mode_before);
  for (std::size_t i = 0; i < std::size(kHandledSignals); ++i)
    ::sigaction(kHandledSignals[i], &actions_before[i], nullptr);
  is_in_use = false;
}

}  // namespace gaitpad
