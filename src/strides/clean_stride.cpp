#include "strides/clean_stride.h"

#include <Eigen/SparseCholesky>

#include "gaitpad/curve.h"
#include "motion/leg_pose.h"

namespace gaitpad {
namespace {

constexpr int kPelvis = 3, kUnknowns = kPelvis + 2 * kLegDofs;  // of one sample

// Weights of squared residuals; an angle of the data (radians) has 1.
constexpr double kDegreeCosts_m = 0.02;  // a pelvis this far off costs as much as one degree
constexpr double kPelvisWeight = (kDegree / kDegreeCosts_m) * (kDegree / kDegreeCosts_m);
constexpr double kSmooth = 200.0;       // of second differences between samples
constexpr double kPelvisSmooth = 400.0;  // times that
constexpr double kPlanted = 2e6, kFloor = 2e5, kKnee = 2e3;  // per square metre, radian
constexpr double kLevel = 2e3;          // the sole is level and points ahead, per square metre
constexpr double kSide_m = 0.1;         // lever of that
constexpr double kSoftFloor_m = 0.004;
constexpr double kLeastKnee = 1.0 * kDegree;
constexpr double kToeClearance_m = 0.01;  // in the middle of the flight
constexpr double kMostStep = 0.15;        // radians or metres an iteration

int leg_unknown(int side) { return kPelvis + side * kLegDofs; }
double fraction(double phase) { return phase - std::floor(phase); }

// How one point of a foot moves with the unknowns of its sample.
struct PointRows {
  vec3 place_m;
  std::array<vec3, kLegDofs> by_angle;  // by the pelvis it is the identity
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
  f.axis = {sample.pelvis * kLeft, hip_x * kForward, hip_z * kUp, f.pose.thigh * kLeft,
            f.pose.shank * kLeft, ankle_x * kForward, ankle_z * kUp};
  f.pivot = {f.pose.hip_m, f.pose.hip_m, f.pose.hip_m, f.pose.knee_m,
             f.pose.ankle_m, f.pose.ankle_m, f.pose.ankle_m};
  return f;
}

PointRows point_rows(const LegFrames& f, const vec3& in_foot) {
  PointRows r;
  r.place_m = f.pose.ankle_m + f.pose.foot * in_foot;
  for (int j = 0; j < kLegDofs; ++j) r.by_angle[j] = glm::cross(f.axis[j], r.place_m - f.pivot[j]);
  return r;
}

}  // namespace

struct StrideSolver::System {
  using Matrix = Eigen::SparseMatrix<double>;
  int samples;
  Matrix normal;  // lower triangle
  Eigen::VectorXd gradient;
  Eigen::SimplicialLDLT<Matrix, Eigen::Lower> factor;

  explicit System(int n) : samples(n), normal(n * kUnknowns, n * kUnknowns), gradient(n * kUnknowns) {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](int row, int column) {
      entries.emplace_back(std::max(row, column), std::min(row, column), 0.0);
    };
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < kUnknowns; ++k) {
        for (int l = 0; l <= k; ++l) {
          const bool both_legs = k >= leg_unknown(1) && l >= leg_unknown(0) && l < leg_unknown(1);
          if (!both_legs) add(i * kUnknowns + k, i * kUnknowns + l);
        }
        for (int d : {1, 2}) add(i * kUnknowns + k, (i + d) % n * kUnknowns + k);
      }
    }
    normal.setFromTriplets(entries.begin(), entries.end());
    factor.analyzePattern(normal);
  }

  double& at(int row, int column) {
    return row >= column ? normal.coeffRef(row, column) : normal.coeffRef(column, row);
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
    for (std::size_t p = 0; p < row.size(); ++p) {
      gradient[where[p]] += weight * row[p] * error_m;
      for (std::size_t q = 0; q <= p; ++q) at(where[p], where[q]) += weight * row[p] * row[q];
    }
  }

  // Keeps a point above a height; rounded, so that the row does not flip from step to step.
  void add_floor(int sample, int side, const PointRows& point, double least_m) {
    const double low = least_m - point.place_m.y;
    if (low <= -kSoftFloor_m) return;
    const double slope = std::min(1.0, 0.5 * (low + kSoftFloor_m) / kSoftFloor_m);
    add_row(sample, side, point, kUp * slope, -soft_positive(low, kSoftFloor_m), kFloor);
  }
};

StrideSolver::StrideSolver(int samples) : system_(std::make_unique<System>(samples)) {}
StrideSolver::~StrideSolver() = default;

namespace {

double& unknown(StrideSample& s, int k) {
  if (k < kPelvis) return s.pelvis_m[k];
  return s.leg[(k - kPelvis) / kLegDofs][(k - kPelvis) % kLegDofs];
}
double unknown(const StrideSample& s, int k) { return unknown(const_cast<StrideSample&>(s), k); }

}  // namespace

