// From raw stick axes to a calibrated position: centre and range of each axis, then dead zones and
// a response curve of each stick. Also the calibration files (TOML, grammar in config/README.md).
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

// "Raw" is what decode() gives: fractions of half the field's logical range from its middle, -1..1,
// +x right, +y forward as the pad's layout has it.

// Measured when a pad is calibrated.
struct AxisCalibration {
  double min = -1.0, centre = 0.0, max = 1.0;  // raw; min < centre < max, at least 0.1 apart
  bool operator==(const AxisCalibration&) const = default;
};
enum class ZoneShape : std::uint8_t {
  radial,  // one round zone
  axial,   // each axis by itself
  both,    // radial, then a narrower zone on the sideways axis: one can walk straight ahead
};
// How the raw axes lie under the thumb: the raw direction that grows when the stick goes right, and
// the one that grows when it goes forward. One is an x, the other a y.
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
// A raw position in the frame: +x right, +y forward under the thumb.
vec2 in_frame(const StickFrame& frame, const vec2& raw) noexcept;

// The defaults are safe for an unknown stick. `inner` and `outer` are fractions of the deflection
// after centre and range were taken out: no output up to `inner`, full output from `outer` on.
struct StickCalibration {
  StickFrame frame;
  AxisCalibration x, y;  // in that frame
  ZoneShape shape = ZoneShape::both;
  double inner = 0.20;     // 0 .. 0.9
  double outer = 0.95;     // inner + 0.05 .. 1
  double sideways = 0.11;  // ZoneShape::both only: fraction of the calibrated deflection, 0 .. 0.5
  double curve = 0.0;      // 0 linear .. 1 cubic: (1 - curve) t + curve t^3
  bool filters_jumps = false;  // each axis is the median of its last three reports: JumpFilter
  bool operator==(const StickCalibration&) const = default;
};
struct TriggerCalibration {
  double released = 0.0, pressed = 1.0;  // raw 0..1; pressed at least 0.1 above released
  bool operator==(const TriggerCalibration&) const = default;
};
// Comes from a file or a measurement, or a program fills it.
struct Calibration {
  StickCalibration left, right;
  TriggerCalibration left_trigger, right_trigger;
  bool operator==(const Calibration&) const = default;
};

inline constexpr double kLeastHalfRange = 0.1;      // raw, from the centre to either end
inline constexpr double kLeastZoneSpan = 0.05;      // from the inner to the outer zone
inline constexpr double kLeastTriggerTravel = 0.1;  // raw
// `Calibration: left.inner is 2, outside [0, 0.9]`. The bounds are those of the files.
std::optional<Error> check(const Calibration& calibration);

// Inner zones for sticks that were not measured; a Sony stick rests within 6 % of its middle.
inline constexpr double kInnerZoneSony = 0.12;
inline constexpr double kInnerZoneUnknown = 0.20;

// The calibrated position, on the unit disc, +x right, +y forward. Exactly 0 inside the inner zone,
// of length 1 from the outer zone on (ZoneShape::both: 3 % shorter at most), continuous and
// monotone between them, odd about the centre. Not-a-number counts as the centre.
vec2 stick_position(const StickCalibration& calibration, const vec2& raw) noexcept;
// Both sticks of a decoded pad.
Stick stick_position(const Calibration& calibration, const PadState& pad) noexcept;
// 0 released .. 1 pressed; not-a-number counts as released.
double trigger_position(const TriggerCalibration& calibration, double raw) noexcept;

// For sticks that jump for single reports: the last three positions of a pad's sticks. A stick that
// moves is delayed by one report; settle() ends the delay when no report follows.
//
//   decode(layout, report, state);
//   filter.take(state);
//   const Stick stick = stick_position(calibration, filter.filtered(calibration, state));
class JumpFilter {
 public:
  void take(const PadState& state) noexcept;  // as the newest report has it
  // No report came for kSettled_s, or twice as long as between the last two: the newest position
  // holds. A pad that reports changes only would be behind for as long as nothing changes.
  void settle() noexcept { last_[0] = last_[1] = last_[2]; }
  // The state with the medians in place of the sticks that the calibration filters; the others stay
  // bit by bit.
  PadState filtered(const Calibration& calibration, const PadState& state) const noexcept;
  static constexpr double kSettled_s = 0.02;

