// Pads of the Switch (Pro Controller, Joy-Cons, NES, SNES, N64 and Mega Drive controllers): their
// start, the calibration of sticks and gyroscope in their flash memory, their motors. All send the
// same report 0x30. Packets, memory map and vibration codes are from dekuNukem's
// Nintendo_Switch_Reverse_Engineering (bluetooth_hid_notes.md, USB-HID-Notes.md,
// spi_flash_notes.md, rumble_data_table.md), ids and kinds from Linux's hid-nintendo.c. The Switch
// 2's Pro Controller is started by commands to its second USB interface: numbers from SDL 3's
// SDL_hidapi_switch2.c.
#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/pads/pad_quirks.h"
#include "gaitpad/math.h"

namespace gaitpad {

namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::uint16_t kNintendo = 0x057e;
enum : std::uint16_t {  // product ids
  kJoyConLeft = 0x2006,
  kJoyConRight = 0x2007,
  kProController = 0x2009,
  kChargingGrip = 0x200e,  // has one interface for each Joy-Con in it
  kSnes = 0x2017,
  kN64 = 0x2019,
  kMegaDrive = 0x201e,
  kSwitch2Pro = 0x2069,
};
enum : std::uint8_t { kLeftKind = 1, kRightKind = 2, kNesLeftKind = 9, kNesRightKind = 10 };

enum : std::uint8_t {  // first bytes of packets
  kOutSubcommand = 0x01,
  kOutRumble = 0x10,
  kOutUsb = 0x80,
  kInReply = 0x21,
  kInFull = 0x30,
  kInSimple = 0x3f,
  kInUsb = 0x81,
};
enum : std::uint8_t {  // second bytes, after kOutUsb
  kUsbHandshake = 0x02,
  kUsbFastSerial = 0x03,
  kUsbStayHid = 0x04,  // keep using USB instead of Bluetooth; has no answer
};
enum : std::uint8_t {  // numbers of subcommands
  kDeviceInfo = 0x02,
  kSetReportMode = 0x03,
  kReadFlash = 0x10,
  kEnableMotion = 0x40,
  kEnableVibration = 0x48,
};

// Time limit of the whole start; number of times that a request is sent; wait for its answer among
// the input reports, which come every 8 to 15 ms.
constexpr milliseconds kStart = 1900ms;
constexpr int kTries = 3;
constexpr milliseconds kAnswer = 200ms;
constexpr milliseconds kUsbAnswer = 100ms;
constexpr int kMaxPacketsAwaited = 512;
// Period of a packet for the motors, which stop by themselves without it.
constexpr milliseconds kRumbleRepeat = 50ms;

constexpr std::size_t kPacketBytes = 64;
constexpr std::size_t kAckAt = 13, kSubcommandAt = 14, kAddressAt = 15, kLengthAt = 19,
                      kFlashAt = 20, kKindAt = 17;

// The addresses of the sticks' calibration in the flash memory, 9 bytes each.
constexpr std::uint32_t kFactoryAddress = 0x603d;  // left stick, right stick
constexpr std::size_t kFactoryBytes = 18;
// For each stick 2 bytes that mark a calibration, then its 9 bytes.
constexpr std::uint32_t kUserAddress = 0x8010;
constexpr std::size_t kUserBytes = 22;
constexpr std::size_t kStickBytes = 9, kMarkBytes = 2;
constexpr std::array<std::uint8_t, kMarkBytes> kMark = {0xb2, 0xa1};

// The calibration of accelerometer and gyroscope: twelve numbers, the gyroscope's zeros from the
// seventh on, its counts at 936 degrees a second from the tenth on.
constexpr std::uint32_t kFactoryMotionAddress = 0x6020;
// Address of the mark before the user's numbers.
constexpr std::uint32_t kUserMotionAddress = 0x8026;
constexpr std::size_t kMotionBytes = 24, kGyroZeros = 6, kGyroTurns = 9;
constexpr double kTurn_rad_s = 936.0 * kDegree;
constexpr double kUsualTurn = 13371.0;  // counts at 936 degrees a second that most pads have

constexpr int kBlank = 0xfff, kMaxCount = 0xfff;
// Limits of a working stick, in counts of 0..4095: the centre is at most 1024 off the middle, and
// the way to each side is at least 256.
constexpr int kMinCentre = 1024, kMaxCentre = 3072, kMinWay = 256;

struct StickRange {  // counts of x, then of y
  std::array<int, 2> min{}, centre{}, max{};
};
// The range that Linux's hid-nintendo assumes for a pad without calibration.
constexpr StickRange kUsualRange = {{500, 500}, {2000, 2000}, {3500, 3500}};

// Unpacks two numbers of 12 bits from three bytes.
std::array<int, 2> unpacked(std::span<const std::uint8_t, 3> bytes) noexcept {
  return {bytes[0] | ((bytes[1] & 0x0f) << 8), (bytes[1] >> 4) | (bytes[2] << 4)};
}

enum class Side { left, right };

// The places of the way up, the centre and the way down among the three pairs of numbers.
struct RangeOrder {
  std::size_t up, centre, down;
};
constexpr RangeOrder kLeftOrder = {0, 1, 2}, kRightOrder = {2, 0, 1}, kSwitch2Order = {1, 0, 2};

// The range of a stick from its 9 bytes. None: the memory is blank or the numbers are out of
// limits.
std::optional<StickRange> stick_range(std::span<const std::uint8_t, kStickBytes> bytes,
                                      const RangeOrder& order) noexcept {
  const std::array<std::array<int, 2>, 3> pairs = {unpacked(bytes.subspan<0, 3>()),
                                                   unpacked(bytes.subspan<3, 3>()),
                                                   unpacked(bytes.subspan<6, 3>())};
  const auto &up = pairs[order.up], &centre = pairs[order.centre], &down = pairs[order.down];
  StickRange range;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    if (up[axis] == kBlank || centre[axis] == kBlank || down[axis] == kBlank) return std::nullopt;
    if (centre[axis] < kMinCentre || centre[axis] > kMaxCentre) return std::nullopt;
    if (up[axis] < kMinWay || down[axis] < kMinWay) return std::nullopt;
    range.min[axis] = centre[axis] - down[axis];
    range.centre[axis] = centre[axis];
    range.max[axis] = centre[axis] + up[axis];
    if (range.min[axis] < 0 || range.max[axis] > kMaxCount) return std::nullopt;
  }
  return range;
}

