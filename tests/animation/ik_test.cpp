#include "gaitpad/ik.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "gaitpad/limbs.h"
#include "tests/animation/random.h"

namespace gaitpad::test {
namespace {

// Number of random cases; fewer in an unoptimised build, such as those with sanitizers.
#ifdef __OPTIMIZE__
constexpr int kMany = 100'000;
#else
constexpr int kMany = 20'000;
#endif

const vec3 kHeel(0.0, -0.08, -0.05), kToe(0.0, -0.06, 0.13);  // heel and toe in the ankle's frame
const vec3 kX(1.0, 0.0, 0.0), kY(0.0, 1.0, 0.0), kZ(0.0, 0.0, 1.0);

// A leg with thigh and shank of 0.42 m each and the limits of a human's joints.
IkChain human_leg() {
  const vec3 shaft(0.0, -0.42, 0.0);
  IkChain c;
  const auto add = [&](const vec3& axis, double min_deg, double max_deg, const vec3& link) {
    c.dof[c.dofs++] = {axis, link, min_deg * kDegree, max_deg * kDegree, 1.0};
  };
  add(kX, -120, 30, vec3(0.0)), add(kZ, -45, 45, vec3(0.0)), add(kY, -45, 45, shaft);
  add(kX, 1, 150, shaft);
  add(kX, -38, 50, vec3(0.0)), add(kZ, -30, 30, vec3(0.0)), add(kY, -30, 30, vec3(0.0));
  return c;
}

IkAngles standing() {
  IkAngles q{};
  q[0] = -4.0 * kDegree, q[3] = 8.0 * kDegree, q[4] = -4.0 * kDegree;
  return q;
}

IkAngles random_pose(const IkChain& c, Random& random) {
  IkAngles q{};
  for (int j = 0; j < c.dofs; ++j) q[j] = random.between(c.dof[j].min_rad, c.dof[j].max_rad);
  return q;
}

// A chain with oblique axes, links of 0.2 to 0.6 m, weights of 0.2 to 1, without limits.
IkChain random_chain(int dofs, Random& random) {
  IkChain c;
  c.dofs = dofs;
  for (int j = 0; j < dofs; ++j) {
    c.dof[j].axis = random.direction();
    c.dof[j].link_m = random.direction();
    c.dof[j].link_m *= random.between(0.2, 0.6);
    c.dof[j].weight = random.between(0.2, 1.0);
  }
  return c;
}

IkAngles random_angles(const IkChain& c, Random& random) {
  IkAngles q{};
  for (int j = 0; j < c.dofs; ++j) q[j] = random.between(-1.5, 1.5);
  return q;
}

vec3 point_at(const IkChain& c, const IkAngles& q, const vec3& point_m) {
  const IkFrame f = end_frame(c, q);
  return f.position_m + f.rotation * point_m;
}

double error_of(const IkChain& c, std::span<const IkRow> rows, const IkAngles& q) {
  double squares = 0.0;
  for (const IkRow& row : rows) {
    const double e = row.goal_m - glm::dot(row.direction, point_at(c, q, row.point_m));
    squares += e * e;
  }
  return std::sqrt(squares);
}

bool within_limits(const IkChain& c, const IkAngles& q) {
  for (int j = 0; j < c.dofs; ++j) {
    if (!(q[j] >= c.dof[j].min_rad && q[j] <= c.dof[j].max_rad)) return false;
  }
  return true;
}

TEST(IkRows, APointGoalIsTheHalfJacobianWithThreeRows) {
  const auto rows = point_goal(kHeel, vec3(1.0, 2.0, 3.0));
  ASSERT_EQ(rows.size(), 3u);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(rows[i].goal_m, i + 1.0);
    EXPECT_EQ(rows[i].direction[i], 1.0);
    EXPECT_EQ(rows[i].point_m, kHeel);
  }
}

using Real = long double;
using Vector = std::vector<Real>;
using Matrix = std::vector<Vector>;

// Positions of the rows' points, by rotation matrices that are multiplied from the root on.
Vector row_values(const IkChain& c, std::span<const IkRow> rows, const Vector& q) {
  Matrix m = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vector p = {0, 0, 0};
  const auto add = [&](const vec3& v) {
    Vector out = p;
    for (int i = 0; i < 3; ++i) out[i] += m[i][0] * v.x + m[i][1] * v.y + m[i][2] * v.z;
    return out;
  };
  for (int j = 0; j < c.dofs; ++j) {
    const Real x = c.dof[j].axis.x, y = c.dof[j].axis.y, z = c.dof[j].axis.z;
    const Real s = std::sin(q[j]), k = std::cos(q[j]), v = 1 - k;
    const Matrix r = {{k + x * x * v, x * y * v - z * s, x * z * v + y * s},
                      {y * x * v + z * s, k + y * y * v, y * z * v - x * s},
                      {z * x * v - y * s, z * y * v + x * s, k + z * z * v}};
    Matrix next(3, Vector(3, 0));
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        for (int i = 0; i < 3; ++i) next[a][b] += m[a][i] * r[i][b];
      }
    }
    m = next;
    p = add(c.dof[j].link_m);
  }
  Vector values;
  for (const IkRow& row : rows) {
    const Vector e = add(row.point_m);
    values.push_back(row.direction.x * e[0] + row.direction.y * e[1] + row.direction.z * e[2]);
  }
  return values;
}