 private:
  std::array<std::array<double, 4>, 3> last_{};  // left x, y, right x, y; the newest last
  bool is_begun_ = false;
};

// The same calibration without negative zeros: the only numbers that calibration_text() does not
// keep bit by bit. A canonical calibration is what a recording of it reads back.
Calibration canonical(const Calibration& calibration) noexcept;

// ---- Calibration files

// Which devices a file is for, as `054c:09cc`, `054c:*` or `*:*`.
struct DevicePattern {
  int vendor = -1, product = -1;  // -1: any
  bool operator==(const DevicePattern&) const = default;
};
// What tells one device from another when a calibration is looked for. identity_of() fills it
// (gaitpad/pad_configuration.h).
struct DeviceIdentity {
  std::uint16_t vendor = 0, product = 0;
  std::string unique_id, port;  // as DeviceInfo::unique_id and physical_path
  std::string driver;           // empty, as in a foreign recording: hidraw
};
// What was measured when the file was made, to compare it with a later day; changes no output. A
// calibration's analysis fills it. Raw,
// in the stick's frame; none: not known.
struct StickMeasured {
  std::optional<double> sigma, hysteresis, drift_per_s, circularity_error;  // the last in percent
  bool operator==(const StickMeasured&) const = default;
};
inline constexpr double kMostGyroBias_rad_s = 1.0;  // no such chip is off by more
struct CalibrationFile {
  std::string name;
  std::string unique_id, port;         // empty: any
  std::vector<DevicePattern> devices;  // empty: none, unless unique_id is given
  std::vector<std::string> drivers;    // empty: any; else hidraw, usb, evdev, sdl
  std::string measured_on;             // a date; empty: not measured
  std::string mapping;                 // a line of SDL's controller data base, or empty
  Calibration calibration;
  std::array<std::optional<StickMeasured>, 2> measured;  // left, right
  // What the gyroscope shows while the pad lies still, each -kMostGyroBias_rad_s ..
  // kMostGyroBias_rad_s.
  std::optional<TurnRates> gyro_bias_rad_s;
  bool operator==(const CalibrationFile&) const = default;
};
// `CalibrationFile: gyro_bias_rad_s[1] is nan, outside [-1, 1]`, or what check() says of its
// calibration.
std::optional<Error> check(const CalibrationFile& file);

// Error: `own.toml:3: "inner" is 0.95, outside [0, 0.9]`.
Result<CalibrationFile> load_calibration_file(const std::string& path);
// The same from text, for instance of a recording. `name` stands for the path in errors.
Result<CalibrationFile> parse_calibration(std::string_view text, const std::string& name,
                                          int first_line = 1);
// Text that parse_calibration() reads back to the same bits, apart from -0 (see canonical) and
// names that are no UTF-8. Numbers are as short as that allows; the text is never empty.
std::string calibration_text(const CalibrationFile& file);

// How well a file fits a device; 0: not at all, the greater the better. In this order: `*:*`,
// `vvvv:*`, `vvvv:pppp`, the same three with the port, the unique id; among equals a file that
// names the device's driver.
int calibration_fit(const CalibrationFile& file, const DeviceIdentity& device);
struct FoundCalibration {
  CalibrationFile file;
  std::vector<std::string> problems;  // one sentence for each file or folder that was skipped
};
// The best fitting *.toml file of the folders; among equals the earlier folder, then the first
// name. The defaults for an unknown stick if none fits. A folder that does not exist is no problem.
// A damaged file is skipped, because it may be for another device.
FoundCalibration find_calibration(std::span<const std::string> folders,
                                  const DeviceIdentity& device);

}  // namespace gaitpad