// The gyroscope's calibration. None: the memory is blank, or has numbers that no such chip has.
std::optional<FactoryGyro> gyro_of(std::span<const std::uint8_t, kMotionBytes> bytes) noexcept {
  const auto number = [bytes](std::size_t i) {
    return static_cast<double>(static_cast<std::int16_t>(bytes[2 * i] | bytes[2 * i + 1] << 8));
  };
  FactoryGyro gyro;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double zero = number(kGyroZeros + axis), turn = number(kGyroTurns + axis) - zero;
    if (!(turn > 0.5 * kUsualTurn && turn < 2.0 * kUsualTurn)) return std::nullopt;
    gyro.zero[axis] = zero;
    gyro.rad_s_per_count[axis] = kTurn_rad_s / turn;
  }
  return gyro;
}

FactoryAxis factory_axis(const StickRange& range, std::size_t axis) noexcept {
  constexpr double kMiddle = kMaxCount / 2.0;
  const auto fraction = [](int count) { return (count - kMiddle) / kMiddle; };
  return {fraction(range.min[axis]), fraction(range.centre[axis]), fraction(range.max[axis])};
}

// NES controllers have the ids of a Joy-Con and other buttons. This collection marks them, and
// config/pads/nintendo.toml has an entry for it: ff57:0009.
constexpr std::uint8_t kNesMark[] = {0x06, 0x57, 0xff, 0x09, 0x09, 0xa1, 0x01, 0xc0};

// Index (0..100) of a strength 0..1 in the published table of amplitudes, by the table's formulas
// for each octave; below 0.12 by a fit to it. The table's end is not exceeded, because that may
// damage the motors.
int amplitude_index(double strength) noexcept {
  if (strength <= 0.0) return 0;
  const double octaves = strength > 0.23   ? 32.0 * std::log2(strength * 8.7)
                         : strength > 0.12 ? 16.0 * std::log2(strength * 17.0)
                                           : 4.0 * std::log2(strength * 120.0);
  return std::clamp(static_cast<int>(std::lround(octaves)), 1, 100);
}