Matrix difference_jacobian(const IkChain& c, std::span<const IkRow> rows, const Vector& q) {
  Matrix j(rows.size(), Vector(c.dofs));
  for (int k = 0; k < c.dofs; ++k) {
    constexpr Real kH = 1e-6L;
    Vector more = q, less = q;
    more[k] += kH, less[k] -= kH;
    const Vector a = row_values(c, rows, more), b = row_values(c, rows, less);
    for (std::size_t r = 0; r < rows.size(); ++r) j[r][k] = (a[r] - b[r]) / (2 * kH);
  }
  return j;
}

// Solves J J^T x = b by Gauss elimination.
Vector gram_solution(const Matrix& j, Vector b) {
  const std::size_t n = j.size();
  Matrix a(n, Vector(n, 0));
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t s = 0; s < n; ++s) {
      for (std::size_t k = 0; k < j[r].size(); ++k) a[r][s] += j[r][k] * j[s][k];
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t r = i + 1; r < n; ++r) {
      const Real f = a[r][i] / a[i][i];
      for (std::size_t s = i; s < n; ++s) a[r][s] -= f * a[i][s];
      b[r] -= f * b[i];
    }
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t s = i + 1; s < n; ++s) b[i] -= a[i][s] * b[s];
    b[i] /= a[i][i];
  }
  return b;
}

Vector errors(const IkChain& c, std::span<const IkRow> rows, const Vector& q) {
  Vector e = row_values(c, rows, q);
  for (std::size_t r = 0; r < rows.size(); ++r) e[r] = rows[r].goal_m - e[r];
  return e;
}

// Checks one step of eq. (5). At full rank steps 4 and 5 change nothing, so eq. (5) is the whole
// step.
void second_derivation(const IkChain& c, std::span<const IkRow> rows, Vector& q) {
  const Matrix j = difference_jacobian(c, rows, q);
  const Vector x = gram_solution(j, errors(c, rows, q));
  for (int k = 0; k < c.dofs; ++k) {
    Real step = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) step += j[r][k] * x[r];
    q[k] += c.dof[k].weight * step;
  }
}

// Rows that a pose near q satisfies.
std::vector<IkRow> near_goal(const IkChain& c, const IkAngles& q, int count, Random& random) {
  IkAngles other = q;
  for (int j = 0; j < c.dofs; ++j) other[j] += random.between(-0.05, 0.05);
  std::vector<IkRow> rows;
  for (int r = 0; r < count; ++r) {
    IkRow row{0.2 * random.direction(), random.direction(), 0.0};
    if (count == 3) row.point_m = vec3(0.0), row.direction = r == 0 ? kX : r == 1 ? kY : kZ;
    row.goal_m = glm::dot(row.direction, point_at(c, other, row.point_m));
    rows.push_back(row);
  }
  return rows;
}

