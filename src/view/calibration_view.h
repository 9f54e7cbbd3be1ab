// The guided calibration in the window, with the same guide, analysis, files and picture as
// `gaitpad calibrate`.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "pads/guided_calibration.h"
#include "view/widgets.h"

namespace gaitpad {

class CalibrationView {
 public:
  struct Options {
    PadWish wish;
    std::string map;  // a pad file; empty: none
    std::vector<std::string> config_folders;
    std::string calibration_folder;  // for the file; empty: the user's own
  };
  // No session may hold the pad meanwhile.
  static Result<std::unique_ptr<CalibrationView>> start(const Options& options);
  ~CalibrationView();

  // wants_test: the person wants the whole pad tested (self_test_view.h).
  enum class State { goes_on, saved, given_up, wants_test };
  // Reads the pad, then draws in the middle of a window of this size. Remarks and errors are added
  // to `messages`.
  State draw(Ui& ui, const ImVec2& window_px, std::vector<std::string>& messages);
  const std::string& saved_to() const noexcept { return target_; }

 private:
  CalibrationView() = default;
  void read_pad(std::vector<std::string>& messages);
  void finish(std::vector<std::string>& messages);
  void draw_guide(Ui& ui, CalibrationGuide& guide);
  void draw_control(Ui& ui, const GuideProgress& control, bool is_stick);
  void draw_result(Ui& ui, float height_px);
  void draw_guide_buttons(Ui& ui, CalibrationGuide& guide);
  void draw_result_buttons(Ui& ui, std::vector<std::string>& messages);
  void upload_picture();

  Options options_;
  PadFiles files_;
  std::unique_ptr<GuidedCalibration> guided_;  // until the guide is done
  bool is_pad_told_ = false;
  State state_ = State::goes_on;
  // Set once the guide is done.
  GuidedPad pad_;
  std::optional<PadAnalysis> analysis_;
  CalibrationFile file_;
  std::string target_, problem_;
  unsigned texture_ = 0;
  int picture_width_ = 0, picture_height_ = 0;
};

}  // namespace gaitpad
