#include "walk/tables.h"

#include <algorithm>
#include <cmath>

#include "gaitpad/curve.h"
#include "motion/leg_pose.h"
#include "motion/stencil.h"
#include "walk/steer.h"

namespace gaitpad {
namespace {

std::array<float, 3> floats(const vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}
template <std::size_t kCount>
std::array<float, kCount> floats(const std::array<double, kCount>& numbers) {
  std::array<float, kCount> to;
  std::transform(numbers.begin(), numbers.end(), to.begin(),
                 [](double number) { return static_cast<float>(number); });
  return to;
}
std::array<float, 4> wxyz(const quat& q) {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
          static_cast<float>(q.z)};
}
std::array<float, 4> xyzw(const quat& q) {
  return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
          static_cast<float>(q.w)};
}

// Knot k stands in row k + 1; rows wrap round.
constexpr int knot_of_row(int row) { return (row + kKnots - 1) % kKnots; }

std::array<double, kRowNumbers> numbers_of(const StridePlace& place) {
  const StrideCell& cell = place.cell;
  std::array<double, kRowNumbers> all{};
  double* to = all.data();
  const auto add = [&to](std::initializer_list<double> numbers) {
    to = std::copy(numbers.begin(), numbers.end(), to);
  };
  for (const StrideFoot& foot : cell.foot) add({foot.heel_m.x, foot.heel_m.y, foot.heel_m.z});
  for (const StrideFoot& foot : cell.foot) add({foot.pitch_rad});
  for (const StrideFoot& foot : cell.foot) add({foot.twist_rad, foot.roll_rad});
  add({cell.pelvis_m.x, cell.pelvis_m.y, cell.pelvis_m.z, cell.pelvis_yaw_rad, cell.pelvis_tilt.x,
       cell.pelvis_tilt.y, cell.pelvis_tilt.z});
  for (const auto& leg : cell.leg_rad) to = std::copy(leg.begin(), leg.end(), to);
  add({place.track.low_m, place.track.high_m});
  return all;
}

// The strides of each ratio at each knot.
template <std::size_t kOf>
using Places = std::vector<std::array<StridePlace, kOf>>;
template <std::size_t kOf>
Places<kOf> places_of(const WalkModel& model, bool backward) {
  Places<kOf> places(kKnots);
  for (int k = 0; k < kKnots; ++k)
    for (std::size_t r = 0; r < kOf; ++r)
      places[k][r] =
          stride_of(model, backward, double(k) / kKnots, kRatioStep * static_cast<double>(r));
  return places;
}

void fill_harmonics(const Places<kStrideRatios>& places, BuildTables& tables) {
  tables.leg_harmonics = {};
  for (int k = 0; k < kKnots; ++k) {
    for (int n = 0; n < 1 + 2 * kHarmonics; ++n) {
      const SinCos turn = gaitpad::sin_cos(2.0 * kPi * ((n + 1) / 2) * k / kKnots);
      const double of = (n == 0 ? 1.0 : n % 2 == 1 ? 2.0 * turn.cos : 2.0 * turn.sin) / kKnots;
      for (int r = 0; r < kStrideRatios; ++r)
        for (int side : {0, 1})
          for (int j = 0; j < kLegAngles; ++j)
            tables.leg_harmonics[r][side][j][n] +=
                static_cast<float>(of * places[k][r].cell.leg_rad[side][j]);
    }
  }
}

template <std::size_t kOf>
void fill_strides(const Places<kOf>& places, RowsOf<kOf>& rows) {
  for (std::size_t r = 0; r < kOf; ++r) {
    std::array<std::array<double, kKnots>, kRowNumbers> sample;
    for (int k = 0; k < kKnots; ++k) {
      const std::array<double, kRowNumbers> numbers = numbers_of(places[k][r]);
      for (int n = 0; n < kRowNumbers; ++n) sample[n][k] = numbers[n];
    }
    for (int n = 0; n < kRowNumbers; ++n) {
      const auto knots = spline_through(sample[n]);
      for (int row = 0; row < kKnots + 3; ++row)
        reinterpret_cast<float*>(&rows[row][r])[n] = static_cast<float>(knots[knot_of_row(row)]);
    }
  }
}
// `most_ratio`: the largest ratio of the tables.
void fill_footprints(const WalkModel& model, bool backward, std::size_t ratios,
                     FootprintLines& lines, float& most_ratio) {
  const double most = kRatioStep * static_cast<double>(ratios - 1);
  const Footprints zero = stride_of(model, backward, 0.0, 0.0).track,
                   last = stride_of(model, backward, 0.0, most).track;
  for (int side : {0, 1}) {
    lines.at_zero_m[side] = floats(zero.footprint_m[side]);
    lines.per_ratio_m[side] = floats((last.footprint_m[side] - zero.footprint_m[side]) / most);
  }
  lines.stride_at_zero_m = static_cast<float>(zero.stride_m);
  lines.stride_per_ratio_m = static_cast<float>((last.stride_m - zero.stride_m) / most);
  most_ratio = static_cast<float>(most);
}

