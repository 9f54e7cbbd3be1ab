// A stick's picture: its track, the measured outline, the zones, raw and calibrated position, the
// circularity by direction.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "gaitpad/result.h"
#include "stick/pad_analysis.h"
#include "stick/statistics.h"
#include "view/drawing.h"

namespace gaitpad {

struct StickPicture {
  std::string title;                   // "left stick"
  std::span<const StickTrack> tracks;  // in the frame of the advice
  const StickStatistics* statistics = nullptr;
  const StickAdvice* advice = nullptr;
};
// One row a stick, opaque (CAIRO_FORMAT_RGB24); without memory cairo's own broken surface.
Surface stick_picture(const std::string& heading, std::span<const StickPicture> sticks);
// The same as a PNG. Written beside `path` first; on error nothing stands there or the old
// file is as it was.
std::optional<Error> write_stick_picture(const std::string& path, const std::string& heading,
                                         std::span<const StickPicture> sticks);

}  // namespace gaitpad
