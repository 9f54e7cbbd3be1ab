#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <optional>
#include <string>

#include "gaitpad/clean_strides.h"
#include "gaitpad/curve.h"
#include "motion/leg_pose.h"
#include "strides/clean_stride.h"
#include "strides/solver_input.h"

namespace gaitpad {
namespace {

constexpr int kOwn = 5;  // the table of the data's own stride
// Iterations. After so many the largest change of an angle is below 1e-4 rad in most clips; ratios
// 0 and 0.2 still drift by up to 1e-2 rad in some, along changes that cost next to nothing.
constexpr int kFirstSolve = 10, kNextSolve = 8;
constexpr double kLeastStandingKnee = 3.0 * kDegree;
// What shows of the data's angles in steps of length 0: a foot still has to leave the floor.
constexpr double kLeastLift = 0.3;
constexpr double kFlat = 0.2;  // own phase: how long a foot stands flat after its roll
// What no walker has. A leg opens by less than half a turn, so a step is shorter than two legs.
constexpr double kLeastBone_m = 0.01, kMostLegs = 4.0, kMostAngle = 2.0 * kPi;

// How a joint is stiffened: the pull to its curve's mean, and what it weighs beside the others.
struct Stiffness {
  int dof;
  double pull, weight;
};
constexpr std::array<Stiffness, 3> kStiffness = {
    {{kHipX, 0.25, 10.0}, {kKneeX, 0.2, 10.0}, {kAnkleX, 0.2, 10.0}}};
// What the other leg's angles weigh where one leg is stiff: an injury leaves the sound leg alone.
constexpr double kOtherLeg = 20.0;
constexpr double kBounceWeight = 1e5;
constexpr int kResponseSolve = 2;

double fraction(double phase) { return phase - std::floor(phase); }

// The cycle run back: what it lifts lands. Its phases count from where the data lift the right foot,
// and its stages have the shares of the cycle's.
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
  std::array<double, 4> phase_share{};
  std::array<LegAngles, 2> mean_rad{};
  vec3 mean_tilt{0.0};
  std::array<vec3, kCycleSamples> tilt{};
  std::array<double, kCycleSamples> yaw{};

