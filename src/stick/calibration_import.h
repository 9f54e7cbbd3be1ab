// Imports calibrations that other tools made. Their numbers are counts of the axes of the pad's
// event node, so the pad must be known.
#pragma once
#include <string>
#include <string_view>

#include "gaitpad/calibration.h"
#include "gaitpad/decode.h"
#include "gaitpad/result.h"
#include "hid/sdl_lines.h"

namespace gaitpad {

// `text` is of one of these kinds:
// - a recording of evemu, libinput or umockdev: the ranges of the kernel's axes and their `flat`;
//   if it has several nodes, the pad's is read;
// - lines of SDL's controller data base: the pad's own line becomes `mapping`; other lines are
//   skipped.
// Errors begin with `source`: `bug.yml:23: ...`. Only the calibration and the mapping are filled;
// what the text does not state is as for an unknown stick. A range beyond what the pad can report
// is cut to that; inner zones are at least 0.05.
Result<CalibrationFile> calibration_import(std::string_view text, const std::string& source,
                                           const DeviceInfo& device, const PadLayout& layout);

// The sticks' axes according to their frames, for sdl_mapping_text().
StickAxes stick_axes(const Calibration& calibration) noexcept;

}  // namespace gaitpad
