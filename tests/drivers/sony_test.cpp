// Numbers: Linux's hid-playstation.c (6.1) and its packets to a virtual pad.
#include <gtest/gtest.h>

#include <string_view>

#include "drivers/pads/crc32.h"
#include "drivers/scripted_port.h"

namespace gaitpad {
namespace {

constexpr std::uint16_t kDualShock4 = 0x09cc, kDualSense = 0x0ce6, kEdge = 0x0df2;
constexpr Rumble kRumble = {.strong = 0xc000, .weak = 0x4000};

std::unique_ptr<PadQuirks> quirks(std::uint16_t product, BusType bus) {
  DeviceInfo device;
  device.bus = bus;
  device.vendor = 0x054c;
  device.product = product;
  device.name = "Pad";
  return make_sony_quirks(device);
}

// CRC-32 by its definition, bit by bit: reflected polynomial, start and end inverted.
std::uint32_t crc_by_bits(const Packet& bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const std::uint8_t byte : bytes) {
    for (int i = 0; i < 8; ++i) {
      const std::uint32_t bit = ((byte >> i) ^ crc) & 1;
      crc = (crc >> 1) ^ (bit * 0xedb88320u);
    }
  }
  return ~crc;
}

// A report with its checksum put into the last four bytes.
Packet sealed(std::uint8_t seed, Packet report) {
  Packet covered(report.begin(), report.end() - 4);
  covered.insert(covered.begin(), seed);
  const std::uint32_t sum = crc_by_bits(covered);
  for (std::size_t i = 0; i < 4; ++i)
    report[report.size() - 4 + i] = static_cast<std::uint8_t>(sum >> (8 * i));
  return report;
}

bool accepts(PadQuirks& pad, const Packet& packet) {
  OutPacket reply;
  const bool is_input = pad.accept(packet, reply);
  EXPECT_EQ(reply.size, 0u);
  return is_input;
}

// The order is that of Linux's hid-sony.c, sixaxis_set_operational_usb().
TEST(DualShock3, IsStartedByReadingTwoFeaturesOnUsbWithoutTheKernel) {
  for (const auto& [bus, started, asked] :
       {std::tuple(BusType::usb, StartedBy::us, std::vector<std::uint8_t>{0xf2, 0xf5}),
        std::tuple(BusType::usb, StartedBy::kernel, std::vector<std::uint8_t>{}),
        std::tuple(BusType::bluetooth, StartedBy::us, std::vector<std::uint8_t>{})}) {
    ScriptedPort port;
    port.features = {{0xf2, Packet(17, 1)}, {0xf5, Packet(8, 1)}};
    const auto pad = quirks(0x0268, bus);
    pad->start(port, started);
    EXPECT_EQ(port.features_asked, asked);
    EXPECT_TRUE(pad->take_remarks().empty());
  }
  ScriptedPort deaf;
  const auto pad = quirks(0x0268, BusType::usb);
  pad->start(deaf, StartedBy::us);
  EXPECT_EQ(pad->take_remarks(),
            std::vector<std::string>{"Pad: does not answer the start over USB"});
}

// The packets are those of SDL's SDL_hidapi_ps4.c; the descriptor is that of other makers' pads.
TEST(DualShock4OfOthers, RunsItsMotorsIfItTellsThatItHasAny) {
  DeviceInfo device;
  device.bus = BusType::usb;
  device.vendor = 0x0f0d;
  device.product = 0x00ee;
  device.descriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x85, 0x01, 0x09, 0x30, 0x09,
                       0x31, 0x15, 0x00, 0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x02, 0x81,
                       0x02, 0x06, 0x00, 0xff, 0x85, 0x05, 0x09, 0x22, 0x95, 0x1f, 0x91,
                       0x02, 0x85, 0x03, 0x0a, 0x21, 0x27, 0x95, 0x2f, 0xb1, 0x02, 0xc0};
  for (const auto& [abilities, size] : {std::pair(0x0f, 32u), {0x07, 0u}}) {
    ScriptedPort port;
    port.features = {{0x03, Packet(48, 0)}};
    port.features[0x03][2] = 0x27;
    port.features[0x03][4] = static_cast<std::uint8_t>(abilities);
    const auto pad = make_sony_quirks(device);
    ASSERT_NE(pad, nullptr);
    pad->start(port, StartedBy::kernel);
    OutPacket packet;
    pad->rumble(kRumble, packet);
    ASSERT_EQ(packet.size, size);
    if (size == 0) continue;
    EXPECT_EQ(packet.bytes[0], 0x05);
    EXPECT_EQ(packet.bytes[4], 0x40) << "weak";
    EXPECT_EQ(packet.bytes[5], 0xc0) << "strong";
  }
  ScriptedPort silent;
  const auto pad = make_sony_quirks(device);
  pad->start(silent, StartedBy::us);
  OutPacket packet;
  pad->rumble(kRumble, packet);
  EXPECT_EQ(packet.size, 0u);
  device.descriptor[39] = 0x2e;  // the feature is a byte shorter, so the pad is unknown
  EXPECT_EQ(make_sony_quirks(device), nullptr);
}

