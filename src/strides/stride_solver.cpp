// Same numbers on every machine: Eigen must not vectorise, because that changes the order of sums.
#define EIGEN_DONT_VECTORIZE
#define EIGEN_DONT_PARALLELIZE
#include "strides/stride_solver.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "gaitpad/curve.h"
#include "motion/leg_pose.h"

namespace gaitpad {
namespace {

constexpr int kPelvis = 3, kUnknowns = kPelvis + 2 * kLegDofs;  // numbers of unknowns of one sample

// Weights of squared residuals, relative to a change of 1 rad of a knee: the weight with which
// `residual` costs as much as 1 degree.
constexpr double costs_as_a_degree(double residual) {
  return (kDegree / residual) * (kDegree / residual);
}
constexpr double kPelvisWeight = costs_as_a_degree(0.04);  // of an error of the pelvis, metres
constexpr double kJointWeight = 1.8;    // a change of hip or ankle, relative to one of a knee
constexpr double kSmoothWeight = 20.0;  // of second differences between samples
// Factors on kSmoothWeight for the pelvis.
constexpr double kPelvisSmooth = 5000.0, kPelvisSmoothUp = 4000.0;
// Of a change of the pelvis' forward speed, as a share of the data's mean speed. The median of 14
// captures then is 3.3 % off their own speed's curve. At 4 % it is 8.3 %, where knees and ankles
// are nearer to their data by 0.3 and 0.2 degrees RMS.
constexpr double kSpeedWeight = costs_as_a_degree(0.015);
// Weights of a planted point's error, of a point's depth in the floor (both per square metre) and
// of a knee's lack of bend (per square radian).
constexpr double kPlantedWeight = 3e5, kFloorWeight = 3e6, kKneeWeight = 1e4;
// Of a sole that is level and points ahead, per square metre.
constexpr double kLevelWeight = 5e2;
// Weights per square metre of second differences, for heels that come to rest and toes that begin
// to move smoothly.
constexpr double kSoftStrikeWeight = 3e4, kSoftToeDownWeight = 1.3e4;
constexpr int kLanding = 3;  // number of samples over which these weights fade
// People's hips accelerate by 2 to 4 m/s^2 along the path. Soft limits on their acceleration
// upwards and ahead, and the limits' widths; excess costs kSurgeWeight per square metre of a second
// difference.
constexpr vec3 kMostSurge_m_s2(0.0, 7.0, 2.8), kSoftSurge_m_s2(0.0, 2.0, 0.8);
constexpr double kSurgeWeight = 1e6;
// Distance beside the heel at which kLevelWeight measures the sole's roll.
constexpr double kSide_m = 0.1;
// Depth to which the edge of a heel may sink into the floor, and the width of that soft limit.
constexpr double kMostSink_m = 0.002, kSoftEdge_m = 0.0015;
// Widths of the soft limits on toes, heels and knees.
constexpr double kSoftFloor_m = 0.004, kSoftHeel_m = 0.001;
constexpr double kSoftKnee = 2.0 * kDegree;
constexpr double kToeClearance_m = 0.01;  // height of the toe in the middle of the flight
constexpr double kMostStep = 0.25;        // largest change in an iteration, radians or metres
constexpr double kRounding = 1e-9;        // metres, radians, cycles or samples: no difference

constexpr std::array<double, 3> kBend = {1.0, -2.0, 1.0};  // coefficients of a second difference

// Slope of soft_positive().
double soft_slope(double x, double width) { return std::min(1.0, 0.5 * (x + width) / width); }

int leg_unknown(int side) { return kPelvis + side * kLegDofs; }

// The unknown that mirrors another one across the walker's middle plane, and its sign.
struct Mirrored {
  int unknown;
  double factor;
};
Mirrored mirror_of(int k) {
  if (k < kPelvis) return {k, k == 0 ? -1.0 : 1.0};
  const int side = (k - kPelvis) / kLegDofs, j = (k - kPelvis) % kLegDofs;
  const bool bends = j == kHipX || j == kKneeX || j == kAnkleX;
  return {leg_unknown(1 - side) + j, bends ? 1.0 : -1.0};
}

double weight_of(int k) {
  if (k < kPelvis) return kPelvisWeight;
  const int j = (k - kPelvis) % kLegDofs;
  return j == kKneeX ? 1.0 : kJointWeight;
}

// Place of a foot's point and its derivatives by the unknowns of its sample.
struct PointRows {
  vec3 place_m;
  // Derivatives by the leg's angles. The derivative by the pelvis' place is the identity.
  std::array<vec3, kLegDofs> by_angle;
};

struct LegFrames {
  LegPose pose;
  std::array<vec3, kLegDofs> axis, pivot;
};

LegFrames leg_frames(const LegModel& model, const StrideSample& sample, int side) {
  const LegAngles& a = sample.leg[side];
  LegFrames f;
  f.pose = leg_pose(model, sample.pelvis_m, sample.pelvis, a, 0.0);
  const quat hip_x = sample.pelvis * rotation_x(a[kHipX]), hip_z = hip_x * rotation_z(a[kHipZ]);
  const quat ankle_x = f.pose.shank * rotation_x(a[kAnkleX]),
             ankle_z = ankle_x * rotation_z(a[kAnkleZ]);
  f.axis = {sample.pelvis * kLeft, hip_x * kForward,   hip_z * kUp,  f.pose.thigh * kLeft,
            f.pose.shank * kLeft,  ankle_x * kForward, ankle_z * kUp};
  f.pivot = {f.pose.hip_m,   f.pose.hip_m,   f.pose.hip_m,  f.pose.knee_m,
             f.pose.ankle_m, f.pose.ankle_m, f.pose.ankle_m};
  return f;
}

PointRows point_rows(const LegFrames& f, const vec3& in_foot) {
  PointRows r;
  r.place_m = f.pose.ankle_m + f.pose.foot * in_foot;
  for (int j = 0; j < kLegDofs; ++j) r.by_angle[j] = glm::cross(f.axis[j], r.place_m - f.pivot[j]);
  return r;
}

struct FootRows {
  LegFrames frames;
  PointRows heel, toe;
};

double& unknown(StrideSample& s, int k) {
  if (k < kPelvis) return s.pelvis_m[k];
  return s.leg[(k - kPelvis) / kLegDofs][(k - kPelvis) % kLegDofs];
}
double unknown(const StrideSample& s, int k) { return unknown(const_cast<StrideSample&>(s), k); }

double factor_of(const StrideProblem& p, int k) {
  if (k < kPelvis) return 1.0;
  return p.leg_weight[(k - kPelvis) / kLegDofs][(k - kPelvis) % kLegDofs];
}

bool is_same(double a, double b) { return std::abs(a - b) < kRounding; }
bool is_mirrored(const vec3& a, const vec3& b) {
  return is_same(glm::distance(a, mirrored(b)), 0.0);
}

// True if everything half a stride later is the mirror image.
bool is_symmetric(const StrideProblem& p) {
  const int n = static_cast<int>(p.wanted.size()), half = n / 2;
  const LegModel &left = p.leg[0], &right = p.leg[1];
  const vec3 on(0.0, 0.0, 0.5 * p.stride_m);
  bool same = n % 2 == 0 && is_mirrored(left.hip_m, right.hip_m) &&
              is_mirrored(left.heel_m, right.heel_m) && is_mirrored(left.toe_m, right.toe_m) &&
              is_same(left.toe_rest_m, right.toe_rest_m) && is_same(left.thigh_m, right.thigh_m) &&
              is_same(left.shank_m, right.shank_m) && is_same(p.strike[0], p.strike[1] + 0.5) &&
              is_same(p.toe_off[0] + 0.5, p.toe_off[1]) &&
              is_mirrored(p.heel_m[0], p.heel_m[1] + on);
  for (int i = 0; i < half && same; ++i) {
    const StrideSample &a = p.wanted[i], &b = p.wanted[i + half];
    same = is_same(p.time[i] + 0.5, p.time[i + half]) &&
           is_same(std::abs(glm::dot(a.pelvis, mirrored(b.pelvis))), 1.0);
    for (int k = 0; k < kUnknowns && same; ++k) {
      const Mirrored m = mirror_of(k);
      same = is_same(unknown(a, k), m.factor * unknown(b, m.unknown)) &&
             factor_of(p, k) == factor_of(p, m.unknown);
    }
  }
  return same;
}

}  // namespace

struct StrideSolver::System {
  using Matrix = Eigen::SparseMatrix<double>;
  static constexpr int kReach = kBend.size();  // most samples that a row involves
  static constexpr int kBlock = kUnknowns * kUnknowns;