  explicit Builder(const GaitCycle& data) : cycle(data) {
    const double left_off = data.toe_off[0], left = data.strike[0], right_off = data.toe_off[1];
    phase_share = {left_off, left - left_off, right_off - left, 1.0 - right_off};
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

  // Where the heels stand while the feet are flat.
  void measure_footprints() {
    for (int side : {0, 1}) {
      const double roll = fraction(cycle.toe_off[1 - side] - cycle.strike[side]);
      vec3 sum(0.0);
      int count = 0;
      for (int i = 0; i < kCycleSamples; ++i) {
        const double own = fraction(double(i) / kCycleSamples - cycle.strike[side]);
        if (own < roll || own > roll + kFlat) continue;
        const CycleSample& s = cycle.samples[i];
        sum += leg_pose(cycle.leg[side], s.pelvis_m, s.pelvis, s.leg[side].angles, 0.0).heel_m;
        sum.z += cycle.stride_m * (cycle.strike[side] + own);
        ++count;
      }
      own_footprint_m[side] = sum / double(count);
      own_footprint_m[side].y = 0.0;
    }
  }

  // The cycle's own steps, between these places.
  void keep_steps() {
    const double step_m = own_footprint_m[kLeftSide].z - own_footprint_m[kRightSide].z;
    const double apart_m = 0.5 * (cycle.step_m[kLeftSide] - step_m);
    own_footprint_m[kLeftSide].z += apart_m;
    own_footprint_m[kRightSide].z -= apart_m;
  }

  // The standing knee is as straight as the data's in stance.
  void measure_standing() {
    double knee = kPi;
    for (int i = 0; i < kCycleSamples; ++i) {
      for (int side : {0, 1}) {
        const double own = fraction(double(i) / kCycleSamples - cycle.strike[side]);
        if (own < fraction(cycle.toe_off[side] - cycle.strike[side]))
          knee = std::min(knee, cycle.samples[i].leg[side].angles[kKneeX]);
      }
    }
    knee = std::max(knee, kLeastStandingKnee);
    const SinCos s = sin_cos(knee);
    for (int side : {0, 1}) {
      const LegModel& leg = cycle.leg[side];
      const double ahead = leg.shank_m * s.sin, down = leg.thigh_m + leg.shank_m * s.cos;
      LegAngles& angles = family.stand_rad[side];
      angles[kHipX] = -gaitpad::atan2(ahead, down);
      angles[kKneeX] = knee;
      angles[kAnkleX] = -angles[kHipX] - knee;
      family.stand_m +=
          0.5 * (std::sqrt(ahead * ahead + down * down) - leg.heel_m.y - leg.hip_m.y);
      family.lead_m += 0.5 * (-leg.heel_m.z - leg.hip_m.z);
    }
  }

  // The data as they would look in a stride of another length.
  StrideSample scaled(int i, double ratio) const {
    const CycleSample& data = cycle.samples[i];
    const double lift = mix(kLeastLift, 1.0, ratio), square = ratio * ratio;
    StrideSample s;
    s.pelvis_m = data.pelvis_m;
    s.pelvis_m.y = mix(family.stand_m, data.pelvis_m.y, square);
    s.pelvis_m.z *= ratio;
    s.pelvis = rotation_y(ratio * yaw[i]) *
               from_rotation_vector(mean_tilt * std::min(1.0, 2.0 * ratio) +
                                    (tilt[i] - mean_tilt) * ratio);
    for (int side : {0, 1}) {
      const LegAngles &all = data.leg[side].angles, &stand = family.stand_rad[side],
                      &mean = mean_rad[side];
      LegAngles& a = s.leg[side];
      for (int j = 0; j < kLegDofs; ++j) a[j] = mean[j] + ratio * (all[j] - mean[j]);
      for (int j : {kKneeX, kAnkleX}) a[j] = stand[j] + lift * (all[j] - stand[j]);
      // In short steps the thigh lifts the foot straight up.
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
    c.phase_share = phase_share;
    for (int first : {0, 2}) {
      const double half = phase_share[first] + phase_share[first + 1];
      c.time_share[first] = roll_time_share(phase_share[first], ratio);
      c.time_share[first + 1] = half - c.time_share[first];
    }
    return c;
  }

  StrideProblem problem(double ratio) const {
    StrideProblem p;
    p.leg = cycle.leg;
    p.stride_m = ratio * cycle.stride_m;
    p.strike = cycle.strike;
    p.toe_off = cycle.toe_off;
    const StageClock stages = clock(ratio);
    for (int i = 0; i < kCycleSamples; ++i) {
      p.wanted.push_back(scaled(i, ratio));
      // The time of this phase, by bisection.
      const double phase = double(i) / kCycleSamples;
      double low = 0.0, high = 1.0;
      for (int n = 0; n < 50; ++n) {
        const double middle = 0.5 * (low + high);
        (stages.phase_at(middle) < phase ? low : high) = middle;
      }
      p.time.push_back(0.5 * (low + high));
    }
    for (int side : {0, 1}) p.heel_m[side] = footprint(side, ratio);
    return p;
  }

  StrideTable table_of(const StrideProblem& p, const std::vector<StrideSample>& solved,
                       double ratio) const {
    StrideTable table;
    table.stride_m = p.stride_m;
    table.footprint_m = p.heel_m;
    std::array<StrideCell, kCycleSamples> cells;
    for (int i = 0; i < kCycleSamples; ++i) {
      const StrideSample& s = solved[i];
      StrideCell& cell = cells[i];
      const double travel = p.stride_m * (p.time[i] - double(i) / kCycleSamples);
      cell.pelvis_m = s.pelvis_m + vec3(0.0, -family.stand_m, travel);
      cell.pelvis_yaw_rad = ratio * yaw[i];
      cell.pelvis_tilt =
          mean_tilt * std::min(1.0, 2.0 * ratio) + (tilt[i] - mean_tilt) * ratio;
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
    const vec3 ahead = glm::normalize(vec3(line.x, 0.0, line.z)), across = glm::cross(kUp, ahead);
    const vec3 now = rotation * line;
    foot.pitch_rad = gaitpad::atan2(line.y, glm::dot(line, ahead)) -
                     gaitpad::atan2(now.y, glm::dot(now, ahead));
    const auto rest_of = [&](double pitch) {
      return rotation_vector(glm::conjugate(rotation_about(across, pitch)) * rotation);
    };
    // What the rest turns about the transverse axis belongs to the pitch. Each pass leaves a
    // hundredth of it.
    for (int n = 0; n < 4; ++n) foot.pitch_rad += glm::dot(rest_of(foot.pitch_rad), across);
    const vec3 rest = rest_of(foot.pitch_rad);
    foot.twist_rad = rest.y;
    foot.roll_rad = glm::dot(rest, ahead);
  }

  // --- What styles ask for: what one stride changes by ---

  // A problem whose answer is `clean` as long as nothing else is wanted: flying heels keep their
  // way, and some angles weigh more than others.
  StrideProblem held(const StrideProblem& own, const std::vector<StrideSample>& clean) const {
    StrideProblem p = own;
    for (const StrideSample& s : clean) {
      std::array<vec3, 2>& heel = p.flying_heel_m.emplace_back();
      for (int side : {0, 1})
        heel[side] = leg_pose(cycle.leg[side], s.pelvis_m, s.pelvis, s.leg[side], 0.0).heel_m;
    }
    return p;
  }

  // Keeps `clean` the answer where the weights are no longer 1.
  static void balance(const std::vector<StrideSample>& clean, StrideProblem& p) {
    for (int i = 0; i < kCycleSamples; ++i) {
      const StrideSample& x = clean[i];
      StrideSample& wanted = p.wanted[i];
      wanted.pelvis_m = x.pelvis_m + (wanted.pelvis_m - x.pelvis_m) / p.pelvis_weight;
      for (int side : {0, 1}) {
        for (int j = 0; j < kLegDofs; ++j)
          wanted.leg[side][j] = x.leg[side][j] + (wanted.leg[side][j] - x.leg[side][j]) / p.leg_weight[side][j];
      }
    }
  }

  static double range_of(const std::vector<StrideSample>& stride, int side, int joint) {
    double low = kMostAngle, high = -kMostAngle;
    for (const StrideSample& s : stride) {
      low = std::min(low, s.leg[side][joint]);
      high = std::max(high, s.leg[side][joint]);
    }
    return high - low;
  }

  StrideResponse response_of(const std::vector<StrideSample>& clean,
                             const std::vector<StrideSample>& changed, double scale) const {
    std::array<StrideChange, kCycleSamples> change;
    for (int i = 0; i < kCycleSamples; ++i) {
      const StrideSample &a = clean[i], &b = changed[i];
      change[i].pelvis_m = scale * (b.pelvis_m - a.pelvis_m);
      for (int side : {0, 1}) {
        const LegModel& leg = cycle.leg[side];
        StrideFoot before, after;
        set_rotation(leg, leg_pose(leg, a.pelvis_m, a.pelvis, a.leg[side], 0.0).foot, before);
        set_rotation(leg, leg_pose(leg, b.pelvis_m, b.pelvis, b.leg[side], 0.0).foot, after);
        change[i].pitch_rad[side] = scale * (after.pitch_rad - before.pitch_rad);
        for (int j = 0; j < kLegDofs; ++j)
          change[i].leg_rad[side][j] = scale * (b.leg[side][j] - a.leg[side][j]);
      }
    }
    return {knots_through(change)};
  }

  // The joints of these sides near the mean of their curves.
  bool stiffen(StrideSolver& solver, const StrideProblem& own,
               const std::vector<StrideSample>& clean, const Stiffness& joint,
               std::initializer_list<int> sides, StrideResponse& response) const {
    StrideProblem p = own;
    if (sides.size() == 1) p.leg_weight[1 - *sides.begin()].fill(kOtherLeg);
    for (int side : sides) {
      for (const int bends : {kHipX, kKneeX, kAnkleX})
        if (sides.size() == 1 || bends == joint.dof) p.leg_weight[side][bends] = joint.weight;
    }
    balance(clean, p);
    for (int side : sides) {
      double mean = 0.0;
      for (const StrideSample& s : clean) mean += s.leg[side][joint.dof] / kCycleSamples;
      for (int i = 0; i < kCycleSamples; ++i)
        p.wanted[i].leg[side][joint.dof] += joint.pull * (mean - clean[i].leg[side][joint.dof]);
    }
    const auto stiff = sides.size() == 2 ? solver.solve(p, clean, kResponseSolve)
                       : joint.dof == kHipX ? solver.solve(p, clean, 1)
                                            : solver.solve_alike(p, clean);
    if (stiff.empty()) return false;
    const int side = *sides.begin();
    const double fall =
        1.0 - range_of(stiff, side, joint.dof) / std::max(1e-3, range_of(clean, side, joint.dof));
    if(getenv("VERB")) { std::printf("dof %d sides %zu fall %.3f ", joint.dof, sides.size(), fall); for(int sd:{0,1}) for(int jj:{0,3,4}) std::printf(" %.3f", range_of(stiff,sd,jj)/range_of(clean,sd,jj)); double pm=0; for(int i=0;i<kCycleSamples;++i) pm=std::max(pm,glm::distance(stiff[i].pelvis_m,clean[i].pelvis_m)); double other=0; if(sides.size()==1) for(int i=0;i<kCycleSamples;++i) for(int j=0;j<7;++j) other=std::max(other,std::abs(stiff[i].leg[1-side][j]-clean[i].leg[1-side][j])); std::printf(" pelvis %.1f mm other leg %.2f deg\n",pm*1e3,other/kDegree); }
    response = response_of(clean, stiff, 1.0);
    return true;
  }

  bool bounce(StrideSolver& solver, const StrideProblem& own,
              const std::vector<StrideSample>& clean, double more,
              StrideResponse& response) const {
    double low = clean[0].pelvis_m.y, high = low;
    for (const StrideSample& s : clean) {
      low = std::min(low, s.pelvis_m.y);
      high = std::max(high, s.pelvis_m.y);
    }
    StrideProblem p = own;
    p.pelvis_weight.y = kBounceWeight;
    balance(clean, p);
    // What stays where it is: the highest place with more bounce, the lowest one with less.
    const double stays = more > 0.0 ? high : low;
    for (int i = 0; i < kCycleSamples; ++i)
      p.wanted[i].pelvis_m.y += more * (clean[i].pelvis_m.y - stays);
    const auto bounced = solver.solve(p, clean, kResponseSolve);
    if (bounced.empty()) return false;
    if(getenv("VERB")) { double l=1e9,h=-1e9; for(auto&s:bounced){l=std::min(l,s.pelvis_m.y);h=std::max(h,s.pelvis_m.y);} std::printf("bounce %g: %.1f mm -> %.1f mm, top %.1f\n",more,(high-low)*1e3,(h-l)*1e3,(h-high)*1e3);}
    response = response_of(clean, bounced, 1.0);
    return true;
  }

  static StrideResponse mirrored_response(const StrideResponse& r) {
    StrideResponse m;
    for (int i = 0; i < kCycleSamples; ++i) {
      const StrideChange& from = r.knot[(i + kCycleSamples / 2) % kCycleSamples];
      StrideChange& to = m.knot[i];
      to.pelvis_m = mirrored(from.pelvis_m);
      for (int side : {0, 1}) {
        to.pitch_rad[side] = from.pitch_rad[1 - side];
        for (int j = 0; j < kLegDofs; ++j) {
          const bool bends = j == kHipX || j == kKneeX || j == kAnkleX;
          to.leg_rad[side][j] = bends ? from.leg_rad[1 - side][j] : -from.leg_rad[1 - side][j];
        }
      }
    }
    return m;
  }

  // False where there is no solution.
  bool respond(StrideSolver& solver, const StrideProblem& data,
               const std::vector<StrideSample>& clean) {
    family.response.resize(kStrideWishes);
    const auto at = [this](StrideWish wish) -> StrideResponse& {
      return family.response[static_cast<std::size_t>(wish)];
    };
    const StrideProblem own = held(data, clean);
    StrideSolver left_solver, right_solver;
    const bool symmetric = is_symmetric(own);
    bool solved = bounce(solver, own, clean, 1.0, at(StrideWish::more_bounce)) &&
                  bounce(solver, own, clean, -1.0, at(StrideWish::less_bounce));
    for (int k = 0; solved && k < static_cast<int>(kStiffness.size()); ++k) {
      const auto of = [&at, k](StrideWish first) -> StrideResponse& {
        return at(static_cast<StrideWish>(static_cast<int>(first) + k));
      };
      StrideResponse &left = of(StrideWish::stiff_left_hip),
                     &right = of(StrideWish::stiff_right_hip);
      solved = stiffen(solver, own, clean, kStiffness[k], {0, 1}, of(StrideWish::stiff_hips)) &&
               stiffen(left_solver, own, clean, kStiffness[k], {0}, left);
      if (solved && symmetric) {
        right = mirrored_response(left);
      } else {
        solved = solved && stiffen(right_solver, own, clean, kStiffness[k], {1}, right);
      }
    }
    return solved;
  }

  // --- All strides ---

  // False where there is no solution.
  bool solve() {
    StrideSolver solver;
    family.table.resize(kStrideRatios);
    const StrideProblem own = problem(1.0);
    const std::vector<StrideSample> clean = solver.solve(own, own.wanted, kFirstSolve);
    if (clean.empty()) return false;
    family.table[kOwn] = table_of(own, clean, 1.0);
    if (own.stride_m > 0.0 && !respond(solver, own, clean)) return false;
    for (int step : {-1, 1}) {
      std::vector<StrideSample> start = clean;
      StrideProblem before = own;
      for (int k = kOwn + step; k >= 0 && k < kStrideRatios; k += step) {
        StrideProblem p = problem(k * kRatioStep);
        // The neighbour's change of its own data.
        for (int i = 0; i < kCycleSamples; ++i) {
          start[i].pelvis_m += p.wanted[i].pelvis_m - before.wanted[i].pelvis_m;
          start[i].pelvis = p.wanted[i].pelvis;
          for (int side : {0, 1})
            for (int j = 0; j < kLegDofs; ++j)
              start[i].leg[side][j] += p.wanted[i].leg[side][j] - before.wanted[i].leg[side][j];
        }
        start = solver.solve(p, std::move(start), kNextSolve);
        if (start.empty()) return false;
        family.table[k] = table_of(p, start, k * kRatioStep);
        before = std::move(p);
      }
    }
    return true;
  }
};

// What forbids to solve for this cycle, so that the solver meets nothing but walks.
std::optional<std::string> fault_of(const GaitCycle& cycle) {
  if (cycle.samples.size() != kCycleSamples) return "has no samples of a whole cycle";
  for (const double number : solver_input(cycle)) {
    if (!std::isfinite(number)) return "holds a number that is not finite";
  }
  for (const LegModel& leg : cycle.leg) {
    const vec3 foot = leg.toe_m - leg.heel_m;
    if (std::min({leg.thigh_m, leg.shank_m, horizontal_length(foot)}) < kLeastBone_m)
      return "has a leg without a thigh, a shank or a foot";
  }
  if (cycle.stride_m <= 0.0) return "does not go forward";
  if (cycle.stride_m > kMostLegs * mean_leg_m(cycle)) return "takes strides longer than four legs";
  constexpr double kSample = 1.0 / kCycleSamples;
  if (std::abs(cycle.strike[1]) > kSample || cycle.toe_off[0] < kSample ||
      cycle.strike[0] < cycle.toe_off[0] + kSample ||
      cycle.toe_off[1] < cycle.strike[0] + kSample || cycle.toe_off[1] > 1.0 - kSample)
    return "has events that are not in the order of a walk";
  for (const CycleSample& sample : cycle.samples) {
    if (std::abs(glm::dot(sample.pelvis, sample.pelvis) - 1.0) > 1e-6)
      return "turns its pelvis by what is no rotation";
    for (const LegSample& leg : sample.leg) {
      for (const double angle : leg.angles) {
        if (std::abs(angle) > kMostAngle) return "turns a leg by more than a full turn";
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
  numbers.insert(numbers.end(), {cycle.stride_m, cycle.step_m[0], cycle.step_m[1], cycle.strike[0], cycle.strike[1],
                                 cycle.toe_off[0], cycle.toe_off[1]});
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
  if (const auto fault = fault_of(cycle)) return Error{cycle.name + ": " + *fault};
  const GaitCycle backwards = run_back(cycle);
  Builder builder(cycle), back(backwards);
  back.family.stand_rad = builder.family.stand_rad;
  back.family.stand_m = builder.family.stand_m;
  const bool solved = builder.solve() && back.solve();
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
