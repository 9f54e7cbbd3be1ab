// DualShock 3: its start. DualShock 4 and DualSense: their motors, and what Bluetooth adds (full
// reports on request, a checksum on every long report). Packet layouts are from Linux's
// hid-playstation.c and were compared with what that driver sends. DualShock 4s of other makers:
// whether they have motors, by SDL's SDL_hidapi_ps4.c.
#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/pads/crc32.h"
#include "drivers/pads/pad_quirks.h"
#include "gaitpad/descriptor.h"
#include "gaitpad/math.h"

namespace gaitpad {

namespace {

constexpr std::uint16_t kSony = 0x054c;
constexpr std::uint16_t kDualSenseEdge = 0x0df2, kAdapter = 0x0ba0;
// Place of a DualShock 4's second status byte in report 0x01 (hid-playstation.c).
constexpr std::size_t kAdapterStateAt = 31;
constexpr std::uint8_t kHasNoPad = 0x04;
// Size of the full input and output reports of both families.
constexpr std::size_t kBluetoothBytes = 78;
constexpr std::size_t kChecksumBytes = 4;

// The byte that comes before the report in the checksum.
enum class Direction : std::uint8_t { input = 0xa1, output = 0xa2, feature = 0xa3 };

std::uint32_t checksum(Direction direction, std::span<const std::uint8_t> report) noexcept {
  const std::uint8_t seed = static_cast<std::uint8_t>(direction);
  return crc32(report, crc32({&seed, 1}));
}

std::uint32_t le32(std::span<const std::uint8_t, kChecksumBytes> bytes) noexcept {
  return bytes[0] | (std::uint32_t{bytes[1]} << 8) | (std::uint32_t{bytes[2]} << 16) |
         (std::uint32_t{bytes[3]} << 24);
}

bool is_intact(Direction direction, std::span<const std::uint8_t> report) noexcept {
  if (report.size() <= kChecksumBytes) return false;
  const std::size_t covered = report.size() - kChecksumBytes;
  return checksum(direction, report.first(covered)) == le32(report.last<kChecksumBytes>());
}

// True if the checksum's place holds zeros, as in a recording that was made by hand. A pad sends
// that by chance once in 2^32 reports.
bool has_no_checksum(std::span<const std::uint8_t> report) noexcept {
  return le32(report.last<kChecksumBytes>()) == 0;
}

// Appends the checksum to a packet.
void seal(OutPacket& packet, std::size_t size) noexcept {
  const std::size_t covered = size - kChecksumBytes;
  const std::uint32_t sum = checksum(Direction::output, std::span(packet.bytes).first(covered));
  for (std::size_t i = 0; i < kChecksumBytes; ++i)
    packet.bytes[covered + i] = static_cast<std::uint8_t>(sum >> (8 * i));
  packet.size = size;
}

// The motor's byte: the upper half, but at least 1 for a weak rumble.
std::uint8_t motor(std::uint16_t strength) noexcept {
  return strength == 0 ? 0 : std::max<std::uint8_t>(1, static_cast<std::uint8_t>(strength >> 8));
}

// by_axis: plus and minus of each axis in turn; by_sign: plus of all axes, then minus of all.
enum class TurnOrder { by_axis, by_sign };
constexpr std::size_t kGyroBytes = 23;
// The calibration of a gyroscope: its counts at rest and while it was turned both ways about each
// axis, then the speed of both turns in degrees a second. The pad has already subtracted the counts
// at rest from its reports (hid-playstation.c: "bias"). None: the numbers are impossible for such a
// chip.
std::optional<FactoryGyro> gyro_of(std::span<const std::uint8_t> feature, TurnOrder order) {
  constexpr double kUsual_rad_s = 2048.0 / 32767.0 * kDegree;
  if (feature.size() < kGyroBytes) return std::nullopt;
  const auto number = [feature](std::size_t i) {
    return static_cast<double>(
        static_cast<std::int16_t>(feature[1 + 2 * i] | feature[2 + 2 * i] << 8));
  };
  FactoryGyro gyro;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool is_by_axis = order == TurnOrder::by_axis;
    const double zero = number(i), plus = number(is_by_axis ? 3 + 2 * i : 3 + i),
                 minus = number(is_by_axis ? 4 + 2 * i : 6 + i);
    const double counts = std::fabs(plus - zero) + std::fabs(minus - zero);
    gyro.rad_s_per_count[i] = (number(9) + number(10)) * kDegree / counts;
    const double share = gyro.rad_s_per_count[i] / kUsual_rad_s;
    if (!(share > 0.5 && share < 2.0)) return std::nullopt;
  }
  return gyro;
}

// Over Bluetooth both families send a short report 0x01 until a certain feature report is read,
// then a full one with a checksum.
class SonyQuirks : public PadQuirks {
 public:
  SonyQuirks(const DeviceInfo& device, std::uint8_t full_report)
      : name_(device.name.empty() ? "this pad" : device.name),
        product_(device.product),
        is_bluetooth_(device.bus == BusType::bluetooth),
        full_report_(full_report) {}