TEST(IkPaper, EqualsASecondDerivationIterationByIteration) {
  Random random(11);
  int compared = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const IkChain c = random_chain(6 + trial % 5, random);
    IkAngles q = random_angles(c, random);
    const auto rows = near_goal(c, q, trial % 3 ? 3 : 5, random);
    Vector expected(q.begin(), q.begin() + c.dofs);
    for (int iteration = 0; iteration < 12; ++iteration) {
      const Real error = std::sqrt([&] {
        Real s = 0;
        for (const Real e : errors(c, rows, expected)) s += e * e;
        return s;
      }());
      ASSERT_NEAR(paper_iteration(c, rows, {}, q), static_cast<double>(error), 1e-8) << trial;
      second_derivation(c, rows, expected);
      for (int j = 0; j < c.dofs; ++j) {
        ASSERT_NEAR(q[j], static_cast<double>(expected[j]), 1e-7) << trial << " " << iteration;
        ++compared;
      }
    }
  }
  EXPECT_GT(compared, 20000);
}

TEST(IkPaper, FullRankNeedsNoHalving) {
  Random random(12);
  for (int trial = 0; trial < 300; ++trial) {
    const IkChain c = random_chain(7, random);
    IkAngles q = random_angles(c, random);
    const IkResult result = solve_paper(c, near_goal(c, q, 3, random), {}, q);
    EXPECT_EQ(result.status, IkStatus::converged);
    EXPECT_EQ(result.halvings, 0);
  }
}

// A straight chain with oblique links: J J^T has rank 2, up to round-off.
IkChain straight_chain(const vec3& along) {
  IkChain c;
  for (const vec3& axis : {kX, kZ, kY, kX, kZ}) c.dof[c.dofs++].axis = axis;
  for (const int j : {2, 4}) c.dof[j].link_m = 0.42 * along;
  return c;
}

TEST(IkPaper, RankLossHalvesOrIsFlaggedAndStaysFinite) {
  Random random(13);
  int halved = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const vec3 along = random.direction();
    const IkChain c = straight_chain(along);
    IkAngles q{};
    const auto rows = point_goal(vec3(0.0), (0.84 - 0.1) * along);
    PaperOptions options;
    options.max_iterations = 1;
    const IkResult result = solve_paper(c, rows, options, q);
    halved += result.halvings >= 1;
    EXPECT_LE(result.halvings, options.max_halvings);
    for (int j = 0; j < c.dofs; ++j) EXPECT_TRUE(std::isfinite(q[j]));
  }
  EXPECT_GE(halved, 1);
}

TEST(IkPaper, NoInverseKeepsThePoseAndIsFlagged) {
  IkChain c;  // all axes along z: the z row of J is zero
  c.dofs = 4;
  for (int j = 0; j < 4; ++j) c.dof[j] = {kZ, vec3(0.0, -0.5, 0.0)};
  IkAngles q{};
  q[1] = 0.3;
  const IkAngles before = q;
  const IkResult result = solve_paper(c, point_goal(vec3(0.0), vec3(0.5, -1.5, 0.2)), {}, q);
  EXPECT_EQ(result.status, IkStatus::singular);
  EXPECT_EQ(q, before);
}

TEST(IkPaper, NotFiniteTargetsAndAnglesAreRefused) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    IkAngles q = standing();
    const IkResult goal = solve_paper(human_leg(), point_goal(kHeel, vec3(0.0, bad, 0.0)), {}, q);
    EXPECT_EQ(goal.status, IkStatus::not_finite);
    EXPECT_EQ(q, standing());
    q[3] = bad;
    const IkResult angle = solve_paper(human_leg(), point_goal(kHeel, vec3(0.0)), {}, q);
    EXPECT_EQ(angle.status, IkStatus::not_finite);
  }
}

TEST(IkPaper, OutOfReachEndsAtTheCap) {
  IkAngles q = standing();
  const auto rows = point_goal(kHeel, vec3(0.0, -1.2, 0.0));
  const IkResult result = solve_paper(human_leg(), rows, {}, q);
  EXPECT_NE(result.status, IkStatus::converged);
  EXPECT_LE(result.iterations, PaperOptions{}.max_iterations);
  for (int j = 0; j < 7; ++j) EXPECT_TRUE(std::isfinite(q[j]));
}

// The chain of figure 4: four links in a plane.
IkChain four_links(double root_weight) {
  IkChain c;
  c.dofs = 4;
  for (int j = 0; j < 4; ++j) c.dof[j] = {kZ, vec3(1.0, 0.0, 0.0)};
  c.dof[0].weight = root_weight;
  return c;
}
std::array<IkRow, 2> plane_goal(const vec3& goal_m) {
  return {{{vec3(0.0), kX, goal_m.x}, {vec3(0.0), kY, goal_m.y}}};
}

