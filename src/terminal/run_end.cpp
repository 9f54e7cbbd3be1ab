#include "terminal/run_end.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>

namespace gaitpad {
namespace {

constexpr std::size_t kMaxLineBytes = 4096;  // a longer line of standard input is cut
constexpr int kMaxReads = 64;                // most reads at once, in case that a writer never
                                             // stops

constexpr int kEndingSignals[] = {SIGINT, SIGTERM, SIGHUP};

sigset_t ending_signals() noexcept {
  sigset_t set;
  sigemptyset(&set);
  for (int signal : kEndingSignals) sigaddset(&set, signal);
  return set;
}

// The longest time limit; keeps the sum with the clock in range.
constexpr double kMaxSeconds = 1e9;

// A second signal within this time counts as the first: a terminal and `timeout` may both send one.
constexpr std::int64_t kOneRequest_ns = 1'000'000'000;
std::atomic<std::int64_t> end_began_ns{0};

void end_at_once(int signal) {
  if (now_ns() - end_began_ns.load() > kOneRequest_ns) ::_exit(128 + signal);
}

// After this call a signal interrupts the calling thread, even while it waits.
void allow_ending_at_once() noexcept {
  end_began_ns = now_ns();
  struct sigaction action = {};
  action.sa_handler = &end_at_once;
  action.sa_flags = SA_RESTART;
  const sigset_t set = ending_signals();
  for (int signal : kEndingSignals) sigaction(signal, &action, nullptr);
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

}  // namespace

RunEnd::RunEnd() {
  const sigset_t set = ending_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  ::signal(SIGPIPE, SIG_IGN);
  signals_ = OwnedFd(signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC));
  // There is nothing to wait for, so no signal could end the program.
  if (signals_.get() < 0) pthread_sigmask(SIG_UNBLOCK, &set, nullptr);
}

void RunEnd::end_after(double seconds) noexcept {
  if (seconds <= 0.0) return;
  end_ns_ = now_ns() + static_cast<std::int64_t>(std::min(seconds, kMaxSeconds) * 1e9);
}

bool RunEnd::is_reached() noexcept {
  if (is_reached_) return true;
  signalfd_siginfo info = {};
  if (::read(signals_.get(), &info, sizeof info) == sizeof info)
    signal_ = static_cast<int>(info.ssi_signo);
  is_reached_ = signal_ != 0 || (end_ns_ != 0 && now_ns() >= end_ns_);
  if (is_reached_) allow_ending_at_once();
  return is_reached_;
}

void RunEnd::wait(std::chrono::milliseconds time, std::span<const pollfd> others) {
  if (is_reached()) return;
  std::int64_t wait_ms = time.count();
  if (end_ns_ != 0) {
    const std::int64_t left_ns = end_ns_ - now_ns();
    wait_ms = std::clamp<std::int64_t>((left_ns + 999'999) / 1'000'000, 0, wait_ms);
  }
  std::vector<pollfd> fds(others.begin(), others.end());
  fds.push_back({signals_.get(), POLLIN, 0});
  ::poll(fds.data(), fds.size(), static_cast<int>(wait_ms));
}

std::vector<std::string> InputLines::take_lines() {
  std::vector<std::string> lines;
  pollfd ready = fd();
  for (int reads = 0; is_open_ && reads < kMaxReads; ++reads) {
    if (::poll(&ready, 1, 0) <= 0) break;
    char bytes[1024];
    const ssize_t count = ::read(0, bytes, sizeof bytes);
    if (count < 0 && errno == EINTR) continue;
    // End of input; the rest counts as a line even without a line break.
    if (count <= 0) is_open_ = false;
    if (count <= 0 && !rest_.empty()) rest_ += '\n';
    if (count > 0) rest_.append(bytes, static_cast<std::size_t>(count));
    for (std::size_t end; (end = rest_.find('\n')) != std::string::npos; rest_.erase(0, end + 1)) {
      std::string line = rest_.substr(0, std::min(end, kMaxLineBytes));
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (!line.empty()) lines.push_back(std::move(line));
    }
    if (rest_.size() > kMaxLineBytes) rest_.resize(kMaxLineBytes);
  }
  return lines;
}

StatusLine::StatusLine(int file) : file_(file), is_terminal_(::isatty(file) == 1) {}

void StatusLine::write_all(std::string_view text) const {
  while (!text.empty()) {
    const ssize_t count = ::write(file_, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;  // a status that cannot be shown is no error
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

void StatusLine::show(std::span<const std::string> lines) {
  if (!is_terminal_) return;
  winsize window = {};
  const bool is_known = ::ioctl(file_, TIOCGWINSZ, &window) == 0 && window.ws_col > 1;
  const std::size_t width = is_known ? window.ws_col - 1u : 79u;
  std::string text = shown_ > 1 ? fmt::format("\033[{}A", shown_ - 1) : "";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += fmt::format("{}\r\033[K{:.{}}", i > 0 ? "\n" : "", lines[i], width);
  }
  text += "\033[J";  // erases the lines below: there are fewer than before
  write_all(text);
  shown_ = lines.size();
}

void StatusLine::clear() {
  if (shown_ == 0) return;
  write_all(shown_ > 1 ? fmt::format("\033[{}A\r\033[J", shown_ - 1) : "\r\033[J");
  shown_ = 0;
}

double Progress::seconds() const { return static_cast<double>(now_ns() - start_ns_) / 1e9; }

void Progress::show(double share) {
  constexpr std::int64_t kBetween_ns = 200'000'000;
  const std::int64_t time_ns = now_ns();
  if (time_ns < next_ns_) return;
  next_ns_ = time_ns + kBetween_ns;
  const double done = std::clamp(share, 0.0, 1.0);
  std::string text = fmt::format("{}: {:.0f} %", work_, 100.0 * done);
  if (done > 0.0) {
    const auto left = static_cast<int>(std::min(seconds() * (1.0 / done - 1.0), 360'000.0) + 0.5);
    text += left < 60 ? fmt::format(", {} s left", left)
                      : fmt::format(", {} min {} s left", left / 60, left % 60);
  }
  line_.show(text);
}

}  // namespace gaitpad
