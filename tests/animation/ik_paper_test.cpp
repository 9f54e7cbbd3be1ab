// Steps 1-7 of section 3.3.2 against a second derivation, and the properties that the paper claims.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ik_chains.h"

namespace gaitpad::test {
namespace {

using Real = long double;
using Vector = std::vector<Real>;
using Matrix = std::vector<Vector>;

// Positions of the rows' points by rotation matrices multiplied from the root on.
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

// Gauss elimination of J J^T x = b.
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

// At full rank steps 4 and 5 change nothing, so eq. (5) is all there is.
void second_derivation(const IkChain& c, std::span<const IkRow> rows, Vector& q) {
  const Matrix j = difference_jacobian(c, rows, q);
  const Vector x = gram_solution(j, errors(c, rows, q));
  for (int k = 0; k < c.dofs; ++k) {
    Real step = 0;
    for (std::size_t r = 0; r < rows.size(); ++r) step += j[r][k] * x[r];
    q[k] += c.dof[k].weight * step;
  }
}

// Rows that a pose near q meets.
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

// e' = (I - J W J^+) e: in the norm of (J J^T)^-1 the factor is at most 1 - w_min, plus what the
// linearisation neglects (of the order of the error).
TEST(IkPaper, TheErrorContractsByOneMinusTheLeastWeight) {
  Random random(14);
  for (int trial = 0; trial < 200; ++trial) {
    const IkChain c = random_chain(7, random);
    double least = 1.0;
    for (int j = 0; j < c.dofs; ++j) least = std::min(least, c.dof[j].weight);
    IkAngles q = random_angles(c, random);
    const auto rows = near_goal(c, q, 3, random);
    PaperOptions options;
    options.tolerance_m = 1e-5;
    solve_paper(c, rows, options, q);
    const auto norm = [&](const Matrix& j, const IkAngles& at) {
      const Vector e = errors(c, rows, Vector(at.begin(), at.begin() + c.dofs));
      const Vector x = gram_solution(j, e);
      return std::sqrt(static_cast<double>(e[0] * x[0] + e[1] * x[1] + e[2] * x[2]));
    };
    const Matrix j = difference_jacobian(c, rows, Vector(q.begin(), q.begin() + c.dofs));
    const double before = norm(j, q);
    paper_iteration(c, rows, options, q);
    EXPECT_LE(norm(j, q), (1.0 - least + 0.002) * before) << trial;
  }
}

// Figure 4: a chain of four links in a plane.
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

TEST(IkPaper, TheRootsShareFallsSteadilyWithItsWeight) {
  IkAngles start{};
  for (int j = 0; j < 4; ++j) start[j] = 0.5;
  const vec3 goal_m = end_frame(four_links(1.0), start).position_m + vec3(-0.4, 0.3, 0.0);
  double last = 1e9;
  for (const double w : {1.0, 0.5, 0.2, 0.1, 0.05}) {
    const double root_rad = shares(w, start, goal_m).root_rad;
    EXPECT_LT(root_rad, last) << w;
    last = root_rad;
  }
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

}  // namespace
}  // namespace gaitpad::test
