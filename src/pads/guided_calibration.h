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

// A pad, and what was measured of it.
struct GuidedPad {
  DeviceInfo info;
  PadLayout layout;
  bool has_factory_sticks = false;
  std::optional<TurnRates> gyro_bias_rad_s;  // none: the pad has no gyroscope, or never lay still
  PadTracks tracks;                          // tracks of the sticks, raw, as the layout has them
  std::array<StickFrame, 2> frame;           // frames of the left and right stick
};

// Call its functions from one thread.
class GuidedCalibration {
 public:
  static Result<std::unique_ptr<GuidedCalibration>> start(const PadFiles& files,
                                                          const PadSelector& selector);

  // Takes in the reports that have come; if there are none, waits for one, at most `timeout`. At
  // the end of a recording the steps that it did not show are skipped.
  void look(std::chrono::milliseconds timeout);
  // Null: no pad has come yet.
  CalibrationGuide* guide() noexcept { return guide_ ? &*guide_ : nullptr; }
  // The pad, once there is one.
  const DeviceInfo& pad() const noexcept { return info_; }
  bool is_plugged() const noexcept { return is_plugged_; }
  std::int64_t plugged() const noexcept { return stream_->counts().plugged; }
  // True if the source is a recording and all of it was read.
  bool has_ended() const noexcept { return has_ended_; }
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
// Fills `file` with the values that were not measured but stay valid: from the file that will be
// replaced, else what config/ says about such pads. `remarks` receives a sentence if the old file
// is damaged.
void take_what_holds(const PadFiles& files, const DeviceInfo& info, const std::string& target,
                     CalibrationFile& file, std::vector<std::string>& remarks);
// Sets the bias of the pad's gyroscope, if it was measured; else the old one stays.
void take_gyro_bias(const GuidedPad& pad, CalibrationFile& file);
// The comments at the top of the file.
std::vector<std::string> calibration_comments(const PadAnalysis& analysis);
std::string today();  // The local date: 2024-02-29.

}  // namespace gaitpad
