// Pads through Linux's evdev, by libevdev: the events that the kernel's own driver makes of a pad's
// reports. It needs no more permission than desktops give their users for pads, has the kernel's
// time of each event, and serves pads that are no HID devices (xpad). The node is stated as a HID
// device: hid/evdev_layout.h.
#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <libevdev/libevdev.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/driver_rows.h"
#include "drivers/event_node.h"
#include "drivers/system_nodes.h"
#include "hid/evdev_layout.h"
#include "system/clock.h"
#include "system/descriptors.h"

namespace gaitpad {

namespace {

constexpr int kMaxEventsAtOpening = 4096;  // most packets that are skipped at the opening
constexpr int kMaxErrorsInARow = 64;       // more errors in a row: the pad counts as gone
// A device that takes longer to upload an effect does not rumble.
constexpr std::chrono::milliseconds kMaxUpload{250};

// ---- An open node

struct FreeLibevdev {
  void operator()(libevdev* device) const noexcept { libevdev_free(device); }
};
struct InputNode {
  OwnedFd fd;
  std::unique_ptr<libevdev, FreeLibevdev> device;
  bool may_write = false;
};

// A sentence for errno; if permission is missing it also says how to get it.
Error open_error(const std::string& node, int error) {
  const std::string access = error == EACCES || error == EPERM ? access_problem(node) : "";
  return Error{access.empty() ? fmt::format("{}: {}", node, std::strerror(error)) : access};
}

EvdevAbilities abilities_of(const libevdev* device) {
  EvdevAbilities abilities;
  for (std::uint16_t code = 0; code <= evdev::kAbsMax; ++code) {
    const input_absinfo* range = libevdev_get_abs_info(device, code);
    if (range) abilities.axes.push_back({code, range->minimum, range->maximum});
  }
  for (std::uint16_t code = 0; code <= evdev::kKeyMax; ++code) {
    if (libevdev_has_event_code(device, EV_KEY, code)) abilities.keys.push_back(code);
  }
  return abilities;
}

// A file of the node's input device.
std::string sysfs_file_path(const std::string& node, const char* name) {
  return fmt::format("/sys/class/input/{}/device/{}", node.substr(node.rfind('/') + 1), name);
}

// `mode` is O_RDONLY or O_RDWR. Reads never block; stamps are of CLOCK_MONOTONIC.
Result<InputNode> open_input_node(const std::string& node, int mode) {
  InputNode opened;
  opened.fd = OwnedFd(::open(node.c_str(), mode | O_NONBLOCK | O_CLOEXEC));
  if (opened.fd.get() < 0) return open_error(node, errno);
  opened.may_write = mode == O_RDWR;
  // The clock is set before libevdev reads the state, because a change of clock drops queued
  // events.
  int clock = CLOCK_MONOTONIC;
  if (::ioctl(opened.fd.get(), EVIOCSCLOCKID, &clock) != 0) return open_error(node, errno);
  // Without this, libevdev prints warnings about unusual devices to stderr.
  libevdev_set_log_function(nullptr, nullptr);
  libevdev* device = nullptr;
  const int status = libevdev_new_from_fd(opened.fd.get(), &device);
  if (status != 0) return open_error(node, -status);
  opened.device.reset(device);
  return opened;
}

// The node, stated as a HID device.
EvdevLayout input_node_layout(const InputNode& opened, const std::string& node) {
  std::vector<std::uint8_t> own_descriptor;
  const auto version = static_cast<unsigned>(libevdev_get_id_version(opened.device.get()));
  if ((version & kKernelCodesBit) == 0) {
    own_descriptor = sysfs_bytes(sysfs_file_path(node, "device/report_descriptor"));
  }
  return evdev_layout(abilities_of(opened.device.get()), own_descriptor);
}

// ---- The device

int error_of(int status) noexcept { return status < 0 ? errno : 0; }

// One force-feedback effect, kept in the kernel and changed in place.
class OwnEffect {
 public:
  // Uploads a silent effect. False: the device refuses it.
  bool upload(EffectTarget& target) {
    ff_effect effect{};
    effect.type = FF_RUMBLE;
    effect.id = -1;
    if (target.upload(effect) != 0) return false;
    target_ = &target;
    id_ = effect.id;
    return true;
  }
  void remove() noexcept {
    if (target_ != nullptr) static_cast<void>(target_->erase(id_));
    target_ = nullptr;
  }
  // Runs until it is changed or stopped, or the handle closes.
  bool set(const Rumble& rumble) noexcept {
    if (target_ == nullptr) return false;
    if (rumble.strong == 0 && rumble.weak == 0) return play(0);
    ff_effect effect{};
    effect.type = FF_RUMBLE;
    effect.id = id_;
    effect.u.rumble.strong_magnitude = rumble.strong;
    effect.u.rumble.weak_magnitude = rumble.weak;
    return target_->upload(effect) == 0 && play(1);
  }

