// Assertions 6 and 29: the same motion on other legs.
#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"
#include "paper/planted.h"

namespace gaitpad {
namespace {

constexpr std::array<double, 3> kRatios = {0.6, 1.0, 1.6};

double greatest(const FlightCurve& curve) { return *std::ranges::max_element(curve.value); }

Walk walk_on(const WalkModel& model, IkMode mode) {
  WalkCase what;
  what.model = &model;
  what.ik = mode;
  what.end_s = 7.0;
  return walked(what);
}

// The source's frames on the character's bones, the root where the file has it times `root_scale`:
// toe positions over a stride.
std::vector<vec3> raw_toes(const GaitCycle& source, const GaitCycle& build, Side side,
                           double root_scale, int samples) {
  std::vector<vec3> track;
  Pose pose;
  JointFrames frames;
  for (int i = 0; i < samples; ++i) {
    const double own = static_cast<double>(i) / samples;
    sample_local(source, own + source.strike[side], pose);
    pose.root_m = sample_at(source, own + source.strike[side]).pelvis_m;
    pose.root_m.z += own * source.stride_m;
    pose.root_m.z *= root_scale;
    forward_kinematics(build.skeleton, pose, frames);
    track.push_back(frames.position_m[build.leg[side].joints.toe]);
  }
  return track;
}

// While the source's own toe stands (slower than 15 % of its greatest speed), how far the played
// one goes.
double raw_slide_mm(const GaitCycle& source, const GaitCycle& build, double root_scale) {
  constexpr int kSamples = 256;
  constexpr double kStands = 0.15;
  double most = 0.0;
  for (const Side side : {kLeftSide, kRightSide}) {
    const auto own = raw_toes(source, source, side, 1.0, kSamples),
               played = raw_toes(source, build, side, root_scale, kSamples);
    double fastest = 0.0;
    const auto speed = [&own](std::size_t i) { return std::fabs(own[i].z - own[i - 1].z); };
    for (std::size_t i = 1; i < own.size(); ++i) fastest = std::max(fastest, speed(i));
    std::size_t begin = 0;
    for (std::size_t i = 1; i < own.size(); ++i) {
      if (speed(i) > kStands * fastest) begin = i + 1;
      if (begin < i) most = std::max(most, std::fabs(played[i].z - played[begin].z));
    }
  }
  return 1e3 * most;
}

}  // namespace

std::vector<Claim> scaling_claims(const Study& study) {
  ClaimList list("3.2", IkMode::robust);
  const GaitLimits own = gait_limits(study.model().leg_length_m);
  double peak = 0.0, stride = 0.0, walked_step = 0.0, ends = 0.0, outside = 0.0;
  for (const double ratio : kRatios) {
    const auto model = study.model_with_legs(ratio);
    if (!model) continue;
    for (const Side side : {kLeftSide, kRightSide}) {
      const FlightCurve &mine = model->leg[side].flight.height_m,
                        &source = study.model().leg[side].flight.height_m;
      peak = std::max(peak, std::fabs(greatest(mine) / greatest(source) / ratio - 1.0));
      for (const double h : source.value) {
        outside = std::max({outside, -h, h / greatest(source) - 1.0});
      }
      ends = std::max(ends, source.value.back() / greatest(source));
    }
    stride = std::max(
        stride,
        std::fabs(gait_limits(model->leg_length_m).max_step_m / own.max_step_m / ratio - 1));
    const Walk walk = walk_on(*model, IkMode::robust);
    const double step = walk.samples.back().frame.stride_m[kRightSide];
    walked_step = std::max(walked_step,
                           std::fabs(step / own.max_step_m / std::sqrt(kPaperStick) / ratio - 1.0));
  }
  list.add("6 flight's peak over the legs' ratio off 1, %", 100.0 * peak, at_most(0.1),
           "legs x 0.6, 1, 1.6");
  list.add("6 longest step over the legs' ratio off 1, %", 100.0 * stride, at_most(0.1));
  list.add("6 walked step over the legs' ratio off 1, %", 100.0 * walked_step, at_most(0.1));
  list.add("6 normalised height outside 0 .. 1 by", outside, at_most(0.0));
  list.add("6 normalised height at the landing", ends, at_most(0.1),
           "the flight begins at the toe's lift, with the heel at 60 to 80 % of its peak: what "
           "comes before belongs to the standing foot");
  return list.take();
}

std::vector<Claim> sliding_claims(const Study& study, IkMode mode) {
  ClaimList list("1 and 5", mode);
  double ours = 0.0, raw = 1e9;
  std::string text;
  for (const double ratio : kRatios) {
    const auto model = study.model_with_legs(ratio);
    if (!model) continue;
    ours = std::max(ours, planted_slide_mm(walk_on(*model, mode)));
    if (ratio == 1.0) continue;
    const GaitCycle& source = study.source().cycle;
    const double slide = raw_slide_mm(source, model->cycle, 1.0);
    text += fmt::format("{}legs x {}: {:.0f} mm, with the root's way scaled too {:.0f} mm",
                        text.empty() ? "" : "; ", ratio, slide,
                        raw_slide_mm(source, model->cycle, ratio));
    raw = std::min(raw, slide);
  }
  list.add("29 planted feet slide on legs x 0.6 to 1.6 by, mm", ours, at_most(0.1));
  if (mode == IkMode::robust) {
    list.add("29 feet slide when the same angles are played, mm", raw, more_than(20.0), text);
  }
  return list.take();
}

}  // namespace gaitpad
