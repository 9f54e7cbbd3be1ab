#include "gaitpad/terrain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gaitpad {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kSole_m = 0.25;

Terrain terrain_of(const std::vector<SectionShape>& shapes) {
  Terrain terrain;
  for (const SectionShape& shape : shapes) {
    const auto problem = add_section(terrain, shape);
    EXPECT_FALSE(problem) << problem->message;
  }
  return terrain;
}

std::string refusal(const SectionShape& shape) {
  Terrain terrain;
  const auto problem = add_section(terrain, shape);
  EXPECT_EQ(terrain.sections.size(), problem ? 0u : 1u);
  return problem ? problem->message : "";
}

// Hills of 6 cm, metres apart, as a picture of heights may have them.
FieldSection field_section(double metres_per_sample) {
  auto field = std::make_shared<HeightField>();
  field->columns = 40, field->rows = 60;
  for (int r = 0; r < field->rows; ++r) {
    for (int c = 0; c < field->columns; ++c) {
      const double x = c * 0.1, z = r * 0.1;
      field->height_m.push_back(
          static_cast<float>(0.03 * std::sin(1.3 * x) * std::cos(1.1 * z + 0.6 * x)));
    }
  }
  FieldSection section;
  section.field = field, section.pixel_m = metres_per_sample;
  section.length_m = 59.0 * metres_per_sample, section.fade_m = 15.0 * metres_per_sample;
  return section;
}

Terrain everything() {
  return terrain_of({FlatSection{2.0}, SlopeSection{4.0, 0.12, 0.6}, FlatSection{1.0},
                     SlopeSection{4.0, -0.2, 0.8}, StairsSection{0.17, 0.28, 5}, FlatSection{1.0},
                     StairsSection{-0.17, 0.28, 5}, rough_section(9.0, 0.06, 2.0, 3.0, 7),
                     field_section(0.1)});
}

TEST(Terrain, FlatGroundIsLevelEverywhere) {
  const Terrain flat = terrain_of({FlatSection{3.0}, FlatSection{2.0}});
  EXPECT_TRUE(is_flat(flat));
  EXPECT_TRUE(is_flat(*flat_terrain()));
  EXPECT_EQ(length_m(flat), 5.0);
  EXPECT_EQ(least_tread_m(flat), kInfinity);
  for (const double z : {-100.0, 0.0, 2.9, 3.0, 7.0, 1e9, kInfinity, kNaN}) {
    const Ground ground = ground_at(flat, kNaN, z);
    EXPECT_EQ(ground.height_m, 0.0);
    EXPECT_EQ(ground.normal, kUp);
    EXPECT_EQ(ground.piece, 0);
  }
  EXPECT_FALSE(is_flat(everything()));
}

TEST(Terrain, AnyPlaceHasAGround) {
  const Terrain terrain = everything();
  for (const double x : {0.0, -1e30, 1e30, kInfinity, -kInfinity, kNaN}) {
    for (const double z : {-1e30, 0.0, 3.0, 13.0, 18.0, 24.0, 1e30, kInfinity, -kInfinity, kNaN}) {
      const Ground ground = ground_at(terrain, x, z);
      EXPECT_TRUE(std::abs(ground.height_m) < 2.0) << x << " " << z;
      EXPECT_NEAR(glm::length(ground.normal), 1.0, 1e-12) << x << " " << z;
      EXPECT_GT(ground.normal.y, 0.8);
    }
  }
}

TEST(Terrain, ASlopeClimbsByItsGradeBetweenRoundings) {
  const Terrain terrain = terrain_of({FlatSection{1.0}, SlopeSection{5.0, 0.2, 1.0}});
  EXPECT_NEAR(ground_at(terrain, 3.0, 4.0).height_m - ground_at(terrain, -3.0, 3.0).height_m, 0.2,
              1e-12);
  const double g = 0.2 / std::sqrt(1.0 + 0.04);
  EXPECT_NEAR(ground_at(terrain, 0.0, 3.5).normal.z, -g, 1e-12);
  // Half-way into the section.
  EXPECT_NEAR(ground_at(terrain, 0.0, 1.5).normal.z, -0.1 / std::sqrt(1.01), 1e-12);
  EXPECT_NEAR(ground_at(terrain, 0.0, 6.0).height_m, 0.2 * 4.0, 1e-12);
  EXPECT_EQ(ground_at(terrain, 0.0, 99.0).height_m, ground_at(terrain, 0.0, 6.0).height_m);
  EXPECT_EQ(ground_at(terrain, 0.0, 99.0).normal, kUp);
}