 private:
  bool play(int times) noexcept {
    if (times != 0 && is_playing_) return true;  // a changed effect runs on by itself
    if (target_->send(static_cast<std::uint16_t>(id_), times) != 0) return false;
    is_playing_ = times != 0;
    return true;
  }
  EffectTarget* target_ = nullptr;  // null: the effect does not exist
  std::int16_t id_ = -1;
  bool is_playing_ = false;
};

class EvdevDevice final : public EventNode {
 public:
  EvdevDevice(DeviceInfo info, InputNode node, EvdevLayout layout)
      : info_(std::move(info)), node_(std::move(node)), layout_(std::move(layout)) {
    info_.descriptor = layout_.descriptor;
    wake_.ring();
    poll_fds_[0] = {node_.fd.get(), POLLIN, 0};
    poll_fds_[1] = {wake_.fd(), POLLIN, 0};
    take_state();
    for (int i = 0; i < kMaxEventsAtOpening && next_packet() == Status::report; ++i) continue;
    lost_ = 0;  // events from before the opening do not count as lost
    start_motors();
  }
  ~EvdevDevice() override { own_effect_.remove(); }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override {
    return {poll_fds_.data(), is_first_ ? std::size_t{2} : std::size_t{1}};
  }
  Status read(Report& report) noexcept override;
  bool rumble(const Rumble& rumble) noexcept override { return own_effect_.set(rumble); }
  std::int64_t lost() const noexcept override { return lost_; }
  std::vector<std::string> take_remarks() override { return std::exchange(remarks_, {}); }

  int grab() noexcept override;
  const EvdevState& state() const noexcept override { return state_; }
  const EvdevLayout& layout() const noexcept override { return layout_; }
  std::vector<std::uint16_t> effect_codes() const override;
  int upload(ff_effect& effect) noexcept override;
  int erase(int id) noexcept override;
  int send(std::uint16_t code, std::int32_t value) noexcept override;

 private:
  Status next_packet() noexcept;
  void resynchronise() noexcept;
  void take_event(const input_event& event) noexcept;
  void take_state() noexcept;
  bool is_untouched() const noexcept;
  void start_motors();