  int samples;  // number of samples of the stride
  int solved;   // unknown samples: half of them if the stride is symmetric
  // Normal equations as dense blocks of samples i and i + d. The sparse matrix holds every entry
  // that was ever written.
  std::vector<double> block;
  std::vector<char> is_entry;
  bool has_new_entries = true;
  std::vector<int> entry_at;  // index in `block` of each number of the sparse matrix
  Matrix normal;              // lower triangle of the normal matrix
  Eigen::VectorXd gradient;
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> factor;

  System(int n, int unknown_samples)
      : samples(n),
        solved(unknown_samples),
        block(solved * kReach * kBlock),
        is_entry(block.size()),
        normal(solved * kUnknowns, solved * kUnknowns),
        gradient(solved * kUnknowns) {
    // Rows within a sample come and go between iterations, so their entries always exist.
    for (int i = 0; i < solved; ++i) {
      for (int side : {0, 1}) {
        for (int k = 0; k < kUnknowns; ++k) {
          for (int l = 0; l <= k; ++l) {
            if (is_seen(k, side) && is_seen(l, side)) at(i * kUnknowns + k, i * kUnknowns + l);
          }
        }
      }
    }
  }

  // A row within a sample involves the pelvis and one leg.
  bool is_seen(int k, int side) const {
    return k < kPelvis || (k >= leg_unknown(side) && k < leg_unknown(side) + kLegDofs);
  }

