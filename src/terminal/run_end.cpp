#include "terminal/run_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "system/descriptors.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxLineBytes = 4096;  // a longer line of standard input is cut
constexpr int kMaxReads = 64;                // most reads at once, in case that a writer never
                                             // stops

// The longest time limit; keeps the sum with the clock in range.
constexpr double kMaxSeconds = 1e9;

}  // namespace

void RunEnd::end_after(double seconds) noexcept {
  if (seconds <= 0.0) return;
  end_ns_ = now_ns() + static_cast<std::int64_t>(std::min(seconds, kMaxSeconds) * 1e9);
}

bool RunEnd::is_reached() noexcept {
  if (is_reached_) return true;
  signal_ = signals_.take();
  is_reached_ = signal_ != 0 || (end_ns_ != 0 && now_ns() >= end_ns_);
  if (is_reached_) end_at_next_signal();
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
  fds.push_back(fd());
  ::poll(fds.data(), fds.size(), static_cast<int>(wait_ms));
}

std::vector<std::string> InputLines::take_lines() {
  std::vector<std::string> lines;
  for (int reads = 0; is_open_ && reads < kMaxReads; ++reads) {
    std::array<char, 1024> bytes;
    const auto count = read_ready(0, bytes);
    if (!count) break;
    is_open_ = *count > 0;
    rest_.append(bytes.data(), *count);
    // At the end of input the rest counts as a line even without a line break.
    if (!is_open_ && !rest_.empty()) rest_ += '\n';
    for (std::size_t end; (end = rest_.find('\n')) != std::string::npos; rest_.erase(0, end + 1)) {
      std::string line = rest_.substr(0, std::min(end, kMaxLineBytes));
      if (!line.empty() && line.back() == '\r') line.pop_back();
      if (!line.empty()) lines.push_back(std::move(line));
    }
    if (rest_.size() > kMaxLineBytes) rest_.resize(kMaxLineBytes);
  }
  return lines;
}

void StatusLine::show(std::span<const std::string> lines) {
  if (!is_terminal_) return;
  const auto size = terminal_size(file_);
  const std::size_t width = size && size->columns > 1 ? size->columns - 1 : 79;
  std::string text = shown_ > 1 ? fmt::format("\033[{}A", shown_ - 1) : "";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    text += fmt::format("{}\r\033[K{:.{}}", i > 0 ? "\n" : "", lines[i], width);
  }
  text += "\033[J";        // erases the lines below: there are fewer than before
  write_all(file_, text);  // a status that cannot be shown is no error
  shown_ = lines.size();
}

void StatusLine::clear() {
  if (shown_ == 0) return;
  write_all(file_, shown_ > 1 ? fmt::format("\033[{}A\r\033[J", shown_ - 1) : "\r\033[J");
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
