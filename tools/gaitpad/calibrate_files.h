// The files around a calibration: where it is written, what other tools' files say, and what is
// handed to them.
#pragma once
#include <string>
#include <vector>

#include "gaitpad/pad_setup.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"

namespace gaitpad {

struct CalibrateArguments {
  PadWish wish;
  std::vector<std::string> traces, pushes;
  std::string out, plot, check, import, map;
  bool as_json = false, exports_sdl = false, is_lenient = false;
};

int calibrate_failed(const std::string& sentence);  // says it; the exit status

// To the target; `-` is standard output. The exit status.
int print_or_save(const std::string& target, const CalibrationFile& file,
                  const std::vector<std::string>& comments);

// --import and --export-sdl, for the pad of the recordings, else the wished one. The exit status.
int import_calibration(const CalibrateArguments& arguments, const PadFiles& files);
int export_sdl(const CalibrateArguments& arguments, const PadFiles& files);

}  // namespace gaitpad
