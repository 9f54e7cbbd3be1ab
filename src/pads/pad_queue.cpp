#include "pads/pad_queue.h"

#include <poll.h>

#include <cassert>

namespace gaitpad {

bool PadQueue::put(const Report& report) noexcept {
  if (!ring_.push(report)) return false;
  written_.fetch_add(1, std::memory_order_relaxed);
  return true;
}

void PadQueue::push(const Report& report, std::uint8_t report_id) {
  assert(report.device < kMaxTraceDevices || report.device == kNoDevice);
  if (!flush() || !put(report)) hold(report, report_id);
}

void PadQueue::hold(const Report& report, std::uint8_t report_id) {
  const bool is_input = report.kind == ReportKind::input;
  if (report.device == kNoDevice) {
    waiting_.push_back({report, 0});
    return;
  }
  HeldReports& held = held_[report.device];
  if (is_input && held[report_id] != nullptr) {
    *held[report_id] = report;
    lost_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  waiting_.push_back({report, report_id});
  if (is_input) {
    held[report_id] = &waiting_.back().report;
  } else {
    held.fill(nullptr);  // what comes now stands behind the plugging
  }
}

bool PadQueue::flush() {
  while (!waiting_.empty()) {
    Waiting& first = waiting_.front();
    if (!put(first.report)) return false;
    if (first.report.device != kNoDevice) {
      Report*& held = held_[first.report.device][first.report_id];
      if (held == &first.report) held = nullptr;
    }
    waiting_.pop_front();
  }
  return true;
}

// Whoever of the two comes second to `reader_sleeps_` sees what the other one did before.
void PadQueue::wake_reader() noexcept {
  if (reader_sleeps_.exchange(false, std::memory_order_acq_rel)) bell_.ring();
}

void PadQueue::wait(std::chrono::milliseconds timeout) {
  bell_.clear();
  reader_sleeps_.exchange(true, std::memory_order_acq_rel);
  if (ring_.front() == nullptr) {
    pollfd bell{bell_.fd(), POLLIN, 0};
    ::poll(&bell, 1, static_cast<int>(timeout.count()));
  }
  reader_sleeps_.exchange(false, std::memory_order_acq_rel);
}

}  // namespace gaitpad