struct Shares {
  double root_rad = 0.0, others_rad = 0.0;
};
Shares shares(double root_weight, const IkAngles& start, const vec3& goal_m) {
  PaperOptions options;
  IkAngles q = start;
  const auto result = solve_paper(four_links(root_weight), plane_goal(goal_m), options, q);
  EXPECT_EQ(result.status, IkStatus::converged);
  Shares s;
  s.root_rad = std::abs(q[0] - start[0]);
  for (int j = 1; j < 4; ++j) s.others_rad += std::abs(q[j] - start[j]);
  return s;
}

TEST(IkPaper, AStifferRootMovesLessAndTheOthersMakeUpForIt) {
  Random random(15);
  constexpr int kGoals = 1000;
  int root_less = 0, others_more = 0;
  for (int trial = 0; trial < kGoals; ++trial) {
    IkAngles start{};
    for (int j = 0; j < 4; ++j) start[j] = random.between(0.5, 1.2);
    vec3 offset(0.0);
    for (int i = 0; i < 2; ++i) offset[i] = random.between(-0.6, 0.6);
    const vec3 goal_m = end_frame(four_links(1.0), start).position_m + offset;
    const Shares even = shares(1.0, start, goal_m), stiff = shares(0.2, start, goal_m);
    root_less += stiff.root_rad < even.root_rad;
    others_more += stiff.others_rad > even.others_rad;
  }
  EXPECT_GE(root_less, kGoals * 99 / 100);
  EXPECT_GE(others_more, kGoals * 80 / 100);
}

TEST(IkPaper, EvenWeightsOnlyCostIterations) {
  IkAngles start{};
  for (int j = 0; j < 4; ++j) start[j] = 0.5;
  const vec3 goal_m = end_frame(four_links(1.0), start).position_m + vec3(-0.1, 0.1, 0.0);
  int iterations = 0;
  for (const double w : {1.0, 0.5, 0.25, 0.125}) {
    IkChain c = four_links(w);
    for (int j = 0; j < 4; ++j) c.dof[j].weight = w;
    IkAngles q = start;
    const IkResult result = solve_paper(c, plane_goal(goal_m), {}, q);
    EXPECT_EQ(result.status, IkStatus::converged);
    EXPECT_LT(glm::length(end_frame(c, q).position_m - goal_m), 1e-4);
    EXPECT_GE(result.iterations, iterations * 3 / 2);
    iterations = result.iterations;
  }
}

TEST(IkPaper, TheTraceHoldsTheStartEachIterationAndTheAnswer) {
  const IkChain c = human_leg();
  IkAngles q = standing();
  std::array<IkAngles, 50> poses;
  std::array<double, 50> error_m;
  IkTrace trace{poses, error_m};
  const auto rows = point_goal(kHeel, vec3(0.05, -0.8, 0.2));
  const IkResult result = solve_paper(c, rows, {}, q, &trace);
  ASSERT_EQ(trace.rows, result.iterations + 1);
  EXPECT_EQ(poses[0], standing());
  EXPECT_EQ(poses[static_cast<std::size_t>(result.iterations)], q);
  IkAngles step = standing();
  for (int k = 0; k < trace.rows; ++k) {
    EXPECT_EQ(poses[static_cast<std::size_t>(k)], step);
    paper_iteration(c, rows, {}, step);
  }
}

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Counts of cold starts: how many fail, fail without being flagged, or exceed the limits.
struct ColdStarts {
  int failed = 0, unflagged = 0, outside = 0;
  void solve(const IkChain& c, std::span<const IkRow> rows) {
    IkAngles q = standing();
    const IkResult result = solve_robust(c, rows, {}, q);
    const bool reached = error_of(c, rows, q) <= 1.01e-6;
    failed += !reached;
    unflagged += !reached && result.status == IkStatus::converged;
    outside += !within_limits(c, q);
  }
  void expect_rare_failures(int count) const {
    EXPECT_LT(failed, count / 1000);
    EXPECT_EQ(unflagged, 0);
    EXPECT_EQ(outside, 0);
    testing::Test::RecordProperty("failed", failed);
  }
};

