// What a joystick of SDL's, numbered axes, buttons and hats, is as a HID pad: stated as the evdev
// node that SDL reads it from, so that both drivers name its controls alike, with SDL's ranges.
#pragma once
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gaitpad/report.h"
#include "hid/evdev_layout.h"

namespace gaitpad {

struct JoystickState {
  std::vector<std::int16_t> axes;
  std::vector<std::uint8_t> buttons;  // 0 or 1
  std::vector<std::uint8_t> hats;     // SDL's mask: 1 up, 2 right, 4 down, 8 left
  std::size_t count() const { return axes.size() + buttons.size() + hats.size(); }
};

// The evdev code that each number stands for; of a hat its x code.
struct JoystickCodes {
  std::vector<std::uint16_t> axes, buttons, hats;
  bool operator==(const JoystickCodes&) const = default;
};
// From the node's bits in sysfs (capabilities/abs, capabilities/key): words in hexadecimal, the
// lowest last. Nothing where SDL counts otherwise.
std::optional<JoystickCodes> node_codes(std::string_view abs_bits, std::string_view key_bits,
                                        const JoystickState& counted);
// Made up, in SDL's order, for what has no node; what is too much is left out.
JoystickCodes plain_codes(const JoystickState& counted);

// Axes -32768 .. 32767, whatever the node has. `own_descriptor` as in evdev_layout().
EvdevLayout joystick_layout(const JoystickCodes& codes,
                            std::span<const std::uint8_t> own_descriptor);

// Changes of single controls, put together to reports.
class JoystickReports {
 public:
  enum class Control : std::uint8_t { axis, button, hat };
  struct Change {
    std::int64_t time_ns = 0;
    Control control = Control::axis;
    std::uint8_t number = 0;
    std::int16_t value = 0;
  };
  JoystickReports(JoystickState state, JoystickCodes codes, EvdevLayout layout)
      : state_(std::move(state)),
        codes_(std::move(codes)),
        layout_(std::move(layout)),
        changed_in_(state_.count()) {}

  std::deque<Change> changes;  // that wait; those of controls that it does not have are skipped
  const JoystickState& state() const noexcept { return state_; }
  const EvdevLayout& layout() const noexcept { return layout_; }
  // False while all axes stand at their lower ends: of a node of which the kernel has heard nothing
  // yet, which says 0 then, the end of most axes.
  bool is_known() const noexcept;
  // All that waits in one report, but the second change of a control begins another: nothing is
  // lost. False where nothing has changed.
  bool next(Report& report) noexcept;
  void write(std::int64_t time_ns, Report& report) const noexcept;

 private:
  std::optional<std::size_t> changed_control(const Change& change) const noexcept;
  void apply(const Change& change) noexcept;

  JoystickState state_;
  JoystickCodes codes_;
  EvdevLayout layout_;
  std::vector<std::uint64_t> changed_in_;  // by control: the report that has its last change
  std::uint64_t report_number_ = 0;
};

// For the joystick that SDL reads from that node; other names than of evdev nodes are none.
JoystickReports joystick_reports(JoystickState state, const std::string& node,
                                 std::uint16_t version);

// What SDL has said of one open joystick and its device has not yet read.
struct JoystickInbox {
  std::int32_t joystick = -1;  // SDL's instance id
  std::deque<JoystickReports::Change> changes;
  bool removed = false;
  std::int64_t lost = 0;  // the oldest ones, where the reader stays away too long
};

// Those of all open devices; filled by whichever thread makes SDL look at its joysticks.
class JoystickInboxes {
 public:
  static constexpr std::size_t kMaxChanges = 8192;  // that wait in one

  void add(JoystickInbox& inbox);
  void remove(const JoystickInbox& inbox) noexcept;
  JoystickInbox take(JoystickInbox& inbox);  // what has come since the last taking
  void put(std::int32_t joystick, const JoystickReports::Change& change);
  // The last changes are taken back as long as `is_unsaid`.
  void mark_removed(std::int32_t joystick,
                    const std::function<bool(const JoystickReports::Change&)>& is_unsaid);

 private:
  std::mutex mutex_;
  std::vector<JoystickInbox*> inboxes_;
};

}  // namespace gaitpad
