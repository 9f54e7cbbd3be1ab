// Converts raw stick axes to a calibrated position: centre and range of each axis, then dead zones
// and a response curve of each stick. Also the calibration files (TOML, grammar in
// config/README.md).
//
//   gaitpad::Calibration calibration;              // of an unknown stick, or from a file
//   gaitpad::Stick stick = stick_position(calibration, pad);  // pad: from decode()
//
// stick_position, trigger_position and in_frame are for the loop: noexcept, no heap. The functions
// on files allocate.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/stick.h"

namespace gaitpad {

// "Raw" is the value from decode(): a fraction of half the field's logical range from its middle,
// -1..1, with +x right and +y forward as the pad's layout has it.

// The range of an axis, measured when a pad is calibrated.
struct AxisCalibration {
  // Ends and centre, raw; min < centre < max, at least 0.1 apart.
  double min = -1.0, centre = 0.0, max = 1.0;
  bool operator==(const AxisCalibration&) const = default;
};
enum class ZoneShape : std::uint8_t {
  radial,  // one round zone for both axes
  axial,   // a zone for each axis alone
  both,    // a round zone, then a narrower zone on the sideways axis, so that one can walk straight
           // ahead
};
// The orientation of the raw axes under the thumb: the raw direction that grows when the stick goes
// right, and the one that grows when it goes forward. One is an x, the other a y.
enum class RawDirection : std::uint8_t { plus_x, minus_x, plus_y, minus_y };
constexpr bool is_along_x(RawDirection d) noexcept {
  return d == RawDirection::plus_x || d == RawDirection::minus_x;
}
constexpr bool is_negative(RawDirection d) noexcept {
  return d == RawDirection::minus_x || d == RawDirection::minus_y;
}
struct StickFrame {
  RawDirection right = RawDirection::plus_x, forward = RawDirection::plus_y;
  bool operator==(const StickFrame&) const = default;
};
// Converts a raw position to the frame: +x right, +y forward under the thumb.
vec2 in_frame(const StickFrame& frame, const vec2& raw) noexcept;

// A stick's calibration; the defaults are safe for an unknown stick. `inner` and `outer` are
// fractions of the deflection after centre and range were taken out: no output up to `inner`, full
// output from `outer` on.
struct StickCalibration {
  StickFrame frame;
  AxisCalibration x, y;  // axes in that frame
  ZoneShape shape = ZoneShape::both;
  double inner = 0.20;  // radius of the inner zone, 0 .. 0.9
  double outer = 0.95;  // radius of the outer zone, inner + 0.05 .. 1
  // Half width of the sideways zone, a fraction of the calibrated deflection, 0 .. 0.5; only with
  // ZoneShape::both.
  double sideways = 0.11;
  double curve = 0.0;  // bend of the response t: (1 - curve) t + curve t^3; 0 linear .. 1 cubic
  bool filters_jumps = false;  // each axis is the median of its last three reports (JumpFilter)
  bool operator==(const StickCalibration&) const = default;
};
struct TriggerCalibration {
  double released = 0.0, pressed = 1.0;  // raw values, 0..1; pressed is at least 0.1 above released
  bool operator==(const TriggerCalibration&) const = default;
};
// A pad's calibration, from a file, a measurement or a program.
struct Calibration {
  StickCalibration left, right;
  TriggerCalibration left_trigger, right_trigger;
  bool operator==(const Calibration&) const = default;
};

inline constexpr double kLeastHalfRange = 0.1;      // least distance from the centre to either end,
                                                    // raw
inline constexpr double kLeastZoneSpan = 0.05;      // least distance from the inner to the outer
                                                    // zone
inline constexpr double kLeastTriggerTravel = 0.1;  // least distance from released to pressed, raw
// Errors read `Calibration: left.inner is 2, outside [0, 0.9]`. The bounds are those of the files.
std::optional<Error> check(const Calibration& calibration);

// Inner zones for sticks that were not measured; a Sony stick rests within 6 % of its middle.
inline constexpr double kInnerZoneSony = 0.12;
inline constexpr double kInnerZoneUnknown = 0.20;

// The calibrated position, on the unit disc, +x right, +y forward. Exactly 0 inside the inner zone,
// of length 1 from the outer zone on (ZoneShape::both: 3 % shorter at most), continuous and
// monotone between them, odd about the centre. Not-a-number counts as the centre.
vec2 stick_position(const StickCalibration& calibration, const vec2& raw) noexcept;
// The calibrated positions of both sticks of a decoded pad.
Stick stick_position(const Calibration& calibration, const PadState& pad) noexcept;
// The calibrated trigger, 0 released .. 1 pressed; not-a-number counts as released.
double trigger_position(const TriggerCalibration& calibration, double raw) noexcept;

// Removes jumps that last one report, by the last three positions of a pad's sticks. It delays a
// stick that moves by one report; settle() ends the delay when no report follows.
//
//   decode(layout, report, state);
//   filter.take(state);
//   const Stick stick = stick_position(calibration, filter.filtered(calibration, state));
class JumpFilter {
 public:
  void take(const PadState& state) noexcept;  // Adds the newest report's positions.
  // Call it when no report came for kSettled_s, or for twice the time between the last two: the
  // newest position then counts at once. Otherwise a pad that reports only changes would lag one
  // report behind while it rests.
  void settle() noexcept { last_[0] = last_[1] = last_[2]; }
  // The state in which medians replace the sticks that the calibration filters; the other values
  // stay bit by bit.
  PadState filtered(const Calibration& calibration, const PadState& state) const noexcept;
  static constexpr double kSettled_s = 0.02;

