// hidraw nodes as hidapi opens them, for the hidraw driver: the ways to an open one, and what
// hidapi 0.13 does not tell of it.
#pragma once
#include <hidapi/hidapi.h>

#include <memory>
#include <string>
#include <vector>

#include "drivers/pads/packet_sender.h"
#include "drivers/pads/pad_model.h"
#include "drivers/present_state.h"
#include "gaitpad/result.h"

namespace gaitpad {

struct CloseHandle {
  void operator()(hid_device* handle) const noexcept { hid_close(handle); }
};
using Handle = std::unique_ptr<hid_device, CloseHandle>;

struct OpenNode {
  Handle handle;
  int fd = -1;  // the handle's own, -1: not found
};

Result<OpenNode> open_hidraw_node(const std::string& node);
// Its report descriptor; empty: it cannot be read.
std::vector<std::uint8_t> hidraw_descriptor(int fd);
// A node's number is used again: between looking and opening it may have become another device.
bool is_another_hidraw(int fd, const DeviceInfo& info);

class HidrawPort final : public PadPort {
 public:
  HidrawPort(hid_device* handle, bool is_numbered) : handle_(handle), is_numbered_(is_numbered) {}
  bool write(std::span<const std::uint8_t> packet) noexcept override;
  std::size_t read(std::span<std::uint8_t> packet,
                   std::chrono::milliseconds timeout) noexcept override;
  std::size_t feature(std::uint8_t id, std::span<std::uint8_t> packet) noexcept override;

 private:
  hid_device* handle_;
  bool is_numbered_;
};

// For threads: each with a handle of its own, since hidapi writes its error text at all it does.
// Null where the node cannot be opened again, or no thread be started.
std::unique_ptr<PacketSender> hidraw_sender(const std::string& node, bool is_numbered);
PresentState::Ask hidraw_input_request(const std::string& node);

}  // namespace gaitpad