// The four bytes for one actuator: 320 Hz with the weak strength and 160 Hz with the strong one.
std::array<std::uint8_t, 4> vibration(const Rumble& rumble) noexcept {
  constexpr double kFull = 1.003;  // amplitude in the table's last row
  const int high = amplitude_index(rumble.weak / 65535.0 * kFull);
  const int low = amplitude_index(rumble.strong / 65535.0 * kFull);
  return {0x00, static_cast<std::uint8_t>(0x01 + 2 * high),
          static_cast<std::uint8_t>(0x40 + (low % 2 != 0 ? 0x80 : 0)),
          static_cast<std::uint8_t>(0x40 + low / 2)};
}

class SwitchPad final : public PadQuirks {
 public:
  explicit SwitchPad(const DeviceInfo& device)
      : name_(device.name.empty() ? "this pad" : device.name),
        product_(device.product),
        is_usb_(device.bus == BusType::usb) {}

  void start(PadPort& port, StartedBy started) override {
    end_ = Clock::now() + kStart;
    if (started == StartedBy::us) start_reports(port);
    if (product_ == kJoyConLeft || product_ == kJoyConRight || product_ == kChargingGrip)
      ask_kind(port);
    if (!has_stick(Side::left) && !has_stick(Side::right)) return;
    // The kernel's driver also listens, and while it waits for a reply it takes any reply for its
    // own. So the memory is read with as few packets as possible.
    std::array<std::uint8_t, kFactoryBytes> factory{};
    std::array<std::uint8_t, kUserBytes> user{};
    const bool has_factory = read_flash(port, kFactoryAddress, factory);
    const bool has_user = has_factory && read_flash(port, kUserAddress, user);
    choose_sticks(has_factory ? std::span<const std::uint8_t>(factory) : std::span<std::uint8_t>(),
                  has_user ? std::span<const std::uint8_t>(user) : std::span<std::uint8_t>());
    if (has_factory && has_motion()) gyro_ = asked_gyro(port);
  }

  void amend(DeviceInfo& device) const override {
    if (kind_ == kNesLeftKind || kind_ == kNesRightKind) {
      device.name = kind_ == kNesLeftKind ? "NES Controller (L)" : "NES Controller (R)";
      device.descriptor.insert(device.descriptor.end(), std::begin(kNesMark), std::end(kNesMark));
    }
    if (product_ != kChargingGrip) return;
    if (kind_ == kLeftKind) device.product = kJoyConLeft;
    if (kind_ == kRightKind) device.product = kJoyConRight;
  }

  // Replies also contain the sticks, but in a layout that no descriptor states.
  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept override {
    reply.size = 0;
    return !packet.empty() && (packet[0] == kInFull || packet[0] == kInSimple);
  }

  void rumble(const Rumble& rumble, OutPacket& packet) noexcept override {
    packet = {};
    packet.bytes[0] = kOutRumble;
    packet.bytes[1] = next_count();
    put_vibration(rumble, packet);
    packet.size = 10;
    if (rumble.strong != 0 || rumble.weak != 0) packet.repeat = kRumbleRepeat;
  }

  std::optional<FactorySticks> factory_sticks() const override { return sticks_; }
  std::optional<FactoryGyro> factory_gyro() const override { return gyro_; }
  std::vector<std::string> take_remarks() override { return std::exchange(remarks_, {}); }

 private:
  std::uint8_t next_count() noexcept { return count_++ & 0x0f; }

  static void put_vibration(const Rumble& rumble, OutPacket& packet) noexcept {
    const auto bytes = vibration(rumble);
    std::copy(bytes.begin(), bytes.end(), packet.bytes.begin() + 2);
    std::copy(bytes.begin(), bytes.end(), packet.bytes.begin() + 6);
  }

  void start_reports(PadPort& port) {
    if (is_usb_) {
      const bool has_answered = ask_usb(port, kUsbHandshake);
      if (has_answered) {
        ask_usb(port, kUsbFastSerial);
        ask_usb(port, kUsbHandshake);
      }
      port.write(std::to_array<std::uint8_t>({kOutUsb, kUsbStayHid}));
      if (!has_answered) remarks_.push_back(name_ + ": does not answer the start over USB");
    }
    ask(port, kSetReportMode, std::to_array<std::uint8_t>({kInFull}));
    if (has_motion()) ask(port, kEnableMotion, std::to_array<std::uint8_t>({0x01}));
    ask(port, kEnableVibration, std::to_array<std::uint8_t>({0x01}));
  }

