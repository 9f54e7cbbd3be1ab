// What recordings of evdev nodes have in common, whichever tool wrote them: the node's abilities
// and its events become a device of a trace.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
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

// One node. The add_ functions give why the line that they are called for is damaged.
class EvdevRecording {
 public:
  DeviceInfo info;  // without driver and descriptor

  void add_key(std::uint16_t code);
  std::optional<std::string> add_axis(std::uint32_t code, std::int32_t min, std::int32_t max);
  // `time`: as it stands in the line.
  std::optional<std::string> add_event(const EvdevEvent& event, std::string_view time);
  bool has_abilities() const { return !abilities_.axes.empty() || !abilities_.keys.empty(); }

  // Appends the device and its reports. The tools keep no state from before the first event: an
  // axis has the value of its first event until then, or stands in its middle if it has none; no
  // key is pressed. Error: there are more reports than a trace may have.
  std::optional<Error> append_to(Trace& trace) const;

 private:
  EvdevState first_state() const;

  EvdevAbilities abilities_;
  std::vector<EvdevEvent> events_;
};

}  // namespace gaitpad