TEST(Terrain, TheUpperTreadOwnsTheLineOfARiser) {
  const Terrain up = terrain_of({FlatSection{1.0}, StairsSection{0.17, 0.28, 3}});
  EXPECT_EQ(ground_at(up, 0.0, 0.999).piece, 0);
  EXPECT_EQ(ground_at(up, 0.0, 1.0).height_m, 0.17);
  EXPECT_EQ(ground_at(up, 0.0, 1.0).piece, 1);
  EXPECT_EQ(ground_at(up, 0.0, 1.5).piece, 2);
  EXPECT_NEAR(ground_at(up, 0.0, 50.0).height_m, 0.51, 1e-12);
  EXPECT_EQ(ground_at(up, 0.0, 50.0).piece, 3);
  const Terrain down = terrain_of({FlatSection{1.0}, StairsSection{-0.17, 0.28, 3}});
  EXPECT_EQ(ground_at(down, 0.0, 1.0).height_m, 0.0);
  EXPECT_EQ(ground_at(down, 0.0, 1.0).piece, 0);
  EXPECT_EQ(ground_at(down, 0.0, 1.001).height_m, -0.17);
  EXPECT_EQ(ground_at(down, 0.0, 1.001).piece, 1);
  EXPECT_EQ(ground_at(down, 0.0, 1.001).normal, kUp);
}

TEST(Terrain, EveryRiserBeginsANewPieceAndNothingElseDoes) {
  const Terrain terrain = everything();
  Ground before = ground_at(terrain, 0.0, -1.0);
  int risers = 0;
  for (double z = -1.0; z < length_m(terrain) + 1.0; z += 1e-3) {
    const Ground ground = ground_at(terrain, 0.4, z);
    const double step_m = std::abs(ground.height_m - before.height_m);
    if (ground.piece != before.piece) {
      EXPECT_EQ(ground.piece, before.piece + 1);
      EXPECT_NEAR(step_m, 0.17, 1e-9);
      ++risers;
    } else {
      EXPECT_LT(step_m, kMaxGrade * 1.001e-3);
      EXPECT_LT(glm::distance(ground.normal, before.normal), kMaxBend_1_m * 1.1e-3 + 1e-9) << z;
    }
    before = ground;
  }
  EXPECT_EQ(risers, 10);
}

TEST(Terrain, PieceAtTellsTheRisersAroundAPlace) {
  const Terrain terrain =
      terrain_of({FlatSection{1.0}, StairsSection{0.17, 0.3, 2}, StairsSection{-0.17, 0.25, 2}});
  EXPECT_EQ(piece_at(terrain, 0.5).from_m, -kInfinity);
  EXPECT_EQ(piece_at(terrain, 0.5).to_m, 1.0);
  EXPECT_EQ(piece_at(terrain, 1.0).from_m, 1.0);
  EXPECT_NEAR(piece_at(terrain, 1.0).to_m, 1.3, 1e-12);
  // The upper tread begins at the line itself.
  EXPECT_NEAR(piece_at(terrain, 1.6).from_m, 1.3, 1e-12);
  EXPECT_NEAR(piece_at(terrain, 9.0).from_m, 1.85, 1e-12);
  EXPECT_EQ(piece_at(terrain, 9.0).to_m, kInfinity);
  EXPECT_NEAR(least_tread_m(terrain), 0.25, 1e-12);
  for (double z = 0.5; z < 2.5; z += 0.0071) {
    const Stretch stretch = piece_at(terrain, z);
    const int piece = ground_at(terrain, 0.0, z).piece;
    for (const double edge_m : {stretch.from_m, stretch.to_m}) {
      if (std::isinf(edge_m)) continue;
      const double inside = edge_m + (edge_m < z ? 1e-9 : -1e-9);
      EXPECT_EQ(ground_at(terrain, 0.0, inside).piece, piece);
      EXPECT_NE(ground_at(terrain, 0.0, 2.0 * edge_m - inside).piece, piece);
    }
  }
}

