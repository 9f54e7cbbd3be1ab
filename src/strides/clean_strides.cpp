#include "gaitpad/clean_strides.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <thread>

#include "motion/leg_pose.h"
#include "strides/solver_input.h"
#include "strides/stride_solver.h"

namespace gaitpad {
namespace {

constexpr int kDataTable = 5;  // index of the table of the data's stride
// Iterations of the first solve and of each later one. In most clips angles then are within 2e-2
// rad of the converged solution (the rest is mostly at nearly straight knees); more iterations make
// no walk smoother or closer to its data.
constexpr int kFirstSolve = 7, kNextSolve = 3;
// Iterations for strides longer than the data's, which stretch the legs.
constexpr int kLongSolve = 6;
// Iterations for backward strides, which change more from one to the next.
constexpr int kNextBack = 5;
// A start's change of the data grows by half as much as in the previous table. The full growth
// overshoots for short steps.
constexpr double kExtrapolation = 0.5;
// Least knee angles of strides. No knee gets straighter than its data by more than kStraighter:
// without it, hips that keep their speed stretch bent knees by up to 6 degrees.
constexpr double kLeastKnee = 2.0 * kDegree, kStraighter = 3.0 * kDegree;
// Backward strides: least knee angle (rad), factor on smoothness, weights of the data.
constexpr double kLeastKneeBack = 8.0 * kDegree, kSmootherBack = 10.0, kHipBack = 0.3,
                 kAnkleBack = 0.17;
// What it costs to miss the hips' forward speed, and what changes with it.
struct SpeedCost {
  double shorter, longer;  // shares in strides that are shorter, times their ratio, and longer
  double legs, pelvis;     // factors on the smoothness of the legs and, by the share, of the pelvis
  double weight;           // of the cost in the data's own stride
};
// Longer strides stretch the legs. With 1 in shorter strides, a step of cmu_12_01 that is resumed
// pushes by 10.5 m/s^2 in place of 7.7; with 1 in longer ones, starts of cmu_m21_walk at full stick
// push by 5.1 m/s^2 in place of 3.9. Legs with 1: second differences of quick walks grow by a
// tenth. Pelvis with 1: a knee follows the hips in a wave of a degree where a capture's feet slide.
constexpr SpeedCost kCapturedSpeed{0.14, 0.03, 1.5, 0.3, 1.0};
// Legs with 2.2: in the built-in walk with a stiff hip a toe joint jerks by 0.56 degrees a tick^2
// in place of 0.49. Pelvis with 1: its hips push harder on slopes. Weight 1: its knees lose 0.1
// degree.
constexpr SpeedCost kMadeSpeed{1.0, 1.0, 4.8, 2.0, 0.61};
// The published angles of the built-in walk would move its hips slowest at the strikes, by a
// quarter of their speed. People's swing as pendulums, fastest about the strikes: by kSurge of the
// mean speed, kEarly of a cycle before the middle of a strike. At 0 the landing leg is so straight
// that its knee jerks by 1 degree a tick^2. Its least knee: 2 lets it jerk by 0.85.
constexpr double kSurge = 0.115, kEarly = 0.066, kLeastMadeKnee = 3.07 * kDegree;
constexpr double kLeastStandingKnee = 5.0 * kDegree;  // least bend
// Share of the data's knee and ankle angles in steps of length 0: the foot still has to leave the
// floor.
constexpr double kLeastLift = 0.3;
// Share of the cycle for which a foot stands flat after its roll.
constexpr double kFlatPhase = 0.2;

// The cycle run backwards in time: a lift becomes a strike. Phase 0 is the right foot's lift in the
// data; the stages keep the cycle's shares.
GaitCycle run_back(const GaitCycle& cycle) {
  GaitCycle back;
  back.name = cycle.name;
  back.leg = cycle.leg;
  back.duration_s = cycle.duration_s;
  back.stride_m = -cycle.stride_m;
  back.step_m = {-cycle.step_m[kRightSide], -cycle.step_m[kLeftSide]};
  back.track_m = cycle.track_m;
  back.strike = cycle.strike;
  back.toe_off = cycle.toe_off;
  for (int i = 0; i < kCycleSamples; ++i)
    back.samples.push_back(sample_at(cycle, cycle.toe_off[kRightSide] - double(i) / kCycleSamples));
  return back;
}

struct Builder {
  const GaitCycle& cycle;
  StrideFamily family;
  std::array<vec3, 2> own_footprint_m{};
  std::array<LegAngles, 2> mean_rad{};
  vec3 mean_tilt{0.0};
  std::array<vec3, kCycleSamples> tilt{};  // rotation vector (rad) of the pelvis without its yaw
  std::array<double, kCycleSamples> yaw{};

