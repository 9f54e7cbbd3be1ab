#include "session/tick_reports.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "hid/decode.h"

namespace gaitpad {
namespace {

void copy(const Report& from, std::int64_t now_ns, Report& to) noexcept {
  to.time_ns = std::min(from.time_ns, now_ns);
  to.device = from.device;
  to.kind = from.kind;
  to.size = std::min<std::uint16_t>(from.size, kMaxReportBytes);
  std::memcpy(to.bytes.data(), from.bytes.data(), to.size);
}

bool tells_of_the_same(const PadLayout& layout, const Report& a, const Report& b) noexcept {
  if (a.size != b.size) return false;
  return !layout.descriptor.numbered || (a.size > 0 && a.bytes[0] == b.bytes[0]);
}

}  // namespace

TickReports::TickReports(PadStream& pads, Simulation& simulation)
    : pads_(pads), simulation_(simulation), reports_(kMaxInTick) {}

void TickReports::begin_anew() noexcept {
  if (!std::exchange(is_used_, false)) return;
  count_ = 0;
  for (Gathered& device : gathered_) {
    if (device.has_state) device = {};
  }
}

std::span<const Report> TickReports::take(std::int64_t now_ns) noexcept {
  begin_anew();
  while (count_ < kMaxInTick) {
    const Report* oldest = pads_.front();
    if (oldest == nullptr) break;
    copy(*oldest, now_ns, reports_[count_]);
    pads_.pop();
    if (is_of_known_device(reports_[count_])) ++count_;
  }
  is_used_ = true;
  return {reports_.data(), count_};
}

bool TickReports::gather(std::int64_t now_ns) noexcept {
  begin_anew();
  // No more in one go than a tick would take: a flood is not to keep the thread.
  std::size_t seen = 0;
  for (; seen < kMaxInTick && count_ < kMaxInTick; ++seen) {
    const Report* oldest = pads_.front();
    if (oldest == nullptr) break;
    Report& report = reports_[count_];
    copy(*oldest, now_ns, report);
    pads_.pop();
    if (is_of_known_device(report) && !replaces_older(report)) ++count_;
  }
  return seen > 0;
}

// A device becomes known when it is added for the first time; nothing else of it counts before.
bool TickReports::is_of_known_device(const Report& report) noexcept {
  if (report.kind == ReportKind::command) return true;
  if (report.device >= is_known_.size()) return false;
  std::atomic<bool>& is_known = is_known_[report.device];
  if (!is_known.load(std::memory_order_relaxed) && report.kind == ReportKind::added) {
    simulation_.set_pad(report.device, std::move(pads_.config(report.device)));
    is_known.store(true, std::memory_order_release);
  }
  return is_known.load(std::memory_order_relaxed);
}

bool TickReports::replaces_older(const Report& report) noexcept {
  if (report.kind == ReportKind::command) return false;
  Gathered& device = gathered_[report.device];
  if (!device.has_state && report.device == simulation_.pads().driving())
    device.state = simulation_.pads().driving_state();
  device.has_state = true;
  const int older = std::exchange(device.newest, -1);
  if (report.kind != ReportKind::input) {
    device.state = PadState{};
    return false;
  }
  const std::uint32_t before = device.state.buttons;
  if (!decode(pads_.layout(report.device), report, device.state)) return false;
  const std::uint32_t pressed = device.state.buttons & ~before;
  for (int b = 0; b < kButtonCount; ++b) device.presses[b] += (pressed >> b) & 1u;
  const bool replaces = older >= 0 && device.state.buttons == before &&
                        tells_of_the_same(pads_.layout(report.device), reports_[older], report);
  device.newest = replaces ? older : static_cast<int>(count_);
  if (replaces) copy(report, report.time_ns, reports_[older]);
  return replaces;
}

void TickReports::show(SessionFrame& frame) const noexcept {
  if (is_used_ || frame.pad.device >= gathered_.size()) return;
  const Gathered& device = gathered_[frame.pad.device];
  if (!device.has_state) return;
  frame.pad.state = device.state;
  for (int b = 0; b < kButtonCount; ++b) frame.presses[b] += device.presses[b];
}

bool TickReports::is_known(std::uint16_t device) const noexcept {
  return device < is_known_.size() && is_known_[device].load(std::memory_order_acquire);
}

}  // namespace gaitpad