TEST(Terrain, NormalsAreThoseOfTheHeights) {
  const Terrain terrain = everything();
  constexpr double kStep_m = 1e-5;
  for (double z = 0.013; z < length_m(terrain); z += 0.0371) {
    for (const double x : {-3.3, -0.4, 0.0, 0.77, 5.1}) {
      const Ground at = ground_at(terrain, x, z);
      const Ground far = ground_at(terrain, x, z + kStep_m),
                   near = ground_at(terrain, x, z - kStep_m);
      if (far.piece != near.piece) continue;
      const double dz = (far.height_m - near.height_m) / (2.0 * kStep_m);
      const double dx = (ground_at(terrain, x + kStep_m, z).height_m -
                         ground_at(terrain, x - kStep_m, z).height_m) /
                        (2.0 * kStep_m);
      EXPECT_LT(glm::distance(at.normal, glm::normalize(vec3(-dx, 1.0, -dz))), 2e-5)
          << x << " " << z;
    }
  }
}

// Largest gap between the ground and the middle of a straight sole whose heel and toe are on the
// ground, in any direction.
double worst_gap_m(const Terrain& terrain, double sole_m) {
  double worst = 0.0;
  for (double z = 0.0; z < length_m(terrain); z += 0.023) {
    for (int turn = 0; turn < 8; ++turn) {
      const double dx = std::sin(turn * kPi / 8.0) * sole_m,
                   dz = std::cos(turn * kPi / 8.0) * sole_m;
      const double x = std::fmod(z * 3.7, 8.0) - 4.0;
      const Ground heel = ground_at(terrain, x, z), toe = ground_at(terrain, x + dx, z + dz);
      if (heel.piece != toe.piece) continue;
      for (const double share : {0.25, 0.5, 0.75}) {
        const double sole = heel.height_m + share * (toe.height_m - heel.height_m);
        worst = std::max(
            worst, std::abs(ground_at(terrain, x + share * dx, z + share * dz).height_m - sole));
      }
    }
  }
  return worst;
}

TEST(Terrain, ASoleLiesOnItWithinFourMillimetres) {
  EXPECT_LE(worst_gap_m(everything(), kSole_m), 0.004);
  // A slope at the bound reaches the limit exactly, so the bound is tight.
  const Terrain bent = terrain_of({SlopeSection{2.0, 0.512 * 0.6, 0.6}});
  EXPECT_NEAR(worst_gap_m(bent, kSole_m), 0.004, 5e-5);
}

TEST(Terrain, RoughGroundKeepsItsAmplitudeAndItsSeed) {
  const auto rough = [](std::uint32_t seed) {
    return terrain_of({rough_section(40.0, 0.08, 2.0, 3.0, seed)});
  };
  const Terrain a = rough(1), same = rough(1), other = rough(2);
  double highest = 0.0, difference = 0.0;
  for (double z = 0.0; z < 40.0; z += 0.05) {
    const double height = ground_at(a, z, z).height_m;
    EXPECT_EQ(height, ground_at(same, z, z).height_m);
    highest = std::max(highest, std::abs(height));
    difference = std::max(difference, std::abs(height - ground_at(other, z, z).height_m));
  }
  EXPECT_LE(highest, 0.08);
  EXPECT_GT(highest, 0.03);
  EXPECT_GT(difference, 0.02);
  for (const double x : {-7.0, 0.0, 3.0}) {
    EXPECT_NEAR(ground_at(a, x, 0.0).height_m, 0.0, 1e-12);
    EXPECT_NEAR(ground_at(a, x, 40.0).height_m, 0.0, 1e-12);
  }
}

