#include "scene/crowd_bodies.h"

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

constexpr double kFull_m = 11.0;  // members that are nearer to the eye are drawn with all bones
constexpr Colour kPlain = {0.60, 0.61, 0.64};
// Share of grey in the crowd's colours, so that walkers stand out.
constexpr double kPlainShare = 0.45;
constexpr double kPaleCrowdShare = 0.30;
constexpr double kAroundFocus_m = 3.0;  // width of the floor that is drawn beyond the last member
// Shadows on the floor: below each foot, and where the light casts the body's shadow.
constexpr double kFootShade_m = 0.17, kBodyShade_m = 0.26, kHeadShade_m = 0.22;
constexpr double kShadeUp_m = 0.006;
// The shadow's offset on the floor per metre of the body's height.
const vec3 kThrown = vec3(-0.49, 0.0, -0.42);

// The colour of the style, brighter or darker by member, so that neighbours differ.
Colour colour_of(const Theme& theme, int style, std::size_t member) {
  const Colour tone =
      mixed(series_colour(theme, static_cast<std::size_t>(style)), kPlain, kPlainShare);
  const double light = 0.82 + 0.30 * static_cast<double>((member * 7919) % 101) / 100.0;
  return {std::min(tone.red * light, 1.0), std::min(tone.green * light, 1.0),
          std::min(tone.blue * light, 1.0), 1.0};
}

quat quat_of(const std::array<float, 4>& q) { return {q[3], q[0], q[1], q[2]}; }

double floor_m(const Terrain* terrain, const vec3& place_m) {
  return terrain == nullptr ? 0.0 : ground_at(*terrain, place_m.x, place_m.z).height_m;
}

}  // namespace

CrowdBodies::CrowdBodies(const Cast& cast) {
  for (const CrowdCastMember& member : cast.crowd) {
    auto known = std::ranges::find(full_, member.model, &Mannequin::model);
    if (known == full_.end()) {
      full_.push_back(mannequin_of(member.model));
      coarse_.push_back(mannequin_of(member.model, MannequinDetail::coarse));
      known = full_.end() - 1;
    }
    const int joints = static_cast<int>(member.model->cycle.skeleton.joints.size());
    members_.push_back({static_cast<int>(known - full_.begin()), member.style, joints});
    joints_ += static_cast<std::size_t>(joints);
  }
}

void CrowdBodies::fill(const FollowerPoses& poses, double share, const Theme& theme,
                       const Terrain* terrain, const vec3& focus_m, SceneContent& content) {
  content.crowd.clear();
  content.crowd_shades.clear();
  content.reach_m = 0.0;
  if (members_.empty() || poses.root_m.size() != members_.size() || poses.local.size() != joints_)
    return;
  const double t = std::clamp(share, 0.0, 1.0);
  content.crowd_origin_m = glm::round(vec3(focus_m.x, 0.0, focus_m.z));
  std::size_t first_joint = 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    const Member& member = members_[i];
    pose_.joint_count = member.joints;
    pose_.root_m = glm::mix(poses.root_before_m[i], poses.root_m[i], t);
    for (int j = 0; j < member.joints; ++j) {
      const std::size_t joint = first_joint + static_cast<std::size_t>(j);
      pose_.local[static_cast<std::size_t>(j)] =
          between(quat_of(poses.before[joint]), quat_of(poses.local[joint]), t);
    }
    first_joint += static_cast<std::size_t>(member.joints);
    const bool is_near = glm::distance(pose_.root_m, eye_m_) < kFull_m;
    const std::vector<Mannequin>& mannequins = is_near ? full_ : coarse_;
    add(mannequins[static_cast<std::size_t>(member.mannequin)], colour_of(theme, member.style, i),
        terrain, content);
    content.reach_m = std::max(content.reach_m,
                               std::hypot(pose_.root_m.x - focus_m.x, pose_.root_m.z - focus_m.z));
  }
  content.reach_m += kAroundFocus_m;
}

void CrowdBodies::add(const Mannequin& mannequin, const Colour& colour, const Terrain* terrain,
                      SceneContent& content) {
  const WalkModel& model = *mannequin.model;
  forward_kinematics(model.cycle.skeleton, pose_, frames_);
  const Colour pale = mixed(colour, {0.83, 0.84, 0.86, 1.0}, kPaleCrowdShare);
  const vec3& origin_m = content.crowd_origin_m;
  const vec3 below = vec3(pose_.root_m.x, floor_m(terrain, pose_.root_m), pose_.root_m.z);
  const auto ground_m = static_cast<float>(below.y - origin_m.y);
  for (const MannequinBone& bone : mannequin.bones) {
    const BonePlace place = place_of(bone, frames_);
    const vec3 a = place.from_m - origin_m, b = place.to_m - origin_m;
    // Trunk and upper limbs end inside other capsules.
    const double width = bone.is_pale ? bone.width_to : -bone.width_to;
    const Colour& paint = bone.is_pale ? pale : colour;
    content.crowd.push_back({row(a, bone.radius_from_m), row(b, bone.radius_to_m),
                             row(frames_.rotation[bone.from] * bone.wide, bone.width_from),
                             row(vec3(paint.red, paint.green, paint.blue), width), ground_m});
  }
  const auto on_floor = [&](vec3 place_m) {
    place_m.y = floor_m(terrain, place_m) + kShadeUp_m;
    return place_m - origin_m;
  };
  const auto shade = [&](const vec3& a, const vec3& b, double radius_a_m, double radius_b_m,
                         float dark) {
    content.crowd_shades.push_back({row(a, radius_a_m), row(b, radius_b_m), dark});
  };
  for (const LegBuild& leg : model.leg) {
    const vec3 heel = on_floor(frames_.position_m[leg.model.joints.ankle]);
    const vec3 toe = on_floor(frames_.position_m[leg.model.joints.toe]);
    shade(heel, toe, kFootShade_m, kFootShade_m, 0.45f);
  }
  const vec3 body = below + kUp * kShadeUp_m - origin_m;
  if (terrain != nullptr) {  // a long shadow would float over steps
    shade(body, body, kBodyShade_m, kBodyShade_m, 0.3f);
    return;
  }
  const vec3 head = body + kThrown * (1.9 * pose_.root_m.y);
  shade(body, head, kBodyShade_m, kHeadShade_m, 0.42f);
}

}  // namespace gaitpad