  explicit Builder(const GaitCycle& data) : cycle(data) {
    measure_footprints();
    keep_steps();
    measure_standing();
    for (int i = 0; i < kCycleSamples; ++i) {
      const CycleSample& sample = data.samples[i];
      yaw[i] = heading_of(sample.pelvis * kForward);
      tilt[i] = rotation_vector(rotation_y(-yaw[i]) * sample.pelvis);
      mean_tilt += tilt[i] / double(kCycleSamples);
      for (int side : {0, 1}) {
        for (int j = 0; j < kLegDofs; ++j)
          mean_rad[side][j] += sample.leg[side].angles[j] / kCycleSamples;
      }
    }
  }

  // Mean places of the heels while the feet are flat.
  void measure_footprints() {
    for (int side : {0, 1}) {
      const double roll = fraction(cycle.toe_off[1 - side] - cycle.strike[side]);
      vec3 sum(0.0);
      int count = 0;
      for (int i = 0; i < kCycleSamples; ++i) {
        const double own = fraction(double(i) / kCycleSamples - cycle.strike[side]);
        if (own < roll || own > roll + kFlatPhase) continue;
        const CycleSample& s = cycle.samples[i];
        sum += pose_of(cycle, side, s).heel_m;
        sum.z += cycle.stride_m * (cycle.strike[side] + own);
        ++count;
      }
      own_footprint_m[side] = sum / double(count);
      own_footprint_m[side].y = 0.0;
    }
  }

  // Moves both footprints equally so that their distance is the cycle's left step.
  void keep_steps() {
    const double step_m = own_footprint_m[kLeftSide].z - own_footprint_m[kRightSide].z;
    const double apart_m = 0.5 * (cycle.step_m[kLeftSide] - step_m);
    own_footprint_m[kLeftSide].z += apart_m;
    own_footprint_m[kRightSide].z -= apart_m;
  }

  // The standing knee is as straight as the straightest knee of the data's stance.
  void measure_standing() {
    double knee = kPi;
    for (int i = 0; i < kCycleSamples; ++i) {
      for (int side : {0, 1}) {
        const double own = fraction(double(i) / kCycleSamples - cycle.strike[side]);
        if (own < fraction(cycle.toe_off[side] - cycle.strike[side]))
          knee = std::min(knee, cycle.samples[i].leg[side].angles[kKneeX]);
      }
    }
    const Stand stand = standing_legs(cycle.leg, std::max(knee, kLeastStandingKnee));
    family.stand_m = stand.pelvis_m;
    family.stand_roll_rad = stand.roll_rad;
    family.stand_rad = stand.angles;
    family.lead_m = stand.lead_m;
  }

  // The pelvis' rotation without its yaw, relative to standing, as a rotation vector (rad); the
  // stride is `ratio` times as long as the data's.
  vec3 tilt_at(int i, double ratio) const {
    const vec3 stand(0.0, 0.0, family.stand_roll_rad);
    return (mean_tilt - stand) * std::min(1.0, 2.0 * ratio) + (tilt[i] - mean_tilt) * ratio;
  }

  // Sample i of the data, scaled to a stride `ratio` times as long.
  StrideSample scaled(int i, double ratio) const {
    const CycleSample& data = cycle.samples[i];
    const double lift = mix(kLeastLift, 1.0, ratio), square = ratio * ratio;
    StrideSample s;
    s.pelvis_m = data.pelvis_m;
    s.pelvis_m.y = mix(family.stand_m, data.pelvis_m.y, square);
    s.pelvis_m.z *= ratio;
    s.pelvis = rotation_y(ratio * yaw[i]) *
               from_rotation_vector(tilt_at(i, ratio) + vec3(0.0, 0.0, family.stand_roll_rad));
    for (int side : {0, 1}) {
      const LegAngles &all = data.leg[side].angles, &stand = family.stand_rad[side],
                      &mean = mean_rad[side];
      LegAngles& a = s.leg[side];
      for (int j = 0; j < kLegDofs; ++j) a[j] = mean[j] + ratio * (all[j] - mean[j]);
      for (int j : {kKneeX, kAnkleX}) a[j] = stand[j] + lift * (all[j] - stand[j]);
      // The thigh undoes half of the knee's additional bend, so that a short step lifts the foot
      // straight up.
      a[kHipX] = stand[kHipX] + ratio * (all[kHipX] - stand[kHipX]) -
                 0.5 * (lift - ratio) * (all[kKneeX] - stand[kKneeX]);
    }
    return s;
  }

