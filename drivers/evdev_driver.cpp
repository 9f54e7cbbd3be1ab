// Pads through Linux's evdev, by libevdev: what the kernel's own driver made of the pad. Needs no
// more permission than desktops give their user for pads, knows the moment of each event, and
// serves pads that are no HID devices (xpad). The node is stated as a HID device: hid/evdev_layout.
#include <errno.h>
#include <fcntl.h>
#include <linux/input.h>
#include <sys/eventfd.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "drivers/driver_entries.h"
#include "drivers/evdev_nodes.h"

namespace gaitpad {

namespace {

constexpr int kMaxEventsAtOpening = 4096;
constexpr int kMaxErrorsInARow = 64;  // a source that only fails is given up
constexpr std::chrono::milliseconds kMaxUpload{250};

// One force-feedback effect, kept in the kernel and changed in place.
class Motors {
 public:
  // Uploads a silent effect. False where the device has no motors, or may not be written to.
  bool take(int fd, const libevdev* device) {
    if (!libevdev_has_event_code(device, EV_FF, FF_RUMBLE)) return false;
    fd_ = fd;
    effect_.type = FF_RUMBLE;
    effect_.id = -1;
    if (::ioctl(fd_, EVIOCSFF, &effect_) == 0) return true;
    fd_ = -1;
    return false;
  }
  void give_back() noexcept {
    if (fd_ >= 0) ::ioctl(fd_, EVIOCRMFF, static_cast<long>(effect_.id));
    fd_ = -1;
  }
  // Without an end of its own: it runs until it is changed, stopped, or its owner's handle closes.
  bool set(const Rumble& rumble) noexcept {
    if (fd_ < 0) return false;
    if (rumble.strong == 0 && rumble.weak == 0) return play(0);
    effect_.u.rumble.strong_magnitude = rumble.strong;
    effect_.u.rumble.weak_magnitude = rumble.weak;
    return ::ioctl(fd_, EVIOCSFF, &effect_) == 0 && play(1);
  }

 private:
  bool play(int times) noexcept {
    if (times != 0 && is_playing_) return true;  // a changed effect goes on by itself
    input_event event{};
    event.type = EV_FF;
    event.code = static_cast<std::uint16_t>(effect_.id);
    event.value = times;
    if (::write(fd_, &event, sizeof event) != sizeof event) return false;
    is_playing_ = times != 0;
    return true;
  }
  int fd_ = -1;
  ff_effect effect_{};
  bool is_playing_ = false;
};

class EvdevDevice final : public Device {
 public:
  EvdevDevice(DeviceInfo info, InputNode node, EvdevLayout layout)
      : info_(std::move(info)), node_(std::move(node)), layout_(std::move(layout)) {
    info_.descriptor = layout_.descriptor;
    wake_ = OwnedFd(::eventfd(1, EFD_CLOEXEC | EFD_NONBLOCK));
    poll_fds_[0] = {node_.fd.get(), POLLIN, 0};
    poll_fds_[1] = {wake_.get(), POLLIN, 0};
    take_state();
    for (int i = 0; i < kMaxEventsAtOpening && next_packet() == Status::report; ++i) continue;
    lost_ = 0;  // nobody has missed what came before the opening
    start_motors();
  }
  ~EvdevDevice() override { motors_.give_back(); }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override {
    return {poll_fds_.data(), is_first_ ? std::size_t{2} : std::size_t{1}};
  }
  Status read(Report& report) noexcept override;
  bool rumble(const Rumble& rumble) noexcept override { return motors_.set(rumble); }
  std::int64_t lost() const noexcept override { return lost_; }
  std::vector<std::string> take_remarks() override { return std::exchange(remarks_, {}); }

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
  Motors motors_;
  OwnedFd wake_;  // readable until the first report, which tells what is held already, is read
  std::array<pollfd, 2> poll_fds_{};
  bool is_first_ = true;
  int errors_in_a_row_ = 0;
  std::int64_t time_ns_ = 0;  // of the newest report; never goes back
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
  // Of a virtual device the program behind it answers, and may take its time for each change.
  const auto start = std::chrono::steady_clock::now();
  if (!motors_.take(node_.fd.get(), node_.device.get())) return;
  if (std::chrono::steady_clock::now() - start <= kMaxUpload) return;
  motors_.give_back();
  remarks_.push_back(info_.name + ": takes too long to set its motors, so it does not rumble");
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

// The kernel's buffer ran over: libevdev asks for the present state, which counts from here on.
void EvdevDevice::resynchronise() noexcept {
  ++lost_;
  input_event event{};
  int status = LIBEVDEV_READ_STATUS_SYNC;
  while (status == LIBEVDEV_READ_STATUS_SYNC) {
    status = libevdev_next_event(node_.device.get(), LIBEVDEV_READ_FLAG_SYNC, &event);
  }
  take_state();
}

// Reads up to the end of one packet of events (SYN_REPORT); `report` where there was a whole one.
Device::Status EvdevDevice::next_packet() noexcept {
  // With the flag libevdev asks the kernel only when it has handed on all that it took before; so
  // events that came before an unplug are not lost, and a packet costs one system call, not ten.
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

// A pad that has sent nothing yet: the kernel's axes stand at 0, which of 0..255 is far left and
// forward. One that is really held there will be seen when it moves.
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

// A node's number is used again: between looking and opening it may have become another device.
bool is_another(const libevdev* device, const DeviceInfo& info) {
  const char* port = libevdev_get_phys(device);
  return libevdev_get_id_vendor(device) != info.vendor ||
         libevdev_get_id_product(device) != info.product ||
         (!info.physical_path.empty() && info.physical_path != (port ? port : ""));
}

}  // namespace

Result<std::unique_ptr<Device>> open_evdev_device(const DeviceListing& listing, Detach) {
  auto opened = open_input_node(listing.node, O_RDWR);
  if (!opened) opened = open_input_node(listing.node, O_RDONLY);
  if (!opened) return opened.error();
  if (is_another(opened->device.get(), listing.info)) {
    return Error{listing.node + ": is another device by now"};
  }
  EvdevLayout layout = input_node_layout(*opened, listing.node);
  return std::unique_ptr<Device>(
      std::make_unique<EvdevDevice>(listing.info, std::move(*opened), std::move(layout)));
}

}  // namespace gaitpad
