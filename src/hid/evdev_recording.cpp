#include "hid/evdev_recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/text.h"
#include "hid/evemu.h"
#include "hid/libinput_record.h"
#include "hid/umockdev_record.h"

namespace gaitpad {
namespace {

constexpr std::uint16_t kSyn = 0x00, kKey = 0x01, kAbs = 0x03;  // types of events
constexpr std::uint16_t kSynReport = 0x00;

}  // namespace

void EvdevRecording::add_key(std::uint16_t code) {
  if (code <= evdev::kKeyMax) keys_.push_back(code);
}

const RecordedAxis* EvdevRecording::axis(std::uint32_t code) const {
  const auto found = std::ranges::find(axes_, code, &RecordedAxis::code);
  return found == axes_.end() ? nullptr : &*found;
}

std::optional<std::string> EvdevRecording::add_axis(const RecordedAxis& axis) {
  if (this->axis(axis.code)) return fmt::format("a second range for the axis {:02x}", axis.code);
  if (axis.code <= evdev::kAbsMax) axes_.push_back(axis);
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

EvdevAbilities EvdevRecording::abilities() const {
  EvdevAbilities abilities{{axes_.begin(), axes_.end()}, keys_};
  std::ranges::sort(abilities.axes, {}, &EvdevAxis::code);
  std::ranges::sort(abilities.keys);
  abilities.keys.erase(std::unique(abilities.keys.begin(), abilities.keys.end()),
                       abilities.keys.end());
  return abilities;
}

EvdevState EvdevRecording::first_state() const {
  EvdevState state;
  for (const EvdevAxis& a : axes_) {
    const auto first = std::ranges::find_if(
        events_, [&a](const EvdevEvent& e) { return e.type == kAbs && e.code == a.code; });
    state.axis[a.code] = first != events_.end()
                             ? first->value
                             : static_cast<std::int32_t>((std::int64_t{a.min} + a.max + 1) / 2);
  }
  return state;
}

std::optional<Error> EvdevRecording::append_to(Trace& trace) const {
  const EvdevLayout layout = evdev_layout(abilities(), {});
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

namespace {

std::unique_ptr<EvdevReader> reader_of(std::string_view text) {
  text = without_byte_order_mark(text);
  // Tried before evemu, because the heads of both formats' events are alike.
  if (is_umockdev_record(text)) return make_umockdev_reader();
  if (is_evemu(text)) return make_evemu_reader();
  if (is_libinput_record(text)) return make_libinput_reader();
  return nullptr;
}

}  // namespace

bool is_evdev_recording(std::string_view text) noexcept {
  text = without_byte_order_mark(text);
  return is_umockdev_record(text) || is_evemu(text) || is_libinput_record(text);
}

Result<EvdevRecordings> evdev_recordings(std::string_view text, const std::string& name,
                                         Damage damage) {
  const std::unique_ptr<EvdevReader> reader = reader_of(text);
  if (!reader) return Error{name + ": not a recording of evemu, libinput or umockdev"};
  EvdevRecordings recordings;
  while (!text.empty()) {
    ++reader->line_number;
    std::string_view line = take_line(text);
    if (line.ends_with('\r')) line.remove_suffix(1);
    const bool is_broken = !line.starts_with('#') && line.find('\r') != line.npos;
    const auto cause = is_broken ? std::optional<std::string>("a carriage return inside the line")
                                 : reader->add(line);
    if (!cause) continue;
    const std::string sentence = fmt::format("{}:{}: {}", name, reader->line_number, *cause);
    if (damage == Damage::refuse) return Error{sentence};
    if (recordings.skipped_lines++ == 0) recordings.first_damage = sentence;
  }
  recordings.nodes = std::move(reader->nodes);
  std::erase_if(recordings.nodes, [](const EvdevRecording& n) { return !n.has_abilities(); });
  if (recordings.nodes.empty()) return Error{name + ": " + reader->missing()};
  return recordings;
}

Result<Trace> parse_evdev_recording(std::string_view text, const std::string& name, Damage damage) {
  const auto recordings = evdev_recordings(text, name, damage);
  if (!recordings) return recordings.error();
  Trace trace;
  trace.path = name;
  trace.skipped_lines = recordings->skipped_lines;
  trace.first_damage = recordings->first_damage;
  for (const EvdevRecording& node : recordings->nodes) {
    if (auto problem = node.append_to(trace)) return *problem;
  }
  std::ranges::stable_sort(trace.events, {}, &TraceEvent::time_us);
  return trace;
}

}  // namespace gaitpad