TEST(IkRobust, ColdStartsFailRarelyAndEachIsFlagged) {
  Random random(21);
  const IkChain c = human_leg();
  ColdStarts starts;
  for (int i = 0; i < kMany; ++i) {
    const vec3& point_m = i % 2 ? kHeel : kToe;
    const auto rows = point_goal(point_m, point_at(c, random_pose(c, random), point_m));
    starts.solve(c, rows);
  }
  starts.expect_rare_failures(kMany);
}

// Heel and toe together, as in the roll stage: five rows.
TEST(IkRobust, ColdStartsWithFiveRowsFailRarelyAndEachIsFlagged) {
  Random random(22);
  const IkChain c = human_leg();
  const int count = kMany / 5;
  ColdStarts starts;
  for (int i = 0; i < count; ++i) {
    const IkAngles pose = random_pose(c, random);
    const auto heel = point_goal(kHeel, point_at(c, pose, kHeel));
    const vec3 toe_m = point_at(c, pose, kToe);
    const std::array<IkRow, 5> rows = {heel[0], heel[1], heel[2], IkRow{kToe, kY, toe_m.y},
                                       IkRow{kToe, kX, toe_m.x}};
    starts.solve(c, rows);
  }
  starts.expect_rare_failures(count);
}

// Places of a heel relative to the hip, 1 to 4 cm apart, along strides drawn at random.
class GaitPath {
 public:
  explicit GaitPath(Random& random) : random_(random) { draw(); }
  // The next place; it is at most `reach_m` from the hip.
  vec3 next(double reach_m) {
    if (phase_ > 6.0 * kPi) draw();
    const double faster = std::hypot(0.5 * stride_m_ * std::sin(phase_),
                                     std::sin(phase_) > 0.0 ? lift_m_ * std::cos(phase_) : 0.0);
    phase_ += std::min(step_m_ / std::max(faster, 1e-3), 0.15);
    const vec3 p(side_m_ + 0.02 * std::sin(phase_),
                 -height_m_ + lift_m_ * std::max(std::sin(phase_), 0.0),
                 -0.5 * stride_m_ * std::cos(phase_));
    return p * std::min(1.0, reach_m / glm::length(p));
  }
  bool fresh() const { return phase_ < 0.2; }

 private:
  void draw() {
    phase_ = 0.0;
    stride_m_ = random_.between(0.3, 0.75), lift_m_ = random_.between(0.03, 0.2);
    height_m_ = random_.between(0.84, 0.93), side_m_ = random_.between(-0.08, 0.08);
    step_m_ = random_.between(0.01, 0.04);
  }
  Random& random_;
  double phase_, stride_m_, lift_m_, height_m_, side_m_, step_m_;
};

TEST(IkRobust, TargetsAlongGaitLikePathsAllConverge) {
  Random random(23);
  IkChain c = human_leg();
  for (const double hip_weight : {1.0, 0.2}) {
    for (int j = 0; j < 3; ++j) c.dof[j].weight = hip_weight;
    const double reach_m = 0.84 + glm::length(kHeel);
    GaitPath path(random);
    IkAngles q = standing();
    long iterations = 0;
    int failed = 0, outside = 0, jumped = 0;
    const int count = kMany / 2;
    for (int i = 0; i < count; ++i) {
      const auto rows = point_goal(kHeel, path.next(0.995 * reach_m));
      if (path.fresh()) q = standing();
      const IkResult result = solve_robust(c, rows, {}, q);
      failed += result.status != IkStatus::converged || !(error_of(c, rows, q) <= 1.01e-6);
      outside += !within_limits(c, q);
      jumped += result.tries > 1;
      iterations += result.iterations;
    }
    EXPECT_EQ(failed, 0);
    EXPECT_EQ(outside, 0);
    EXPECT_EQ(jumped, 0);
    EXPECT_LT(static_cast<double>(iterations) / count, 4.0);
    RecordProperty("iterations", static_cast<int>(iterations));
  }
}