void fill_legs(const WalkModel& model, BuildTables& tables) {
  tables.legs_are_plain = true;
  for (int side : {0, 1}) {
    const LegBuild& from = model.leg[side];
    LegBones& to = tables.leg[side];
    tables.chain[side] = from.chain;
    to.hip_m = floats(from.model.hip_m);
    to.heel_m = floats(from.model.heel_m);
    to.toe_m = floats(from.model.toe_m);
    to.forward = floats(from.forward);
    to.side = floats(from.side);
    to.ball_m = floats(from.ball_m);
    to.tip_m = floats(from.tip_m);
    to.thigh_m = static_cast<float>(from.model.thigh_m);
    to.shank_m = static_cast<float>(from.model.shank_m);
    const vec3 line = from.model.toe_m - from.model.heel_m;
    to.elevation_rad = static_cast<float>(gaitpad::atan2(line.y, horizontal_length(line)));
    to.foot_m = static_cast<float>(glm::length(line));
    to.toe_rest_m = static_cast<float>(from.model.toe_rest_m);
    to.half_width_m = static_cast<float>(kHalfFoot * from.model.length_m());
    to.track_m = static_cast<float>(from.track_m);
    const double below_hip_m = from.model.hip_m.x + from.model.heel_m.x;
    to.stance_m = static_cast<float>(std::abs(below_hip_m) > std::abs(from.track_m) ? below_hip_m
                                                                                    : from.track_m);
    to.own_step_m = static_cast<float>(model.own_step_m[side]);
    to.stand_rad = floats(model.stand_rad[side]);
    for (int j = 0; j < 4; ++j) {
      to.joint[j] = from.joint[j].joint;
      to.before[j] = wxyz(from.joint[j].before);
      to.after[j] = wxyz(from.joint[j].after);
      tables.legs_are_plain &= to.before[j] == wxyz(kIdentity) && to.after[j] == wxyz(kIdentity);
    }
  }
}

// UpperJoint::swings of a joint.
int swing_of(const WalkModel& model, int joint) {
  for (int side : {0, 1}) {
    const ArmBuild& arm = model.body.arm[side];
    if (!arm.is_there) continue;
    if (joint == arm.joints.shoulder) return 1 + 2 * side;
    if (joint == arm.joints.elbow) return 2 + 2 * side;
  }
  return 0;
}