  double& at(int row, int column) {
    int d = column / kUnknowns - row / kUnknowns;
    if (d < 0) d += solved;
    if (d >= kReach || (d == 0 && row < column)) {
      std::swap(row, column);
      d = d == 0 ? 0 : solved - d;
    }
    const int at =
        (row / kUnknowns * kReach + d) * kBlock + row % kUnknowns * kUnknowns + column % kUnknowns;
    if (!is_entry[at]) is_entry[at] = 1, has_new_entries = true;
    return block[at];
  }

  // Lists the entries by column, the order of the sparse matrix.
  void find_entries() {
    struct Entry {
      int row, column, at;
    };
    std::vector<Entry> entries;
    for (int at = 0; at < static_cast<int>(block.size()); ++at) {
      if (!is_entry[at]) continue;
      const int i = at / (kReach * kBlock), d = at / kBlock % kReach;
      const int k = i * kUnknowns + at % kBlock / kUnknowns,
                l = (i + d) % solved * kUnknowns + at % kUnknowns;
      entries.push_back({std::max(k, l), std::min(k, l), at});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return std::pair(a.column, a.row) < std::pair(b.column, b.row);
    });
    std::vector<Eigen::Triplet<double>> triplets;
    entry_at.clear();
    for (const Entry& e : entries) {
      triplets.emplace_back(e.row, e.column, 0.0);
      entry_at.push_back(e.at);
    }
    normal.setFromTriplets(triplets.begin(), triplets.end());
    factor.analyzePattern(normal);
    has_new_entries = false;
  }

  // factor.info() reports a failure if a number is not finite.
  void factorise() {
    if (has_new_entries) find_entries();
    for (std::size_t e = 0; e < entry_at.size(); ++e) normal.valuePtr()[e] = block[entry_at[e]];
    factor.factorize(normal);
  }

  // Index of unknown k of sample i, -1 <= i <= samples, and its sign if it is mirrored.
  Mirrored place_of(int i, int k) const {
    i = (i + samples) % samples;
    if (i < solved) return {i * kUnknowns + k, 1.0};
    const Mirrored m = mirror_of(k);
    return {(i - solved) * kUnknowns + m.unknown, m.factor};
  }

  // Adds weight * error^2; `row` holds the error's derivatives by the unknowns `where`.
  template <std::size_t kCount>
  void add_square(const std::array<double, kCount>& row, const std::array<int, kCount>& where,
                  double error, double weight) {
    for (std::size_t p = 0; p < kCount; ++p) {
      if (row[p] == 0.0) continue;
      gradient[where[p]] += weight * row[p] * error;
      for (std::size_t q = 0; q <= p; ++q) {
        if (row[q] != 0.0) at(where[p], where[q]) += weight * row[p] * row[q];
      }
    }
  }

  // Adds weight * (direction . (place - goal))^2.
  void add_row(int sample, int side, const PointRows& point, const vec3& direction, double error_m,
               double weight) {
    const int base = sample * kUnknowns, leg = base + leg_unknown(side);
    std::array<double, kPelvis + kLegDofs> row;
    std::array<int, kPelvis + kLegDofs> where;
    for (int a = 0; a < kPelvis; ++a) row[a] = direction[a], where[a] = base + a;
    for (int j = 0; j < kLegDofs; ++j) {
      row[kPelvis + j] = glm::dot(direction, point.by_angle[j]);
      where[kPelvis + j] = leg + j;
    }
    add_square(row, where, error_m, weight);
  }

