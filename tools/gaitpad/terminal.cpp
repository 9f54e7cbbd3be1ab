#include "tools/gaitpad/terminal.h"

#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <cassert>
#include <cerrno>
#include <utility>

namespace gaitpad {
namespace {

constexpr std::size_t kMaxTypedBytes = 256;
constexpr char kEscape = 0x1b, kEndOfInput = 0x04;
constexpr int kMaxEscapeBytes = 16;

// For the signal handlers, which are set while there is a TerminalKeys.
termios mode_before, mode_of_keys;
bool is_in_use = false;
constexpr int kHandledSignals[] = {SIGTSTP, SIGQUIT};
struct sigaction actions_before[2];

void put_back_and_obey(int signal) {
  const int error = errno;
  ::tcsetattr(0, TCSANOW, &mode_before);
  if (signal == SIGTSTP) {
    ::kill(::getpid(), SIGSTOP);  // returns when the process is continued
    ::tcsetattr(0, TCSANOW, &mode_of_keys);
  } else {
    ::signal(signal, SIG_DFL);
    ::raise(signal);  // comes when the handler has returned
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

TerminalKeys::TerminalKeys(Earlier earlier) {
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

TerminalKeys::~TerminalKeys() {
  if (!is_terminal_) return;
  ::tcsetattr(0, TCSANOW, &mode_before);
  for (std::size_t i = 0; i < std::size(kHandledSignals); ++i)
    ::sigaction(kHandledSignals[i], &actions_before[i], nullptr);
  is_in_use = false;
}

// Reads one byte, not more: the bytes behind it may be for the next reader.
std::optional<char> TerminalKeys::byte() {
  pollfd ready = {0, POLLIN, 0};
  if (is_at_end_ || ::poll(&ready, 1, 0) <= 0) return std::nullopt;
  char value = 0;
  const ssize_t count = ::read(0, &value, 1);
  if (count == 1) return value;
  if (count == 0 || (errno != EINTR && errno != EAGAIN)) is_at_end_ = true;
  return std::nullopt;
}

std::optional<char> TerminalKeys::take_key() {
  while (const std::optional<char> next = byte()) {
    if (!is_terminal_ && *next != '\n') {
      if (line_.size() < kMaxTypedBytes && *next != '\r') line_ += *next;
      continue;
    }
    if (!is_terminal_) {
      const std::string line = std::exchange(line_, {});
      return line.empty() ? '\n' : line.front();
    }
    if (*next == kEndOfInput) is_at_end_ = true;
    for (int i = 0; *next == kEscape && i < kMaxEscapeBytes && byte(); ++i) continue;
    if (*next != kEscape && *next != kEndOfInput) return *next == '\r' ? '\n' : *next;
  }
  if (!is_at_end_ || line_.empty()) return std::nullopt;
  return std::exchange(line_, {}).front();  // a last line without a line break
}

ScreenSize screen_size() noexcept {
  winsize window = {};
  if (::ioctl(2, TIOCGWINSZ, &window) != 0 || window.ws_col < 2 || window.ws_row < 2) return {};
  return {window.ws_col - 1u, window.ws_row};
}

std::vector<std::string> wrapped_lines(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::size_t begin = 0;
  while (text.size() - begin > width) {
    std::size_t end = text.rfind(' ', begin + width);
    if (end == std::string::npos || end <= begin) end = begin + width;
    lines.push_back(text.substr(begin, end - begin));
    begin = end < text.size() && text[end] == ' ' ? end + 1 : end;
  }
  lines.push_back(text.substr(begin));
  return lines;
}

}  // namespace gaitpad