  // A wireless adapter without a pad sends reports all the same.
  bool has_pad() const noexcept final { return has_pad_; }

  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept final {
    reply.size = 0;
    if (packet.empty()) return false;
    if (product_ == kAdapter && packet[0] == 0x01 && packet.size() > kAdapterStateAt) {
      has_pad_ = (packet[kAdapterStateAt] & kHasNoPad) == 0;
      return has_pad_;
    }
    if (!is_bluetooth_ || packet[0] != full_report_) return true;
    const bool is_whole = packet.size() == kBluetoothBytes;
    if (is_whole && (is_intact(Direction::input, packet) || has_no_checksum(packet))) return true;
    ++damaged_;
    return false;
  }
  std::int64_t lost() const noexcept final { return damaged_; }
  std::optional<FactoryGyro> factory_gyro() const final { return gyro_; }
  std::vector<std::string> take_remarks() final { return std::exchange(remarks_, {}); }

 protected:
  // Reads the calibration of the gyroscope. Over Bluetooth this makes the pad send full reports.
  bool ask_for_gyro(PadPort& port, std::uint8_t id, TurnOrder order) {
    std::array<std::uint8_t, 64> bytes{};
    const std::size_t size = std::min(port.feature(id, bytes), bytes.size());
    const auto feature = std::span<const std::uint8_t>(bytes).first(size);
    if (!is_bluetooth_ || is_intact(Direction::feature, feature)) gyro_ = gyro_of(feature, order);
    return size > 0;
  }
  void remark_short_reports() {
    remarks_.push_back(name_ + ": does not change to full reports; motion and touch are not sent");
  }

  std::string name_;
  std::uint16_t product_;
  bool is_bluetooth_;

 private:
  std::uint8_t full_report_;
  bool has_pad_ = true;
  std::int64_t damaged_ = 0;
  std::optional<FactoryGyro> gyro_;
  std::vector<std::string> remarks_;
};

// A DualShock 3. On USB it sends nothing until two features were read: Linux's hid-sony.c
// (sixaxis_set_operational_usb), whose third step makes some copies rumble without end.
class DualShock3 final : public PadQuirks {
 public:
  explicit DualShock3(const DeviceInfo& device)
      : name_(device.name.empty() ? "this pad" : device.name),
        is_usb_(device.bus == BusType::usb) {}

  void start(PadPort& port, StartedBy started) override {
    if (!is_usb_ || started == StartedBy::kernel) return;
    std::array<std::uint8_t, 17> state{};
    std::array<std::uint8_t, 8> address{};
    if (port.feature(0xf2, state) == 0)
      remarks_.push_back(name_ + ": does not answer the start over USB");
    port.feature(0xf5, address);  // not checked for its id: the answer begins with another one
  }
  std::vector<std::string> take_remarks() override { return std::exchange(remarks_, {}); }

 private:
  std::string name_;
  bool is_usb_;
  std::vector<std::string> remarks_;
};

class DualShock4 final : public SonyQuirks {
  static constexpr std::uint8_t kReportInterval_ms = 4;

 public:
  explicit DualShock4(const DeviceInfo& device) : SonyQuirks(device, 0x11) {}

  // Over Bluetooth feature 0x05 works with every firmware that Linux knows, 0x02 with the first
  // ones.
  void start(PadPort& port, StartedBy started) final {
    if (!is_bluetooth_) {
      ask_for_gyro(port, 0x02, TurnOrder::by_axis);
    } else if (!ask_for_gyro(port, 0x05, TurnOrder::by_sign) && started == StartedBy::us &&
               !ask_for_gyro(port, 0x02, TurnOrder::by_sign)) {
      remark_short_reports();
    }
  }

  void rumble(const Rumble& rumble, OutPacket& packet) noexcept final {
    packet = {};
    // Place of the part that USB and Bluetooth have in common.
    const std::size_t at = is_bluetooth_ ? 3 : 1;
    packet.bytes[0] = is_bluetooth_ ? 0x11 : 0x05;
    // Bluetooth: a HID report with checksum. The lower bits are the pad's report interval in
    // milliseconds: the kernel and SDL set 4; 0 would make it as short as the link allows.
    if (is_bluetooth_) packet.bytes[1] = 0xc0 | kReportInterval_ms;
    packet.bytes[at] = 0x01;  // sets the motors and leaves the light unchanged
    packet.bytes[at + 3] = motor(rumble.weak);
    packet.bytes[at + 4] = motor(rumble.strong);
    packet.size = 32;
    if (is_bluetooth_) seal(packet, kBluetoothBytes);
  }
};

// A pad of another maker for the PlayStation 4: on USB only, and only some have motors. The pad
// tells whether it has in a feature that its descriptor must state: pads of the same makers without
// that feature hang when they are asked for it.
class DualShock4OfOthers final : public PadQuirks {
 public:
  static constexpr std::uint8_t kAbilities = 0x03, kEffects = 0x05;
  static constexpr std::size_t kAbilityBytes = 48, kEffectBytes = 32;