TEST(Terrain, AHeightFieldIsItsSamplesAndLevelBeyondThem) {
  const FieldSection section = field_section(0.1);
  const Terrain terrain = terrain_of({section});
  // Beyond the fade the samples have their full height; a B-spline averages each with its
  // neighbours.
  for (int c = 15; c < 25; ++c) {
    const double x = (0.5 * 39 - c) * 0.1;
    EXPECT_NEAR(ground_at(terrain, x, 3.0).height_m, section.field->height_m[30 * 40 + c], 3e-4);
  }
  for (const double beyond_m : {0.0, 0.01, 100.0}) {
    EXPECT_EQ(ground_at(terrain, 0.5 * 39 * 0.1 + beyond_m, 3.0).height_m, 0.0);
    EXPECT_EQ(ground_at(terrain, -0.5 * 39 * 0.1 - beyond_m, 3.0).normal, kUp);
  }
  EXPECT_EQ(ground_at(terrain, 1.0, 0.0).height_m, 0.0);
}

TEST(Terrain, ScalingIsTheSameGroundInAnotherUnit) {
  Terrain terrain = everything();
  TerrainZone& zone = terrain.zones.emplace_back();
  zone.from_m = 1.0, zone.to_m = 2.0;
  const Terrain big = scaled(terrain, 1.6);
  EXPECT_NEAR(least_tread_m(big), 1.6 * 0.28, 1e-12);
  EXPECT_NEAR(length_m(big), 1.6 * length_m(terrain), 1e-9);
  EXPECT_EQ(big.zones[0].to_m, 3.2);
  EXPECT_TRUE(std::isinf(big.zones[0].left_m));
  for (double z = -0.5; z < length_m(terrain); z += 0.0173) {
    for (const double x : {-2.1, 0.3}) {
      const Ground a = ground_at(terrain, x, z), b = ground_at(big, 1.6 * x, 1.6 * z);
      if (a.piece != b.piece) continue;  // the two places are exactly at a riser
      EXPECT_NEAR(b.height_m, 1.6 * a.height_m, 1e-9);
      EXPECT_LT(glm::distance(a.normal, b.normal), 1e-9);
    }
  }
}

TEST(Terrain, RefusesGroundThatNobodyCouldWalkOn) {
  EXPECT_NE(refusal(FlatSection{0.0}), "");
  EXPECT_NE(refusal(FlatSection{kNaN}), "");
  EXPECT_NE(refusal(FlatSection{kInfinity}), "");
  EXPECT_NE(refusal(SlopeSection{4.0, 0.7, 1.5}), "");  // the slope is too steep
  EXPECT_NE(refusal(SlopeSection{4.0, 0.3, 0.3}), "");  // the rounding is too short
  EXPECT_NE(refusal(SlopeSection{1.0, 0.1, 0.6}), "");  // the rounding is longer than the slope
  EXPECT_NE(refusal(SlopeSection{4.0, kNaN, 0.5}), "");
  EXPECT_NE(refusal(StairsSection{0.17, 0.1, 3}), "");
  EXPECT_NE(refusal(StairsSection{0.5, 0.28, 3}), "");
  EXPECT_NE(refusal(StairsSection{0.17, 0.28, 0}), "");
  EXPECT_NE(refusal(StairsSection{0.17, 0.28, 101}), "");
  EXPECT_NE(refusal(rough_section(9.0, 0.1, 1.0, 3.0, 1)), "");   // the ground bends too sharply
  EXPECT_NE(refusal(rough_section(4.0, 0.01, 2.0, 3.0, 1)), "");  // too short to fade in and out
  EXPECT_NE(refusal(rough_section(9.0, 0.01, kNaN, 3.0, 1)), "");
  EXPECT_NE(refusal(field_section(0.02)), "");  // the same heights on a fifth of the length
  EXPECT_NE(refusal(FieldSection{}), "");
  EXPECT_EQ(refusal(SlopeSection{4.0, 0.3, 0.7}), "");
  Terrain terrain;
  for (int i = 0; i < kMaxSections; ++i) EXPECT_FALSE(add_section(terrain, FlatSection{1.0}));
  EXPECT_TRUE(add_section(terrain, FlatSection{1.0}));
}

}  // namespace
}  // namespace gaitpad
