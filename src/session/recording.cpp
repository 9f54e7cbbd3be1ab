#include "session/recording.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kRingItems = 4096;
constexpr std::chrono::milliseconds kPause{20};  // between looks at the ring; nobody is woken
constexpr std::size_t kWriteBytes = std::size_t{1} << 18;

Error failure(const std::string& path, int number) {
  return Error{fmt::format("{}: cannot be written: {}", path, std::strerror(number))};
}

// Open and empty, and nobody else's. A pipe of that name without a reader is an error, no waiting.
Result<OwnedFd> opened_part(const std::string& part) {
  OwnedFd file(
      ::open(part.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666));
  if (file.get() < 0) return failure(part, errno);
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0)
    return Error{part + ": another session is recording into it"};
  if (::ftruncate(file.get(), 0) != 0) return failure(part, errno);
  return file;
}

}  // namespace

Result<std::unique_ptr<Recording>> Recording::start(const Options& options,
                                                    RecordedDevices devices) {
  std::error_code ignored;
  const fs::file_status status = fs::status(options.path, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return Error{options.path + ": this is no file, a recording cannot take its place"};
  }
  auto file = opened_part(options.path + ".part");
  if (!file) return file.error();
  std::unique_ptr<Recording> recording(
      new Recording(options, std::move(devices), std::move(*file)));
  recording->thread_ = std::thread([r = recording.get()] { r->run(); });
  return recording;
}

Recording::Recording(const Options& options, RecordedDevices devices, OwnedFd file)
    : path_(options.path),
      part_(options.path + ".part"),
      file_(std::move(file)),
      lines_(options.rate_hz, std::move(devices), options.limits),
      ring_(kRingItems) {}

Recording::~Recording() { end_thread(); }

void Recording::add(std::int64_t tick, const Report& report) noexcept {
  Item item;
  item.tick = tick;
  // No report comes from the future: a wrong stamp would end the recording.
  item.report.time_ns = std::min(report.time_ns, now_ns());
  item.report.device = report.device;
  item.report.kind = report.kind;
  item.report.size = std::min<std::uint16_t>(report.size, kMaxReportBytes);
  std::memcpy(item.report.bytes.data(), report.bytes.data(), item.report.size);
  if (!ring_.push(item)) lost_.fetch_add(1, std::memory_order_relaxed);
}

// A remark for people: where it finds no room the recording is still an exact one.
void Recording::clock(std::int64_t tick, std::int64_t time_ns, double pace) noexcept {
  Item item;
  item.tick = tick;
  item.clock_ns = time_ns;
  item.pace = pace;
  static_cast<void>(ring_.push(item));
}

void Recording::run() {
  bool is_last = false;
  while (!is_last) {
    {
      std::unique_lock lock(mutex_);
      is_last = ending_.wait_for(lock, kPause, [this] { return is_ending_; });
    }
    take_all();
    write(lines_.take_text());
  }
}

void Recording::take_all() {
  while (const Item* item = ring_.front()) {
    if (item->clock_ns != kNoClock) {
      lines_.clock(item->tick, item->clock_ns, item->pace);
    } else if (problem_ != 0 || !lines_.add(item->tick, item->report)) {
      lost_.fetch_add(1, std::memory_order_relaxed);
    }
    ring_.pop();
    if (lines_.text_size() >= kWriteBytes) write(lines_.take_text());
  }
}

void Recording::write(std::string_view text) {
  if (problem_ != 0) return;
  const auto whole = static_cast<std::int64_t>(text.size());
  while (!text.empty()) {
    const ssize_t count = ::write(file_.get(), text.data(), text.size());
    if (count >= 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno != EINTR) {
      problem_ = errno;
      // Half a line would spoil the rest; where even this fails, `replay --lenient` skips it.
      static_cast<void>(!::ftruncate(file_.get(), written_));
      return;
    }
  }
  written_ += whole;
}

void Recording::end_thread() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  ending_.notify_one();
  thread_.join();
}

Result<std::vector<std::string>> Recording::finish(std::int64_t ticks, std::int64_t time_ns) {
  end_thread();
  lines_.end(ticks, time_ns);
  write(lines_.take_text());
  if (auto failed = problem()) return *failed;
  if (!lines_.has_devices()) {
    ::unlink(part_.c_str());
    return std::vector<std::string>{path_ + ": was not written: there was no pad to record"};
  }
  if (std::rename(part_.c_str(), path_.c_str()) != 0) return failure(path_, errno);
  return remarks();
}

std::optional<Error> Recording::problem() const {
  if (problem_ == 0) return std::nullopt;
  return failure(part_, problem_);
}

std::vector<std::string> Recording::remarks() const {
  std::vector<std::string> remarks;
  if (lines_.is_full()) {
    remarks.push_back(fmt::format("{}: ends after {:.0f} s: a longer recording could not be read",
                                  path_, lines_.duration_s()));
  } else if (lost() > 0) {
    remarks.push_back(fmt::format(
        "{}: {} reports are missing, so it will not replay to the same poses", path_, lost()));
  }
  return remarks;
}

}  // namespace gaitpad