TEST(IkRobust, ASlightlyMovedGoalMovesTheAnswerSlightly) {
  Random random(24);
  const IkChain c = human_leg();
  int large = 0;
  for (int i = 0; i < 20000; ++i) {
    IkAngles start = random_pose(c, random);
    start[3] = random.between(5.0, 120.0) * kDegree;
    const vec3 goal_m = point_at(c, start, kHeel) + 0.03 * random.direction();
    IkAngles a = start, b = start;
    RobustOptions options;
    options.max_tries = 1;
    options.tolerance_m = 1e-9;
    const IkResult first = solve_robust(c, point_goal(kHeel, goal_m), options, a);
    const IkResult second =
        solve_robust(c, point_goal(kHeel, goal_m + 1e-6 * random.direction()), options, b);
    if (first.status != IkStatus::converged || second.status != IkStatus::converged) continue;
    double greatest = 0.0;
    for (int j = 0; j < c.dofs; ++j) greatest = std::max(greatest, std::abs(a[j] - b[j]));
    large += greatest > 1e-4;
  }
  EXPECT_LE(large, 20);
}

TEST(IkRobust, WeightsCountOnlyRelativeToEachOther) {
  Random random(25);
  for (int trial = 0; trial < 200; ++trial) {
    IkChain c = random_chain(7, random), halved = c, tenth = c;
    for (int j = 0; j < c.dofs; ++j) halved.dof[j].weight *= 0.5, tenth.dof[j].weight *= 0.1;
    const IkAngles start = random_angles(c, random);
    const auto rows =
        point_goal(vec3(0.0), end_frame(c, start).position_m + 0.05 * random.direction());
    IkAngles a = start, b = start, d = start;
    solve_robust(c, rows, {}, a);
    solve_robust(halved, rows, {}, b);
    solve_robust(tenth, rows, {}, d);
    EXPECT_EQ(a, b);
    for (int j = 0; j < c.dofs; ++j) EXPECT_NEAR(a[j], d[j], 1e-9);
  }
}

TEST(IkRobust, SmallerWeightTurnsThatJointLessAndZeroLocksIt) {
  Random random(26);
  for (int trial = 0; trial < 200; ++trial) {
    const IkChain even = human_leg();
    IkAngles start = standing();
    start[kKneeX] = 0.6, start[kAnkleX] = 0.3;
    const auto rows = point_goal(kHeel, point_at(even, start, kHeel) + 0.01 * random.direction());
    double last = 1e9;
    for (const double w : {1.0, 0.5, 0.2, 0.05, 0.0}) {
      IkChain c = even;
      c.dof[kHipX].weight = w;
      IkAngles q = start;
      EXPECT_EQ(solve_robust(c, rows, {}, q).status, IkStatus::converged);
      const double moved = std::abs(q[kHipX] - start[kHipX]);
      EXPECT_LT(moved, last + 1e-3);
      last = moved;
    }
    EXPECT_EQ(last, 0.0);
  }
}

// A chain without redundancy: hip x, hip z and knee move the ankle. The pose is the same for every
// W.
TEST(IkRobust, WeightsChangeNothingOnAChainWithoutRedundancy) {
  IkChain c;
  c.dofs = 3;
  c.dof[0] = {kZ, vec3(0.0)};
  c.dof[1] = {kX, vec3(0.0, -0.42, 0.0)};
  c.dof[2] = {kX, vec3(0.0, -0.42, 0.0), 1.0 * kDegree, 150.0 * kDegree};
  IkAngles even{}, stiff{};
  even[2] = stiff[2] = 0.3;
  const auto rows = point_goal(vec3(0.0), vec3(0.05, -0.75, 0.2));
  solve_robust(c, rows, {}, even);
  c.dof[1].weight = 0.1;
  solve_robust(c, rows, {}, stiff);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(even[j], stiff[j], 1e-5);
}

TEST(IkRobust, OutOfReachIsFlaggedAndStretchesTowardsTheGoal) {
  Random random(27);
  const IkChain c = human_leg();
  for (int trial = 0; trial < 2000; ++trial) {
    const double far = trial % 2 ? random.between(0.96, 1.5) : random.between(2.0, 1e6);
    const vec3 direction = glm::normalize(vec3(0.0, -1.0, 0.0) + 0.3 * random.direction());
    const auto rows = point_goal(kHeel, far * direction);
    IkAngles q = standing();
    const IkResult result = solve_robust(c, rows, {}, q);
    ASSERT_EQ(result.status, IkStatus::unreachable);
    ASSERT_TRUE(within_limits(c, q));
    ASSERT_NEAR(result.error_m, error_of(c, rows, q), 1e-9 * far);
    if (trial % 2) {
      EXPECT_LT(result.error_m, far - (0.84 + glm::length(kHeel)) + 0.02);
    }
  }
}