  void start(PadPort& port, StartedBy) override {
    std::array<std::uint8_t, kAbilityBytes> bytes{};
    const bool is_told = port.feature(kAbilities, bytes) == bytes.size() && bytes[2] == kPs4;
    has_motors_ = is_told && (bytes[4] & kHasMotors) != 0;
  }
  void rumble(const Rumble& rumble, OutPacket& packet) noexcept override {
    packet = {};
    if (!has_motors_) return;
    packet.bytes[0] = kEffects;
    packet.bytes[1] = 0x01;  // sets the motors and leaves the light unchanged
    packet.bytes[4] = motor(rumble.weak);
    packet.bytes[5] = motor(rumble.strong);
    packet.size = kEffectBytes;
  }

 private:
  static constexpr std::uint8_t kPs4 = 0x27, kHasMotors = 0x08;
  bool has_motors_ = false;
};

// Recognises such a pad by its descriptor: the reports for abilities and effects, of exactly these
// sizes.
bool is_dualshock4_of_others(const DeviceInfo& device) {
  if (device.bus != BusType::usb) return false;
  const auto d = parse_descriptor(device.descriptor);
  using Quirks = DualShock4OfOthers;
  return d && report_bytes(*d, FieldKind::feature, Quirks::kAbilities) == Quirks::kAbilityBytes &&
         report_bytes(*d, FieldKind::output, Quirks::kEffects) == Quirks::kEffectBytes;
}

class DualSense final : public SonyQuirks {
 public:
  explicit DualSense(const DeviceInfo& device)
      : SonyQuirks(device, 0x31), has_new_motors_(device.product == kDualSenseEdge) {}

  void start(PadPort& port, StartedBy started) final {
    const bool has_answered = ask_for_gyro(port, 0x05, TurnOrder::by_axis);
    if (!has_answered && is_bluetooth_ && started == StartedBy::us) remark_short_reports();
    if (product_ != kDualSenseEdge) has_new_motors_ = firmware(port) >= kFirstWithNewMotors;
  }

  void rumble(const Rumble& rumble, OutPacket& packet) noexcept final {
    packet = {};
    // Place of the part that USB and Bluetooth have in common.
    const std::size_t at = is_bluetooth_ ? 3 : 1;
    packet.bytes[0] = is_bluetooth_ ? 0x31 : 0x02;
    if (is_bluetooth_) {
      packet.bytes[1] = static_cast<std::uint8_t>(sequence_ << 4);
      packet.bytes[2] = 0x10;
      sequence_ = (sequence_ + 1) & 0x0f;
    }
    // Selects the motors; which bits do so depends on the firmware.
    packet.bytes[at] = has_new_motors_ ? 0x02 : 0x03;
    packet.bytes[at + 2] = motor(rumble.weak);
    packet.bytes[at + 3] = motor(rumble.strong);
    if (has_new_motors_) packet.bytes[at + 38] = 0x04;
    packet.size = 48;  // the size in the descriptor; the kernel sends 63 bytes
    if (is_bluetooth_) seal(packet, kBluetoothBytes);
  }

 private:
  static constexpr std::uint16_t kFirstWithNewMotors = 0x0215;  // version 2.21

  // The version of the pad's firmware (2.36 is 0x0224); 0: unknown.
  std::uint16_t firmware(PadPort& port) const {
    std::array<std::uint8_t, 64> bytes{};
    if (port.feature(0x20, bytes) < bytes.size() || bytes[0] != 0x20) return 0;
    if (is_bluetooth_ && !is_intact(Direction::feature, bytes)) return 0;
    return static_cast<std::uint16_t>(bytes[44] | (bytes[45] << 8));
  }

  bool has_new_motors_;
  std::uint8_t sequence_ = 0;
};

}  // namespace

std::unique_ptr<PadQuirks> make_sony_quirks(const DeviceInfo& device) {
  if (device.vendor != kSony)
    return is_dualshock4_of_others(device) ? std::make_unique<DualShock4OfOthers>() : nullptr;
  switch (device.product) {
    case 0x0268:
      return std::make_unique<DualShock3>(device);
    case 0x05c4:  // the first DualShock 4
    case 0x09cc:
    case kAdapter:  // the wireless adapter of the DualShock 4, on USB
      return std::make_unique<DualShock4>(device);
    case 0x0ce6:
    case kDualSenseEdge:
      return std::make_unique<DualSense>(device);
    default:
      return nullptr;
  }
}

}  // namespace gaitpad
