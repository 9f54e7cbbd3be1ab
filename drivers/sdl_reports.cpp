#include "drivers/sdl_reports.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "base/text.h"
#include "drivers/system_nodes.h"

namespace gaitpad {
namespace {

constexpr std::int32_t kAxisMin = -32768, kAxisMax = 32767;

// Codes below `end` whose bits are set. A word is as wide as the kernel's long.
std::vector<std::uint16_t> set_codes(std::string_view text, std::uint16_t end) {
  constexpr unsigned kWordBits = 8 * sizeof(long);
  std::vector<std::uint16_t> codes;
  for (unsigned word = 0; !text.empty() && word * kWordBits < end; ++word) {
    const std::size_t last = text.find_last_not_of(" \n");
    if (last == std::string_view::npos) break;
    text = text.substr(0, last + 1);
    const std::size_t begin = text.find_last_of(" \n") + 1;  // 0 where there is none before it
    std::string_view digits = text.substr(begin);
    const std::uint64_t bits = take_number<std::uint64_t>(digits, 16).value_or(0);
    for (unsigned i = 0; i < kWordBits && word * kWordBits + i < end; ++i) {
      if (((bits >> i) & 1u) != 0)
        codes.push_back(static_cast<std::uint16_t>(word * kWordBits + i));
    }
    text = text.substr(0, begin);
  }
  return codes;
}

bool is_hat_code(std::uint16_t code) {
  return code >= evdev::kAbsHat0X && code <= evdev::kAbsHat3Y;
}

// SDL takes all hats as switches or, if the kernel gives them a fuzz, as axes.
void divide_axes(const std::vector<std::uint16_t>& all, bool has_hats, JoystickCodes& codes) {
  for (const std::uint16_t code : all) {
    if (!has_hats || !is_hat_code(code)) {
      codes.axes.push_back(code);
      continue;
    }
    const auto x = static_cast<std::uint16_t>(code & ~1u);
    if (codes.hats.empty() || codes.hats.back() != x) codes.hats.push_back(x);
  }
}

}  // namespace

std::optional<JoystickCodes> node_codes(std::string_view abs_bits, std::string_view key_bits,
                                        const JoystickState& counted) {
  JoystickCodes codes;
  divide_axes(set_codes(abs_bits, evdev::kAbsMax), !counted.hats.empty(), codes);
  codes.buttons = set_codes(key_bits, evdev::kKeyMax);
  // SDL counts from BTN_JOYSTICK on, then the codes below.
  std::stable_partition(codes.buttons.begin(), codes.buttons.end(),
                        [](std::uint16_t code) { return code >= evdev::kBtnJoystick; });
  const bool fits = codes.axes.size() == counted.axes.size() &&
                    codes.buttons.size() == counted.buttons.size() &&
                    codes.hats.size() == counted.hats.size();
  if (!fits) return std::nullopt;
  return codes;
}

JoystickCodes plain_codes(const JoystickState& counted) {
  // With up to five axes the second stick is Z, Rz; with more these are the triggers.
  constexpr std::uint16_t kFew[] = {0x00, 0x01, 0x02, 0x05, 0x06};
  constexpr std::uint16_t kMostAxes = 16, kPadButtons = 16;
  constexpr std::uint16_t kHappyButtons = evdev::kKeyMax - evdev::kBtnTriggerHappy;
  JoystickCodes codes;
  for (std::uint16_t i = 0; i < kMostAxes && i < counted.axes.size(); ++i) {
    codes.axes.push_back(counted.axes.size() <= std::size(kFew) ? kFew[i] : i);
  }
  for (std::uint16_t i = 0; i < kPadButtons + kHappyButtons && i < counted.buttons.size(); ++i) {
    const std::uint32_t code =
        i < kPadButtons ? evdev::kBtnJoystick + i : evdev::kBtnTriggerHappy + i - kPadButtons;
    codes.buttons.push_back(static_cast<std::uint16_t>(code));
  }
  for (std::uint16_t i = 0; i < 4 && i < counted.hats.size(); ++i) {
    codes.hats.push_back(static_cast<std::uint16_t>(evdev::kAbsHat0X + 2 * i));
  }
  return codes;
}

EvdevLayout joystick_layout(const JoystickCodes& codes,
                            std::span<const std::uint8_t> own_descriptor) {
  EvdevAbilities abilities;
  for (const std::uint16_t code : codes.axes) abilities.axes.push_back({code, kAxisMin, kAxisMax});
  for (const std::uint16_t x : codes.hats) {
    abilities.axes.push_back({x, -1, 1});
    abilities.axes.push_back({static_cast<std::uint16_t>(x + 1), -1, 1});
  }
  std::sort(abilities.axes.begin(), abilities.axes.end(),
            [](const EvdevAxis& a, const EvdevAxis& b) { return a.code < b.code; });
  abilities.keys = codes.buttons;
  std::sort(abilities.keys.begin(), abilities.keys.end());
  return evdev_layout(abilities, own_descriptor);
}

void JoystickReports::write(std::int64_t time_ns, Report& report) const noexcept {
  EvdevState node;
  for (std::size_t i = 0; i < state_.axes.size() && i < codes_.axes.size(); ++i) {
    node.axis[codes_.axes[i]] = state_.axes[i];
  }
  for (std::size_t i = 0; i < state_.buttons.size() && i < codes_.buttons.size(); ++i) {
    node.keys[codes_.buttons[i]] = state_.buttons[i] != 0;
  }
  for (std::size_t i = 0; i < state_.hats.size() && i < codes_.hats.size(); ++i) {
    const unsigned mask = state_.hats[i];
    const auto down = [mask](unsigned bit) { return (mask & bit) != 0 ? 1 : 0; };
    node.axis[codes_.hats[i]] = down(2) - down(8);
    node.axis[codes_.hats[i] + 1u] = down(4) - down(1);
  }
  put_state(layout_, node, report);
  report.time_ns = time_ns;
  report.kind = ReportKind::input;
}

bool JoystickReports::is_known() const noexcept {
  const auto is_end = [](std::int16_t value) { return value == kAxisMin; };
  return state_.axes.empty() || !std::all_of(state_.axes.begin(), state_.axes.end(), is_end);
}

// The index of the control among all; none if it does not exist or has that value already.
std::optional<std::size_t> JoystickReports::changed_control(const Change& c) const noexcept {
  const auto place = [&c](const auto& values, std::size_t before) -> std::optional<std::size_t> {
    if (c.number >= values.size() || values[c.number] == c.value) return std::nullopt;
    return before + c.number;
  };
  const std::size_t axes = state_.axes.size(), buttons = state_.buttons.size();
  switch (c.control) {
    case Control::axis:
      return place(state_.axes, 0);
    case Control::button:
      return place(state_.buttons, axes);
    case Control::hat:
      return place(state_.hats, axes + buttons);
  }
  return std::nullopt;
}

void JoystickReports::apply(const Change& c) noexcept {
  switch (c.control) {
    case Control::axis:
      state_.axes[c.number] = c.value;
      return;
    case Control::button:
      state_.buttons[c.number] = static_cast<std::uint8_t>(c.value);
      return;
    case Control::hat:
      state_.hats[c.number] = static_cast<std::uint8_t>(c.value);
      return;
  }
}

bool JoystickReports::next(Report& report) noexcept {
  ++report_number_;
  std::optional<std::int64_t> time_ns;
  while (!changes.empty()) {
    const Change& change = changes.front();
    if (const auto control = changed_control(change)) {
      if (changed_in_[*control] == report_number_) break;
      changed_in_[*control] = report_number_;
      apply(change);
      time_ns = change.time_ns;
    }
    changes.pop_front();
  }
  if (!time_ns) return false;
  write(*time_ns, report);
  return true;
}

namespace {

// A file of the node's input device.
std::string in_sysfs(const std::string& node, const char* name) {
  return fmt::format("/sys/class/input/{}/device/{}", node.substr(node.rfind('/') + 1), name);
}

}  // namespace

JoystickReports joystick_reports(JoystickState state, const std::string& node,
                                 std::uint16_t version) {
  constexpr std::uint16_t kCodesByKernel = 0x8000;  // its driver chose codes of its own
  std::vector<std::uint8_t> own;
  auto codes = node_codes(sysfs_text(in_sysfs(node, "capabilities/abs")),
                          sysfs_text(in_sysfs(node, "capabilities/key")), state);
  if (!codes) {
    codes = plain_codes(state);
  } else if ((version & kCodesByKernel) == 0) {
    own = sysfs_bytes(in_sysfs(node, "device/report_descriptor"));
  }
  EvdevLayout layout = joystick_layout(*codes, own);
  return {std::move(state), std::move(*codes), std::move(layout)};
}

void JoystickInboxes::add(JoystickInbox& inbox) {
  const std::lock_guard lock(mutex_);
  inboxes_.push_back(&inbox);
}

void JoystickInboxes::remove(const JoystickInbox& inbox) noexcept {
  const std::lock_guard lock(mutex_);
  std::erase(inboxes_, &inbox);
}

JoystickInbox JoystickInboxes::take(JoystickInbox& inbox) {
  const std::lock_guard lock(mutex_);
  JoystickInbox taken = std::move(inbox);
  inbox = {taken.joystick, {}, taken.removed, taken.lost};
  return taken;
}

bool JoystickInboxes::has(std::int32_t joystick) const noexcept {
  const std::lock_guard lock(mutex_);
  return std::ranges::any_of(inboxes_,
                             [joystick](const auto* i) { return i->joystick == joystick; });
}

void JoystickInboxes::put(std::int32_t joystick, const JoystickReports::Change& change) {
  const std::lock_guard lock(mutex_);
  for (JoystickInbox* inbox : inboxes_) {
    if (inbox->joystick != joystick) continue;
    if (inbox->changes.size() >= kMaxChanges) {
      inbox->changes.pop_front();  // the newest changes restore the state
      ++inbox->lost;
    }
    inbox->changes.push_back(change);
  }
}

void JoystickInboxes::mark_removed(
    std::int32_t joystick, const std::function<bool(const JoystickReports::Change&)>& is_reset) {
  const std::lock_guard lock(mutex_);
  for (JoystickInbox* inbox : inboxes_) {
    if (inbox->joystick != joystick || inbox->removed) continue;
    inbox->removed = true;
    auto& changes = inbox->changes;
    while (!changes.empty() && is_reset(changes.back())) changes.pop_back();
  }
}

}  // namespace gaitpad
