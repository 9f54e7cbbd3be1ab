// A pad on one of the Xbox protocols over USB, read by the descriptor that its model states and the
// shipped files.
#pragma once
#include <gtest/gtest.h>

#include "drivers/scripted_port.h"
#include "gaitpad/decode.h"
#include "tests/hid/made_pads.h"

namespace gaitpad {

class XboxPad : public testing::Test {
 protected:
  using Make = VendorPad (*)(const UsbInterfaceClass&, const DeviceInfo&);

  void use(Make make, const UsbInterfaceClass& interface, std::uint16_t vendor,
           std::uint16_t product) {
    DeviceInfo info;
    info.bus = BusType::usb;
    info.vendor = vendor;
    info.product = product;
    info.driver = "usb";
    info.name = "pad";
    VendorPad pad = make(interface, info);
    info.descriptor = pad.descriptor;
    layout_ = value_of(pad_layout(info, shipped_pads()));
    EXPECT_TRUE(layout_.is_pad);
    EXPECT_TRUE(layout_.unnamed.empty());
    model_ = std::move(pad.model);
    state_ = {};
  }
  bool decodes(const Packet& packet) { return decode(layout_, report_of(packet), state_); }
  // Of a packet with this bit too.
  std::uint32_t buttons_of(Packet packet, std::size_t byte, int bit) {
    packet[byte] = static_cast<std::uint8_t>(1 << bit);
    EXPECT_TRUE(decodes(packet));
    return state_.buttons;
  }

  PadLayout layout_;
  PadState state_;
  std::unique_ptr<PadModel> model_;
  OutPacket reply_;
};

}  // namespace gaitpad
