#include "pads/guided_calibration.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <iterator>
#include <utility>

#include "gaitpad/limbs.h"
#include "pads/calibration_store.h"
#include "system/clock.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kOnTheWayNs = 50'000'000;  // the longest delay of a report

}  // namespace

Result<std::unique_ptr<GuidedCalibration>> GuidedCalibration::start(const PadFiles& files,
                                                                    const PadSelector& selector) {
  PadStreamOptions options;
  options.files = files;
  options.selector = selector;
  auto stream = PadStream::start(std::move(options));
  if (!stream) return stream.error();
  std::unique_ptr<GuidedCalibration> calibration(new GuidedCalibration());
  calibration->stream_ = std::move(*stream);
  return calibration;
}

void GuidedCalibration::take_report(const Report& report) {
  if (report.kind == ReportKind::added && device_ == kNoDevice) {
    device_ = report.device;
    info_ = stream_->device(device_).info;
    config_ = stream_->take_config(device_);
    guide_.emplace(*config_.layout);
    gyro_ = {info_, config_.factory_gyro};
  }
  if (report.device != device_ || device_ == kNoDevice) return;
  if (report.kind == ReportKind::added) is_plugged_ = true;
  if (report.kind == ReportKind::removed) is_plugged_ = false;
  guide_->take_report(report);
  if (report.kind == ReportKind::input) gyro_.take(report);
}

void GuidedCalibration::end_recording() {
  has_ended_ = true;
  if (!guide_ || guide_->step() == GuideStep::done) return;
  remarks_.emplace_back("the recording has ended: the steps that it does not show are skipped");
  while (guide_->step() != GuideStep::done) guide_->skip();
}

void GuidedCalibration::look(std::chrono::milliseconds timeout) {
  if (timeout.count() > 0) stream_->wait(timeout);
  // Asked before the reports are read, so that the last ones are not missed.
  const bool has_ended = stream_->has_ended();
  for (; const Report* report = stream_->front(); stream_->pop()) take_report(*report);
  if (guide_) guide_->tick(now_ns() - kOnTheWayNs);
  if (has_ended && !has_ended_) end_recording();
}

std::vector<std::string> GuidedCalibration::take_remarks() {
  std::vector<std::string> all = stream_->take_remarks();
  std::move(remarks_.begin(), remarks_.end(), std::back_inserter(all));
  remarks_.clear();
  return all;
}

GuidedPad GuidedCalibration::finish() {
  GuidedPad pad;
  if (!guide_) return pad;
  pad.info = info_;
  pad.has_factory_sticks = config_.has_factory_sticks;
  if (gyro_.rest()) pad.gyro_bias_rad_s = gyro_.rest()->bias_rad_s;
  pad.tracks = guide_->tracks();
  pad.frame = {guide_->frame(0), guide_->frame(1)};
  if (config_.layout) pad.layout = *config_.layout;
  return pad;
}

std::string driver_remark(const DeviceInfo& info) {
  if (info.driver != "evdev" && info.driver != "sdl") return {};
  return fmt::format(
      "through {} the kernel may filter small changes (fuzz) and correct the sticks, so noise and "
      "centre are not the pad's own; --driver hidraw or usb sees more, where the pad has it",
      info.driver);
}

Result<std::string> calibration_target(const std::string& out, const CalibrationFile& file) {
  if (!out.empty()) return out;
  const std::string folder = user_calibration_folder();
  if (!folder.empty()) return calibration_path(folder, file);
  return Error{"neither XDG_CONFIG_HOME nor HOME names a folder for the file: give --out FILE"};
}

void take_gyro_bias(const GuidedPad& pad, CalibrationFile& file) {
  if (pad.gyro_bias_rad_s) file.gyro_bias_rad_s = pad.gyro_bias_rad_s;
}

void take_what_holds(const PadFiles& files, const DeviceInfo& info, const std::string& target,
                     CalibrationFile& file, std::vector<std::string>& remarks) {
  std::error_code error;
  if (target != "-" && std::filesystem::exists(target, error)) {
    auto old = load_calibration_file(target);
    if (old) {
      file.calibration = old->calibration;
      file.mapping = old->mapping;
      file.measured = old->measured;
      file.gyro_bias_rad_s = old->gyro_bias_rad_s;
      file.measured_on = old->measured_on;
      return;
    }
    remarks.push_back(old.error().message + "; it is ignored");
  }
  file.calibration =
      find_calibration(files.calibration_folders, identity_of(info)).file.calibration;
}

std::vector<std::string> axes_questions(const GuidedPad& pad) {
  // Words for the directions, by RawDirection.
  constexpr const char* kRaw[] = {"right", "left", "forward", "back"};
  std::vector<std::string> questions;
  for (std::size_t i = 0; i < 2 && !pad.layout.override_origin.empty(); ++i) {
    const StickFrame& frame = pad.frame[i];
    if (frame == StickFrame{}) continue;
    questions.push_back(fmt::format(
        "this pad is known, but pushed right its {} stick went {} and pushed forward {}: is this "
        "right? if not, measure again and push where it is asked for",
        kSideNames[i], kRaw[static_cast<std::size_t>(frame.right)],
        kRaw[static_cast<std::size_t>(frame.forward)]));
  }
  return questions;
}

std::vector<std::string> calibration_comments(const PadAnalysis& analysis) {
  std::vector<std::string> comments = {
      "Made by gaitpad calibrate; config/README.md says what the "
      "keys mean. Edit it as you like."};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!analysis.stick[i]) continue;
    comments.push_back(fmt::format("{} stick: {}. {}{}", kSideNames[i],
                                   name_of(analysis.stick[i]->advice.verdict),
                                   analysis.stick[i]->advice.reason,
                                   is_known(analysis, i) ? "" : "; its calibration is kept"));
  }
  return comments;
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  return fmt::format("{:%Y-%m-%d}", fmt::localtime(now));
}

}  // namespace gaitpad