  // Adds weight * |place - goal|^2.
  void add_place(int sample, int side, const PointRows& point, const vec3& goal_m, double weight) {
    for (int a = 0; a < 3; ++a) {
      vec3 direction(0.0);
      direction[a] = 1.0;
      add_row(sample, side, point, direction, point.place_m[a] - goal_m[a], weight);
    }
  }

  // Adds weight * |second difference of the point's place along the path|^2.
  void add_bend(int sample, int side, const std::vector<FootRows>& feet,
                const PointRows FootRows::*which, const StrideProblem& problem, double weight) {
    if (sample >= solved) return;
    for (int axis = 0; axis < 3; ++axis) {
      std::array<double, 3 * (kPelvis + kLegDofs)> row{};
      std::array<int, 3 * (kPelvis + kLegDofs)> where{};
      double error = 0.0;
      int m = 0;
      for (int d : {0, 1, 2}) {
        const int at = sample + d - 1, j = (at + samples) % samples;
        const PointRows& point = feet[j].*which;
        double place = point.place_m[axis];
        if (axis == 2) {
          const double stride_m = problem.stride_m;
          place += stride_m * problem.time[j] + (at < 0          ? -stride_m
                                                 : at >= samples ? stride_m
                                                                 : 0.0);
        }
        error += kBend[d] * place;
        const auto add = [&](int k, double slope) {
          const Mirrored place = place_of(at, k);
          row[m] = kBend[d] * slope * place.factor;
          where[m++] = place.unknown;
        };
        for (int a = 0; a < kPelvis; ++a) add(a, a == axis ? 1.0 : 0.0);
        for (int k = 0; k < kLegDofs; ++k) add(leg_unknown(side) + k, point.by_angle[k][axis]);
      }
      add_square(row, where, error, weight);
    }
  }

  // Adds the square of the change of the pelvis' forward speed between a sample and the next one.
  void add_speed(int sample, const std::vector<StrideSample>& x, const StrideProblem& problem) {
    const int next = (sample + 1) % samples;
    const double begin = problem.time[sample], end = problem.time[next] + (next == 0 ? 1.0 : 0.0),
                 slope = 1.0 / ((end - begin) * problem.own_stride_m);
    const auto change = [&](int i) { return x[i].pelvis_m.z - problem.wanted[i].pelvis_m.z; };
    const std::array<double, 2> row = {-slope, slope};
    const std::array<int, 2> where = {place_of(sample, 2).unknown, place_of(sample + 1, 2).unknown};
    add_square(row, where, slope * (change(next) - change(sample)),
               kSpeedWeight * problem.speed_weight);
  }

  // Softly limits the pelvis' acceleration along an axis; in metres per sample^2, for samples that
  // are evenly spaced in time.
  void add_surge(int sample, int axis, const std::vector<StrideSample>& x,
                 const StrideProblem& problem) {
    const double tick2 = problem.duration_s * problem.duration_s / (double(samples) * samples);
    const double most_m = kMostSurge_m_s2[axis] * tick2, soft_m = kSoftSurge_m_s2[axis] * tick2;
    std::array<double, 3> when, place;
    std::array<Mirrored, 3> where;
    for (int d : {0, 1, 2}) {
      const int at = sample + d - 1, j = (at + samples) % samples;
      when[d] = problem.time[j] + (at < 0 ? -1.0 : at >= samples ? 1.0 : 0.0);
      place[d] = x[j].pelvis_m[axis] + (axis == 2 ? problem.stride_m * when[d] : 0.0);
      where[d] = place_of(at, axis);
    }
    const double begin = when[1] - when[0], end = when[2] - when[1];
    const double even = 2.0 / (double(samples) * samples * (begin + end));
    const std::array<double, 3> slope_of = {even / begin, -even / begin - even / end, even / end};
    double bend = 0.0;
    for (int d : {0, 1, 2}) bend += slope_of[d] * place[d];
    const double over = std::abs(bend) - most_m;
    if (over <= -soft_m) return;
    const double share = soft_slope(over, soft_m);
    const double error = std::copysign(soft_positive(over, soft_m), bend);
    for (int d : {0, 1, 2}) {
      const double slope = share * slope_of[d];
      gradient[where[d].unknown] += kSurgeWeight * slope * error;
      for (int e = 0; e <= d; ++e)
        at(where[d].unknown, where[e].unknown) += kSurgeWeight * slope * share * slope_of[e];
    }
  }

