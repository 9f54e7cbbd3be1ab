// A live pad's way through the guided calibration, for the terminal and the window: the pad that
// comes first, its reports through the guide, and at the end the file that its calibration goes to.
#pragma once
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "stick/guide.h"
#include "stick/pad_analysis.h"

namespace gaitpad {

// A pad and all that was seen of it.
struct GuidedPad {
  DeviceInfo info;
  PadLayout layout;
  bool has_factory_sticks = false;
  PadTracks tracks;                 // raw, as the layout has them
  std::array<StickFrame, 2> frame;  // left, right
};

// From one thread.
class GuidedCalibration {
 public:
  static Result<std::unique_ptr<GuidedCalibration>> start(const PadFiles& files,
                                                          const PadWish& wish);

  // Takes in what has come; where nothing is there waits so long for it. A recording that comes to
  // its end skips what it did not show.
  void look(std::chrono::milliseconds timeout);
  CalibrationGuide* guide() noexcept { return guide_ ? &*guide_ : nullptr; }  // null: no pad yet
  const DeviceInfo& pad() const noexcept { return info_; }                    // once there is one
  bool is_plugged() const noexcept { return is_plugged_; }
  std::int64_t plugged() const noexcept { return stream_->counts().plugged; }
  bool has_ended() const noexcept { return has_ended_; }  // the recording, and all of it was seen
  std::vector<std::string> take_remarks();
  // What the guide has learned; it begins no more.
  GuidedPad finish();

 private:
  GuidedCalibration() = default;
  void take(const Report& report);
  void end_recording();

  std::unique_ptr<PadStream> stream_;
  std::uint16_t device_ = kNoDevice;
  DeviceInfo info_;
  PadConfig config_;  // the guide looks at its layout
  bool is_plugged_ = false, has_ended_ = false;
  std::optional<CalibrationGuide> guide_;
  std::vector<std::string> remarks_;
};

// That this driver shows other values than the pad's own, where it may; else empty.
std::string driver_remark(const DeviceInfo& info);

// Where a calibration is kept: `out`, else the device's own file.
Result<std::string> calibration_target(const std::string& out, const CalibrationFile& file);
// `file` gets what holds so far: of the file that is to be replaced, else what config/ says about
// such pads. Remarks: that file is damaged.
void take_what_holds(const PadFiles& files, const DeviceInfo& info, const std::string& target,
                     CalibrationFile& file, std::vector<std::string>& remarks);
// What stands at the top of the file.
std::vector<std::string> calibration_comments(const PadAnalysis& analysis);
std::string today();  // 2024-02-29, local

}  // namespace gaitpad
