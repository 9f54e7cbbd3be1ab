// A recording as devices: delivers its events at their recorded times, counted from the moment when
// the first of its devices was opened.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <utility>

#include "base/text.h"
#include "drivers/driver_rows.h"
#include "drivers/pads/recorded_packets.h"
#include "gaitpad/trace.h"
#include "system/clock.h"
#include "system/descriptors.h"

namespace gaitpad {
namespace {

// Without a Q: line the recording ends a second after the last event, as in a replay.
constexpr std::int64_t kTail_us = 1'000'000;

// One run of a file. All of its open devices share it and its start time.
struct Playback {
  Trace trace;                            // its packets turned into reports by quirks
  std::vector<TraceEvent> raw_events;     // its events before that, for hand_on_raw()
  std::int64_t start_ns = 0;              // start by CLOCK_MONOTONIC
  std::int64_t first_us = 0, end_us = 0;  // times of the file's first event and of its end

  std::int64_t due_ns(std::int64_t time_us) const noexcept {
    return start_ns + (time_us - first_us) * 1000;
  }
};

Playback started_playback(Trace trace) {
  Playback playback;
  // The first and the last event are searched for: if the file has T: lines, only the times of each
  // single device are in order.
  const auto [first, last] = std::ranges::minmax_element(trace.events, {}, &TraceEvent::time_us);
  if (first != trace.events.end()) {
    playback.first_us = first->time_us;
    playback.end_us = std::max(last->time_us, trace.end_time_us.value_or(last->time_us + kTail_us));
  }
  playback.raw_events = trace.events;
  accept_packets(trace);
  playback.trace = std::move(trace);
  playback.start_ns = now_ns();
  return playback;
}

Result<std::shared_ptr<const Playback>> running_playback(const std::string& path) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const Playback>> running;
  const std::lock_guard lock(mutex);
  if (auto known = running[path].lock()) return known;
  std::erase_if(running, [](const auto& entry) { return entry.second.expired(); });
  auto trace = read_trace(path);
  if (!trace) return trace.error();
  auto playback = std::make_shared<const Playback>(started_playback(std::move(*trace)));
  running[path] = playback;
  return playback;
}

class TraceFileDevice final : public Device {
 public:
  TraceFileDevice(std::shared_ptr<const Playback> playback, std::uint16_t device, Timer timer)
      : playback_(std::move(playback)),
        device_(device),
        end_ns_(playback_->due_ns(playback_->end_us)),
        timer_(std::move(timer)),
        poll_fd_{timer_.fd(), POLLIN, 0} {
    find_own();
    timer_.set(due_ns());
  }

  const DeviceInfo& info() const noexcept override {
    return playback_->trace.devices[device_].info;
  }
  std::span<const pollfd> poll_fds() const noexcept override { return {&poll_fd_, 1}; }

  Status read(Report& report) noexcept override {
    const std::int64_t due = due_ns();
    if (now_ns() < due) {
      timer_.take();
      timer_.set(due);
      return Status::nothing;
    }
    const std::vector<TraceEvent>& events = *events_;
    if (next_ == events.size()) return Status::gone;
    copy_report(playback_->trace, events[next_], report);
    report.time_ns = due;
    ++next_;
    find_own();
    return Status::report;
  }

  void hand_on_raw() noexcept override {
    events_ = &playback_->raw_events;
    next_ = 0;
    find_own();
    timer_.set(due_ns());
  }

 private:
  void find_own() noexcept {
    const std::vector<TraceEvent>& events = *events_;
    while (next_ < events.size() && events[next_].device != device_) ++next_;
  }
  // The time at which the next event is due; after the last one, that of the end.
  std::int64_t due_ns() const noexcept {
    const std::vector<TraceEvent>& events = *events_;
    return next_ < events.size() ? playback_->due_ns(events[next_].time_us) : end_ns_;
  }

  const std::shared_ptr<const Playback> playback_;
  const std::vector<TraceEvent>* events_ = &playback_->trace.events;
  const std::uint16_t device_;
  const std::int64_t end_ns_;
  Timer timer_;
  const pollfd poll_fd_;
  std::size_t next_ = 0;
};

std::string node_of(const std::string& path, std::size_t device) {
  return device == 0 ? path : fmt::format("{}#{}", path, device + 1);
}

// Splits a node of node_of() into path and number; the path may contain a `#` itself.
std::pair<std::string, std::size_t> path_and_device(const std::string& node) {
  const std::size_t mark = node.rfind('#');
  if (mark == std::string::npos) return {node, 0};
  const auto number =
      parse_number<std::size_t>(std::string_view(node).substr(mark + 1)).value_or(0);
  if (number < 2 || number > kMaxTraceDevices) return {node, 0};
  return {node.substr(0, mark), number - 1};
}

}  // namespace

std::vector<DeviceListing> find_trace_devices() { return {}; }

Result<std::vector<DeviceListing>> trace_listings(const std::string& path) {
  auto trace = read_trace(path);
  if (!trace) return trace.error();
  std::vector<DeviceListing> listings;
  for (std::size_t i = 0; i < trace->devices.size(); ++i) {
    DeviceListing& listing = listings.emplace_back();
    listing.info = trace->devices[i].info;
    listing.node = node_of(path, i);
    listing.pad_path = listing.node;
  }
  return listings;
}

std::string trace_calibration(const DeviceListing& listing) {
  const auto [path, device] = path_and_device(listing.node);
  auto playback = running_playback(path);
  if (!playback || device >= (*playback)->trace.devices.size()) return {};
  return (*playback)->trace.devices[device].calibration;
}

Result<std::unique_ptr<Device>> open_trace_device(const DeviceListing& listing, Detach) {
  const auto [path, device] = path_and_device(listing.node);
  auto playback = running_playback(path);
  if (!playback) return playback.error();
  if (device >= (*playback)->trace.devices.size())
    return Error{fmt::format("{}: there are {} devices in it", listing.node,
                             (*playback)->trace.devices.size())};
  Timer timer;
  if (timer.fd() < 0)
    return Error{fmt::format("{}: no timer: {}", listing.node, std::strerror(errno))};
  return std::unique_ptr<Device>(std::make_unique<TraceFileDevice>(
      std::move(*playback), static_cast<std::uint16_t>(device), std::move(timer)));
}

}  // namespace gaitpad
