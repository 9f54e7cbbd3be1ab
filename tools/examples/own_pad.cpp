// A device of your own: its report descriptor and its reports in, calibrated sticks out. The bytes
// may come from anywhere, a microcontroller or a file; no driver and no real device takes part.
#include <gaitpad/calibration.h>
#include <gaitpad/decode.h>

#include <algorithm>
#include <cstdio>
#include <vector>

namespace {

// A game pad with X and Y of 8 bits and eight buttons. Its reports have three bytes and no id.
const std::vector<std::uint8_t> kDescriptor = {
    0x05, 0x01, 0x09, 0x05, 0xa1, 0x01,              // Generic Desktop, Game Pad, Application
    0x09, 0x30, 0x09, 0x31,                          // usages X, Y
    0x15, 0x00, 0x26, 0xff, 0x00,                    // range 0 to 255
    0x75, 0x08, 0x95, 0x02, 0x81, 0x02,              // 8 bits, two of them, Input
    0x05, 0x09, 0x19, 0x01, 0x29, 0x08,              // Buttons 1 to 8
    0x25, 0x01, 0x75, 0x01, 0x95, 0x08, 0x81, 0x02,  // range 0 to 1, 1 bit, eight of them, Input
    0xc0};

}  // namespace

int main() {
  gaitpad::DeviceInfo device;
  device.name = "own pad";
  device.descriptor = kDescriptor;
  const auto layout = gaitpad::pad_layout(device);
  if (!layout) {
    std::fprintf(stderr, "own_pad: %s\n", layout.error().message.c_str());
    return 1;
  }

  const std::vector<std::vector<std::uint8_t>> reports = {
      {0x80, 0x80, 0x00}, {0x80, 0x00, 0x01}, {0xff, 0x80, 0x00}, {0xc0, 0x20, 0x02}, {0x80}};
  const gaitpad::Calibration calibration;  // has the default zones of an unknown stick
  gaitpad::PadState state;
  int refused = 0;
  std::puts("x,y,buttons");
  for (const std::vector<std::uint8_t>& bytes : reports) {
    gaitpad::Report report;
    report.size = static_cast<std::uint16_t>(bytes.size());
    std::copy(bytes.begin(), bytes.end(), report.bytes.begin());
    if (!gaitpad::decode(*layout, report, state)) {  // too short, or not of this device
      ++refused;
      continue;
    }
    const gaitpad::Stick stick = gaitpad::stick_position(calibration, state);
    std::printf("%+.4f,%+.4f,", stick.left.x, stick.left.y);
    for (int button = 0; button < gaitpad::kButtonCount; ++button) {
      if (gaitpad::pressed(state, gaitpad::PadButton(button))) {
        std::printf("%s ", gaitpad::kButtonNames[button].data());
      }
    }
    std::putchar('\n');
  }
  std::fprintf(stderr, "%d of %zu reports were refused\n", refused, reports.size());
}
