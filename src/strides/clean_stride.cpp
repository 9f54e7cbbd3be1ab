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
constexpr double kSmooth = 150.0;       // of second differences between samples
constexpr double kPelvisSideways = 1000.0;
constexpr double kPelvisSmooth = 500.0;  // times that
constexpr double kPlanted = 2e6, kFloor = 2e5, kKnee = 1e4;  // per square metre, radian
constexpr double kLevel = 2e3;          // the sole is level and points ahead, per square metre
constexpr double kFlat = 2e5;            // the heel of a flat foot, per square metre
// A heel comes to rest and a toe begins to move smoothly: of second differences, per square metre.
constexpr double kSoftStrike = 2e5, kSoftToe = 1e4;
constexpr int kLanding = 3, kToeLanding = 3;  // samples
constexpr double kSide_m = 0.1;         // lever of that
constexpr double kSoftFloor_m = 0.004;
constexpr double kLeastKnee = 2.5 * kDegree, kSoftKnee = 2.0 * kDegree;
constexpr double kToeClearance_m = 0.01;  // in the middle of the flight
constexpr double kMostStep = 0.15;        // radians or metres an iteration

// A row sees the pelvis and one leg.
bool are_coupled(int k, int l) {
  const int low = std::min(k, l), high = std::max(k, l);
  return low < kPelvis || high < kPelvis + kLegDofs || low >= kPelvis + kLegDofs;
}
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
          if (are_coupled(k, l)) add(i * kUnknowns + k, i * kUnknowns + l);
        }
        for (int d : {1, 2}) {
          const int j = (i + d) % n;
          for (int l = 0; l < kUnknowns; ++l) {
            if (are_coupled(k, l)) add(i * kUnknowns + k, j * kUnknowns + l);
          }
        }
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

  // Adds weight * |second difference of the point's place along the path|^2.
  void add_bend(int sample, int side, const std::vector<PointRows>& point,
                const std::vector<double>& path_m, double stride_m, double weight) {
    constexpr std::array<double, 3> kBend = {1.0, -2.0, 1.0};
    for (int axis = 0; axis < 3; ++axis) {
      std::array<double, 3 * (kPelvis + kLegDofs)> row{};
      std::array<int, 3 * (kPelvis + kLegDofs)> where{};
      double error = 0.0;
      int m = 0;
      for (int d : {0, 1, 2}) {
        const int at = sample + d - 1, j = (at + samples) % samples;
        double place = point[j].place_m[axis];
        if (axis == 2) place += path_m[j] + (at < 0 ? -stride_m : at >= samples ? stride_m : 0.0);
        error += kBend[d] * place;
        for (int a = 0; a < kPelvis; ++a, ++m) {
          row[m] = a == axis ? kBend[d] : 0.0;
          where[m] = j * kUnknowns + a;
        }
        for (int k = 0; k < kLegDofs; ++k, ++m) {
          row[m] = kBend[d] * point[j].by_angle[k][axis];
          where[m] = j * kUnknowns + leg_unknown(side) + k;
        }
      }
      for (int p = 0; p < m; ++p) {
        if (row[p] == 0.0) continue;
        gradient[where[p]] += weight * row[p] * error;
        for (int q = 0; q <= p; ++q) {
          if (row[q] != 0.0) at(where[p], where[q]) += weight * row[p] * row[q];
        }
      }
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
        const double smooth = kSmooth * weight * (k == 1 ? kPelvisSmooth : k < kPelvis ? kPelvisSideways : 1.0);
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
    std::vector<double> path_m(n);
    for (int i = 0; i < n; ++i) path_m[i] = problem.stride_m * problem.time[i];
    for (int side : {0, 1}) {
      const LegModel& leg = problem.leg[side];
      std::vector<PointRows> heels, toes;
      for (int i = 0; i < n; ++i) {
        const LegFrames frames = leg_frames(leg, x[i], side);
        heels.push_back(point_rows(frames, leg.heel_m));
        toes.push_back(point_rows(frames, leg.toe_m));
      }
      const int strike = static_cast<int>(std::floor(problem.strike[side] * n + 1e-9)),
                lift = static_cast<int>(std::ceil(problem.toe_off[side] * n - 1e-9)),
                down = static_cast<int>(std::floor(problem.toe_off[1 - side] * n + 1e-9));
      for (int d = -kLanding; d <= 0; ++d) {
        s.add_bend((strike + d + n) % n, side, heels, path_m, problem.stride_m, kSoftStrike);
      }
      for (int d = -kToeLanding; d <= 0; ++d) {
        s.add_bend((lift - d + n) % n, side, toes, path_m, problem.stride_m, kSoftToe);
        s.add_bend((down + d + n) % n, side, toes, path_m, problem.stride_m, kSoftToe);
      }
    }
    for (int i = 0; i < n; ++i) {
      const double phase = double(i) / n;
      for (int side : {0, 1}) {
        const LegModel& leg = problem.leg[side];
        const LegFrames frames = leg_frames(leg, x[i], side);
        // A point stands from the sample before its event to the one after it.
        constexpr double kNear = 1e-9;
        const double sample = (1.0 - kNear) / n;
        const double begins = fraction(phase - problem.strike[side] + sample);
        const double own = begins - sample;
        const double roll = fraction(problem.toe_off[1 - side] - problem.strike[side]);
        const double support = fraction(problem.toe_off[side] - problem.strike[side]);
        const PointRows heel = point_rows(frames, leg.heel_m), toe = point_rows(frames, leg.toe_m);
        vec3 heel_goal = problem.heel_m[side];
        // A foot in stance at the cycle's end stands on where it came from.
        const double turns = std::floor(problem.strike[side] + own - phase + 0.5);
        heel_goal.z -= problem.stride_m * (problem.time[i] + turns);
        const vec3 toe_goal = heel_goal + leg.toe_m - leg.heel_m;
        const bool rolls = own <= roll + sample,
                   supports = own >= roll - sample && own <= support + sample;
        if (rolls) {
          for (int a = 0; a < 3; ++a) {
            vec3 d(0.0);
            d[a] = 1.0;
            s.add_row(i, side, heel, d, heel.place_m[a] - heel_goal[a], kPlanted);
          }
        } else if (own <= problem.flat[side]) {
          s.add_row(i, side, heel, kUp, heel.place_m.y, kFlat);
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
          const double u = rolls ? 0.0 : std::max(0.0, own - support) / (1.0 - support);
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
        const double bend = kLeastKnee - x[i].leg[side][kKneeX];
        if (bend > -kSoftKnee) {
          const int at = i * kUnknowns + leg_unknown(side) + kKneeX;
          const double slope = std::min(1.0, 0.5 * (bend + kSoftKnee) / kSoftKnee);
          s.at(at, at) += kKnee * slope * slope;
          s.gradient[at] -= kKnee * slope * soft_positive(bend, kSoftKnee);
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
