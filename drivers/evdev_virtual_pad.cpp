// The virtual pad (drivers/virtual_pad.h), by libevdev's uinput.
#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>
#include <linux/uinput.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>

#include "drivers/driver_rows.h"
#include "drivers/virtual_pad.h"
#include "system/descriptors.h"

namespace gaitpad {
namespace {

struct FreeDevice {
  void operator()(libevdev* device) const noexcept { libevdev_free(device); }
};
struct FreeUinput {
  void operator()(libevdev_uinput* uinput) const noexcept { libevdev_uinput_destroy(uinput); }
};
using Uinput = std::unique_ptr<libevdev_uinput, FreeUinput>;

class EvdevVirtualPad final : public VirtualPad {
 public:
  EvdevVirtualPad(OwnedFd fd, Uinput uinput) : fd_(std::move(fd)), uinput_(std::move(uinput)) {}

  std::string node() const override {
    const char* node = libevdev_uinput_get_devnode(uinput_.get());
    return node != nullptr ? node : "an input node";
  }
  bool write(std::span<const VirtualPadEvent> events) noexcept override;
  pollfd fd() const noexcept override { return {fd_.get(), POLLIN, 0}; }
  void serve_effects(EffectTable& effects) noexcept override;

 private:
  bool send(std::span<const input_event> events) noexcept {
    const auto size = static_cast<ssize_t>(events.size_bytes());
    return ::write(fd_.get(), events.data(), events.size_bytes()) == size;
  }
  void answer_upload(std::uint32_t request, EffectTable& effects) noexcept;
  void answer_erasing(std::uint32_t request, EffectTable& effects) noexcept;

  OwnedFd fd_;
  Uinput uinput_;  // does not close fd_, which this class owns
};

input_event event_of(std::uint16_t type, std::uint16_t code, std::int32_t value) noexcept {
  input_event event{};
  event.type = type;
  event.code = code;
  event.value = value;
  return event;
}

// Writes the events by one system call, which has room for a whole pad's.
bool EvdevVirtualPad::write(std::span<const VirtualPadEvent> events) noexcept {
  if (events.empty()) return true;
  std::array<input_event, 64> packet;
  std::size_t count = 0;
  for (const VirtualPadEvent& e : events) {
    if (count + 1 == packet.size() && !send({packet.data(), std::exchange(count, 0)})) return false;
    packet[count++] = event_of(e.type, e.code, e.value);
  }
  packet[count++] = event_of(EV_SYN, SYN_REPORT, 0);
  return send({packet.data(), count});
}

void EvdevVirtualPad::serve_effects(EffectTable& effects) noexcept {
  input_event event;
  while (::read(fd_.get(), &event, sizeof event) == sizeof event) {
    const auto value = static_cast<std::uint32_t>(event.value);
    if (event.type == EV_FF) effects.send(event.code, event.value);
    if (event.type != EV_UINPUT) continue;
    if (event.code == UI_FF_UPLOAD) answer_upload(value, effects);
    if (event.code == UI_FF_ERASE) answer_erasing(value, effects);
  }
}

// A request may have vanished, if the program has given up meanwhile.
void EvdevVirtualPad::answer_upload(std::uint32_t request, EffectTable& effects) noexcept {
  uinput_ff_upload upload{};
  upload.request_id = request;
  if (::ioctl(fd_.get(), UI_BEGIN_FF_UPLOAD, &upload) != 0) return;
  upload.retval = -effects.upload(upload.effect);
  static_cast<void>(::ioctl(fd_.get(), UI_END_FF_UPLOAD, &upload));
}

void EvdevVirtualPad::answer_erasing(std::uint32_t request, EffectTable& effects) noexcept {
  uinput_ff_erase erase{};
  erase.request_id = request;
  if (::ioctl(fd_.get(), UI_BEGIN_FF_ERASE, &erase) != 0) return;
  erase.retval = -effects.erase(static_cast<int>(erase.effect_id));
  static_cast<void>(::ioctl(fd_.get(), UI_END_FF_ERASE, &erase));
}

Error uinput_error(int error) {
  const bool is_missing = error == ENOENT || error == ENODEV;
  const char* cure = is_missing        ? "; run: sudo modprobe uinput"
                     : error == EACCES ? "; run: sudo gaitpad forward --install-rules"
                                       : "";
  return Error{
      fmt::format("/dev/uinput: no pad can be made there: {}{}", std::strerror(error), cure)};
}

}  // namespace

Result<std::unique_ptr<VirtualPad>> make_evdev_virtual_pad(const VirtualPadShape& shape) {
  OwnedFd fd(::open("/dev/uinput", O_RDWR | O_NONBLOCK | O_CLOEXEC));
  if (fd.get() < 0) return uinput_error(errno);
  const std::string port = std::string(kVirtualPort) + shape.port;
  if (::ioctl(fd.get(), UI_SET_PHYS, port.c_str()) != 0) return uinput_error(errno);
  const std::unique_ptr<libevdev, FreeDevice> described(::libevdev_new());
  libevdev_set_name(described.get(), shape.name.c_str());
  libevdev_set_id_bustype(described.get(), static_cast<int>(shape.bus));
  libevdev_set_id_vendor(described.get(), shape.vendor);
  libevdev_set_id_product(described.get(), shape.product);
  libevdev_set_id_version(described.get(), shape.version);
  for (const VirtualPadAxis& axis : shape.axes) {
    input_absinfo range{};
    range.minimum = axis.min;
    range.maximum = axis.max;
    libevdev_enable_event_code(described.get(), EV_ABS, axis.code, &range);
  }
  for (const std::uint16_t code : shape.keys)
    libevdev_enable_event_code(described.get(), EV_KEY, code, nullptr);
  for (const std::uint16_t code : shape.effects)
    libevdev_enable_event_code(described.get(), EV_FF, code, nullptr);
  libevdev_uinput* made = nullptr;
  const int status = libevdev_uinput_create_from_device(described.get(), fd.get(), &made);
  if (status != 0) return uinput_error(-status);
  return std::unique_ptr<VirtualPad>(
      std::make_unique<EvdevVirtualPad>(std::move(fd), Uinput(made)));
}

}  // namespace gaitpad