  // Softly keeps a point above a height; a hard limit would flip on and off between iterations.
  void add_floor(int sample, int side, const PointRows& point, double least_m, double soft_m) {
    const double low = least_m - point.place_m.y;
    if (low <= -soft_m) return;
    const double slope = soft_slope(low, soft_m);
    add_row(sample, side, point, kUp * slope, -soft_positive(low, soft_m), kFloorWeight);
  }

  // A small and smooth change of the data costs least.
  void add_changes(int sample, const std::vector<StrideSample>& x, const StrideProblem& problem) {
    for (int k = 0; k < kUnknowns; ++k) {
      const double weight = weight_of(k) * factor_of(problem, k);
      const double smooth = problem.smoothness * kSmoothWeight * weight *
                            (k == 1        ? kPelvisSmoothUp * problem.pelvis_smoothness
                             : k < kPelvis ? kPelvisSmooth * problem.pelvis_smoothness
                                           : problem.leg_smoothness);
      std::array<double, 3> change, row;
      std::array<int, 3> where;
      for (int d : {0, 1, 2}) {
        const int j = (sample + d + samples - 1) % samples;
        const Mirrored place = place_of(sample + d - 1, k);
        change[d] = unknown(x[j], k) - unknown(problem.wanted[j], k);
        row[d] = kBend[d] * place.factor;
        where[d] = place.unknown;
      }
      add_square(std::array{1.0}, std::array{where[1]}, change[1], weight);
      add_square(row, where, change[0] - 2.0 * change[1] + change[2], smooth);
    }
  }

  // Heels come to rest smoothly, and so do toes; toes begin to move smoothly.
  void add_landings(int side, const std::vector<FootRows>& feet, const StrideProblem& problem) {
    const int strike = static_cast<int>(std::floor(problem.strike[side] * samples + kRounding)),
              lift = static_cast<int>(std::ceil(problem.toe_off[side] * samples - kRounding)),
              down = static_cast<int>(std::floor(problem.toe_off[1 - side] * samples + kRounding));
    for (int d = 0; d < kLanding; ++d) {
      const double fades = 1.0 - double(d) / kLanding, weight = fades * fades;
      const auto soften = [&](int sample, const PointRows FootRows::*point, double soft) {
        add_bend((sample + samples) % samples, side, feet, point, problem, weight * soft);
      };
      soften(strike - d, &FootRows::heel, kSoftStrikeWeight);
      soften(down - d, &FootRows::toe, kSoftToeDownWeight);
      soften(lift + d, &FootRows::toe, problem.soft_toe);
    }
  }

  // Heel and toe stand where Table I plants them, and no part of the foot goes through the floor.
  void add_foot(int i, int side, const FootRows& foot, const StrideProblem& problem) {
    const LegModel& leg = problem.leg[side];
    const LegFrames& frames = foot.frames;
    const PointRows &heel = foot.heel, &toe = foot.toe;
    // A point stands from the sample before its event to the one after it.
    const double sample = (1.0 - kRounding) / samples, phase = double(i) / samples;
    const double begins = fraction(phase - problem.strike[side] + sample);
    const double own = begins - sample;
    const double roll = fraction(problem.toe_off[1 - side] - problem.strike[side]);
    const double support = fraction(problem.toe_off[side] - problem.strike[side]);
    vec3 heel_goal = problem.heel_m[side];
    // At the cycle's end a foot in stance stands on the footprint of its last strike.
    const double turns = std::floor(problem.strike[side] + own - phase + 0.5);
    heel_goal.z -= problem.stride_m * (problem.time[i] + turns);
    const vec3 across_foot = glm::cross(kUp, foot_forward(leg));
    const bool rolls = own <= roll + sample,
               supports = own >= roll - sample && own <= support + sample;
    if (rolls) {
      add_place(i, side, heel, heel_goal, kPlantedWeight);
    } else {
      add_floor(i, side, heel, 0.0, kSoftHeel_m);
      // Keep the edges of a twisted or rolled heel out of the floor.
      for (double half : {-kHalfFoot, kHalfFoot}) {
        const vec3 edge_m = leg.heel_m + across_foot * (half * leg.length_m());
        add_floor(i, side, point_rows(frames, edge_m), -kMostSink_m, kSoftEdge_m);
      }
    }
    if (supports) {
      add_place(i, side, toe, heel_goal + leg.toe_m - leg.heel_m, kPlantedWeight);
    } else {
      const double u = rolls ? 0.0 : std::max(0.0, own - support) / (1.0 - support);
      const double least = leg.toe_rest_m + kToeClearance_m * 16.0 * u * u * (1.0 - u) * (1.0 - u);
      add_floor(i, side, toe, least, kSoftFloor_m);
    }
    if (!rolls && !supports) return;
    // The foot is level across and points ahead. Neither depends on the pelvis' place.
    const auto add_level = [&](const PointRows& point, int axis, double wanted_m) {
      std::array<double, kLegDofs> row;
      std::array<int, kLegDofs> where;
      for (int j = 0; j < kLegDofs; ++j) {
        row[j] = point.by_angle[j][axis] - heel.by_angle[j][axis];
        where[j] = i * kUnknowns + leg_unknown(side) + j;
      }
      add_square(row, where, point.place_m[axis] - heel.place_m[axis] - wanted_m, kLevelWeight);
    };
    add_level(point_rows(frames, leg.heel_m + across_foot * kSide_m), 1, 0.0);
    add_level(toe, 0, (leg.toe_m - leg.heel_m).x);
  }