TEST(Crc32, IsTheBitwiseOneWithThePublishedCheckValueAndGoesOnInParts) {
  const std::string_view text = "123456789";
  EXPECT_EQ(crc32(Packet(text.begin(), text.end())), 0xcbf43926u);
  EXPECT_EQ(crc32({}), 0u);
  Packet bytes;
  for (std::uint32_t i = 0; i < 300; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(i * 2654435761u >> 24));
    EXPECT_EQ(crc32(bytes), crc_by_bits(bytes));
  }
  const std::span<const std::uint8_t> all(bytes);
  EXPECT_EQ(crc32(all.subspan(37), crc32(all.first(37))), crc32(all));
}

TEST(Sony, KnowsItsPadsAndNoOthers) {
  for (const std::uint16_t product : {0x0268, 0x05c4, 0x09cc, 0x0ba0, 0x0ce6, 0x0df2})
    EXPECT_NE(quirks(product, BusType::usb), nullptr);
  EXPECT_EQ(quirks(0x0cda, BusType::usb), nullptr);  // a PlayStation Classic is plain HID
  DeviceInfo other;
  other.vendor = 0x0f0d;
  other.product = kDualShock4;
  EXPECT_EQ(make_sony_quirks(other), nullptr);
}

TEST(DualShock4, RumblesOverUsbIn32BytesWithoutTouchingTheLight) {
  const auto pad = quirks(kDualShock4, BusType::usb);
  Packet expected(32, 0);
  expected[0] = 0x05;
  expected[1] = 0x01;
  expected[4] = 0x40;
  expected[5] = 0xc0;
  EXPECT_EQ(rumble_of(*pad, kRumble), expected);
  expected[4] = expected[5] = 0;
  EXPECT_EQ(rumble_of(*pad, {}), expected);
}

// Bit 2 of the second status byte is set if no pad is connected (hid-playstation.c,
// DS4_STATUS1_DONGLE_STATE).
TEST(DualShock4, ItsAdapterTellsWhetherAPadIsConnected) {
  const auto adapter = quirks(0x0ba0, BusType::usb);
  Packet report(64, 0x80);
  report[0] = 0x01;
  OutPacket reply;
  report[31] = 0x04;
  EXPECT_FALSE(adapter->accept(report, reply));
  EXPECT_FALSE(adapter->has_pad());
  report[31] = 0x00;
  EXPECT_TRUE(adapter->accept(report, reply));
  EXPECT_TRUE(adapter->has_pad());
  report[31] = 0x04;
  const auto cable = quirks(kDualShock4, BusType::usb);
  EXPECT_TRUE(cable->accept(report, reply)) << "no adapter";
  EXPECT_TRUE(cable->has_pad());
}

TEST(DualShock4, RumblesOverBluetoothIn78BytesWithChecksum) {
  const auto pad = quirks(kDualShock4, BusType::bluetooth);
  Packet expected(78, 0);
  expected[0] = 0x11;
  // Bits: a checksum follows, HID, reports every 4 ms (hid-playstation.c, SDL_hidapi_ps4.c).
  expected[1] = 0xc4;
  expected[3] = 0x01;
  expected[6] = 0x40;
  expected[7] = 0xc0;
  EXPECT_EQ(rumble_of(*pad, kRumble), sealed(0xa2, expected));
}

Packet firmware_of(int version) {
  Packet firmware(64, 0);
  firmware[0] = 0x20;
  firmware[44] = static_cast<std::uint8_t>(version);
  firmware[45] = static_cast<std::uint8_t>(version >> 8);
  return firmware;
}

TEST(DualSense, RumblesOverUsbByItsFirmware) {
  const auto pad = quirks(kDualSense, BusType::usb);
  Packet expected(48, 0);
  expected[0] = 0x02;
  expected[1] = 0x03;  // bits: compatible vibration and haptics
  expected[3] = 0x40;
  expected[4] = 0xc0;
  EXPECT_EQ(rumble_of(*pad, kRumble), expected) << "not started: the old way";

  ScriptedPort port;
  port.features[0x20] = firmware_of(0x0224);  // version 2.36; the new bits are used from 2.21 on
  pad->start(port, StartedBy::kernel);
  expected[1] = 0x02;
  expected[39] = 0x04;
  EXPECT_EQ(rumble_of(*pad, kRumble), expected);
  EXPECT_TRUE(port.written.empty());
}