// The offset of a joint; 0 for a root, whose place is in the pose.
std::array<float, 3> offset_of(const std::vector<Joint>& joints, int joint) {
  return joint == 0 ? std::array<float, 3>{} : floats(joints[joint].offset_m);
}
// The part of a path from the root that hangs from the pelvis; the whole path if it does not.
std::span<const int> below_pelvis(const WalkModel& model, const std::vector<int>& path) {
  const auto pelvis = std::find(path.begin(), path.end(), model.cycle.pelvis);
  return pelvis == path.end() ? std::span(path) : std::span(pelvis + 1, path.end());
}
// The index in the trunk's path of a joint; -1: it is beside the path.
int index_on_path(const BuildTables& tables, int joint) {
  const auto at = std::find_if(tables.path.begin(), tables.path.end(),
                               [&](const PathJoint& p) { return p.joint == joint; });
  return at == tables.path.end() ? -1 : static_cast<int>(at - tables.path.begin());
}
// The spine's joints share the turn of the chest equally. Neck and head share the rest of the
// head's turn.
void fill_path(const WalkModel& model, BuildTables& tables) {
  constexpr double kNeckShare = 0.45;  // of the head's turn beside the chest
  const UpperBodyModel& body = model.body;
  const std::vector<Joint>& all = model.cycle.skeleton.joints;
  tables.has_head = !body.head_path.empty();
  const std::vector<int>&spine = body.joints.spine,
        &from_root = tables.has_head ? body.head_path : body.spine_path;
  const std::span<const int> path = below_pelvis(model, from_root);
  const int joints = static_cast<int>(path.size()),
            above = static_cast<int>(from_root.size()) - joints;
  tables.on_pelvis = above > 0;
  tables.neck = tables.has_head ? body.neck_at - above : joints;
  const int necks = joints - 1 - tables.neck;
  for (int i = 0; i < joints; ++i) {
    const bool bends = std::find(spine.begin(), spine.end(), path[i]) != spine.end();
    const float share = bends ? 1.0f / static_cast<float>(spine.size()) : 0.0f;
    PathJoint to{path[i], -1, share, 0.0f, share, 0.0f, offset_of(all, path[i])};
    if (i >= tables.neck) {
      to.of_head = static_cast<float>(i < joints - 1 ? kNeckShare / necks
                                      : necks > 0    ? 1.0 - kNeckShare
                                                     : 1.0);
      to.of_chest -= to.of_head;
      to.of_look =
          static_cast<float>(i == joints - 1 ? 1.0 : kNeckShare * (i - tables.neck + 1) / necks);
    }
    tables.path.push_back(to);
  }
  tables.chest_standing = wxyz(body.chest_standing);
  tables.head_standing = wxyz(body.head_standing);
  for (const SpineJoint& joint : body.spine) {
    const int at = index_on_path(tables, joint.joint);
    if (at >= 0)
      tables.spine.push_back({at, wxyz(joint.standing), static_cast<float>(joint.upper)});
  }
  if (tables.spine.size() < 2) tables.spine.clear();
  tables.spine_base = wxyz(body.spine_base);
  tables.neck_m = floats(body.neck_m);
}

void fill_arms(const WalkModel& model, BuildTables& tables) {
  const UpperBodyModel& body = model.body;
  const std::vector<Joint>& all = model.cycle.skeleton.joints;
  for (int side : {0, 1}) {
    const ArmBuild& from = body.arm[side];
    ArmBones& arm = tables.arm[side];
    if (!from.is_there) continue;
    for (const int joint : below_pelvis(model, from.path)) {
      if (joint == from.joints.shoulder) arm.shoulder = static_cast<int>(arm.path.size());
      if (joint == from.joints.elbow) arm.elbow = static_cast<int>(arm.path.size());
      arm.path.push_back({joint, offset_of(all, joint)});
    }
    arm.on_trunk = 0;
    while (arm.on_trunk < static_cast<int>(std::min(arm.path.size(), tables.path.size())) &&
           arm.path[arm.on_trunk].joint == tables.path[arm.on_trunk].joint)
      ++arm.on_trunk;
    arm.turns_wrist = !all[from.joints.wrist].is_end_site;
    arm.hanging = wxyz(from.hanging);
    arm.chest = wxyz(from.chest);
    arm.grip_m = floats(from.grip_m);
    arm.min_rad = floats(from.min_rad);
    arm.max_rad = floats(from.max_rad);
    arm.middle_rad = floats(from.middle_rad);
  }
  tables.arm_m = static_cast<float>(body.arm_m);
  tables.shoulder_height_m = static_cast<float>(body.shoulder_height_m);
  tables.plain_body = floats(body_numbers(UpperBodyParams{}));
}

// The pelvis, and the joints between it and the root.
void fill_root(const WalkModel& model, BuildTables& tables) {
  const std::vector<Joint>& all = model.cycle.skeleton.joints;
  const int pelvis = model.cycle.pelvis;
  for (const int j : path_below(model.cycle.skeleton, -1, all[pelvis].parent))
    tables.above_pelvis.push_back({j, floats(all[j].offset_m)});
  tables.pelvis = pelvis;
  tables.pelvis_offset_m = floats(all[pelvis].offset_m);
  tables.pelvis_standing = wxyz(model.cycle.pelvis_standing);
}

