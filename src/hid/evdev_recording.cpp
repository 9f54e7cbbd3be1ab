#include "hid/evdev_recording.h"

#include <fmt/format.h>

#include <algorithm>

namespace gaitpad {
namespace {

constexpr std::uint16_t kSyn = 0x00, kKey = 0x01, kAbs = 0x03;  // event types
constexpr std::uint16_t kSynReport = 0x00;

}  // namespace

void EvdevRecording::add_key(std::uint16_t code) {
  if (code <= evdev::kKeyMax) abilities_.keys.push_back(code);
}

std::optional<std::string> EvdevRecording::add_axis(std::uint32_t code, std::int32_t min,
                                                    std::int32_t max) {
  const bool is_known =
      std::ranges::any_of(abilities_.axes, [code](const EvdevAxis& a) { return a.code == code; });
  if (is_known) return fmt::format("a second range for the axis {:02x}", code);
  if (code <= evdev::kAbsMax)
    abilities_.axes.push_back({static_cast<std::uint16_t>(code), min, max});
  return std::nullopt;
}

std::optional<std::string> EvdevRecording::add_event(const EvdevEvent& event,
                                                     std::string_view time) {
  if (!events_.empty()) {
    const std::int64_t before = events_.back().time_us;
    if (event.time_us < before) return fmt::format("time goes back to {}", time);
    if (event.time_us - before > kMaxTraceGapUs) return "a gap of more than ten minutes";
    if (event.time_us - events_.front().time_us > kMaxTraceDurationUs)
      return "a recording of more than a million seconds";
  }
  if (events_.size() >= kMaxTraceEvents) return fmt::format("more than {} events", kMaxTraceEvents);
  events_.push_back(event);
  return std::nullopt;
}

EvdevState EvdevRecording::first_state() const {
  EvdevState state;
  for (const EvdevAxis& a : abilities_.axes) {
    const auto first = std::ranges::find_if(
        events_, [&a](const EvdevEvent& e) { return e.type == kAbs && e.code == a.code; });
    state.axis[a.code] = first != events_.end()
                             ? first->value
                             : static_cast<std::int32_t>((std::int64_t{a.min} + a.max + 1) / 2);
  }
  return state;
}

std::optional<Error> EvdevRecording::append_to(Trace& trace) const {
  const EvdevLayout layout = evdev_layout(abilities_, {});
  const auto index = static_cast<std::uint16_t>(trace.devices.size());
  TraceDevice& device = trace.devices.emplace_back();
  device.info = info;
  device.info.driver = "evdev";
  device.info.descriptor = layout.descriptor;
  EvdevState state = first_state();
  Report report;
  for (const EvdevEvent& e : events_) {
    if (e.type == kAbs && e.code <= evdev::kAbsMax) state.axis[e.code] = e.value;
    if (e.type == kKey && e.code <= evdev::kKeyMax) state.keys[e.code] = e.value != 0;
    if (e.type != kSyn || e.code != kSynReport) continue;
    put_state(layout, state, report);
    if (trace.bytes.size() + report.size > kMaxTraceBytes || trace.events.size() >= kMaxTraceEvents)
      return Error{
          fmt::format("{}: reports of more than {} MiB", trace.path, kMaxTraceBytes >> 20)};
    TraceEvent event;
    event.time_us = e.time_us;
    event.device = index;
    event.first_byte = static_cast<std::uint32_t>(trace.bytes.size());
    event.size = report.size;
    trace.bytes.insert(trace.bytes.end(), report.bytes.begin(), report.bytes.begin() + report.size);
    trace.events.push_back(event);
  }
  return std::nullopt;
}

}  // namespace gaitpad
