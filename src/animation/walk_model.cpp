#include "animation/walk_model.h"

#include <fmt/format.h>

namespace gaitpad {
namespace {

// Joint limits of a walker in radians (hip flexion and dorsiflexion are negative): AAOS-type
// ranges, dorsiflexion under load up to 38 degrees.
constexpr std::array<double, kLegDofs> kMin = {-120, -50, -70, 1.0, -60, -60, -80};
constexpr std::array<double, kLegDofs> kMax = {60, 50, 70, 150, 75, 60, 80};
constexpr double kHeelDown = 0.007;   // of the leg: a heel this low has landed
constexpr double kLatestDown = 0.05;  // own phase
constexpr double kHalfWidth = 0.054;  // of the leg: half a foot's breadth, 9 cm of an adult's
constexpr double kOscillation = 0.8;  // share of the fore-aft oscillation, which FK exaggerates

IkChain leg_chain(const LegModel& leg) {
  constexpr std::array<vec3, kLegDofs> kAxis = {vec3(1, 0, 0), vec3(0, 0, 1), vec3(0, 1, 0),
                                                vec3(1, 0, 0), vec3(1, 0, 0), vec3(0, 0, 1),
                                                vec3(0, 1, 0)};
  IkChain chain;
  chain.dofs = kLegDofs;
  for (int j = 0; j < kLegDofs; ++j) {
    chain.dof[j].axis = kAxis[j];
    chain.dof[j].min_rad = kMin[j] * kDegree;
    chain.dof[j].max_rad = kMax[j] * kDegree;
  }
  chain.dof[kHipY].link_m = vec3(0.0, -leg.thigh_m, 0.0);
  chain.dof[kKneeX].link_m = vec3(0.0, -leg.shank_m, 0.0);
  return chain;
}

double elevation(const vec3& v) { return atan2(v.y, std::sqrt(v.x * v.x + v.z * v.z)); }

bool below(const Skeleton& skeleton, int joint, int ancestor) {
  while (joint >= 0 && joint != ancestor) joint = skeleton.joints[joint].parent;
  return joint == ancestor;
}

// Bones below the hips grow by scale * leg_ratio, all others by scale.
void scale_build(GaitCycle& cycle, double scale, double leg_ratio) {
  for (std::size_t j = 0; j < cycle.skeleton.joints.size(); ++j) {
    Joint& joint = cycle.skeleton.joints[j];
    bool in_leg = false;
    for (const LegModel& leg : cycle.leg) {
      in_leg = in_leg || (static_cast<int>(j) != leg.joints.hip &&
                          below(cycle.skeleton, static_cast<int>(j), leg.joints.hip));
    }
    joint.offset_m *= in_leg ? scale * leg_ratio : scale;
  }
  const double k = scale * leg_ratio;
  for (LegModel& leg : cycle.leg) {
    leg.hip_m *= scale;
    leg.thigh_m *= k;
    leg.shank_m *= k;
    leg.heel_m *= k;
    leg.toe_m *= k;
    leg.toe_end_m *= k;
    leg.toe_rest_m *= k;
    leg.toe_end_rest_m *= k;
  }
}

LegBuild leg_build(const LegModel& model) {
  LegBuild leg;
  leg.model = model;
  leg.chain = leg_chain(model);
  const vec3 line = model.toe_m - model.heel_m;
  leg.foot_m = glm::length(line);
  leg.elevation_rad = elevation(line);
  leg.forward = glm::normalize(vec3(line.x, 0.0, line.z));
  leg.side = glm::cross(kUp, leg.forward);
  leg.ball_m = vec3(model.toe_m.x, model.heel_m.y, model.toe_m.z);
  leg.tip_m = leg.ball_m + vec3(model.toe_end_m.x, 0.0, model.toe_end_m.z);
  leg.half_width_m = kHalfWidth * model.length_m();
  return leg;
}

// A heel or toe of the source in its travel frame.
vec3 foot_point(const CycleSample& sample, Side side, const vec3& point_m) {
  const LegSample& leg = sample.leg[side];
  return leg.ankle_m + leg.foot * point_m;
}

// Where a heel stands, from the pelvis' path, mean over the flat part of support.
vec3 mean_heel(const GaitCycle& source, Side side) {
  vec3 sum(0.0);
  constexpr int kCount = 16;
  for (int i = 0; i < kCount; ++i) {
    const double own = 0.12 + 0.2 * i / kCount;
    vec3 heel =
        foot_point(sample_at(source, own + source.strike[side]), side, source.leg[side].heel_m);
    heel.z += source.stride_m * own;
    sum += heel / static_cast<double>(kCount);
  }
  return sum;
}

void fill_foot_tables(const GaitCycle& source, double ratio, Side side, LegBuild& leg) {
  const LegModel& build = source.leg[side];
  const vec3 line = build.toe_m - build.heel_m;
  const double rest = elevation(line);
  for (int i = 0; i < kCycleSamples; ++i) {
    const double own = static_cast<double>(i) / kCycleSamples;
    const CycleSample sample = sample_at(source, own + source.strike[side]);
    leg.pitch_rad.value[i] = rest - elevation(sample.leg[side].foot * line);
  }
  const double lift = source.toe_off[side] - source.strike[side];
  leg.toe_off = lift - std::floor(lift);
  const double flight = 1.0 - leg.toe_off;
  const auto heel_at = [&](double u) {  // with the travel since the lift
    const double own = leg.toe_off + u * flight;
    vec3 p = foot_point(sample_at(source, own + source.strike[side]), side, build.heel_m);
    p.z += source.stride_m * u * flight;
    return p;
  };
  const double start = heel_at(0.0).z, travel = heel_at(1.0).z - start;
  const double floor = mean_heel(source, side).y;  // the capture's, under this foot
  for (int i = 0; i < kFlightSamples; ++i) {
    const double u = static_cast<double>(i) / (kFlightSamples - 1);
    const vec3 heel = heel_at(u);
    leg.flight.progress.value[i] = (heel.z - start) / travel;
    leg.flight.height_m.value[i] = std::max(0.0, heel.y - floor) * ratio;
  }
}

void fill_pelvis_tables(const GaitCycle& source, double ratio, WalkModel& model) {
  double mean = 0.0;
  for (const CycleSample& sample : source.samples) mean += sample.pelvis_m.y / kCycleSamples;
  for (int i = 0; i < kCycleSamples; ++i) {
    const CycleSample& sample = source.samples[i];
    model.sway_m.value[i] = sample.pelvis_m.x * ratio;
    model.bounce_m.value[i] = (sample.pelvis_m.y - mean) * ratio;
    model.surge_m.value[i] = sample.pelvis_m.z * ratio * kOscillation;
    const double yaw = heading_of(sample.pelvis * kForward);
    model.yaw_rad.value[i] = yaw;
    const vec3 tilt = rotation_vector(rotation_y(-yaw) * sample.pelvis);
    for (int a = 0; a < 3; ++a) model.tilt[a].value[i] = tilt[a];
    for (int side = 0; side < 2; ++side) {
      for (int j = 0; j < kLegDofs; ++j) {
        model.reference_rad[side][j].value[i] = sample.leg[side].angles[j];
      }
    }
  }
}

// At a strike the front heel is alpha of the step before the hips (mean over both feet). The heel
// of the data still sinks and slides for a moment when it strikes; ours stands at once. So the
// distance is that of the flat foot, run back to the moment when the heel of the data is down.
double front_share(const GaitCycle& source, double source_step) {
  const double down_m = kHeelDown * 0.5 * (source.leg[0].length_m() + source.leg[1].length_m());
  double sum = 0.0;
  for (Side side : {kLeftSide, kRightSide}) {
    const auto heel_at = [&](double own) {
      return foot_point(sample_at(source, own + source.strike[side]), side,
                        source.leg[side].heel_m);
    };
    const vec3 flat = mean_heel(source, side);
    double down = 0.0;
    while (down < kLatestDown && heel_at(down).y - flat.y > down_m)
      down += 1.0 / (2 * kCycleSamples);
    sum += flat.z - source.stride_m * down;
  }
  return std::clamp(0.5 * sum / source_step, 0.3, 0.7);
}

void fill_shares(const GaitCycle& source, WalkModel& model) {
  const double left_off = source.toe_off[kLeftSide], left_strike = source.strike[kLeftSide],
               right_off = source.toe_off[kRightSide];
  model.share = {left_off, left_strike - left_off, right_off - left_strike, 1.0 - right_off};
}

void collect_kept_joints(WalkModel& model) {
  const Skeleton& skeleton = model.cycle.skeleton;
  for (const LegModel& leg : model.cycle.leg) {
    for (int j = skeleton.joints[leg.joints.toe].parent; j > model.cycle.pelvis;
         j = skeleton.joints[j].parent) {
      if (j != leg.joints.hip && j != leg.joints.knee && j != leg.joints.ankle)
        model.kept.push_back(j);
    }
  }
}

// The pose is written without a heap: what stands between two joints of a leg is bounded here.
bool has_overlong_leg(const GaitCycle& cycle) {
  for (const LegModel& leg : cycle.leg) {
    const std::array<int, 5> chain = {cycle.pelvis, leg.joints.hip, leg.joints.knee,
                                      leg.joints.ankle, leg.joints.toe};
    for (std::size_t i = 1; i < chain.size(); ++i) {
      int between = 0;
      for (int j = cycle.skeleton.joints[chain[i]].parent; j > chain[i - 1] && j >= 0;
           j = cycle.skeleton.joints[j].parent) {
        ++between;
      }
      if (between > kMaxBetween) return true;
    }
  }
  return false;
}

}  // namespace

Result<WalkModel> walk_model(const GaitCycle& cycle, const Character& character) {
  if (!character.skeleton.empty()) {
    return Error{fmt::format("{}: a character with a skeleton of its own is not supported yet",
                             character.name)};
  }
  if (has_overlong_leg(cycle)) {
    return Error{
        fmt::format("{}: a leg has more than {} joints between two of hip, knee, ankle and toe",
                    cycle.name, kMaxBetween)};
  }
  WalkModel model;
  model.cycle = cycle;
  const double ratio = character.scale * character.leg_ratio;
  scale_build(model.cycle, character.scale, character.leg_ratio);
  model.source_leg_length_m = 0.5 * (cycle.leg[0].length_m() + cycle.leg[1].length_m());
  model.leg_length_m = model.source_leg_length_m * ratio;
  model.size = model.leg_length_m / kReferenceLeg_m;
  model.time_scale = std::sqrt(std::sqrt(model.size));  // as step times scale
  for (Side side : {kLeftSide, kRightSide}) {
    model.leg[side] = leg_build(model.cycle.leg[side]);
    fill_foot_tables(cycle, ratio, side, model.leg[side]);
    model.leg[side].track_m = mean_heel(cycle, side).x * character.scale;
  }
  fill_pelvis_tables(cycle, ratio, model);
  fill_shares(cycle, model);
  const double source_step = 0.5 * cycle.stride_m;
  model.step_front = front_share(cycle, source_step);
  model.source_step_m = source_step * ratio;
  for (const LegBuild& leg : model.leg) {
    model.rest_lead_m += 0.5 * (-leg.model.heel_m.z - leg.model.hip_m.z);
    model.stand_m += 0.5 * (0.998 * leg.model.length_m() - leg.model.heel_m.y - leg.model.hip_m.y);
  }
  collect_kept_joints(model);
  model.body = body_model(model.cycle, ratio, model.stand_m);
  return model;
}

double terrain_scale(const Terrain& terrain, const WalkModel& model) noexcept {
  constexpr double kSpare_m = 0.02;  // at the reference leg
  const double tread_m = least_tread_m(terrain);
  double scale = 1.0;
  for (const LegBuild& leg : model.leg) {
    const vec3 sole = leg.tip_m - leg.model.heel_m;
    const double needed_m = glm::length(vec2(sole.x, sole.z)) + kSpare_m * model.size;
    if (needed_m <= tread_m) continue;
    scale = std::max({scale, model.leg_length_m / kReferenceLeg_m, needed_m / tread_m});
  }
  return scale;
}

}  // namespace gaitpad