// An Edge has the new motors with any version.
TEST(DualSense, TakesTheOldWayUntilFirmware2_20) {
  for (const auto& [product, version, flags] :
       {std::tuple(kDualSense, 0x0214, 0x03), {kDualSense, 0x0215, 0x02}, {kEdge, 0, 0x02}}) {
    const auto pad = quirks(product, BusType::usb);
    ScriptedPort port;
    if (version != 0) port.features[0x20] = firmware_of(version);
    pad->start(port, StartedBy::us);
    EXPECT_EQ(rumble_of(*pad, kRumble)[1], flags);
    EXPECT_EQ(rumble_of(*pad, kRumble)[39], flags == 0x02 ? 0x04 : 0x00);
  }
}

TEST(DualSense, RumblesOverBluetoothWithSequenceTagAndChecksum) {
  const auto pad = quirks(kDualSense, BusType::bluetooth);
  for (int i = 0; i < 18; ++i) {
    Packet expected(78, 0);
    expected[0] = 0x31;
    expected[1] = static_cast<std::uint8_t>((i % 16) << 4);
    expected[2] = 0x10;
    expected[3] = 0x03;
    expected[5] = 0x40;
    expected[6] = 0xc0;
    EXPECT_EQ(rumble_of(*pad, kRumble), sealed(0xa2, expected)) << i;
  }
}

TEST(Sony, AWeakBeatIsNotRoundedAway) {
  const auto pad = quirks(kDualShock4, BusType::usb);
  EXPECT_EQ(rumble_of(*pad, {.strong = 200, .weak = 0})[5], 1);
  EXPECT_EQ(rumble_of(*pad, {.strong = 0xffff, .weak = 0})[5], 0xff);
}

TEST(Sony, BluetoothFullReportsCountOnlyWithTheirChecksum) {
  for (const auto& [product, id] : {std::pair(kDualShock4, 0x11), std::pair(kDualSense, 0x31)}) {
    const auto pad = quirks(product, BusType::bluetooth);
    Packet report(78, 0x5a);
    report[0] = static_cast<std::uint8_t>(id);
    const Packet good = sealed(0xa1, report);
    EXPECT_TRUE(accepts(*pad, good));
    EXPECT_EQ(pad->lost(), 0);
    std::int64_t lost = 0;
    for (std::size_t byte = 1; byte < good.size(); ++byte) {
      Packet wrong = good;
      wrong[byte] ^= 0x10;
      EXPECT_FALSE(accepts(*pad, wrong)) << byte;
      EXPECT_EQ(pad->lost(), ++lost);
    }
    EXPECT_FALSE(accepts(*pad, sealed(0xa2, report))) << "the checksum of an output report";
  }
}

TEST(Sony, ShortLongAndEmptyBluetoothPacketsAreRefused) {
  const auto pad = quirks(kDualSense, BusType::bluetooth);
  for (std::size_t size = 1; size < 200; ++size) {
    Packet report(size, 0);
    report[0] = 0x31;
    if (size > 5) report = sealed(0xa1, report);
    EXPECT_EQ(accepts(*pad, report), size == 78) << size;
  }
  EXPECT_FALSE(accepts(*pad, {}));
  EXPECT_EQ(pad->lost(), 198);
}

TEST(Sony, OtherReportsGoOnAsTheyAre) {
  const auto usb = quirks(kDualSense, BusType::usb);
  EXPECT_TRUE(accepts(*usb, Packet(64, 0x01)));
  EXPECT_TRUE(accepts(*usb, {0x31})) << "has no checksum on USB";
  const auto bluetooth = quirks(kDualSense, BusType::bluetooth);
  EXPECT_TRUE(accepts(*bluetooth, Packet(10, 0x01))) << "the short report before the change";
  EXPECT_EQ(usb->lost() + bluetooth->lost(), 0);
}

TEST(Sony, BluetoothPadsAreAskedForFullReportsOnlyIfTheKernelHasNot) {
  ScriptedPort port;
  port.features[0x05] = Packet(41, 0x05);
  auto pad = quirks(kDualShock4, BusType::bluetooth);
  pad->start(port, StartedBy::us);
  EXPECT_EQ(port.features_asked, (std::vector<std::uint8_t>{0x05}));
  EXPECT_TRUE(pad->take_remarks().empty());

  port.features_asked.clear();
  port.features.clear();
  pad = quirks(kDualShock4, BusType::bluetooth);
  pad->start(port, StartedBy::kernel);
  EXPECT_EQ(port.features_asked, (std::vector<std::uint8_t>{0x05})) << "for its gyroscope alone";
  EXPECT_TRUE(pad->take_remarks().empty());
}

