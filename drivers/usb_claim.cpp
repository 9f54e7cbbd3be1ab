#include "drivers/usb_claim.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>

#include <cstring>

#include "drivers/system_nodes.h"

namespace gaitpad {

Error usb_error(const std::string& node, std::string_view what, int error) {
  return Error{fmt::format("{}: {}: {}", node, what, libusb_strerror(error))};
}

Result<std::unique_ptr<ClaimedInterface>> ClaimedInterface::claim(const std::string& node,
                                                                  const UsbInterface& interface) {
  std::unique_ptr<ClaimedInterface> claimed(new ClaimedInterface(interface.number));
  if (auto opened = claimed->open(node); !opened) return opened.error();
  if (auto taken = claimed->take(node, interface.kernel_driver); !taken) return taken.error();
  return claimed;
}

Result<bool> ClaimedInterface::open(const std::string& node) {
  node_ = OwnedFd(::open(node.c_str(), O_RDWR | O_CLOEXEC));
  if (node_.get() < 0) {
    const int cause = errno;
    const std::string problem = access_problem(node);
    return Error{problem.empty() ? fmt::format("{}: {}", node, std::strerror(cause)) : problem};
  }
  // The devices are known from sysfs. For the whole process: libusb has no other way to say it.
  libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
  libusb_context* context = nullptr;
  int error = libusb_init(&context);
  if (error != LIBUSB_SUCCESS) return usb_error(node, "libusb does not start", error);
  context_.reset(context);
  libusb_device_handle* handle = nullptr;
  error = libusb_wrap_sys_device(context, node_.get(), &handle);
  if (error != LIBUSB_SUCCESS) return usb_error(node, "cannot be opened", error);
  handle_.reset(handle);
  return true;
}

Result<bool> ClaimedInterface::take(const std::string& node, const std::string& kernel_driver) {
  if (!kernel_driver.empty()) {
    auto watcher = ReattachWatcher::start(node, number_);
    if (!watcher) return watcher.error();
    watcher_ = std::make_unique<ReattachWatcher>(std::move(*watcher));
    const int error = libusb_detach_kernel_driver(handle(), number_);
    if (error != LIBUSB_SUCCESS && error != LIBUSB_ERROR_NOT_FOUND) {
      return usb_error(node, fmt::format("the kernel's driver {} stays", kernel_driver), error);
    }
  }
  const int error = libusb_claim_interface(handle(), number_);
  if (error == LIBUSB_ERROR_BUSY) return Error{node + ": another program has the pad"};
  if (error != LIBUSB_SUCCESS) return usb_error(node, "the pad cannot be taken", error);
  is_claimed_ = true;
  return true;
}

ClaimedInterface::~ClaimedInterface() {
  if (is_claimed_) libusb_release_interface(handle(), number_);
  if (!watcher_) return;
  const int error = libusb_attach_kernel_driver(handle(), number_);
  // BUSY: it has a driver. NOT_FOUND: the kernel has none that fits any more. Else the watcher goes
  // on trying.
  if (error == LIBUSB_SUCCESS || error == LIBUSB_ERROR_NO_DEVICE || error == LIBUSB_ERROR_BUSY ||
      error == LIBUSB_ERROR_NOT_FOUND) {
    watcher_->dismiss();
  }
}

}  // namespace gaitpad
