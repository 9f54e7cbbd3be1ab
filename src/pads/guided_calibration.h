// The guided calibration of a live pad, for the terminal and the window: it takes the first pad
// that comes, passes its reports to the guide, and finds the file that the calibration goes to.
#pragma once
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "pads/gyroscope.h"
#include "stick/guide.h"
#include "stick/pad_analysis.h"

namespace gaitpad {

// A pad, and what was seen of it.
struct GuidedPad {
  DeviceInfo info;
  PadLayout layout;
  bool has_factory_sticks = false;
  std::optional<TurnRates> gyro_bias_rad_s;  // none: no gyroscope, or it never lay still
  PadTracks tracks;                          // raw, as the layout has them
  std::array<StickFrame, 2> frame;           // left, right
};

// From one thread.
class GuidedCalibration {
 public:
  static Result<std::unique_ptr<GuidedCalibration>> start(const PadFiles& files,
                                                          const PadSelector& selector);

  // Takes in the reports that have come; if there are none, waits for one, at most `timeout`. At
  // the end of a recording the steps that it did not show are skipped.
  void look(std::chrono::milliseconds timeout);
  CalibrationGuide* guide() noexcept { return guide_ ? &*guide_ : nullptr; }  // null: no pad yet
  const DeviceInfo& pad() const noexcept { return info_; }                    // once there is one
  bool is_plugged() const noexcept { return is_plugged_; }
  std::int64_t plugged() const noexcept { return stream_->counts().plugged; }
  bool has_ended() const noexcept { return has_ended_; }  // the recording, and all of it was read
  std::vector<std::string> take_remarks();
  // Ends the calibration and returns what the guide has learned.
  GuidedPad finish();

 private:
  GuidedCalibration() = default;
  void take_report(const Report& report);
  void end_recording();

  std::unique_ptr<PadStream> stream_;
  std::uint16_t device_ = kNoDevice;
  DeviceInfo info_;
  PadConfig config_;  // the guide refers to its layout
  bool is_plugged_ = false, has_ended_ = false;
  std::optional<CalibrationGuide> guide_;
  GyroMeter gyro_;
  std::vector<std::string> remarks_;
};

// One sentence if this driver may show other values than the pad's own; else empty.
std::string driver_remark(const DeviceInfo& info);
// A question for each stick of a known pad whose pushes went elsewhere than config/pads says.
std::vector<std::string> axes_questions(const GuidedPad& pad);

// The file that a calibration is written to: `out`, else the device's own file. Error: neither
// XDG_CONFIG_HOME nor HOME is set.
Result<std::string> calibration_target(const std::string& out, const CalibrationFile& file);
// Fills `file` with what holds so far: from the file that will be replaced, else what config/ says
// about such pads. `remarks` receives a sentence if the old file is damaged.
void take_what_holds(const PadFiles& files, const DeviceInfo& info, const std::string& target,
                     CalibrationFile& file, std::vector<std::string>& remarks);
// The bias of the pad's gyroscope, if it was seen; else the old one stays.
void take_gyro_bias(const GuidedPad& pad, CalibrationFile& file);
// The comments at the top of the file.
std::vector<std::string> calibration_comments(const PadAnalysis& analysis);
std::string today();  // 2024-02-29, local

}  // namespace gaitpad
