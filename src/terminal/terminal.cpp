#include "terminal/terminal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <utility>

#include "base/text.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxTypedBytes = 256;
constexpr char kEscape = 0x1b, kEndOfInput = 0x04;
constexpr int kMaxEscapeBytes = 16;

// Used by the signal handlers, which are installed while a TerminalKeys exists.
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

// Reads only one byte: later bytes may be for the next reader.
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
  // The rest of the input, a last line without a line break.
  return std::exchange(line_, {}).front();
}

ScreenSize screen_size() noexcept {
  winsize window = {};
  if (::ioctl(2, TIOCGWINSZ, &window) != 0 || window.ws_col < 2 || window.ws_row < 2) return {};
  return {window.ws_col - 1u, window.ws_row};
}

std::optional<std::size_t> terminal_columns(int descriptor) noexcept {
  winsize window = {};
  if (::isatty(descriptor) == 0 || ::ioctl(descriptor, TIOCGWINSZ, &window) != 0 ||
      window.ws_col == 0)
    return std::nullopt;
  return window.ws_col;
}

namespace {

// Number of bytes of the first `count` characters.
std::size_t bytes_of(std::string_view text, std::size_t count) {
  std::size_t at = 0;
  for (; at < text.size() && count > 0; --count)
    at += std::max<std::size_t>(character_bytes(text.substr(at)), 1);
  return std::min(at, text.size());
}

// Removes and returns the first line of at most `width` characters. A longer word is broken after a
// comma, or else anywhere.
std::string_view take_fitting(std::string_view& rest, std::size_t width) {
  const std::size_t most = bytes_of(rest, std::max<std::size_t>(width, 1));
  std::size_t end = most;
  if (most < rest.size()) {
    const std::size_t blank = rest.rfind(' ', most);
    const std::size_t comma = most > 0 ? rest.rfind(',', most - 1) : std::string_view::npos;
    if (blank != std::string_view::npos && blank > 0) {
      end = blank;
    } else if (comma != std::string_view::npos) {
      end = comma + 1;
    }
  }
  const std::string_view line = rest.substr(0, end);
  rest.remove_prefix(end);
  if (rest.starts_with(' ')) rest.remove_prefix(1);
  return line;
}

// Start of the last column in the left half of the width; 2 if the line has no columns.
std::size_t hanging_indent(std::string_view line, std::size_t width) {
  std::size_t indent = 0;
  for (std::size_t i = 2; i < line.size() && i <= width / 2; ++i) {
    if (line[i] != ' ' && line[i - 1] == ' ' && line[i - 2] == ' ') indent = i;
  }
  return indent > 0 ? indent : std::min<std::size_t>(2, width / 2);
}

}  // namespace

std::vector<std::string> wrapped_lines(const std::string& text, std::size_t width) {
  std::vector<std::string> lines;
  std::string_view rest = text;
  do {
    lines.emplace_back(take_fitting(rest, width));
  } while (!rest.empty());
  return lines;
}

std::string fitted(std::string_view text, std::size_t width) {
  std::string all;
  while (!text.empty()) {
    const bool is_whole = text.find('\n') != std::string_view::npos;
    std::string_view line = take_line(text);
    const std::size_t indent = hanging_indent(line, width);
    // Do not break at the blanks before the first word.
    const std::size_t begin = std::min(line.find_first_not_of(' '), line.size());
    const std::size_t lead = std::min(begin, width / 2);
    all.append(lead, ' ');
    line.remove_prefix(begin);
    all += take_fitting(line, width - lead);
    while (!line.empty()) {
      line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
      all.append("\n").append(indent, ' ');
      all += take_fitting(line, width - indent);
    }
    if (is_whole) all += '\n';
  }
  return all;
}

std::string table_text(const std::vector<TableRow>& table) {
  if (table.empty()) return "";
  std::vector<std::size_t> widths(table.front().size(), 0);
  for (const TableRow& row : table) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (const TableRow& row : table) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) line += fmt::format("{:<{}}  ", row[c], widths[c]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += printable(line) + "\n";
  }
  return text;
}

}  // namespace gaitpad