 private:
  // The last three positions, each left x, y, right x, y; the newest is last.
  std::array<std::array<double, 4>, 3> last_{};
  bool is_begun_ = false;
};

// The calibration without negative zeros, the only numbers that calibration_text() does not keep
// bit by bit. A calibration that was read back from a recording is canonical.
Calibration canonical(const Calibration& calibration) noexcept;

// ---- Calibration files

// The devices that a file is for, as `054c:09cc`, `054c:*` or `*:*`.
struct DevicePattern {
  int vendor = -1, product = -1;  // ids; -1: any
  bool operator==(const DevicePattern&) const = default;
};
// The facts by which calibration files tell devices apart. identity_of() fills them
// (gaitpad/pad_configuration.h).
struct DeviceIdentity {
  std::uint16_t vendor = 0, product = 0;
  std::string unique_id, port;  // as in DeviceInfo::unique_id and physical_path
  std::string driver;           // name of the driver; empty (foreign recordings): hidraw
};
// Measurements that were made along with the file, to compare with later ones; they change no
// output. A calibration's analysis fills them. Raw, in the stick's frame; none: not known.
struct StickMeasured {
  // Circularity is in percent.
  std::optional<double> sigma, hysteresis, drift_per_s, circularity_error;
  bool operator==(const StickMeasured&) const = default;
};
// Greatest bias of a gyroscope; no such chip has a larger one.
inline constexpr double kMostGyroBias_rad_s = 1.0;
struct CalibrationFile {
  std::string name;
  std::string unique_id, port;  // unique id and port of the device that the file is for; empty: any
  // Devices that the file is for; empty: none, unless unique_id is given.
  std::vector<DevicePattern> devices;
  // Drivers that the file is for: hidraw, usb, evdev, sdl; empty: any.
  std::vector<std::string> drivers;
  std::string measured_on;  // date of the measurement; empty: not measured
  std::string mapping;      // a line of SDL's controller data base, or empty
  Calibration calibration;
  // Measurements of the left and the right stick.
  std::array<std::optional<StickMeasured>, 2> measured;
  // The gyroscope's rates while the pad lies still, each -kMostGyroBias_rad_s ..
  // kMostGyroBias_rad_s.
  std::optional<TurnRates> gyro_bias_rad_s;
  bool operator==(const CalibrationFile&) const = default;
};
// Errors read `CalibrationFile: gyro_bias_rad_s[1] is nan, outside [-1, 1]`, or what check() says
// of its calibration.
std::optional<Error> check(const CalibrationFile& file);

// Reads a file. Errors read `own.toml:3: "inner" is 0.95, outside [0, 0.9]`.
Result<CalibrationFile> load_calibration_file(const std::string& path);
// Reads a file's text, for instance of a recording. `name` replaces the path in errors.
Result<CalibrationFile> parse_calibration(std::string_view text, const std::string& name,
                                          int first_line = 1);
// Text that parse_calibration() reads back to the same bits, apart from -0 (see canonical) and
// names that are no UTF-8. Numbers are as short as that allows; the text is never empty.
std::string calibration_text(const CalibrationFile& file);

// Rates how well a file fits a device; 0: not at all; greater values fit better. The ranking:
// `*:*`, `vvvv:*`, `vvvv:pppp`, these three with the port, the unique id; among equals a file that
// names the device's driver.
int calibration_fit(const CalibrationFile& file, const DeviceIdentity& device);
struct FoundCalibration {
  CalibrationFile file;
  std::vector<std::string> problems;  // sentences about files and folders that were skipped
};
// The best fitting *.toml file of the folders; among equals the earlier folder, then the first
// name. The defaults for an unknown stick if none fits. A folder that does not exist is no problem.
// A damaged file is skipped, because it may be for another device.
FoundCalibration find_calibration(std::span<const std::string> folders,
                                  const DeviceIdentity& device);

}  // namespace gaitpad