  // True for pads with that stick: a Joy-Con has one and is held sideways, the Pro Controller has
  // two, the N64's has the left one.
  bool has_stick(Side side) const noexcept {
    if (kind_ == kNesLeftKind || kind_ == kNesRightKind) return false;
    if (product_ == kProController) return true;
    const bool is_left = product_ == kJoyConLeft || product_ == kN64 || kind_ == kLeftKind;
    const bool is_right = product_ == kJoyConRight || kind_ == kRightKind;
    return side == Side::left ? is_left : is_right;
  }

  bool has_motion() const noexcept {
    return product_ != kN64 && product_ != kSnes && product_ != kMegaDrive;
  }

  // Reads the gyroscope's calibration; the user's is preferred to the factory's.
  std::optional<FactoryGyro> asked_gyro(PadPort& port) {
    std::array<std::uint8_t, kMarkBytes + kMotionBytes> user{};
    const auto own = std::span<const std::uint8_t>(user);
    if (read_flash(port, kUserMotionAddress, user) &&
        std::equal(kMark.begin(), kMark.end(), user.begin())) {
      if (auto gyro = gyro_of(own.subspan<kMarkBytes, kMotionBytes>())) return gyro;
    }
    std::array<std::uint8_t, kMotionBytes> factory{};
    if (!read_flash(port, kFactoryMotionAddress, factory)) return std::nullopt;
    return gyro_of(factory);
  }

  void ask_kind(PadPort& port) {
    std::array<std::uint8_t, kPacketBytes> answer{};
    if (ask(port, kDeviceInfo, {}, answer) > kKindAt) kind_ = answer[kKindAt];
  }

  // Sends `packet`, several times if need be, until an input packet satisfies `is_answer`. Returns
  // the size of the answer; 0: none came.
  template <class IsAnswer>
  std::size_t exchange_packets(PadPort& port, std::span<const std::uint8_t> packet,
                               milliseconds patience, std::span<std::uint8_t> answer,
                               IsAnswer is_answer) {
    for (int i = 0; i < kTries && Clock::now() < end_; ++i) {
      if (!port.write(packet)) return 0;
      const auto until = std::min(Clock::now() + patience, end_);
      for (int n = 0; n < kMaxPacketsAwaited; ++n) {
        const auto left = std::chrono::ceil<milliseconds>(until - Clock::now());
        const std::size_t size = left > 0ms ? port.read(answer, left) : 0;
        if (size == 0) break;
        if (is_answer(std::span<const std::uint8_t>(answer.first(std::min(size, answer.size())))))
          return size;
      }
    }
    return 0;
  }

  bool ask_usb(PadPort& port, std::uint8_t command) {
    std::array<std::uint8_t, kPacketBytes> answer{};
    const auto is_answer = [command](std::span<const std::uint8_t> p) {
      return p.size() >= 2 && p[0] == kInUsb && p[1] == command;
    };
    const auto packet = std::to_array<std::uint8_t>({kOutUsb, command});
    return exchange_packets(port, packet, kUsbAnswer, answer, is_answer) > 0;
  }

  OutPacket subcommand(std::uint8_t id, std::span<const std::uint8_t> data) noexcept {
    OutPacket packet;
    packet.bytes[0] = kOutSubcommand;
    packet.bytes[1] = next_count();
    put_vibration(Rumble{}, packet);
    packet.bytes[10] = id;
    std::copy(data.begin(), data.end(), packet.bytes.begin() + 11);
    packet.size = 11 + data.size();
    return packet;
  }

  void ask(PadPort& port, std::uint8_t id, std::span<const std::uint8_t> data) {
    std::array<std::uint8_t, kPacketBytes> answer{};
    ask(port, id, data, answer);
  }
  std::size_t ask(PadPort& port, std::uint8_t id, std::span<const std::uint8_t> data,
                  std::span<std::uint8_t> answer) {
    const auto is_answer = [id](std::span<const std::uint8_t> p) {
      return p.size() > kSubcommandAt && p[0] == kInReply && (p[kAckAt] & 0x80) != 0 &&
             p[kSubcommandAt] == id;
    };
    const OutPacket packet = subcommand(id, data);
    return exchange_packets(port, std::span(packet.bytes).first(packet.size), kAnswer, answer,
                            is_answer);
  }