  vec3 footprint(int side, double ratio) const {
    vec3 p = own_footprint_m[side];
    p.z = -family.lead_m + ratio * (p.z + family.lead_m);
    return p;
  }

  StageClock clock(double ratio) const {
    StageClock c;
    c.phase_share = stage_shares(cycle);
    for (int first : {0, 2}) {
      const double half = c.phase_share[first] + c.phase_share[first + 1];
      c.time_share[first] = roll_time_share(c.phase_share[first], ratio);
      c.time_share[first + 1] = half - c.time_share[first];
    }
    return c;
  }

  StrideProblem problem(double ratio) const {
    StrideProblem p;
    p.leg = cycle.leg;
    p.stride_m = ratio * cycle.stride_m;
    // People who walk backwards land on their toes and leave on their heels; Table I has the
    // opposite. So the data weigh less there, the ankles' above all, and the change is smoother.
    if (cycle.stride_m < 0.0) {
      p.least_knee_rad.fill(kLeastKneeBack);
      p.soft_toe *= kSmootherBack;
      p.smoothness = kSmootherBack;
      for (LegAngles& weight : p.leg_weight)
        weight = {kHipBack, kHipBack, kHipBack, 1.0, kAnkleBack, kAnkleBack, kAnkleBack};
    }
    p.duration_s = cycle.duration_s * std::sqrt(std::clamp(ratio, kRatioStep, 1.0));
    p.strike = cycle.strike;
    p.toe_off = cycle.toe_off;
    const StageClock stages = clock(ratio);
    const bool is_made = !cycle.captured && cycle.stride_m > 0.0;
    for (int i = 0; i < kCycleSamples; ++i) {
      p.wanted.push_back(scaled(i, ratio));
      p.time.push_back(stages.time_at(double(i) / kCycleSamples));
      if (is_made) {
        const double swing = 4.0 * kPi * (double(i) / kCycleSamples + kEarly);
        p.wanted.back().pelvis_m.z = p.stride_m * kSurge / (4.0 * kPi) * sin_cos(swing).sin;
      }
    }
    for (int side : {0, 1}) {
      p.heel_m[side] = footprint(side, ratio);
      if (cycle.stride_m < 0.0) continue;
      double least_rad = kPi;
      for (const StrideSample& s : p.wanted) least_rad = std::min(least_rad, s.leg[side][kKneeX]);
      p.least_knee_rad[side] =
          std::max(is_made ? kLeastMadeKnee : kLeastKnee, least_rad - kStraighter);
    }
    // Run back, the data's speed would cost knees 2 degrees. Steps on the spot have none to keep.
    if (cycle.stride_m > 0.0) {
      const SpeedCost& cost = is_made ? kMadeSpeed : kCapturedSpeed;
      const double share = ratio > 1.0 ? cost.longer : ratio < 1.0 ? cost.shorter * ratio : 1.0;
      p.own_stride_m = cycle.stride_m;
      p.leg_smoothness = mix(1.0, cost.legs, std::min(1.0, ratio));
      p.pelvis_smoothness = mix(1.0, cost.pelvis, share);
      p.speed_weight = cost.weight * share;
    }
    return p;
  }

