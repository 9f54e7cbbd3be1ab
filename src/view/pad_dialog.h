// The window's dialogs for a pad while no session uses it: they calibrate the sticks, ask which
// control is which, or test the whole pad.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/pad_configuration.h"
#include "gaitpad/result.h"
#include "selftest/self_test.h"
#include "view/widgets.h"

namespace gaitpad {

class PadDialog {
 public:
  virtual ~PadDialog() = default;  // Frees the pad.

  // wants_map, wants_test: the user asks for the mapping dialog or the self-test instead.
  enum class State { goes_on, ended, calibrated, wants_map, wants_test };
  // Draws in the middle of a window of this size. Remarks and errors are added to `messages`.
  virtual State draw(Ui& ui, const ImVec2& window_px, std::vector<std::string>& messages) = 0;
};

// Draws a step's title, its pad's name (`who`; may be empty), and the request.
void draw_step(Ui& ui, std::string_view title, std::string_view who, std::string_view request);
// Moves the cursor to the row of buttons at the lower edge of a dialog of this height.
void go_to_buttons(float height_px);
// A button that a key presses as well; true if either pressed it.
bool key_button(Ui& ui, std::string_view id, std::string_view label, SDL_Keycode key,
                const ButtonLook& look = {});

struct PadDialogOptions {
  PadSelector selector;
  std::string map;  // path of a pad file (--map); empty: none
  std::vector<std::string> config_folders;
  std::string calibration_folder;  // folder of the calibration's file; empty: the user's own
  std::string program;             // "gaitpad" with its version, for the report of the self-test
};

// Uses the guide, analysis, files and picture of `gaitpad calibrate`.
Result<std::unique_ptr<PadDialog>> start_calibration(const PadDialogOptions& options);
// Uses the steps and the file of `gaitpad map`.
Result<std::unique_ptr<PadDialog>> start_mapping(const PadDialogOptions& options);
// Uses the test and the folder of `gaitpad selftest`.
Result<std::unique_ptr<PadDialog>> start_self_test(const PadDialogOptions& options);

}  // namespace gaitpad
