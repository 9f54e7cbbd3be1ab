// What the window does with a pad that no session holds meanwhile: it calibrates the sticks, asks
// which control is which, or tests the whole pad.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/pad_setup.h"
#include "gaitpad/result.h"
#include "selftest/self_test.h"
#include "view/widgets.h"

namespace gaitpad {

class PadDialog {
 public:
  virtual ~PadDialog() = default;  // frees the pad

  // wants_map, wants_test: the person asks for that dialog instead.
  enum class State { goes_on, ended, calibrated, wants_map, wants_test };
  // Draws in the middle of a window of this size. Remarks and errors are added to `messages`.
  virtual State draw(Ui& ui, const ImVec2& window_px, std::vector<std::string>& messages) = 0;
};

struct PadDialogOptions {
  PadWish wish;
  std::string map;  // a pad file; empty: none
  std::vector<std::string> config_folders;
  std::string calibration_folder;  // for a calibration's file; empty: the user's own
  std::string program;             // for the self-test: gaitpad itself
};

// With the same guide, analysis, files and picture as `gaitpad calibrate`.
Result<std::unique_ptr<PadDialog>> start_calibration(const PadDialogOptions& options);
// The same steps and the same file as `gaitpad map`.
Result<std::unique_ptr<PadDialog>> start_mapping(const PadDialogOptions& options);
// The same test and the same folder as `gaitpad selftest`.
Result<std::unique_ptr<PadDialog>> start_self_test(const PadDialogOptions& options);

}  // namespace gaitpad
