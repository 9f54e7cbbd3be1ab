#include "gaitpad/ik.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ik_chains.h"

namespace gaitpad::test {
namespace {

TEST(IkJacobian, ColumnsEqualCentralDifferences) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const IkChain c = trial % 2 ? human_leg() : random_chain(3 + trial % 14, random);
    const IkAngles q = random_angles(c, random);
    std::array<IkRow, kMaxIkRows> rows;
    for (IkRow& row : rows) row = {0.2 * random.direction(), random.direction(), 0.3};
    IkJacobian jacobian;
    std::array<double, kMaxIkRows> error_m;
    position_jacobian(c, rows, q, jacobian, error_m);
    for (int j = 0; j < c.dofs; ++j) {
      constexpr double kH = 1e-6;
      IkAngles more = q, less = q;
      more[j] += kH, less[j] -= kH;
      for (int r = 0; r < kMaxIkRows; ++r) {
        const vec3 change =
            (point_at(c, more, rows[r].point_m) - point_at(c, less, rows[r].point_m)) / (2.0 * kH);
        EXPECT_NEAR(jacobian[r][j], glm::dot(rows[r].direction, change), 1e-6);
      }
    }
    for (int r = 0; r < kMaxIkRows; ++r) {
      EXPECT_NEAR(error_m[r], 0.3 - glm::dot(rows[r].direction, point_at(c, q, rows[r].point_m)),
                  1e-12);
    }
  }
}

TEST(IkChain, EndFrameEqualsAProductOfQuaternions) {
  Random random(2);
  for (int trial = 0; trial < 200; ++trial) {
    const IkChain c = trial % 2 ? human_leg() : random_chain(16, random);
    const IkAngles q = random_angles(c, random);
    quat rotation = kIdentity;
    vec3 position(0.0);
    for (int j = 0; j < c.dofs; ++j) {
      const vec3 v = c.dof[j].axis * std::sin(0.5 * q[j]);
      rotation = rotation * quat(std::cos(0.5 * q[j]), v.x, v.y, v.z);
      position += rotation * c.dof[j].link_m;
    }
    const IkFrame f = end_frame(c, q);
    EXPECT_LT(glm::length(f.position_m - position), 1e-12);
    EXPECT_NEAR(std::abs(glm::dot(f.rotation, rotation)), 1.0, 1e-12);
  }
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

}  // namespace
}  // namespace gaitpad::test
