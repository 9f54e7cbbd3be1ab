// A stick's picture: its track, the measured outline, the zones, raw and calibrated position, the
// circularity by direction.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "base/result.h"
#include "stick/recommendation.h"
#include "stick/statistics.h"

namespace gaitpad {

struct StickPicture {
  std::string title;                   // "left stick"
  std::span<const StickTrack> tracks;  // in the frame of the advice
  const StickStatistics* statistics = nullptr;
  const StickAdvice* advice = nullptr;
};
// A PNG with one row a stick. Written beside `path` first; on error nothing stands there or the old
// file is as it was.
std::optional<Error> write_stick_picture(const std::string& path, const std::string& heading,
                                         std::span<const StickPicture> sticks);

}  // namespace gaitpad