  // Softly keeps a knee bent.
  void add_knee(int sample, int side, double knee_rad, double least_rad) {
    const double bend = least_rad - knee_rad;
    if (bend <= -kSoftKnee) return;
    const int at = sample * kUnknowns + leg_unknown(side) + kKneeX;
    add_square(std::array{-soft_slope(bend, kSoftKnee)}, std::array{at},
               soft_positive(bend, kSoftKnee), kKneeWeight);
  }

  // Sets up the equations of a step from `x`.
  void fill(const StrideProblem& problem, const std::vector<StrideSample>& x) {
    std::fill(block.begin(), block.end(), 0.0);
    gradient.setZero();
    for (int i = 0; i < solved; ++i) add_changes(i, x, problem);
    for (int i = 0; i < solved && problem.own_stride_m > 0.0; ++i) add_speed(i, x, problem);
    for (int i = 0; i < solved; ++i) {
      for (int axis : {2, 1}) add_surge(i, axis, x, problem);
    }
    std::array<std::vector<FootRows>, 2> feet;
    for (int side : {0, 1}) {
      const LegModel& leg = problem.leg[side];
      feet[side].resize(samples);
      // Solved samples and their neighbours.
      for (int at = -1; at <= solved; ++at) {
        const int i = (at + samples) % samples;
        const LegFrames frames = leg_frames(leg, x[i], side);
        feet[side][i] = {frames, point_rows(frames, leg.heel_m), point_rows(frames, leg.toe_m)};
      }
      add_landings(side, feet[side], problem);
    }
    for (int i = 0; i < solved; ++i) {
      for (int side : {0, 1}) {
        add_foot(i, side, feet[side][i], problem);
        add_knee(i, side, x[i].leg[side][kKneeX], problem.least_knee_rad[side]);
      }
    }
  }

  // Applies one solver step. False if the system has no solution.
  bool move(std::vector<StrideSample>& x) const {
    if (factor.info() != Eigen::Success) return false;
    const Eigen::VectorXd step = factor.solve(gradient);
    for (int i = 0; i < solved; ++i) {
      for (int k = 0; k < kUnknowns; ++k) {
        unknown(x[i], k) -= std::clamp(step[i * kUnknowns + k], -kMostStep, kMostStep);
      }
    }
    for (int i = solved; i < samples; ++i) {
      for (int k = 0; k < kUnknowns; ++k) {
        const Mirrored m = mirror_of(k);
        unknown(x[i], k) = m.factor * unknown(x[i - solved], m.unknown);
      }
    }
    return true;
  }
};

StrideSolver::StrideSolver() = default;
StrideSolver::~StrideSolver() = default;

std::vector<StrideSample> StrideSolver::solve(const StrideProblem& problem,
                                              std::vector<StrideSample> x, int iterations) {
  const int n = static_cast<int>(problem.wanted.size());
  const int solved = is_symmetric(problem) ? n / 2 : n;
  if (!system_ || system_->solved != solved) system_ = std::make_unique<System>(n, solved);
  for (int iteration = 0; iteration < iterations; ++iteration) {
    system_->fill(problem, x);
    system_->factorise();
    if (!system_->move(x)) return {};
  }
  return x;
}

}  // namespace gaitpad
