// A picture of measured sticks: tracks, outline and zones, raw and calibrated, the magnified rest
// position, the reach by direction, the numbers and the verdict.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "draw/picture.h"
#include "gaitpad/result.h"
#include "pads/calibration_store.h"
#include "stick/pad_analysis.h"
#include "stick/statistics.h"

namespace gaitpad {

struct StickPicture {
  std::string title;                   // for example "left stick"
  std::span<const StickTrack> tracks;  // raw tracks, turned to the frame that the advice found
  const StickStatistics* statistics = nullptr;
  const StickAdvice* advice = nullptr;
};
// Converts a deflection, centred and scaled by the range, to a raw position: a zone's edge is the
// image of a circle or square of deflections.
vec2 raw_of(const StickCalibration& calibration, const vec2& deflection) noexcept;

// Draws one card for each stick, opaque (CAIRO_FORMAT_RGB24); returns cairo's error surface if
// memory is exhausted.
Surface stick_picture(const std::string& heading, std::span<const StickPicture> sticks);
// Writes stick_picture() as a PNG, beside `path` first, so that an error leaves an old file
// unchanged.
std::optional<Error> write_stick_picture(const std::string& path, const std::string& heading,
                                         std::span<const StickPicture> sticks);

// Two calibrations of one stick, for example before and after a repair.
struct ComparedStick {
  std::string title;
  std::string names[2];
  const StickCalibration* calibrations[2] = {};
  std::span<const ComparedNumber> numbers;
};
std::optional<Error> write_comparison(const std::string& path, const std::string& heading,
                                      std::span<const ComparedStick> sticks);

}  // namespace gaitpad