TEST(IkRobust, AGoalThatWandersOutOfReachIsFollowedWithoutAJerk) {
  const IkChain c = human_leg();
  RobustOptions options;
  options.max_tries = 1;
  IkAngles q = standing(), last = q;
  IkAngles step{};
  for (int tick = 0; tick < 2400; ++tick) {
    const double sway = sin_cos(2.0 * kPi * tick / 240.0).sin;
    solve_robust(c, point_goal(kHeel, vec3(0.0, -0.96, 0.3 * sway)), options, q);
    for (int j = 0; j < c.dofs; ++j) {
      const double change = q[j] - last[j];
      if (tick > 20) {
        ASSERT_LT(std::abs(change - step[j]), 0.5 * kDegree) << tick;
      }
      step[j] = change;
    }
    last = q;
  }
}

TEST(IkRobust, NotFiniteInputsLeaveTheAnglesUntouched) {
  for (const double bad : {std::nan(""), kInfinity, -kInfinity, 1e200}) {
    const IkChain c = human_leg();
    IkAngles q = standing();
    q[0] = 2.0;  // outside the limits; the start stays unchanged
    const IkAngles before = q;
    const IkResult result = solve_robust(c, point_goal(kHeel, vec3(0.0, bad, 0.1)), {}, q);
    EXPECT_EQ(result.status, IkStatus::not_finite);
    EXPECT_EQ(q, before);
  }
  for (const double bad : {std::nan(""), kInfinity}) {
    const auto rows = point_goal(kHeel, vec3(0.0, -0.8, 0.1));
    IkAngles q = standing();
    q[4] = bad;
    EXPECT_EQ(solve_robust(human_leg(), rows, {}, q).status, IkStatus::not_finite);
    for (int what = 0; what < 4; ++what) {
      IkChain c = human_leg();
      if (what == 0) c.dof[2].link_m.y = bad;
      if (what == 1) c.dof[3].weight = bad;
      if (what == 2) c.dof[3].axis.x = bad;
      if (what == 3) c.dof[3].min_rad = bad;
      q = standing();
      EXPECT_EQ(solve_robust(c, rows, {}, q).status, IkStatus::not_finite) << what;
      EXPECT_EQ(q, standing());
    }
  }
}

// Chains and rows beyond kMaxIkDofs and kMaxIkRows have no room in the arrays.
TEST(IkChecks, MoreDofsOrRowsThanThereIsRoomForAreRefused) {
  const auto three = point_goal(kHeel, vec3(0.0, -0.7, 0.1));
  const std::vector<IkRow> seven(kMaxIkRows + 1, three[0]);
  for (const int dofs : {-1, kMaxIkDofs + 1, 1 << 30, 7}) {
    IkChain c = human_leg();
    c.dofs = dofs;
    const std::span<const IkRow> rows = dofs == 7 ? std::span<const IkRow>(seven) : three;
    IkAngles q = standing();
    EXPECT_EQ(solve_paper(c, rows, {}, q).status, IkStatus::not_finite) << dofs;
    EXPECT_EQ(solve_robust(c, rows, {}, q).status, IkStatus::not_finite) << dofs;
    EXPECT_EQ(paper_iteration(c, rows, {}, q), kInfinity) << dofs;
    EXPECT_EQ(q, standing());
  }
}

TEST(IkChecks, AChainThatIsNoneIsNamedByItsField) {
  const auto said_of = [](const auto& spoil) {
    IkChain c = human_leg();
    spoil(c);
    const auto problem = check(c);
    return problem ? problem->message : "";
  };
  using Chain = IkChain;
  EXPECT_EQ(said_of([](Chain&) {}), "");
  EXPECT_EQ(said_of([](Chain& c) { c.dof[1].min_rad = -kInfinity; }), "");
  EXPECT_EQ(said_of([](Chain& c) { c.dofs = 17; }), "IkChain: dofs is 17, outside [1, 16]");
  EXPECT_EQ(said_of([](Chain& c) { c.dofs = 0; }), "IkChain: dofs is 0, outside [1, 16]");
  EXPECT_EQ(said_of([](Chain& c) { c.dof[2].weight = std::nan(""); }),
            "IkChain: dof[2].weight is nan, outside [0, 1]");
  EXPECT_EQ(said_of([](Chain& c) { c.dof[2].link_m.y = kInfinity; }),
            "IkChain: dof[2].link_m.y is inf, outside [-1e+06, 1e+06]");
  EXPECT_EQ(said_of([](Chain& c) { c.dof[0].axis *= 2.0; }),
            "IkChain: dof[0].axis, its length, is 2, outside [0.999999, 1]");
  EXPECT_EQ(said_of([](Chain& c) { c.dof[3].min_rad = std::nan(""); }),
            "IkChain: dof[3].min_rad is nan, outside [-inf, inf]");
  EXPECT_EQ(said_of([](Chain& c) { c.dof[3].min_rad = 1.5, c.dof[3].max_rad = 1.0; }),
            "IkChain: dof[3].max_rad is 1, outside [1.5, inf]");
}

