// What the window does with a pad that no session holds meanwhile: it calibrates the sticks, asks
// which control is which, or tests the whole pad.
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
  virtual ~PadDialog() = default;  // frees the pad

  // wants_map, wants_test: the person asks for that dialog instead.
  enum class State { goes_on, ended, calibrated, wants_map, wants_test };
  // Draws in the middle of a window of this size. Remarks and errors are added to `messages`.
  virtual State draw(Ui& ui, const ImVec2& window_px, std::vector<std::string>& messages) = 0;
};

// A step of a dialog: its title, whose pad it is about (empty: left out), and what to do.
void draw_step(Ui& ui, std::string_view title, std::string_view who, std::string_view request);
// Goes to the row of buttons at the lower edge of a dialog that is so high.
void go_to_buttons(float height_px);
// A button that a key presses as well.
bool key_button(Ui& ui, std::string_view id, std::string_view label, SDL_Keycode key,
                const ButtonLook& look = {});

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