void fill_upper_body(const WalkModel& model, BuildTables& tables) {
  const GaitCycle& cycle = model.cycle;
  fill_path(model, tables);
  fill_arms(model, tables);
  fill_root(model, tables);
  std::vector<int> moved = model.moving;
  for (const int joint : model.still) {
    // A joint that keeps still in the data may turn if it is on the path or the root above the
    // pelvis.
    const bool turns = index_on_path(tables, joint) >= 0 || (joint == 0 && cycle.pelvis != 0);
    (turns ? moved : tables.still).push_back(joint);
  }
  const std::size_t joints = cycle.skeleton.joints.size(), count = moved.size();
  tables.upper_rows.resize((kKnots + 3) * count * 4);
  for (std::size_t i = 0; i < count; ++i) {
    const int joint = moved[i];
    UpperJoint to{joint, swing_of(model, joint), xyzw(cycle.standing_local[joint]), {}};
    const ArmBuild& arm = model.body.arm[to.swings > 2];
    const quat middle = to.swings % 2 == 1 ? arm.swing_shoulder : arm.swing_elbow;
    to.middle = xyzw(middle);
    std::array<std::array<double, kKnots>, 4> sample;
    quat last = to.swings ? middle : cycle.standing_local[joint];
    for (int k = 0; k < kKnots; ++k) {
      last = glm::normalize(nearer(cycle.local[k * joints + joint], last));
      sample[0][k] = last.x, sample[1][k] = last.y, sample[2][k] = last.z, sample[3][k] = last.w;
    }
    for (int n = 0; n < 4; ++n) {
      const auto knots = spline_through(sample[n]);
      for (int row = 0; row < kKnots + 3; ++row)
        tables.upper_rows[(row * count + i) * 4 + n] = static_cast<float>(knots[knot_of_row(row)]);
    }
    if (const int at = index_on_path(tables, joint); at >= 0)
      tables.path[at].upper = static_cast<int>(i);
    tables.upper.push_back(to);
  }
  for (int side : {0, 1})
    tables.most_elbow_swing[side] = static_cast<float>(model.body.arm[side].most_elbow_swing);
  for (const int j : model.kept) tables.kept.emplace_back(j, cycle.standing_local[j]);
  tables.joints = static_cast<int>(joints);
}

// Bounds of the angular acceleration of chest and head while a walk changes: multiples of that in
// the data at their own pace.
constexpr double kHarderChest = 1.7, kHarderHead = 1.9;
void fill_hardness(const WalkModel& model, BuildTables& tables) {
  const GaitCycle& cycle = model.cycle;
  const std::size_t joints = cycle.skeleton.joints.size();
  // Turns of chest and head by phase.
  std::array<std::array<quat, kKnots>, 2> turn;
  for (int k = 0; k < kKnots; ++k) {
    const StrideCell cell = stride_of(model, false, double(k) / kKnots, 1.0).cell;
    quat above = kIdentity;
    if (tables.on_pelvis)
      above = rotation_y(cell.pelvis_yaw_rad) *
              from_rotation_vector(cell.pelvis_tilt + vec3(0.0, 0.0, model.stand_roll_rad)) *
              cycle.pelvis_standing;
    turn[0][k] = turn[1][k] = above;
    for (int i = 0; i < static_cast<int>(tables.path.size()); ++i) {
      above = above * cycle.local[k * joints + tables.path[i].joint];
      (i < tables.neck ? turn[0][k] : turn[1][k]) = above;
    }
  }
  constexpr int kApart = 2;  // knots
  const double between_s = 2.0 * model.body.own_step_s * kApart / kKnots;
  std::array<double, 2> most{};
  for (int part : {0, 1}) {
    for (int k = 0; k < kKnots; ++k) {
      const quat &a = turn[part][k], &b = turn[part][(k + kApart) % kKnots],
                 &c = turn[part][(k + 2 * kApart) % kKnots];
      const vec3 bend =
          rotation_vector(c * glm::conjugate(b)) - rotation_vector(b * glm::conjugate(a));
      most[part] = std::max(most[part], glm::length(bend) / (between_s * between_s));
    }
  }
  tables.most_chest_s2 = static_cast<float>(kHarderChest * most[0]);
  tables.most_head_s2 = static_cast<float>(kHarderHead * most[1]);
}