TEST(IkChecks, RowsThatAreNoneAreNamedByTheirField) {
  const auto said_of = [](const auto& spoil) {
    const auto three = point_goal(kHeel, vec3(0.0, -0.7, 0.1));
    std::vector<IkRow> rows(three.begin(), three.end());
    spoil(rows);
    const auto problem = check(std::span<const IkRow>(rows));
    return problem ? problem->message : "";
  };
  using Rows = std::vector<IkRow>;
  EXPECT_EQ(said_of([](Rows&) {}), "");
  EXPECT_EQ(said_of([](Rows& r) { r.clear(); }), "the number of IkRow is 0, outside [1, 6]");
  EXPECT_EQ(said_of([](Rows& r) { r.resize(7); }), "the number of IkRow is 7, outside [1, 6]");
  EXPECT_EQ(said_of([](Rows& r) { r[1].goal_m = std::nan(""); }),
            "IkRow 1: goal_m is nan, outside [-1e+06, 1e+06]");
  EXPECT_EQ(said_of([](Rows& r) { r[2].point_m.x = 1e7; }),
            "IkRow 2: point_m.x is 1e+07, outside [-1e+06, 1e+06]");
  EXPECT_EQ(said_of([](Rows& r) { r[0].direction *= 0.5; }),
            "IkRow 0: direction, its length, is 0.5, outside [0.999999, 1]");
}

TEST(IkRobust, AnglesOutsideTheirLimitsComeBackInside) {
  Random random(28);
  const IkChain c = human_leg();
  for (int trial = 0; trial < 2000; ++trial) {
    IkAngles q{};
    for (int j = 0; j < c.dofs; ++j) q[j] = random.between(-4.0, 4.0);
    const double far_m = random.between(0.1, 2.0);
    const auto rows = point_goal(kHeel, far_m * random.direction());
    solve_robust(c, rows, {}, q);
    ASSERT_TRUE(within_limits(c, q));
  }
}

TEST(IkRobust, AFrozenKneeLeavesTheStepToTheOthersAndComesBack) {
  const IkChain c = human_leg();
  IkAngles q = standing();
  q[3] = c.dof[3].min_rad;
  const vec3 there = point_at(c, q, kHeel) + vec3(0.0, 0.0, 0.08);
  EXPECT_EQ(solve_robust(c, point_goal(kHeel, there), {}, q).status, IkStatus::converged);
  const vec3 up = point_at(c, q, kHeel) + vec3(0.0, 0.1, 0.0);
  EXPECT_EQ(solve_robust(c, point_goal(kHeel, up), {}, q).status, IkStatus::converged);
  EXPECT_GT(q[3], 10.0 * kDegree);
}

TEST(IkRobust, TheTraceEndsWithTheAnswerAndItsErrorsDoNotRiseWithinATry) {
  const IkChain c = human_leg();
  std::array<IkAngles, 200> poses;
  std::array<double, 200> error_m;
  IkTrace trace{poses, error_m};
  IkAngles q = standing();
  const IkResult result = solve_robust(c, point_goal(kHeel, vec3(0.05, -0.6, 0.4)), {}, q, &trace);
  ASSERT_EQ(result.tries, 1);
  ASSERT_EQ(trace.rows, result.iterations + 1);
  EXPECT_EQ(poses[static_cast<std::size_t>(result.iterations)], q);
  for (int k = 1; k < trace.rows; ++k) {
    EXPECT_LE(error_m[static_cast<std::size_t>(k)], error_m[static_cast<std::size_t>(k - 1)]);
  }
}

}  // namespace
}  // namespace gaitpad::test