  // An answer must name the request, because another program may be asking the pad as well.
  bool read_flash(PadPort& port, std::uint32_t address, std::span<std::uint8_t> bytes) {
    const std::array<std::uint8_t, 5> request = {
        static_cast<std::uint8_t>(address), static_cast<std::uint8_t>(address >> 8),
        static_cast<std::uint8_t>(address >> 16), static_cast<std::uint8_t>(address >> 24),
        static_cast<std::uint8_t>(bytes.size())};
    const auto is_answer = [&](std::span<const std::uint8_t> p) {
      return p.size() >= kFlashAt + bytes.size() && p[0] == kInReply && (p[kAckAt] & 0x80) != 0 &&
             p[kSubcommandAt] == kReadFlash &&
             std::equal(request.begin(), request.end(), p.begin() + kAddressAt);
    };
    static_assert(kAddressAt + 4 == kLengthAt && kLengthAt + 1 == kFlashAt);
    std::array<std::uint8_t, kPacketBytes> answer{};
    const OutPacket packet = subcommand(kReadFlash, request);
    if (exchange_packets(port, std::span(packet.bytes).first(packet.size), kAnswer, answer,
                         is_answer) == 0)
      return false;
    std::copy_n(answer.begin() + kFlashAt, bytes.size(), bytes.begin());
    return true;
  }

  // The range of a stick: the user's calibration is preferred to the factory's; both may be
  // missing.
  static std::optional<StickRange> chosen_range(std::span<const std::uint8_t> factory,
                                                std::span<const std::uint8_t> user, Side side) {
    const std::size_t number = side == Side::left ? 0 : 1;
    const RangeOrder& order = side == Side::left ? kLeftOrder : kRightOrder;
    if (user.size() == kUserBytes) {
      const auto own = user.subspan(number * (kMarkBytes + kStickBytes));
      if (std::equal(kMark.begin(), kMark.end(), own.begin())) {
        if (auto range = stick_range(own.subspan<kMarkBytes, kStickBytes>(), order)) return range;
      }
    }
    if (factory.size() != kFactoryBytes) return std::nullopt;
    return stick_range(factory.subspan(number * kStickBytes).first<kStickBytes>(), order);
  }

  void choose_sticks(std::span<const std::uint8_t> factory, std::span<const std::uint8_t> user) {
    const bool has_left = has_stick(Side::left), has_right = has_stick(Side::right);
    const auto left = has_left ? chosen_range(factory, user, Side::left) : std::nullopt;
    const auto right = has_right ? chosen_range(factory, user, Side::right) : std::nullopt;
    if (!left && !right) {
      remarks_.push_back(name_ + (factory.empty()
                                      ? ": does not tell its stick calibration; none is used"
                                      : ": holds no usable stick calibration; none is used"));
      return;
    }
    if ((has_left && !left) || (has_right && !right))
      remarks_.push_back(name_ + ": holds no usable calibration of its " +
                         (left ? "right" : "left") + " stick; the usual one is taken");
    const StickRange l = left.value_or(kUsualRange), r = right.value_or(kUsualRange);
    const FactoryAxis left_x = factory_axis(l, 0), left_y = factory_axis(l, 1),
                      right_x = factory_axis(r, 0), right_y = factory_axis(r, 1);
    // A single Joy-Con is held sideways: the left one is turned to the left, the right one to the
    // right.
    if (has_left && has_right)
      sticks_ = FactorySticks{left_x, left_y, right_x, right_y};
    else if (product_ == kN64)
      sticks_ = FactorySticks{left_x, left_y, {}, {}};
    else if (has_left)
      sticks_ = FactorySticks{mirrored(left_y), left_x, {}, {}};
    else
      sticks_ = FactorySticks{right_y, mirrored(right_x), {}, {}};
  }

  std::string name_;
  std::uint16_t product_;
  bool is_usb_;
  std::uint8_t kind_ = 0;  // kind of controller as the pad says; 0: unknown
  Clock::time_point end_;
  std::uint8_t count_ = 0;
  std::optional<FactorySticks> sticks_;
  std::optional<FactoryGyro> gyro_;
  std::vector<std::string> remarks_;
};

// ---- Switch 2