  StrideTable table_of(const StrideProblem& p, const std::vector<StrideSample>& solved,
                       double ratio) const {
    StrideTable table;
    table.stride_m = p.stride_m;
    table.footprint_m = p.heel_m;
    table.low_m = 1e9, table.high_m = -1e9;
    std::array<StrideCell, kCycleSamples> cells;
    for (int i = 0; i < kCycleSamples; ++i) {
      const StrideSample& s = solved[i];
      StrideCell& cell = cells[i];
      const double travel = p.stride_m * (p.time[i] - double(i) / kCycleSamples);
      cell.pelvis_m = s.pelvis_m + vec3(0.0, -family.stand_m, travel);
      table.low_m = std::min(table.low_m, cell.pelvis_m.y);
      table.high_m = std::max(table.high_m, cell.pelvis_m.y);
      cell.pelvis_yaw_rad = ratio * yaw[i];
      cell.pelvis_tilt = tilt_at(i, ratio);
      for (int side : {0, 1}) {
        const LegModel& leg = cycle.leg[side];
        const LegPose pose = leg_pose(leg, s.pelvis_m, s.pelvis, s.leg[side], 0.0);
        StrideFoot& foot = cell.foot[side];
        foot.heel_m = pose.heel_m + vec3(0.0, 0.0, travel);
        set_rotation(leg, pose.foot, foot);
        for (int j = 0; j < kLegDofs; ++j)
          cell.leg_rad[side][j] = s.leg[side][j] - family.stand_rad[side][j];
      }
    }
    table.knot = knots_through(cells);
    return table;
  }

  static void set_rotation(const LegModel& leg, const quat& rotation, StrideFoot& foot) {
    const vec3 line = leg.toe_m - leg.heel_m;
    const vec3 ahead = foot_forward(leg), across = glm::cross(kUp, ahead);
    const vec3 now = rotation * line;
    foot.pitch_rad =
        gaitpad::atan2(line.y, glm::dot(line, ahead)) - gaitpad::atan2(now.y, glm::dot(now, ahead));
    const auto rest_of = [&](double pitch) {
      return rotation_vector(glm::conjugate(rotation_about(across, pitch)) * rotation);
    };
    // Adds the rest's turn about the transverse axis to the pitch; each pass leaves 1 % of it.
    for (int n = 0; n < 4; ++n) foot.pitch_rad += glm::dot(rest_of(foot.pitch_rad), across);
    const vec3 rest = rest_of(foot.pitch_rad);
    foot.twist_rad = rest.y;
    foot.roll_rad = glm::dot(rest, ahead);
  }

  // --- All strides ---

  struct Solved {
    StrideProblem problem;
    std::vector<StrideSample> stride;
  };

  // The start of the solve of `p`: its data plus the change that the neighbour's solution made.
  // With a second stride `far`, the change is extrapolated: near + kExtrapolation (near - far).
  static std::vector<StrideSample> start_of(const StrideProblem& p, const Solved& near,
                                            const Solved* far) {
    std::vector<StrideSample> start = p.wanted;
    const auto add = [&start](const Solved& from, double share) {
      for (int i = 0; i < kCycleSamples; ++i) {
        const StrideSample &solved = from.stride[i], &wanted = from.problem.wanted[i];
        start[i].pelvis_m += share * (solved.pelvis_m - wanted.pelvis_m);
        for (int side : {0, 1}) {
          for (int j = 0; j < kLegDofs; ++j)
            start[i].leg[side][j] += share * (solved.leg[side][j] - wanted.leg[side][j]);
        }
      }
    };
    add(near, far == nullptr ? 1.0 : 1.0 + kExtrapolation);
    if (far != nullptr) add(*far, -kExtrapolation);
    return start;
  }