std::vector<StrideSample> StrideSolver::solve(const StrideProblem& problem,
                                              std::vector<StrideSample> x, int iterations) {
  System& s = *system_;
  const int n = s.samples;
  for (int iteration = 0; iteration < iterations; ++iteration) {
    std::fill_n(s.normal.valuePtr(), s.normal.nonZeros(), 0.0);
    s.gradient.setZero();
    // Close to the data, and smoothly so.
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < kUnknowns; ++k) {
        const int at = i * kUnknowns + k;
        const double weight = k < kPelvis ? kPelvisWeight : 1.0;
        const double smooth = kSmooth * weight * (k < kPelvis ? kPelvisSmooth : 1.0);
        std::array<double, 3> change;
        std::array<int, 3> where;
        for (int d : {0, 1, 2}) {
          const int j = (i + d + n - 1) % n;
          change[d] = unknown(x[j], k) - unknown(problem.wanted[j], k);
          where[d] = j * kUnknowns + k;
        }
        s.at(at, at) += weight;
        s.gradient[at] += weight * change[1];
        constexpr std::array<double, 3> kBend = {1.0, -2.0, 1.0};
        const double bend = change[0] - 2.0 * change[1] + change[2];
        for (int d : {0, 1, 2}) {
          s.gradient[where[d]] += smooth * kBend[d] * bend;
          for (int e = 0; e <= d; ++e) s.at(where[d], where[e]) += smooth * kBend[d] * kBend[e];
        }
      }
    }
    // Feet.
    for (int i = 0; i < n; ++i) {
      const double phase = double(i) / n;
      for (int side : {0, 1}) {
        const LegModel& leg = problem.leg[side];
        const LegFrames frames = leg_frames(leg, x[i], side);
        const double own = fraction(phase - problem.strike[side]);
        const double roll = fraction(problem.toe_off[1 - side] - problem.strike[side]);
        const double support = fraction(problem.toe_off[side] - problem.strike[side]);
        const PointRows heel = point_rows(frames, leg.heel_m), toe = point_rows(frames, leg.toe_m);
        vec3 heel_goal = problem.heel_m[side];
        // A foot in stance at the cycle's end stands on where it came from.
        const double turns = std::floor(problem.strike[side] + own - phase + 0.5);
        heel_goal.z -= problem.stride_m * (problem.time[i] + turns);
        const vec3 toe_goal = heel_goal + leg.toe_m - leg.heel_m;
        const bool rolls = own <= roll, supports = own >= roll && own <= support;
        if (rolls) {
          for (int a = 0; a < 3; ++a) {
            vec3 d(0.0);
            d[a] = 1.0;
            s.add_row(i, side, heel, d, heel.place_m[a] - heel_goal[a], kPlanted);
          }
        } else {
          s.add_floor(i, side, heel, 0.0);
        }
        if (supports) {
          for (int a = 0; a < 3; ++a) {
            vec3 d(0.0);
            d[a] = 1.0;
            s.add_row(i, side, toe, d, toe.place_m[a] - toe_goal[a], kPlanted);
          }
        } else {
          const double u = rolls ? 0.0 : (own - support) / (1.0 - support);
          const double least = leg.toe_rest_m + kToeClearance_m * 16.0 * u * u * (1.0 - u) * (1.0 - u);
          s.add_floor(i, side, toe, least);
        }
        if (rolls || supports) {
          // Level across, pointing ahead.
          const PointRows beside = point_rows(frames, leg.heel_m + vec3(kSide_m, 0.0, 0.0));
          PointRows across = beside, along = toe;
          across.place_m -= heel.place_m;
          along.place_m -= heel.place_m;
          for (int j = 0; j < kLegDofs; ++j) {
            across.by_angle[j] -= heel.by_angle[j];
            along.by_angle[j] -= heel.by_angle[j];
          }
          // These two do not depend on the pelvis: add by hand.
          const int base = i * kUnknowns + leg_unknown(side);
          const double want_x = (leg.toe_m - leg.heel_m).x;
          for (const auto& [point, axis, error] :
               {std::tuple{&across, 1, across.place_m.y}, std::tuple{&along, 0, along.place_m.x - want_x}}) {
            for (int p = 0; p < kLegDofs; ++p) {
              s.gradient[base + p] += kLevel * point->by_angle[p][axis] * error;
              for (int q = 0; q <= p; ++q) {
                s.at(base + p, base + q) += kLevel * point->by_angle[p][axis] * point->by_angle[q][axis];
              }
            }
          }
        }
        const double knee = x[i].leg[side][kKneeX];
        if (knee < kLeastKnee) {
          const int at = i * kUnknowns + leg_unknown(side) + kKneeX;
          s.at(at, at) += kKnee;
          s.gradient[at] += kKnee * (knee - kLeastKnee);
        }
      }
    }
    s.factor.factorize(s.normal);
    const Eigen::VectorXd step = s.factor.solve(s.gradient);
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < kUnknowns; ++k) {
        unknown(x[i], k) -= std::clamp(step[i * kUnknowns + k], -kMostStep, kMostStep);
      }
    }
  }
  return x;
}

}  // namespace gaitpad
