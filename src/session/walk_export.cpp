#include "session/walk_export.h"

#include <utility>

#include "session/frames_csv.h"

namespace gaitpad {
namespace {

BvhLayout layout_of(const WalkModel& model, int fps) {
  const GaitCycle& cycle = model.cycle;
  BvhLayout layout;
  layout.metres_per_unit = cycle.metres_per_unit;
  layout.frame_time_s = 1.0 / fps;
  for (const LegBuild& leg : model.leg) {
    const int toe = leg.model.joints.toe;
    if (cycle.skeleton.joints[toe].is_end_site) layout.end_sites_as_joints.push_back(toe);
  }
  layout.orders = euler_orders(cycle.skeleton, cycle.local);
  return layout;
}

// Bound as it stands, at the origin.
GltfLayout gltf_layout(const Walker& walker, int fps) {
  const WalkModel& model = *walker.model;
  return {.name = walker.model->cycle.name,
          .fps = static_cast<double>(fps),
          .rest_local = model.cycle.standing_local,
          .rest_root_m = vec3(0.0, model.stand_m, 0.0)};
}

// Tick t is shown where a frame's time j / fps falls into (t - 1, t] ticks; the first frame is tick
// 0.
bool is_shown(std::int64_t tick, int rate_hz, int fps) {
  const auto frames_until = [=](std::int64_t t) { return (t * fps + rate_hz) / rate_hz; };
  return tick == 0 || frames_until(tick) != frames_until(tick - 1);
}

// The heel point in the ankle joint's own frame, as the files have it.
nlohmann::ordered_json heel_offset(const LegModel& leg) {
  const vec3 heel_m = glm::conjugate(leg.standing[2]) * leg.heel_m;
  return {heel_m.x, heel_m.y, heel_m.z};
}

}  // namespace

std::string numbered_name(const std::string& stem, const std::string& extension,
                          std::size_t walker) {
  if (walker == 0) return stem + extension;
  return fmt::format("{}-{}{}", stem, walker + 1, extension);
}

Result<WalkExport> WalkExport::open(OutputFiles& files, const Walker& walker, std::size_t index,
                                    const ExportFormat& format) {
  WalkExport e(walker, format);
  auto poses = files.add(numbered_name("pose", ".bvh", index));
  if (!poses) return poses.error();
  auto frames = files.add(numbered_name("frames", ".csv", index));
  if (!frames) return frames.error();
  auto summary = files.add(numbered_name("summary", ".json", index));
  if (!summary) return summary.error();
  e.frames_ = *frames;
  e.summary_ = *summary;
  e.poses_ = std::make_unique<BvhWriter>(**poses, walker.model->cycle.skeleton,
                                         layout_of(*walker.model, format.fps));
  if (format.with_gltf) {
    auto out = files.add(numbered_name("pose", ".glb", index));
    if (!out) return out.error();
    auto scratch = files.scratch();
    if (!scratch) return scratch.error();
    e.gltf_ = std::make_unique<GltfWriter>(**out, std::move(*scratch), walker.model->cycle.skeleton,
                                           gltf_layout(walker, format.fps));
  }
  append_frames_header(e.row_);
  return e;
}

void WalkExport::write(std::int64_t tick, const Stick& stick) {
  append_frames_row(tick, format_.rate_hz, stick, walker_->state.frame, row_);
  frames_->write(row_.data(), static_cast<std::streamsize>(row_.size()));
  row_.clear();
  if (!is_shown(tick, format_.rate_hz, format_.fps)) return;
  poses_->write(walker_->pose);
  if (gltf_) gltf_->write(walker_->pose);
}

std::optional<Error> WalkExport::finish(const nlohmann::ordered_json& summary) {
  frames_->write(row_.data(),
                 static_cast<std::streamsize>(row_.size()));  // header of an empty walk
  row_.clear();
  poses_->finish();
  *summary_ << summary.dump(2) << '\n';
  if (!gltf_) return std::nullopt;
  const auto problem = gltf_->finish();
  return problem ? std::optional(Error{"pose.glb: " + *problem}) : std::nullopt;
}

nlohmann::ordered_json walker_summary(const Walker& walker) {
  const WalkModel& model = *walker.model;
  const auto& joints = model.cycle.skeleton.joints;
  const LegModel& left = model.leg[kLeftSide].model;
  const LegModel& right = model.leg[kRightSide].model;
  nlohmann::ordered_json s;
  s["motion"] = model.cycle.name;
  s["metres_per_unit"] = model.cycle.metres_per_unit;
  s["leg_length_m"] = model.leg_length_m;
  s["source_leg_length_m"] = model.source_leg_length_m;
  s["left_toe_joint"] = joints[left.joints.toe].name;
  s["right_toe_joint"] = joints[right.joints.toe].name;
  s["left_ankle_joint"] = joints[left.joints.ankle].name;
  s["right_ankle_joint"] = joints[right.joints.ankle].name;
  s["left_heel_offset_m"] = heel_offset(left);
  s["right_heel_offset_m"] = heel_offset(right);
  s["left_toe_rest_m"] = left.toe_rest_m;
  s["right_toe_rest_m"] = right.toe_rest_m;
  s["steps_left"] = walker.state.frame.steps[kLeftSide];
  s["steps_right"] = walker.state.frame.steps[kRightSide];
  return s;
}

}  // namespace gaitpad