  // Solves all tables. False if one has no solution.
  bool solve() {
    StrideSolver solver;
    const bool forwards = cycle.stride_m > 0.0;
    const int tables = forwards ? kStrideRatios : kBackRatios,
              first = std::min(kDataTable, tables - 1);
    std::vector<Solved> all(tables);
    family.table.resize(tables);
    // Solves table k from its neighbour `from`, or from its data if that is itself.
    const auto solve_from = [&](int k, int from) {
      const int beyond = 2 * from - k, steps = k == from        ? kFirstSolve
                                               : !forwards      ? kNextBack
                                               : k > kDataTable ? kLongSolve
                                                                : kNextSolve;
      const bool is_known = beyond >= 0 && beyond < tables && !all[beyond].stride.empty();
      StrideProblem p = problem(k * kRatioStep);
      std::vector<StrideSample> stride = solver.solve(
          p, k == from ? p.wanted : start_of(p, all[from], is_known ? &all[beyond] : nullptr),
          steps);
      if (stride.empty()) return false;
      family.table[k] = table_of(p, stride, k * kRatioStep);
      all[k] = {std::move(p), std::move(stride)};
      return true;
    };
    bool solved = solve_from(first, first);
    for (int k = first - 1; solved && k >= 0; --k) solved = solve_from(k, k + 1);
    for (int k = first + 1; solved && k < tables; ++k) solved = solve_from(k, k - 1);
    return solved;
  }
};

// The reason why a cycle that check() accepts is not a walk that the solver accepts, if any.
std::optional<std::string> fault_of(const GaitCycle& cycle) {
  for (const double number : solver_input(cycle)) {
    if (!std::isfinite(number)) return "holds a number that is not finite";
  }
  for (const LegModel& leg : cycle.leg) {
    const vec3 foot = leg.toe_m - leg.heel_m;
    if (std::min({leg.thigh_m, leg.shank_m, horizontal_length(foot)}) < 0.01)
      return "has a leg without a thigh, a shank or a foot";
  }
  // A step is shorter than two legs.
  if (cycle.stride_m > 4.0 * mean_leg_m(cycle)) return "takes strides longer than four legs";
  const double sample_share = 1.0 / kCycleSamples;
  if (std::abs(cycle.strike[1]) > sample_share || cycle.toe_off[0] < sample_share ||
      cycle.strike[0] < cycle.toe_off[0] + sample_share ||
      cycle.toe_off[1] < cycle.strike[0] + sample_share || cycle.toe_off[1] > 1.0 - sample_share)
    return "has events that are not in the order of a walk";
  for (const CycleSample& sample : cycle.samples) {
    if (std::abs(glm::dot(sample.pelvis, sample.pelvis) - 1.0) > 1e-6)
      return "holds a rotation of the pelvis that is not a unit quaternion";
    for (const LegSample& leg : sample.leg) {
      for (const double angle : leg.angles) {
        if (std::abs(angle) > 2.0 * kPi) return "turns a leg by more than a full turn";
      }
    }
  }
  return std::nullopt;
}

bool is_finite(const StrideFamily& family) {
  double sum = 0.0;
  for_each_number(family, [&sum](double number) { sum += std::abs(number); });
  return std::isfinite(sum);
}

}  // namespace

std::vector<double> solver_input(const GaitCycle& cycle) {
  std::vector<double> numbers;
  const auto add = [&numbers](const vec3& v) { numbers.insert(numbers.end(), {v.x, v.y, v.z}); };
  for (const LegModel& leg : cycle.leg) {
    for (const vec3& v : {leg.hip_m, leg.heel_m, leg.toe_m}) add(v);
    numbers.insert(numbers.end(), {leg.thigh_m, leg.shank_m, leg.toe_rest_m});
  }
  numbers.insert(numbers.end(), {cycle.stride_m, cycle.step_m[0], cycle.step_m[1], cycle.strike[0],
                                 cycle.strike[1], cycle.toe_off[0], cycle.toe_off[1],
                                 cycle.duration_s, cycle.captured ? 1.0 : 0.0});
  for (const CycleSample& sample : cycle.samples) {
    add(sample.pelvis_m);
    const quat& q = sample.pelvis;
    numbers.insert(numbers.end(), {q.w, q.x, q.y, q.z});
    for (const LegSample& leg : sample.leg)
      numbers.insert(numbers.end(), leg.angles.begin(), leg.angles.end());
  }
  return numbers;
}

Result<StrideFamily> stride_family(const GaitCycle& cycle) {
  if (auto problem = check(cycle)) return *problem;
  if (const auto fault = fault_of(cycle)) return Error{cycle.name + ": " + *fault};
  const GaitCycle backwards = run_back(cycle);
  Builder builder(cycle), back(backwards);
  back.family = builder.family;
  bool back_solved = false;
  const auto solve_back = [&back, &back_solved] { back_solved = back.solve(); };
  std::thread beside;
  if (std::thread::hardware_concurrency() > 1) {
    beside = std::thread(solve_back);
  } else {  // there is no second core
    solve_back();
  }
  const bool forwards_solved = builder.solve();
  if (beside.joinable()) beside.join();
  const bool solved = back_solved && forwards_solved;
  builder.family.back = std::move(back.family.table);
  if (!solved || !is_finite(builder.family))
    return Error{cycle.name + ": no stride keeps its feet where they stand"};
  return std::move(builder.family);
}

Result<GaitCycle> with_clean_strides(GaitCycle cycle) {
  auto family = stride_family(cycle);
  if (!family) return family.error();
  cycle.strides = std::make_shared<const StrideFamily>(std::move(*family));
  return cycle;
}

}  // namespace gaitpad