// A command, its argument and its data; the packet's header has the length of the data.
struct Switch2Command {
  std::uint8_t command, argument;
  std::uint8_t size = 0;
  std::array<std::uint8_t, 20> data{};
};
// Bits of all features: buttons, sticks, motion, motors.
constexpr std::uint8_t kAllFeatures = 0x27;
// The commands in SDL's order; the purpose of those without a comment is not known.
constexpr Switch2Command kStartSwitch2[] = {
    {0x07, 0x01},
    {0x16, 0x01},
    {0x0c, 0x02, 4, {kAllFeatures}},  // selects the features
    {0x11, 0x03},
    {0x0a, 0x08, 20, {0x01, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x35, 0x00, 0x46}},
    {0x0c, 0x04, 4, {kAllFeatures}},  // switches the features on
    {0x10, 0x01},
    {0x01, 0x01},                                                      // starts the motors
    {0x03, 0x0d, 8, {0x01, 0x00, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff}}  // reports to this interface
};
constexpr std::uint32_t kFactoryBlock = 0x013080, kUserBlock = 0x1fc040, kNextStick = 0x40;
// Places in the answer to a reading of the flash memory: where the block begins, and where the
// calibration is in it.
constexpr std::size_t kBlockAt = 0x10, kFactoryAt = kBlockAt + 0x28, kAnswerBytes = 0x50;

class Switch2Pad final : public PadQuirks {
 public:
  explicit Switch2Pad(const DeviceInfo& device)
      : name_(device.name.empty() ? "this pad" : device.name) {}

  void start(PadPort& port, StartedBy) override {
    const auto left = stored_range(port, 0), right = stored_range(port, 1);
    if (left && right)
      sticks_ = FactorySticks{factory_axis(*left, 0), factory_axis(*left, 1),
                              factory_axis(*right, 0), factory_axis(*right, 1)};
    bool has_answered = true;
    for (const Switch2Command& command : kStartSwitch2) {
      std::array<std::uint8_t, kAnswerBytes> answer{};
      has_answered = has_answered && send(port, command, answer) > 0;
    }
    if (!has_answered)
      remarks_.push_back(name_ + ": was not started; only --driver usb can do that");
  }
  std::optional<FactorySticks> factory_sticks() const override { return sticks_; }
  std::vector<std::string> take_remarks() override { return std::exchange(remarks_, {}); }

 private:
  static std::size_t send(PadPort& port, const Switch2Command& command,
                          std::span<std::uint8_t> answer) {
    std::array<std::uint8_t, 8 + sizeof(command.data)> packet = {
        command.command, 0x91, 0x00, command.argument, 0x00, command.size};
    std::copy_n(command.data.begin(), command.size, packet.begin() + 8);
    return port.command(std::span(packet).first(8u + command.size), answer);
  }

  // The range of a stick (0 left, 1 right): the user's calibration is preferred to the factory's.
  static std::optional<StickRange> stored_range(PadPort& port, std::uint32_t stick) {
    for (const std::uint32_t block : {kUserBlock, kFactoryBlock}) {
      const std::uint32_t address = block + stick * kNextStick;
      Switch2Command read = {0x02, 0x01, 8, {}};
      for (std::size_t i = 0; i < 4; ++i)
        read.data[4 + i] = static_cast<std::uint8_t>(address >> (8 * i));
      std::array<std::uint8_t, kAnswerBytes> answer{};
      if (send(port, read, answer) < kFactoryAt + kStickBytes) continue;
      const bool is_user = block == kUserBlock;
      if (is_user && !std::equal(kMark.begin(), kMark.end(), answer.begin() + kBlockAt)) continue;
      const std::size_t at = is_user ? kBlockAt + kMarkBytes : kFactoryAt;
      const auto bytes = std::span(answer).subspan(at).first<kStickBytes>();
      if (auto range = stick_range(bytes, kSwitch2Order)) return range;
    }
    return std::nullopt;
  }

  std::string name_;
  std::optional<FactorySticks> sticks_;
  std::vector<std::string> remarks_;
};

}  // namespace

std::unique_ptr<PadQuirks> make_switch_quirks(const DeviceInfo& device) {
  constexpr std::uint16_t kProducts[] = {kJoyConLeft, kJoyConRight, kProController, kChargingGrip,
                                         kSnes,       kN64,         kMegaDrive};
  const bool is_known =
      std::find(std::begin(kProducts), std::end(kProducts), device.product) != std::end(kProducts);
  if (device.vendor != kNintendo) return nullptr;
  if (device.product == kSwitch2Pro) return std::make_unique<Switch2Pad>(device);
  if (!is_known) return nullptr;
  return std::make_unique<SwitchPad>(device);
}

}  // namespace gaitpad
