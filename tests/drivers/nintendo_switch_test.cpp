// Numbers: dekuNukem's Nintendo_Switch_Reverse_Engineering (packets, flash memory, table of
// amplitudes), Linux's hid-nintendo.c (order of the calibration bytes, range without calibration).
#include <gtest/gtest.h>

#include "drivers/scripted_port.h"

namespace gaitpad {
namespace {

// A stick's calibration in flash memory: (max, centre, min) of 0x600, 0x800, 0x600 on both axes:
// raw 0x200 .. 0x800 .. 0xe00.
const Packet kLeft = {0x00, 0x06, 0x60, 0x00, 0x08, 0x80, 0x00, 0x06, 0x60};
const Packet kRight = {0x00, 0x08, 0x80, 0x00, 0x06, 0x60, 0x00, 0x06, 0x60};
constexpr std::size_t kUserBytes = 22;

DeviceInfo switch_pad(std::uint16_t product, BusType bus) {
  DeviceInfo device;
  device.bus = bus;
  device.vendor = 0x057e;
  device.product = product;
  device.name = product == 0x2009 ? "Pro Controller" : "A pad";
  return device;
}
std::unique_ptr<PadQuirks> quirks(BusType bus = BusType::usb) {
  return make_switch_quirks(switch_pad(0x2009, bus));
}
// A Pro Controller under a kernel driver, started: only its memory is read.
std::unique_ptr<PadQuirks> asked(ScriptedPort& port) {
  auto pad = quirks();
  pad->start(port, StartedBy::kernel);
  return pad;
}
std::unique_ptr<PadQuirks> started(std::uint16_t product, ScriptedPort& port) {
  auto pad = make_switch_quirks(switch_pad(product, BusType::bluetooth));
  pad->start(port, StartedBy::us);
  return pad;
}

double fraction(int count) { return (count - 2047.5) / 2047.5; }

Packet joined(const Packet& a, const Packet& b) {
  Packet both = a;
  both.insert(both.end(), b.begin(), b.end());
  return both;
}

// Six numbers of 12 bits in the flash's format.
Packet packed(const std::array<int, 6>& n) {
  Packet bytes;
  for (std::size_t i = 0; i < n.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(n[i]));
    bytes.push_back(static_cast<std::uint8_t>((n[i] >> 8) | (n[i + 1] << 4)));
    bytes.push_back(static_cast<std::uint8_t>(n[i + 1] >> 4));
  }
  return bytes;
}

// A pad with this flash memory that answers like a real one: 81 to 80, 21 to 01, full reports in
// between. It calls itself `kind`: 1 left Joy-Con, 2 right, 3 Pro, 9 NES.
ScriptedPort pad_with(std::map<std::uint32_t, Packet> flash, std::uint8_t kind = 3) {
  ScriptedPort port;
  port.answer = [flash, kind](const Packet& packet, std::deque<Packet>& waiting) {
    waiting.push_back(Packet(64, 0x30));
    Packet reply(64, 0);
    if (packet[0] == 0x80) {
      reply[0] = 0x81;
      reply[1] = packet[1];
      if (packet[1] != 0x04) waiting.push_back(reply);
      return;
    }
    if (packet[0] != 0x01) return;
    reply[0] = 0x21;
    reply[13] = packet[10] == 0x10 ? 0x90 : 0x80;
    reply[14] = packet[10];
    if (packet[10] == 0x02) reply[17] = kind;
    if (packet[10] == 0x10) {
      std::copy_n(packet.begin() + 11, 5, reply.begin() + 15);
      const std::uint32_t address = packet[11] | (packet[12] << 8);
      const auto found = flash.find(address);
      std::fill_n(reply.begin() + 20, packet[15], 0xff);
      if (found != flash.end())
        std::copy(found->second.begin(), found->second.end(), reply.begin() + 20);
    }
    waiting.push_back(reply);
  };
  return port;
}

void expect_axis(const FactoryAxis& axis, int min, int centre, int max) {
  EXPECT_DOUBLE_EQ(axis.min, fraction(min));
  EXPECT_DOUBLE_EQ(axis.centre, fraction(centre));
  EXPECT_DOUBLE_EQ(axis.max, fraction(max));
}

TEST(SwitchPro, KnowsThePadsOfTheSwitchAlone) {
  EXPECT_NE(quirks(), nullptr);
  for (const std::uint16_t product : {0x2006, 0x2007, 0x200e, 0x2017, 0x2019, 0x201e})
    EXPECT_NE(make_switch_quirks(switch_pad(product, BusType::bluetooth)), nullptr);
  EXPECT_EQ(make_switch_quirks(switch_pad(0x0306, BusType::bluetooth)), nullptr) << "Wii";
}

// The calibration of a left stick with 0x200 .. 0x800 .. 0xd00 in x and 0x100 .. 0x7f0 .. 0xe00 in
// y.
const Packet kUneven = packed({0x500, 0x610, 0x800, 0x7f0, 0x600, 0x6f0});

TEST(SwitchPro, TheSticksOfASingleJoyConAreTurnedAsItIsHeld) {
  const Packet uneven_right = packed({0x800, 0x7f0, 0x600, 0x6f0, 0x500, 0x610});
  ScriptedPort port = pad_with({{0x603d, joined(kUneven, uneven_right)}}, 1);
  const auto left = started(0x2006, port);
  ASSERT_TRUE(left->factory_sticks());
  // The left Joy-Con is turned to the left: up becomes left, right becomes up.
  FactoryAxis x = left->factory_sticks()->left_x;
  expect_axis({-x.max, -x.centre, -x.min}, 0x100, 0x7f0, 0xe00);
  expect_axis(left->factory_sticks()->left_y, 0x200, 0x800, 0xd00);

  port = pad_with({{0x603d, joined(kLeft, uneven_right)}}, 2);
  const auto right = started(0x2007, port);
  ASSERT_TRUE(right->factory_sticks());
  expect_axis(right->factory_sticks()->left_x, 0x100, 0x7f0, 0xe00);
  const FactoryAxis y = right->factory_sticks()->left_y;
  expect_axis({-y.max, -y.centre, -y.min}, 0x200, 0x800, 0xd00);
  EXPECT_TRUE(right->take_remarks().empty());
}

TEST(SwitchPro, AJoyConNeedsTheCalibrationOfItsOwnStickAlone) {
  const Packet blank(9, 0xff);
  ScriptedPort port = pad_with({{0x603d, joined(kLeft, blank)}}, 1);
  const auto left = started(0x2006, port);
  EXPECT_TRUE(left->factory_sticks());
  EXPECT_TRUE(left->take_remarks().empty());
}

TEST(SwitchPro, ANesControllerIsToldFromAJoyConByWhatItSays) {
  ScriptedPort port = pad_with({}, 9);
  DeviceInfo device = switch_pad(0x2006, BusType::bluetooth);
  device.descriptor = {0xc0};
  const auto pad = make_switch_quirks(device);
  pad->start(port, StartedBy::us);
  pad->amend(device);
  EXPECT_EQ(device.name, "NES Controller (L)");
  EXPECT_EQ(device.descriptor, (Packet{0xc0, 0x06, 0x57, 0xff, 0x09, 0x09, 0xa1, 0x01, 0xc0}));
  EXPECT_FALSE(pad->factory_sticks());
  EXPECT_TRUE(pad->take_remarks().empty()) << "it has no stick to be calibrated";
}

TEST(SwitchPro, TheChargingGripTellsWhichJoyConIsInIt) {
  ScriptedPort port = pad_with({{0x603d, joined(kLeft, kRight)}}, 2);
  DeviceInfo device = switch_pad(0x200e, BusType::usb);
  const auto pad = make_switch_quirks(device);
  pad->start(port, StartedBy::us);
  pad->amend(device);
  EXPECT_EQ(device.product, 0x2007);
  EXPECT_TRUE(pad->factory_sticks());
}

TEST(SwitchPro, OnlyTheSticksOfAModelAreRead) {
  ScriptedPort port = pad_with({{0x603d, joined(kUneven, kRight)}});
  const auto snes = started(0x2017, port);
  EXPECT_FALSE(snes->factory_sticks());
  EXPECT_EQ(port.written.size(), 2u) << "it is started, and its memory is left alone";
  const auto n64 = started(0x2019, port);
  ASSERT_TRUE(n64->factory_sticks());
  expect_axis(n64->factory_sticks()->left_y, 0x100, 0x7f0, 0xe00);
}

TEST(SwitchPro, StartsOverUsbAsTheConsoleDoes) {
  ScriptedPort port = pad_with({{0x603d, joined(kLeft, kRight)}});
  const auto pad = quirks();
  pad->start(port, StartedBy::us);
  ASSERT_EQ(port.written.size(), 11u);
  EXPECT_EQ(port.written[0], (Packet{0x80, 0x02}));
  EXPECT_EQ(port.written[1], (Packet{0x80, 0x03}));
  EXPECT_EQ(port.written[2], (Packet{0x80, 0x02}));
  EXPECT_EQ(port.written[3], (Packet{0x80, 0x04}));
  const Packet still = {0x00, 0x01, 0x40, 0x40, 0x00, 0x01, 0x40, 0x40};
  EXPECT_EQ(port.written[4], joined(joined({0x01, 0x00}, still), {0x03, 0x30}));
  EXPECT_EQ(port.written[5], joined(joined({0x01, 0x01}, still), {0x40, 0x01}));
  EXPECT_EQ(port.written[6], joined(joined({0x01, 0x02}, still), {0x48, 0x01}));
  EXPECT_EQ(port.written[7],
            joined(joined({0x01, 0x03}, still), {0x10, 0x3d, 0x60, 0x00, 0x00, 18}));
  EXPECT_EQ(port.written[8],
            joined(joined({0x01, 0x04}, still), {0x10, 0x10, 0x80, 0x00, 0x00, 22}));
  EXPECT_EQ(port.written[9],
            joined(joined({0x01, 0x05}, still), {0x10, 0x26, 0x80, 0x00, 0x00, 26}));
  EXPECT_EQ(port.written[10],
            joined(joined({0x01, 0x06}, still), {0x10, 0x20, 0x60, 0x00, 0x00, 24}));
  EXPECT_TRUE(pad->take_remarks().empty());
}

TEST(SwitchPro, OnBluetoothThereIsNoUsbHandshakeAndTheKernelsPadIsOnlyAskedForItsMemory) {
  ScriptedPort port = pad_with({{0x603d, joined(kLeft, kRight)}});
  started(0x2009, port);
  ASSERT_EQ(port.written.size(), 7u);
  EXPECT_EQ(port.written[0][10], 0x03);
  port = pad_with({{0x603d, joined(kLeft, kRight)}});
  EXPECT_TRUE(asked(port)->factory_sticks());
  ASSERT_EQ(port.written.size(), 4u);
  for (const Packet& packet : port.written) EXPECT_EQ(packet[10], 0x10);
}

// Twelve numbers of 16 bits as the flash holds them: accelerometer, then the gyroscope's zeros and
// its counts at 936 degrees a second.
Packet motion(const std::array<int, 6>& gyro) {
  Packet bytes(12, 0x11);
  for (const int n : gyro) {
    bytes.push_back(static_cast<std::uint8_t>(n & 0xff));
    bytes.push_back(static_cast<std::uint8_t>((n >> 8) & 0xff));
  }
  return bytes;
}

TEST(SwitchPro, TheUsersCalibrationOfTheGyroscopeComesBeforeTheFactorys) {
  const Packet factory = motion({10, -20, 30, 13381, 13351, 13401}),
               own = joined({0xb2, 0xa1}, motion({0, 0, -7, 13371, 14000, 13364}));
  std::map<std::uint32_t, Packet> flash = {{0x603d, joined(kLeft, kRight)}, {0x6020, factory}};
  ScriptedPort port = pad_with(flash);
  const auto from_factory = asked(port)->factory_gyro();
  ASSERT_TRUE(from_factory);
  EXPECT_EQ(from_factory->zero, (std::array<double, 3>{10.0, -20.0, 30.0}));
  for (const double scale : from_factory->rad_s_per_count)
    EXPECT_NEAR(scale, 936.0 / 13371.0 * 3.14159265358979 / 180.0, 1e-12);
  flash[0x8026] = own;
  port = pad_with(flash);
  const auto from_user = asked(port)->factory_gyro();
  ASSERT_TRUE(from_user);
  EXPECT_EQ(from_user->zero, (std::array<double, 3>{0.0, 0.0, -7.0}));
  EXPECT_NEAR(from_user->rad_s_per_count[1], 936.0 / 14000.0 * 3.14159265358979 / 180.0, 1e-12);
  flash = {{0x603d, joined(kLeft, kRight)}};
  port = pad_with(flash);
  EXPECT_FALSE(asked(port)->factory_gyro()) << "blank";
}

TEST(SwitchPro, TheTwoSticksKeepTheirNumbersInDifferentOrder) {
  ScriptedPort port = pad_with({{0x603d, joined(packed({1500, 1400, 2100, 1950, 1300, 1200}),
                                                packed({2000, 2150, 1250, 1350, 1450, 1550}))}});
  const auto pad = asked(port);
  const auto sticks = pad->factory_sticks();
  ASSERT_TRUE(sticks);
  expect_axis(sticks->left_x, 2100 - 1300, 2100, 2100 + 1500);
  expect_axis(sticks->left_y, 1950 - 1200, 1950, 1950 + 1400);
  expect_axis(sticks->right_x, 2000 - 1250, 2000, 2000 + 1450);
  expect_axis(sticks->right_y, 2150 - 1350, 2150, 2150 + 1550);
}

TEST(SwitchPro, TheUsersPlausibleCalibrationOfAStickComesFirst) {
  Packet user(kUserBytes, 0xff);
  user[11] = 0xb2;
  user[12] = 0xa1;
  const Packet own = packed({2222, 1888, 1100, 1101, 1102, 1103});
  std::copy(own.begin(), own.end(), user.begin() + 13);
  ScriptedPort port = pad_with({{0x603d, joined(kLeft, kRight)}, {0x8010, user}});
  const auto pad = asked(port);
  const auto sticks = pad->factory_sticks();
  ASSERT_TRUE(sticks);
  expect_axis(sticks->left_x, 0x200, 0x800, 0xe00);
  expect_axis(sticks->right_x, 2222 - 1100, 2222, 2222 + 1102);
  expect_axis(sticks->right_y, 1888 - 1101, 1888, 1888 + 1103);
  user.assign(kUserBytes, 0x00);  // marked as written, but all zero: the factory's values count
  user[0] = user[11] = 0xb2;
  user[1] = user[12] = 0xa1;
  port = pad_with({{0x603d, joined(kLeft, kRight)}, {0x8010, user}});
  const auto other = asked(port);
  ASSERT_TRUE(other->factory_sticks());
  expect_axis(other->factory_sticks()->left_x, 0x200, 0x800, 0xe00);
}

TEST(SwitchPro, BlankMemoryIsNoCalibration) {
  ScriptedPort port = pad_with({});
  const auto pad = asked(port);
  EXPECT_FALSE(pad->factory_sticks());
  EXPECT_EQ(
      pad->take_remarks(),
      std::vector<std::string>{"Pro Controller: holds no usable stick calibration; none is used"});
  EXPECT_TRUE(pad->take_remarks().empty());
}

TEST(SwitchPro, OneBlankStickTakesTheUsualRange) {
  ScriptedPort port = pad_with({{0x603d, joined(kLeft, Packet(9, 0xff))}});
  const auto pad = asked(port);
  ASSERT_TRUE(pad->factory_sticks());
  expect_axis(pad->factory_sticks()->right_y, 500, 2000, 3500);
  EXPECT_EQ(pad->take_remarks().size(), 1u);
}

TEST(SwitchPro, NumbersThatNoStickHasAreRefused) {
  const auto is_taken = [](const std::array<int, 6>& left) {
    ScriptedPort port = pad_with({{0x603d, joined(packed(left), Packet(9, 0xff))}});
    const auto pad = asked(port);
    return pad->factory_sticks().has_value();
  };
  EXPECT_TRUE(is_taken({1500, 1500, 2048, 2048, 1500, 1500}));
  EXPECT_FALSE(is_taken({0xfff, 1500, 2048, 2048, 1500, 1500})) << "blank";
  EXPECT_FALSE(is_taken({1500, 1500, 2048, 2048, 1500, 0})) << "no way down";
  EXPECT_FALSE(is_taken({2200, 1500, 2048, 2048, 1500, 1500})) << "beyond 12 bits";
  EXPECT_FALSE(is_taken({1500, 1500, 1200, 2048, 1300, 1500})) << "below zero";
  EXPECT_FALSE(is_taken({500, 500, 3400, 2048, 500, 500})) << "centre at the edge";
}

TEST(SwitchPro, AnswersToOthersAreNotTakenForOurs) {
  ScriptedPort port = pad_with({{0x603d, joined(kLeft, kRight)}});
  const auto honest = port.answer;
  port.answer = [&](const Packet& packet, std::deque<Packet>& waiting) {
    Packet other(64, 0);
    other[0] = 0x21;
    other[13] = 0x90;
    other[14] = 0x10;
    other[15] = 0x86;  // an answer with 9 bytes from address 8086
    other[16] = 0x80;
    other[19] = 9;
    waiting.push_back(other);
    other[15] = 0x3d;  // an answer with the right address and another length
    other[16] = 0x60;
    waiting.push_back(other);
    other[19] = 18;
    other[13] = 0x00;  // an answer that refuses the request
    waiting.push_back(other);
    honest(packet, waiting);
  };
  const auto pad = asked(port);
  ASSERT_TRUE(pad->factory_sticks());
  expect_axis(pad->factory_sticks()->left_x, 0x200, 0x800, 0xe00);
}

TEST(SwitchPro, ShortRepliesAreNone) {
  for (std::size_t size = 0; size < 38; ++size) {
    ScriptedPort port;
    port.answer = [size](const Packet& packet, std::deque<Packet>& waiting) {
      Packet reply(64, 0);
      reply[0] = 0x21;
      reply[13] = 0x90;
      reply[14] = 0x10;
      std::copy_n(packet.begin() + 11, 5, reply.begin() + 15);
      reply.resize(size);
      waiting.push_back(reply);
    };
    const auto pad = asked(port);
    EXPECT_FALSE(pad->factory_sticks());
  }
}

TEST(SwitchPro, ALostAnswerIsAskedForAgain) {
  ScriptedPort port = pad_with({{0x603d, joined(kLeft, kRight)}});
  const auto honest = port.answer;
  int writes = 0;
  port.answer = [&](const Packet& packet, std::deque<Packet>& waiting) {
    if (++writes % 3 == 0) honest(packet, waiting);
  };
  const auto pad = asked(port);
  EXPECT_TRUE(pad->factory_sticks());
  EXPECT_EQ(port.written.size(), 12u) << "four parts of the memory, the third time each";
}

TEST(SwitchPro, ASilentPadEndsTheStartAndIsNamed) {
  ScriptedPort port;
  const auto pad = quirks();
  pad->start(port, StartedBy::us);
  EXPECT_FALSE(pad->factory_sticks());
  EXPECT_LE(port.written.size(), 16u);
  EXPECT_EQ(pad->take_remarks(),
            (std::vector<std::string>{
                "Pro Controller: does not answer the start over USB",
                "Pro Controller: does not tell its stick calibration; none is used"}));
}

TEST(SwitchPro, APadThatTalksWithoutEverAnsweringEndsTheStart) {
  ScriptedPort port;
  port.is_endless = true;
  port.waiting.push_back(Packet(64, 0x30));
  const auto pad = quirks();
  pad->start(port, StartedBy::us);
  EXPECT_LT(port.reads, 16 * 512 + 1);
  EXPECT_FALSE(pad->factory_sticks());
  ScriptedPort gone;
  gone.is_gone = true;
  quirks()->start(gone, StartedBy::us);
  EXPECT_EQ(gone.reads, 0) << "a pad that has gone is left alone";
}

TEST(SwitchPro, OnlyInputReportsAreHandedOn) {
  const auto pad = quirks();
  OutPacket reply;
  EXPECT_TRUE(pad->accept(Packet(64, 0x30), reply));
  EXPECT_TRUE(pad->accept(Packet(12, 0x3f), reply));
  EXPECT_FALSE(pad->accept(Packet(64, 0x21), reply));
  EXPECT_FALSE(pad->accept(Packet(64, 0x81), reply));
  EXPECT_FALSE(pad->accept({}, reply));
  EXPECT_EQ(reply.size, 0u);
}

TEST(SwitchPro, RestingMotorsAreTheDocumentedPacketAndTheCounterRunsTo15) {
  const auto pad = quirks();
  for (int i = 0; i < 18; ++i) {
    const auto count = static_cast<std::uint8_t>(i % 16);
    EXPECT_EQ(rumble_of(*pad, {}),
              (Packet{0x10, count, 0x00, 0x01, 0x40, 0x40, 0x00, 0x01, 0x40, 0x40}));
  }
}

// Rows of rumble_data_table.md: amplitude, byte of the high band, 16 bits of the low band.
TEST(SwitchPro, AmplitudesFollowThePublishedTable) {
  struct Row {
    double amplitude;
    int high, low;
  };
  for (const Row& row :
       {Row{0.010, 0x02, 0x8040}, Row{0.112, 0x1e, 0x8047}, Row{0.225, 0x3e, 0x804f},
        Row{0.230, 0x40, 0x0050}, Row{1.003, 0xc8, 0x0072}}) {
    const auto strength =
        static_cast<std::uint16_t>(std::min(65535.0, row.amplitude / 1.003 * 65535 + 0.5));
    const auto pad = quirks();
    const Packet packet = rumble_of(*pad, {.strong = strength, .weak = strength});
    for (const std::size_t at : {2u, 6u}) {
      EXPECT_EQ(packet[at], 0x00);
      EXPECT_EQ(packet[at + 1], 0x01 + row.high);
      EXPECT_EQ(packet[at + 2], 0x40 + (row.low >> 8));
      EXPECT_EQ(packet[at + 3], row.low & 0xff);
    }
  }
}

TEST(SwitchPro, StrongerIsNeverWeakerInThePacket) {
  const auto pad = quirks();
  int before = -1;
  for (int strength = 0; strength <= 65535; strength += 13) {
    const Packet packet =
        rumble_of(*pad, {.strong = static_cast<std::uint16_t>(strength), .weak = 0});
    EXPECT_EQ(packet[3], 0x01) << "the weak motor rests";
    const int low = (packet[5] - 0x40) * 2 + (packet[4] >> 7);
    EXPECT_GE(low, before);
    EXPECT_LE(low, 100);
    EXPECT_EQ(low > 0, strength > 0);
    before = low;
  }
}

TEST(SwitchPro, RunningMotorsAreToBeToldAgain) {
  const auto pad = quirks();
  OutPacket packet;
  pad->rumble({.strong = 1, .weak = 0}, packet);
  EXPECT_EQ(packet.repeat, std::chrono::milliseconds(50));
  pad->rumble({}, packet);
  EXPECT_EQ(packet.repeat, std::chrono::milliseconds(0));
}

// ---- Switch 2: numbers from SDL 3's SDL_hidapi_switch2.c

// A pad with these blocks of flash memory, by address; a block begins 16 bytes into an answer.
ScriptedPort switch_2_with(std::map<std::uint32_t, Packet> flash) {
  ScriptedPort port;
  port.answer_command = [flash](const Packet& command) {
    Packet answer(command[0] == 0x02 ? 0x50 : 8, 0);
    if (command[0] != 0x02 || command.size() != 16) return answer;
    const std::uint32_t address = command[12] | command[13] << 8 | command[14] << 16;
    if (const auto block = flash.find(address); block != flash.end())
      std::copy(block->second.begin(), block->second.end(), answer.begin() + 0x10);
    return answer;
  };
  return port;
}

TEST(Switch2Pro, IsStartedByCommandsAndTellsItsSticks) {
  // Numbers in the order centre, up, down.
  const Packet range = packed({0x800, 0x800, 0x600, 0x500, 0x400, 0x300});
  const Packet factory = joined(Packet(0x28, 0), range);
  const Packet user = joined({0xb2, 0xa1}, packed({0x810, 0x800, 0x600, 0x600, 0x600, 0x600}));
  ScriptedPort port = switch_2_with({{0x013080, factory}, {0x0130c0, factory}, {0x1fc080, user}});
  const auto pad = make_switch_quirks(switch_pad(0x2069, BusType::usb));
  pad->start(port, StartedBy::us);
  const auto sticks = pad->factory_sticks().value();
  EXPECT_DOUBLE_EQ(sticks.left_x.min, fraction(0x800 - 0x400));
  EXPECT_DOUBLE_EQ(sticks.left_x.max, fraction(0x800 + 0x600));
  EXPECT_DOUBLE_EQ(sticks.left_y.min, fraction(0x800 - 0x300));
  EXPECT_DOUBLE_EQ(sticks.left_y.max, fraction(0x800 + 0x500));
  EXPECT_DOUBLE_EQ(sticks.right_x.centre, fraction(0x810)) << "the user's";
  ASSERT_GE(port.commands.size(), 9u);
  EXPECT_EQ(port.commands.back(), (Packet{0x03, 0x91, 0x00, 0x0d, 0x00, 0x08, 0x00, 0x00, 0x01,
                                          0x00, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}));
  for (const Packet& command : port.commands) EXPECT_EQ(command.size(), 8u + command[5]);
  EXPECT_TRUE(pad->take_remarks().empty());
}

TEST(Switch2Pro, SaysThatItWasNotStartedWhereTheDriverCannot) {
  ScriptedPort port;
  const auto pad = make_switch_quirks(switch_pad(0x2069, BusType::usb));
  pad->start(port, StartedBy::us);
  EXPECT_FALSE(pad->factory_sticks());
  EXPECT_EQ(pad->take_remarks(),
            std::vector<std::string>{"A pad: was not started; only --driver usb can do that"});
}

}  // namespace
}  // namespace gaitpad
