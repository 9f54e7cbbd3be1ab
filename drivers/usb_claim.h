// A USB interface in our hands: its device's node open, a kernel driver that had it detached, and
// all of that undone at the end, however the process ends.
#pragma once
#include <libusb.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "drivers/posix.h"
#include "drivers/usb_interfaces.h"
#include "drivers/usb_reattach.h"
#include "gaitpad/result.h"

namespace gaitpad {

// `NODE: WHAT: the library's word`
Error usb_error(const std::string& node, std::string_view what, int error);

struct ExitContext {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
struct CloseHandle {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};

// One context a pad: no thread of the library, no other pad's events.
class ClaimedInterface {
 public:
  static Result<std::unique_ptr<ClaimedInterface>> claim(const std::string& node,
                                                         const UsbInterface& interface);
  ~ClaimedInterface();
  libusb_context* context() const { return context_.get(); }
  libusb_device_handle* handle() const { return handle_.get(); }

 private:
  explicit ClaimedInterface(std::uint8_t number) : number_(number) {}
  Result<bool> open(const std::string& node);
  Result<bool> take(const std::string& node, const std::string& kernel_driver);

  OwnedFd node_;
  std::uint8_t number_;
  std::unique_ptr<libusb_context, ExitContext> context_;
  std::unique_ptr<libusb_device_handle, CloseHandle> handle_;
  std::unique_ptr<ReattachWatcher> watcher_;  // where there was a kernel driver
  bool is_claimed_ = false;
};

}  // namespace gaitpad
