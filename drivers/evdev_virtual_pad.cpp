// The virtual pad (drivers/virtual_pad.h), by libevdev's uinput.
#include <errno.h>
#include <fmt/format.h>
#include <libevdev/libevdev-uinput.h>
#include <libevdev/libevdev.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <utility>

#include "drivers/driver_entries.h"
#include "drivers/virtual_pad.h"

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
  explicit EvdevVirtualPad(Uinput uinput) : uinput_(std::move(uinput)) {}
  std::string node() const override {
    const char* node = libevdev_uinput_get_devnode(uinput_.get());
    return node != nullptr ? node : "an input node";
  }

 private:
  bool write(std::span<const VirtualPadEvent> events) override {
    return std::ranges::all_of(events, [this](const VirtualPadEvent& e) {
      return libevdev_uinput_write_event(uinput_.get(), e.type, e.code, e.value) == 0;
    });
  }
  Uinput uinput_;
};

const char* cure(int error) {
  if (error == ENOENT || error == ENODEV) return "; run: sudo modprobe uinput";
  return error == EACCES ? "; run it as root" : "";
}

}  // namespace

Result<std::unique_ptr<VirtualPad>> make_evdev_virtual_pad() {
  const std::unique_ptr<libevdev, FreeDevice> described(::libevdev_new());
  libevdev_set_name(described.get(), "gaitpad calibrated pad");
  libevdev_set_id_bustype(described.get(), BUS_VIRTUAL);
  libevdev_set_id_vendor(described.get(), kVirtualPadVendor);
  libevdev_set_id_product(described.get(), kVirtualPadProduct);
  libevdev_set_id_version(described.get(), 1);
  for (const VirtualPadAxis& axis : virtual_pad_axes()) {
    input_absinfo range{};
    range.minimum = axis.min;
    range.maximum = axis.max;
    libevdev_enable_event_code(described.get(), EV_ABS, axis.code, &range);
  }
  for (const std::uint16_t code : virtual_pad_keys())
    libevdev_enable_event_code(described.get(), EV_KEY, code, nullptr);
  libevdev_uinput* made = nullptr;
  const int status =
      libevdev_uinput_create_from_device(described.get(), LIBEVDEV_UINPUT_OPEN_MANAGED, &made);
  if (status != 0)
    return Error{fmt::format("/dev/uinput: no pad can be made there: {}{}", std::strerror(-status),
                             cure(-status))};
  return std::unique_ptr<VirtualPad>(std::make_unique<EvdevVirtualPad>(Uinput(made)));
}

}  // namespace gaitpad
