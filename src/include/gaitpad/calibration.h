// From raw stick axes to a calibrated position: centre and range per axis, then dead zones and a
// response curve per stick. The words and rules are those of the interface contract, section
// Sticks.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/stick.h"

namespace gaitpad {

// Raw axes are fractions of half the logical range from its middle: -1..1, +x right, +y forward.
struct AxisCalibration {
  double min = -1.0, centre = 0.0, max = 1.0;  // raw; min < centre < max
  bool operator==(const AxisCalibration&) const = default;
};
enum class ZoneShape : std::uint8_t {
  radial,  // one round zone
  axial,   // each axis by itself
  both,    // radial, then a narrower zone on the sideways axis alone: straight ahead can be held
};
// How the raw axes lie under the thumb: the raw direction that grows when the stick goes right and
// when it goes forward. One is an x, the other a y.
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
// A raw position as it is in the frame: +x right, +y forward.
vec2 in_frame(const StickFrame& frame, const vec2& raw) noexcept;

struct StickCalibration {
  StickFrame frame;
  AxisCalibration x, y;  // in that frame
  ZoneShape shape = ZoneShape::both;
  double inner = 0.20;  // fractions of the centred, ranged deflection
  double outer = 0.95;
  double sideways = 0.08;  // `both` only, fraction of the calibrated deflection
  double curve = 0.0;      // response: (1 - curve) t + curve t^3
  bool operator==(const StickCalibration&) const = default;
};
struct TriggerCalibration {
  double released = 0.0, pressed = 1.0;  // raw, 0..1; released < pressed
  bool operator==(const TriggerCalibration&) const = default;
};
struct Calibration {
  StickCalibration left, right;
  TriggerCalibration left_trigger, right_trigger;
  bool operator==(const Calibration&) const = default;
};

// Inner zones where nothing was measured; a Sony stick rests within 6 % of its middle.
inline constexpr double kInnerZoneSony = 0.12;
inline constexpr double kInnerZoneUnknown = 0.20;

// Inside the inner zone exactly 0, from the outer zone on of length 1, between them continuous and
// monotone; odd about the centre. Not-a-number counts as the centre.
vec2 stick_position(const StickCalibration& calibration, const vec2& raw) noexcept;
Stick stick_position(const Calibration& calibration, const vec2& raw_left,
                     const vec2& raw_right) noexcept;
// 0 released .. 1 pressed; not-a-number counts as released.
double trigger_position(const TriggerCalibration& calibration, double raw) noexcept;

// Which devices a calibration file is for; the grammar stands in config/README.md.
struct DevicePattern {
  int vendor = -1, product = -1;  // -1: any
  bool operator==(const DevicePattern&) const = default;
};
struct DeviceIdentity {
  std::uint16_t vendor = 0, product = 0;
  std::string unique_id, port;
  std::string driver;  // empty as in a foreign recording: hidraw
};
// What was measured when the file was made, to compare with a later day; steers nothing. Raw, in
// the stick's frame; none: not known.
struct StickMeasured {
  std::optional<double> sigma, hysteresis, drift_per_s, circularity_error;  // the last in percent
  bool operator==(const StickMeasured&) const = default;
};
struct CalibrationFile {
  std::string name;
  std::string unique_id, port;         // empty: any
  std::vector<DevicePattern> devices;  // empty: none, unless unique_id tells
  std::vector<std::string> drivers;    // empty: any; else where other drivers' values differ
  std::string measured_on;             // a date, empty: not measured
  std::string mapping;  // a line of SDL's controller data base that names the controls, or empty
  Calibration calibration;
  std::array<std::optional<StickMeasured>, 2> measured;  // left, right
  bool operator==(const CalibrationFile&) const = default;
};

Result<CalibrationFile> load_calibration_file(const std::string& path);
// The same from text that stands elsewhere (a recording carries its calibration).
Result<CalibrationFile> parse_calibration(std::string_view text, const std::string& name,
                                          int first_line = 1);
// The text that parse_calibration reads back to the same bits (-0 to 0; names that are no UTF-8
// lose what is none). Numbers as short as that allows; never empty.
std::string calibration_text(const CalibrationFile& file);

// How well a file fits a device: 0 not at all, then `*:*`, `vvvv:*`, `vvvv:pppp`, the same with the
// port, the unique id; among these a file that names the device's driver fits better than one that
// names none.
int calibration_fit(const CalibrationFile& file, const DeviceIdentity& device);
struct FoundCalibration {
  CalibrationFile file;
  std::vector<std::string> problems;  // a sentence for each file or folder that was left out
};
// The best fitting *.toml file of the folders; among equals the earlier folder, then the first
// name. Without any, zones for an unknown stick. A folder need not exist; a damaged file is left
// out, since nobody can tell whose it is.
FoundCalibration find_calibration(std::span<const std::string> folders,
                                  const DeviceIdentity& device);

}  // namespace gaitpad
