// The guided calibration in the window: the same guide, analysis, files and picture as `gaitpad
// calibrate`.
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
    std::string map;  // a pad file, empty: none
    std::vector<std::string> config_folders;
    std::string calibration_folder;  // where the file goes; empty: the user's own
  };
  // No session may hold the pad then.
  static Result<std::unique_ptr<CalibrationView>> start(const Options& options);
  ~CalibrationView();

  enum class State { goes_on, saved, given_up };
  // Takes in what the pad did, then draws, in the middle of a window of this size. A sentence for
  // whatever there is to say goes to `messages`.
  State draw(Ui& ui, const ImVec2& window_px, std::vector<std::string>& messages);
  const std::string& saved_to() const noexcept { return target_; }

 private:
  CalibrationView() = default;
  void look(std::vector<std::string>& messages);
  void finish(std::vector<std::string>& messages);
  void draw_guide(Ui& ui, CalibrationGuide& guide);
  void draw_control(Ui& ui, const GuideProgress& control, bool is_stick);
  void draw_result(Ui& ui, float height_px);
  void draw_guide_buttons(Ui& ui, CalibrationGuide& guide);
  void draw_result_buttons(Ui& ui, std::vector<std::string>& messages);
  void upload_picture();

  Options options_;
  PadFiles files_;
  std::unique_ptr<GuidedCalibration> guided_;  // until it is done
  bool is_pad_told_ = false;
  State state_ = State::goes_on;
  // Once it is done.
  GuidedPad pad_;
  std::optional<PadAnalysis> analysis_;
  CalibrationFile file_;
  std::string target_, problem_;
  unsigned texture_ = 0;
  int picture_width_ = 0, picture_height_ = 0;
};

}  // namespace gaitpad
