// Recordings of evdev nodes, as people attach them to reports of bugs: of evemu, `libinput record`
// and umockdev. A node's abilities and its events become a device of a trace; its axes' ranges can
// be imported as a calibration.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/trace.h"
#include "hid/evdev_layout.h"

namespace gaitpad {

struct EvdevEvent {
  std::int64_t time_us = 0;
  std::uint16_t type = 0, code = 0;
  std::int32_t value = 0;
};

struct RecordedAxis : EvdevAxis {
  std::int32_t flat = 0;  // the flat range around the middle, as the kernel has it
  std::int64_t line = 0;  // number of the line that states the range
};

// One node. The add_ functions return why the line is damaged; none: it is not.
class EvdevRecording {
 public:
  DeviceInfo info;  // the device, without driver and descriptor

  void add_key(std::uint16_t code);
  std::optional<std::string> add_axis(const RecordedAxis& axis);
  // `time`: as it stands in the line.
  std::optional<std::string> add_event(const EvdevEvent& event, std::string_view time);
  bool has_abilities() const { return !axes_.empty() || !keys_.empty(); }
  std::span<const RecordedAxis> axes() const { return axes_; }
  const RecordedAxis* axis(std::uint32_t code) const;  // Null: the range of this axis is not known.

  // Appends the device and its reports. The tools keep no state from before the first event: an
  // axis has the value of its first event until then, or stands in its middle if it has none; no
  // key is pressed. Error: there are more reports than a trace may have.
  std::optional<Error> append_to(Trace& trace) const;

 private:
  EvdevAbilities abilities() const;
  EvdevState first_state() const;

  std::vector<RecordedAxis> axes_;
  std::vector<std::uint16_t> keys_;
  std::vector<EvdevEvent> events_;
};

// Reads the recordings of one tool, line by line.
class EvdevReader {
 public:
  std::vector<EvdevRecording> nodes;
  std::int64_t line_number = 0;  // number of the line that is added next, from 1

  virtual ~EvdevReader() = default;
  // Takes a line. Returns why it is damaged, without its place; none: it is not.
  virtual std::optional<std::string> add(std::string_view line) = 0;
  // The text for an error if no node has an axis or a key.
  virtual std::string missing() const { return "no device with an axis or a key"; }
};

bool is_evdev_recording(std::string_view text) noexcept;

struct EvdevRecordings {
  std::vector<EvdevRecording> nodes;  // at least one node, each with an axis or a key
  std::int64_t skipped_lines = 0;
  std::string first_damage;
};
// `name` stands for the path in errors.
Result<EvdevRecordings> evdev_recordings(std::string_view text, const std::string& name,
                                         Damage damage);
// Every node is a device of the trace, of the evdev driver; their events share one time.
Result<Trace> parse_evdev_recording(std::string_view text, const std::string& name, Damage damage);

}  // namespace gaitpad