// Time constants in seconds at the reference leg. Longer ones are felt as a delay behind the stick,
// shorter ones are seen as a jerk.
Filters filters_of(double time_scale, double tick_s) noexcept {
  const auto of = [&](double time_constant_s) {
    const Damping damping(time_constant_s * time_scale, tick_s);
    return Filter{static_cast<float>(damping.pull), static_cast<float>(damping.keep),
                  static_cast<float>(tick_s)};
  };
  Filters filters;
  filters.tick_s = static_cast<float>(tick_s);
  filters.step = of(0.12);
  filters.first_step = of(0.05);
  filters.turn_goal = of(0.02);
  filters.turn = of(0.10);
  filters.bounce = of(0.30);
  filters.lean = of(0.12);
  filters.posture = of(0.06);
  filters.chest = of(0.10);
  filters.head = of(0.071);
  filters.room = of(0.04);
  filters.ground = of(0.30);
  filters.slope_lean = of(0.30);
  filters.weights = of(0.15);
  filters.loosens = of(0.04);
  filters.lowers = of(0.03);
  filters.body = of(0.22);
  filters.speed = of(0.15);
  filters.push = of(0.04);
  filters.rail = of(kRailSmoothing_s);
  const double mean_s = 0.5 * time_scale;
  filters.turn_keep = filters.turn.keep;
  filters.mean_pull = static_cast<float>(tick_s / (mean_s + tick_s));
  return filters;
}

// The last filters that a thread asked for, because most walks have the same tick and size.
const Filters& kept_filters(double time_scale, double tick_s) noexcept {
  struct Kept {
    double time_scale, tick_s;
    Filters filters;
  };
  static thread_local Kept kept{};
  if (kept.time_scale != time_scale || kept.tick_s != tick_s)
    kept = {time_scale, tick_s, filters_of(time_scale, tick_s)};
  return kept.filters;
}

}  // namespace

std::shared_ptr<const BuildTables> build_tables(const WalkModel& model) {
  auto tables = std::make_shared<BuildTables>();
  const Places<kStrideRatios> places = places_of<kStrideRatios>(model, false);
  fill_strides(places, tables->forward);
  fill_harmonics(places, *tables);
  fill_strides(places_of<kBackRatios>(model, true), tables->back);
  fill_footprints(model, false, kStrideRatios, tables->footprints, tables->most_ratio);
  fill_footprints(model, true, kBackRatios, tables->back_footprints, tables->most_back_ratio);
  fill_legs(model, *tables);
  fill_upper_body(model, *tables);
  fill_hardness(model, *tables);
  tables->stage_share = floats(model.share);
  tables->size = static_cast<float>(model.size);
  tables->time_scale = static_cast<float>(model.time_scale);
  tables->stand_m = static_cast<float>(model.stand_m);
  tables->stand_roll_rad = static_cast<float>(model.stand_roll_rad);
  tables->rest_lead_m = static_cast<float>(model.rest_lead_m);
  tables->source_step_m = static_cast<float>(model.source_step_m);
  tables->own_step_s = static_cast<float>(model.body.own_step_s);
  tables->leg_m = static_cast<float>(model.leg_length_m);
  return tables;
}

Filters in_several_ticks(const Filters& one, float ticks) noexcept {
  constexpr int kFilters = sizeof(Smoothing) / sizeof(Filter);
  Filters several = one;
  if (ticks == 1.0f) return several;
  several.ticks = ticks;
  auto* const filter = reinterpret_cast<Filter*>(static_cast<Smoothing*>(&several));
  for (int k = 0; k < kFilters; ++k) {
    // As Damping: its pull times the tick is the square of w.
    Filter& of = filter[k];
    const float with = 1.0f + ticks * std::sqrt(of.pull * of.tick_s);
    of = {of.pull * ticks, 1.0f / (with * with), of.tick_s * ticks};
  }
  return several;
}

Tables tables_of(const WalkModel& model, double tick_s) noexcept {
  const BuildTables& of = *model.tables;
  return {of,      kept_filters(model.time_scale, tick_s),
          of,      of.leg,
          of.path, of.spine,
          of.arm,  is_flat(*model.terrain) ? nullptr : model.terrain.get()};
}

}  // namespace gaitpad
