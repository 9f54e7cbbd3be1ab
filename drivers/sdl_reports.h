// SDL joysticks as HID pads. SDL numbers axes, buttons and hats; these are stated like the evdev
// node that SDL reads, with SDL's ranges, so that both drivers give the controls the same names.
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

// The evdev code of each number; of a hat its x code.
struct JoystickCodes {
  std::vector<std::uint16_t> axes, buttons, hats;
  bool operator==(const JoystickCodes&) const = default;
};
// The codes by the node's bits in sysfs (capabilities/abs, capabilities/key): hexadecimal words,
// the lowest last. None if SDL has counted other numbers of controls.
std::optional<JoystickCodes> node_codes(std::string_view abs_bits, std::string_view key_bits,
                                        const JoystickState& counted);
// Plausible codes in SDL's order, for a joystick without a node; too many controls are left out.
JoystickCodes plain_codes(const JoystickState& counted);

// Axes are -32768 .. 32767, whatever the node has. `own_descriptor`: as in evdev_layout().
EvdevLayout joystick_layout(const JoystickCodes& codes,
                            std::span<const std::uint8_t> own_descriptor);

// Combines changes of single controls to reports.
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

  std::deque<Change> changes;  // waiting; changes of controls that do not exist are skipped
  const JoystickState& state() const noexcept { return state_; }
  const EvdevLayout& layout() const noexcept { return layout_; }
  // False while all axes are at their lower ends: the kernel says 0, the end of most axes, until
  // the pad has sent something.
  bool is_known() const noexcept;
  // Puts the waiting changes into one report, up to the second change of one control, so that no
  // change is lost. False: nothing has changed.
  bool next(Report& report) noexcept;
  void write(std::int64_t time_ns, Report& report) const noexcept;

 private:
  std::optional<std::size_t> changed_control(const Change& change) const noexcept;
  void apply(const Change& change) noexcept;

  JoystickState state_;
  JoystickCodes codes_;
  EvdevLayout layout_;
  std::vector<std::uint64_t>
      changed_in_;  // by control: the number of the report with its last change
  std::uint64_t report_number_ = 0;
};

// For the joystick that SDL reads from that node; a name that is no evdev node means no node.
JoystickReports joystick_reports(JoystickState state, const std::string& node,
                                 std::uint16_t version);

// The reports of SDL on one open joystick that its device has not read yet.
struct JoystickInbox {
  std::int32_t joystick = -1;  // SDL's instance id
  std::deque<JoystickReports::Change> changes;
  bool removed = false;
  std::int64_t lost = 0;  // the oldest changes, if the reader is too slow
};

// The inboxes of all open devices; filled by any thread that updates SDL's joysticks.
class JoystickInboxes {
 public:
  static constexpr std::size_t kMaxChanges = 8192;  // waiting in one inbox

  void add(JoystickInbox& inbox);
  void remove(const JoystickInbox& inbox) noexcept;
  JoystickInbox take(JoystickInbox& inbox);  // takes its content out
  bool has(std::int32_t joystick) const noexcept;
  void put(std::int32_t joystick, const JoystickReports::Change& change);
  // Drops the last changes as long as `is_reset` is true of them.
  void mark_removed(std::int32_t joystick,
                    const std::function<bool(const JoystickReports::Change&)>& is_reset);

 private:
  mutable std::mutex mutex_;
  std::vector<JoystickInbox*> inboxes_;
};

}  // namespace gaitpad
