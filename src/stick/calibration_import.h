// Calibrations that other tools made: read for a given pad, since their numbers are counts of the
// axes of its event node. And the way back: what an exported line has to know of a calibration.
#pragma once
#include <string>
#include <string_view>

#include "gaitpad/calibration.h"
#include "gaitpad/decode.h"
#include "gaitpad/result.h"
#include "hid/sdl_mapping.h"

namespace gaitpad {

// `text` is one of these, told apart by itself; other lines in it are skipped:
// - jscal's command line, as `jscal -p` prints it (with `jscal -u` before it where the axes were
//   mapped): centre, ranges, the zone round the centre;
// - ranges and `flat` of the kernel's axes: evemu's `A:` lines, `EVDEV_ABS_..=` of a hwdb file,
//   what evtest prints;
// - lines of SDL's controller data base, of which the pad's own is taken: `mapping`.
// `source` stands in errors: `old.js:3: ...`. Filled are the calibration and the mapping alone, and
// what the text does not tell is as for an unknown stick. A range beyond what the pad can report
// counts as that; inner zones are 0.05 at least.
Result<CalibrationFile> calibration_import(std::string_view text, const std::string& source,
                                           const DeviceInfo& device, const PadLayout& layout);

// How the sticks lie by their frames, for sdl_mapping_text.
StickAxes stick_axes(const Calibration& calibration) noexcept;

}  // namespace gaitpad