// A feature report that holds these numbers of 16 bits.
Packet gyro_feature(std::uint8_t id, std::size_t size, const std::array<int, 11>& numbers) {
  Packet feature(size, 0);
  feature[0] = id;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    feature[1 + 2 * i] = static_cast<std::uint8_t>(numbers[i] & 0xff);
    feature[2 + 2 * i] = static_cast<std::uint8_t>((numbers[i] >> 8) & 0xff);
  }
  return feature;
}
// Expects the scales of a calibration at 540 degrees a second each way: pitch counts 8640, yaw 8650
// and 8630, roll 9000.
void expect_scales(const std::optional<FactoryGyro>& gyro) {
  ASSERT_TRUE(gyro);
  EXPECT_EQ(gyro->zero, (std::array<double, 3>{})) << "the reports are without bias";
  EXPECT_NEAR(gyro->rad_s_per_count[0], 540.0 / 8640.0 * 3.14159265358979 / 180.0, 1e-12);
  EXPECT_NEAR(gyro->rad_s_per_count[1], 540.0 / 8640.0 * 3.14159265358979 / 180.0, 1e-12);
  EXPECT_NEAR(gyro->rad_s_per_count[2], 540.0 / 9000.0 * 3.14159265358979 / 180.0, 1e-12);
}

TEST(Sony, TheGyroscopesCalibrationIsReadInItsOrder) {
  const std::array<int, 11> by_axis = {5, -5, 0, 8645, -8635, 8645, -8635, 9000, -9000, 540, 540};
  const std::array<int, 11> by_sign = {5, -5, 0, 8645, 8645, 9000, -8635, -8635, -9000, 540, 540};
  ScriptedPort port;
  port.features[0x02] = gyro_feature(0x02, 37, by_axis);
  auto pad = quirks(kDualShock4, BusType::usb);
  pad->start(port, StartedBy::kernel);
  expect_scales(pad->factory_gyro());
  port.features[0x05] = sealed(0xa3, gyro_feature(0x05, 41, by_sign));
  pad = quirks(kDualShock4, BusType::bluetooth);
  pad->start(port, StartedBy::kernel);
  expect_scales(pad->factory_gyro());
  port.features[0x05] = gyro_feature(0x05, 41, by_axis);
  pad = quirks(kDualSense, BusType::usb);
  pad->start(port, StartedBy::kernel);
  expect_scales(pad->factory_gyro());
  pad = quirks(kDualSense, BusType::bluetooth);
  pad->start(port, StartedBy::us);
  EXPECT_FALSE(pad->factory_gyro()) << "no checksum";
  port.features[0x05] = Packet(41, 0);
  pad = quirks(kDualSense, BusType::usb);
  pad->start(port, StartedBy::us);
  EXPECT_FALSE(pad->factory_gyro()) << "empty";
}

TEST(Sony, APadThatRefusesFullReportsIsNamedOnce) {
  for (const std::uint16_t product : {kDualShock4, kDualSense}) {
    ScriptedPort port;
    const auto pad = quirks(product, BusType::bluetooth);
    pad->start(port, StartedBy::us);
    EXPECT_EQ(pad->take_remarks().size(), 1u);
    EXPECT_TRUE(pad->take_remarks().empty());
  }
}

TEST(DualSense, AShortOrDamagedAnswerAboutTheFirmwareIsNone) {
  const Packet firmware = firmware_of(0x0300);
  ScriptedPort port;
  for (std::size_t size = 0; size < 64; ++size) {
    const auto pad = quirks(kDualSense, BusType::usb);
    port.features[0x20] = Packet(firmware.begin(), firmware.begin() + static_cast<long>(size));
    pad->start(port, StartedBy::us);
    EXPECT_EQ(rumble_of(*pad, kRumble)[1], 0x03) << size;
  }
  auto pad = quirks(kDualSense, BusType::bluetooth);
  port.features[0x20] = firmware;
  pad->start(port, StartedBy::kernel);
  EXPECT_EQ(rumble_of(*pad, kRumble)[3], 0x03) << "no checksum";
  pad = quirks(kDualSense, BusType::bluetooth);
  port.features[0x20] = sealed(0xa3, firmware);
  pad->start(port, StartedBy::kernel);
  EXPECT_EQ(rumble_of(*pad, kRumble)[3], 0x02);
}

}  // namespace
}  // namespace gaitpad