  DeviceInfo info_;
  InputNode node_;
  EvdevLayout layout_;
  EvdevState state_;
  OwnEffect own_effect_;
  // Makes the device readable until the first report, which has the present state, is read.
  Bell wake_;
  std::array<pollfd, 2> poll_fds_{};
  bool is_first_ = true;
  int errors_in_a_row_ = 0;
  std::int64_t time_ns_ = 0;  // stamp of the newest report; never decreases
  std::int64_t lost_ = 0;
  std::vector<std::string> remarks_;
};

void EvdevDevice::start_motors() {
  if (!node_.may_write) {
    if (libevdev_has_event_code(node_.device.get(), EV_FF, FF_RUMBLE)) {
      remarks_.push_back(info_.name + ": may be read only, so it does not rumble");
    }
    return;
  }
  if (!libevdev_has_event_code(node_.device.get(), EV_FF, FF_RUMBLE)) return;
  // Measures the time, because a virtual device is answered by a program, which may take long for
  // each change.
  const auto start = std::chrono::steady_clock::now();
  if (!own_effect_.upload(*this)) return;
  if (std::chrono::steady_clock::now() - start <= kMaxUpload) return;
  own_effect_.remove();
  remarks_.push_back(info_.name + ": takes too long to set its motors, so it does not rumble");
}

int EvdevDevice::grab() noexcept {
  own_effect_.remove();
  return error_of(::ioctl(node_.fd.get(), EVIOCGRAB, 1));
}

std::vector<std::uint16_t> EvdevDevice::effect_codes() const {
  std::vector<std::uint16_t> codes;
  if (!node_.may_write) return codes;
  for (std::uint16_t code = 0; code <= FF_MAX; ++code) {
    // The samples of a custom wave lie in the memory of the program that uploads it.
    if (code != FF_CUSTOM && libevdev_has_event_code(node_.device.get(), EV_FF, code))
      codes.push_back(code);
  }
  return codes;
}

int EvdevDevice::upload(ff_effect& effect) noexcept {
  return error_of(::ioctl(node_.fd.get(), EVIOCSFF, &effect));
}

int EvdevDevice::erase(int id) noexcept {
  return error_of(::ioctl(node_.fd.get(), EVIOCRMFF, static_cast<long>(id)));
}

int EvdevDevice::send(std::uint16_t code, std::int32_t value) noexcept {
  input_event event{};
  event.type = EV_FF;
  event.code = code;
  event.value = value;
  return error_of(static_cast<int>(::write(node_.fd.get(), &event, sizeof event)));
}

void EvdevDevice::take_state() noexcept {
  const libevdev* device = node_.device.get();
  const auto value = [device](EvdevCode c, int offset) {
    const auto code = static_cast<unsigned>(c.code + offset);
    return libevdev_get_event_value(device, static_cast<unsigned>(c.type), code);
  };
  for (const EvdevField& f : layout_.fields) {
    if (f.code.type == EvdevType::key) {
      state_.keys[f.code.code] = value(f.code, 0) != 0;
      continue;
    }
    state_.axis[f.code.code] = value(f.code, 0);
    if (f.is_hat) state_.axis[f.code.code + 1] = value(f.code, 1);
  }
}

void EvdevDevice::take_event(const input_event& event) noexcept {
  if (event.type == EV_ABS && event.code <= evdev::kAbsMax) {
    state_.axis[event.code] = event.value;
  } else if (event.type == EV_KEY && event.code <= evdev::kKeyMax) {
    state_.keys[event.code] = event.value != 0;
  }
}

// The kernel's buffer overflowed: libevdev asks for the present state.
void EvdevDevice::resynchronise() noexcept {
  ++lost_;
  input_event event{};
  int status = LIBEVDEV_READ_STATUS_SYNC;
  while (status == LIBEVDEV_READ_STATUS_SYNC) {
    status = libevdev_next_event(node_.device.get(), LIBEVDEV_READ_FLAG_SYNC, &event);
  }
  take_state();
}

// Reads up to the end of one packet of events (SYN_REPORT). `report`: the packet is complete.
Device::Status EvdevDevice::next_packet() noexcept {
  // With BLOCKING libevdev reads from the kernel only after it has returned all events of the last
  // read. So events before an unplugging are not lost, and a packet takes one system call instead
  // of ten.
  constexpr unsigned kFlags = LIBEVDEV_READ_FLAG_NORMAL | LIBEVDEV_READ_FLAG_BLOCKING;
  while (true) {
    input_event event{};
    const int status = libevdev_next_event(node_.device.get(), kFlags, &event);
    if (status == LIBEVDEV_READ_STATUS_SYNC) {
      resynchronise();
      time_ns_ = std::max(time_ns_, now_ns());
      return Status::report;
    }
    if (status != LIBEVDEV_READ_STATUS_SUCCESS) {
      if (status == -EAGAIN) return Status::nothing;
      if (status == -ENODEV || ++errors_in_a_row_ > kMaxErrorsInARow) return Status::gone;
      if (status != -EINTR) return Status::nothing;
      continue;
    }
    errors_in_a_row_ = 0;
    if (event.type == EV_SYN && event.code == SYN_REPORT) {
      const std::int64_t stamp_ns = std::int64_t{event.input_event_sec} * 1'000'000'000 +
                                    std::int64_t{event.input_event_usec} * 1'000;
      time_ns_ = std::max(time_ns_, stamp_ns);
      return Status::report;
    }
    take_event(event);
  }
}

// True if the pad has sent nothing yet. Its axes then read 0, which would be a push far left and
// forward if their range is 0..255. A stick that is really held there shows when it moves.
bool EvdevDevice::is_untouched() const noexcept {
  bool is_at_an_end = false;
  for (const EvdevField& f : layout_.fields) {
    if (f.code.type != EvdevType::absolute || f.is_hat) continue;
    if (state_.axis[f.code.code] != 0) return false;
    const bool is_left_stick = f.code.code == ABS_X || f.code.code == ABS_Y;
    is_at_an_end = is_at_an_end || (is_left_stick && f.min >= 0);
  }
  return is_at_an_end;
}

Device::Status EvdevDevice::read(Report& report) noexcept {
  if (std::exchange(is_first_, false) && !is_untouched()) {
    time_ns_ = now_ns();
  } else if (const Status status = next_packet(); status != Status::report) {
    return status;
  }
  report.time_ns = time_ns_;
  report.kind = ReportKind::input;
  put_state(layout_, state_, report);
  return Status::report;
}

// True if the node has become another device between finding and opening: node numbers are reused.
bool is_another(const libevdev* device, const DeviceInfo& info) {
  const char* port = libevdev_get_phys(device);
  const auto of_device = [](std::string_view path) { return path.substr(0, path.rfind("/input")); };
  return libevdev_get_id_vendor(device) != info.vendor ||
         libevdev_get_id_product(device) != info.product ||
         (!info.physical_path.empty() &&
          of_device(info.physical_path) != of_device(port ? port : ""));
}

// ---- Finding

bool has_key_between(const libevdev* device, unsigned first, unsigned end) {
  for (unsigned code = first; code < end; ++code) {
    if (libevdev_has_event_code(device, EV_KEY, code)) return true;
  }
  return false;
}

// The kind of device that the node is, such as a keyboard; empty: it is a pad.
const char* what_else(const libevdev* device, const SystemNode& node) {
  if (libevdev_has_property(device, INPUT_PROP_ACCELEROMETER) || node.name.ends_with("(IMU)") ||
      node.name.ends_with(" IMU")) {
    return "the motion sensor of a pad";
  }
  const bool has_stick = libevdev_has_event_code(device, EV_ABS, ABS_X) &&
                         libevdev_has_event_code(device, EV_ABS, ABS_Y);
  const bool has_buttons = has_key_between(device, BTN_JOYSTICK, BTN_DIGI);
  if (!has_buttons && has_key_between(device, BTN_DIGI, BTN_WHEEL)) {
    return "a touchpad or tablet";
  }
  if (!has_buttons && has_key_between(device, BTN_MOUSE, BTN_JOYSTICK)) return "a mouse";
  if (!has_stick) return "a device without a stick";
  const bool has_other_buttons = has_key_between(device, BTN_MISC, BTN_MOUSE) ||
                                 has_key_between(device, BTN_WHEEL, BTN_GEAR_UP + 1) ||
                                 has_key_between(device, BTN_DPAD_UP, BTN_DPAD_RIGHT + 1) ||
                                 has_key_between(device, BTN_TRIGGER_HAPPY, KEY_MAX + 1);
  if (has_buttons || has_other_buttons || node.is_joystick) return "";
  return "a device without buttons";
}

// Keyboards, mice and power buttons have neither ABS_X nor ABS_Y, which sysfs tells without opening
// them. The file holds words in hexadecimal, the lowest last.
bool cannot_have_a_stick(const std::string& node) {
  const std::string bits = sysfs_text(sysfs_file_path(node, "capabilities/abs"));
  return !bits.empty() && std::string_view("37bfBF").find(bits.back()) == std::string_view::npos;
}

// The facts about a node that were read when it was opened.
struct Seen {
  std::string other;  // the kind of device, if it is not a pad
  std::vector<std::uint8_t> descriptor;
};
// Nodes seen, by the sysfs path of the input device, whose number is never reused. They are kept
// because all nodes are looked at whenever anything is plugged in, and opening a HID pad takes the
// kernel 50 ms.
using Memory = std::map<std::string, Seen>;

// Looks at a node; error: why it cannot be opened.
Result<Seen> look_at(const SystemNode& node, const Memory& known) {
  if (node.is_motion_sensor) return Seen{"the motion sensor of a pad", {}};
  if (node.is_touchpad) return Seen{"a touchpad or tablet", {}};
  if (cannot_have_a_stick(node.node)) return Seen{"a device without a stick", {}};
  if (::access(node.node.c_str(), R_OK) != 0) return open_error(node.node, errno);
  const auto it = known.find(node.sysfs_path + (node.is_joystick ? " joystick" : ""));
  if (it != known.end()) return it->second;
  const auto opened = open_input_node(node.node, O_RDONLY);
  if (!opened) return opened.error();
  return Seen{what_else(opened->device.get(), node),
              input_node_layout(*opened, node.node).descriptor};
}

}  // namespace

std::vector<DeviceListing> find_evdev_devices() {
  static std::mutex one_at_a_time;
  static Memory known;
  const std::lock_guard lock(one_at_a_time);
  std::vector<DeviceListing> listings;
  Memory still_there;
  for (const SystemNode& node : system_nodes("input")) {
    DeviceListing& listing = listings.emplace_back(listing_of(node, "evdev"));
    auto seen = look_at(node, known);
    if (!seen) {
      listing.problem = seen.error().message;
      continue;
    }
    listing.info.descriptor = seen->descriptor;
    if (!seen->other.empty()) {
      listing.is_other = true;
      listing.problem = fmt::format("{}: {} is {}, not a pad", node.node, node.name, seen->other);
    }
    if (seen->descriptor.empty()) continue;
    still_there[node.sysfs_path + (node.is_joystick ? " joystick" : "")] = std::move(*seen);
  }
  known = std::move(still_there);
  return listings;
}

Result<std::unique_ptr<EventNode>> open_event_node(const DeviceListing& listing) {
  auto opened = open_input_node(listing.node, O_RDWR);
  if (!opened) opened = open_input_node(listing.node, O_RDONLY);
  if (!opened) return opened.error();
  if (is_another(opened->device.get(), listing.info)) {
    return Error{listing.node + ": is another device by now"};
  }
  EvdevLayout layout = input_node_layout(*opened, listing.node);
  return std::unique_ptr<EventNode>(
      std::make_unique<EvdevDevice>(listing.info, std::move(*opened), std::move(layout)));
}

Result<std::unique_ptr<Device>> open_evdev_device(const DeviceListing& listing, Detach) {
  auto node = open_event_node(listing);
  if (!node) return node.error();
  return std::unique_ptr<Device>(std::move(*node));
}

}  // namespace gaitpad
