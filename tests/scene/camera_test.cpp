// The projection is derived here a second time, by similar triangles.
#include "scene/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace gaitpad {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// A point's distance from the picture's middle, in half heights, is the tangent of its angle over
// the tangent of half the field of view.
vec3 by_triangles(const Camera& camera, const vec3& world_m, int width, int height) {
  const vec3 eye = camera.eye_m();
  const vec3 ahead = glm::normalize(camera.target_m - eye);
  const vec3 right = glm::normalize(glm::cross(ahead, kUp));
  const vec3 up = glm::cross(right, ahead);
  const vec3 to = world_m - eye;
  const double depth = glm::dot(to, ahead);
  const double half_height = height / 2.0;
  const double pixels = half_height / (depth * std::tan(camera.field_of_view_rad / 2.0));
  return {width / 2.0 + glm::dot(to, right) * pixels, half_height - glm::dot(to, up) * pixels,
          depth};
}

TEST(Camera, ProjectsAsSimilarTrianglesDo) {
  for (const double yaw : {-3.0, -0.7, 0.0, 0.16, 2.2}) {
    for (const double pitch : {-0.05, 0.2, 1.4}) {
      Camera camera;
      camera.yaw_rad = yaw;
      camera.pitch_rad = pitch;
      camera.target_m = {3.0, 0.9, -8.0};
      for (const vec3& offset : {vec3(0.0), vec3(0.4, 0.0, 0.0), vec3(-1.0, 0.8, 1.5)}) {
        const vec3 at = projected(camera, camera.target_m + offset, 750, 610);
        const vec3 expected = by_triangles(camera, camera.target_m + offset, 750, 610);
        EXPECT_LT(glm::distance(at, expected), 1e-9) << yaw << " " << pitch;
      }
    }
  }
}

TEST(Camera, AtYawZeroItSeesTheFrontOfAWalkerAndItsLeftHandOnTheRight) {
  Camera camera;
  camera.yaw_rad = 0.0;
  EXPECT_GT(camera.eye_m().z, camera.target_m.z + 5.0);
  EXPECT_NEAR(camera.eye_m().x, 0.0, 1e-12);
  EXPECT_GT(projected(camera, camera.target_m + kLeft, 640, 480).x, 320.0);
  EXPECT_LT(projected(camera, camera.target_m + kUp, 640, 480).y, 240.0);
}

TEST(Camera, WhatIsBehindTheEyeHasNoDepth) {
  const Camera camera;
  const vec3 behind = camera.eye_m() + (camera.eye_m() - camera.target_m);
  EXPECT_LT(projected(camera, behind, 640, 480).z, 0.0);
  EXPECT_EQ(projected(camera, camera.eye_m(), 640, 480).x, 0.0);
}

TEST(Camera, StaysAboveTheFloorAndInItsDistancesWhateverIsAsked) {
  Camera camera;
  const auto expect_bounds = [&camera] {
    EXPECT_GE(camera.eye_m().y, 0.1 - 1e-9);
    EXPECT_GE(camera.distance_m, 1.0);
    EXPECT_LE(camera.distance_m, 40.0);
    EXPECT_LT(camera.pitch_rad, kPi / 2.0);
    EXPECT_GE(camera.target_m.y, 0.0);
  };
  orbit(camera, 0.0, -10.0);
  expect_bounds();
  dolly(camera, 1e9);  // at this pitch an eye that is farther away would be below the floor
  expect_bounds();
  dolly(camera, 1e-9);
  expect_bounds();
  pan(camera, {0.0, -1e6}, 600.0);
  expect_bounds();
  orbit(camera, 100.0, 10.0);
  expect_bounds();
  orbit(camera, kNan, 0.1);
  dolly(camera, -2.0);
  dolly(camera, kNan);
  pan(camera, {kNan, 0.0}, 600.0);
  pan(camera, {1.0, 0.0}, 0.0);
  follow(camera, vec3(kNan), 0.1);
  expect_bounds();
  EXPECT_TRUE(std::isfinite(camera.yaw_rad));
}

TEST(Camera, StandsOnUnevenGround) {
  Camera camera;
  camera.target_m.y = 2.8;
  stand_on(camera, 2.0, 2.5);
  orbit(camera, 0.0, -10.0);
  EXPECT_NEAR(camera.eye_m().y, 2.6, 1e-9);
  stand_on(camera, 2.0, 3.1);  // the ground is higher than the eye
  EXPECT_NEAR(camera.eye_m().y, 3.2, 1e-9);
  pan(camera, {0.0, -1e6}, 600.0);
  EXPECT_EQ(camera.target_m.y, 2.0);
  const Camera before = camera;
  stand_on(camera, kNan, 0.0);
  EXPECT_EQ(camera.floor_m, before.floor_m);
}

TEST(Camera, PanningMovesTheTargetUnderThePointer) {
  Camera camera;
  orbit(camera, 0.9, 0.3);
  const vec3 before = camera.target_m;
  pan(camera, {40.0, -25.0}, 480.0);
  const vec3 at = projected(camera, before, 640, 480);
  EXPECT_NEAR(at.x, 320.0 + 40.0, 1e-9);
  EXPECT_NEAR(at.y, 240.0 - 25.0, 1e-9);
  EXPECT_FALSE(camera.is_following);
}

// A character walks at 1.4 m/s; after two seconds the camera's place does not depend on the frame
// rate.
vec3 followed(const vec3& velocity_m_s, int frames) {
  Camera camera;
  const vec3 start = camera.followed_m;
  for (int i = 1; i <= frames; ++i) {
    const double time_s = 2.0 * i / frames;
    follow(camera, start + velocity_m_s * time_s, 2.0 / frames);
  }
  return camera.target_m;
}

TEST(Camera, FollowsEquallyAtAnyFrameRate) {
  const vec3 velocity(0.5, 0.0, 1.3);
  const vec3 slow = followed(velocity, 20), fast = followed(velocity, 480);
  EXPECT_LT(glm::distance(slow, fast), 1e-9);
  // The camera does not lag behind a character that walks at constant velocity.
  const vec3 expected = Camera{}.target_m + velocity * 2.0;
  EXPECT_LT(glm::distance(slow, expected), 2e-3);
}

TEST(Camera, GlidesWhereThePlaceJumps) {
  Camera camera;
  follow(camera, vec3(0.0, 0.8, 30.0), 1.0 / 60.0);
  EXPECT_GT(camera.target_m.z, 0.0);
  EXPECT_LT(camera.target_m.z, 10.0);
  for (int i = 0; i < 240; ++i) follow(camera, vec3(0.0, 0.8, 30.0), 1.0 / 60.0);
  EXPECT_NEAR(camera.target_m.z, 30.0, 1e-3);
}

// Places in a row, at different heights, seen from all sides: each is in the picture with its
// label; from 2 % nearer at least one is not.
TEST(Camera, ItsFramingIsTheNearestThatShowsEverything) {
  const std::vector<vec3> places = {{-2.4, 0.0, 0.3}, {-2.4, 1.7, 0.3}, {0.0, 1.9, -0.4},
                                    {0.0, -0.2, 0.0}, {1.2, 1.1, 0.2},  {3.6, 0.4, 0.9}};
  const vec2 label_px(30.0, 24.0);
  for (const auto& [width, height] : {std::pair(744, 612), {640, 330}, {300, 700}, {3200, 1960}}) {
    for (const double yaw : {0.16, 1.1, 2.05, -2.9}) {
      Camera camera;
      orbit(camera, yaw - camera.yaw_rad, 0.1);
      const auto is_seen = [&, width = width, height = height](const vec3& place_m, double share) {
        const vec3 at = by_triangles(camera, place_m, width, height);
        const double edge = 0.5 * (1.0 - share);
        return at.x >= edge * width + label_px.x && at.x <= (1.0 - edge) * width - label_px.x &&
               at.y >= edge * height + label_px.y && at.y <= (1.0 - edge) * height;
      };
      const Framing found = framing(camera, places, width, height, label_px, 1.0);
      show(camera, found, vec3(0.0));
      for (const vec3& place : places) EXPECT_TRUE(is_seen(place, 0.9201)) << width << " " << yaw;
      dolly(camera, 0.98);
      EXPECT_FALSE(std::ranges::all_of(places, [&](const vec3& p) { return is_seen(p, 0.92); }));
    }
  }
}

// A panel opens, so the picture becomes narrower. The camera moves by less than a tenth in each
// frame.
TEST(Camera, GoesToAFramingSmoothlyAndKeepsWhatIsZoomed) {
  Camera camera;
  show(camera, {{0.0, 0.8, 0.0}, 8.0}, vec3(0.0));
  dolly(camera, 0.5);
  const Framing wide{{0.3, 0.9, 0.0}, 12.0};
  double last_m = camera.distance_m;
  for (int i = 0; i < 120; ++i) {
    approach(camera, wide, 1.0 / 60.0);
    EXPECT_GE(camera.distance_m, last_m);
    EXPECT_LT(camera.distance_m, last_m * 1.1);
    last_m = camera.distance_m;
  }
  EXPECT_NEAR(camera.framed_m, 12.0, 0.05);
  EXPECT_NEAR(camera.distance_m, 6.0, 0.03);
  EXPECT_LT(glm::distance(camera.target_m, wide.target_m), 0.01);
  for (int i = 0; i < 240; ++i) approach(camera, {wide.target_m, 11.8}, 1.0 / 60.0);
  EXPECT_NEAR(camera.framed_m, 12.0, 0.05) << "2 % inwards are let pass";
  camera.is_following = false;
  const Camera before = camera;
  approach(camera, {vec3(0.0), 20.0}, 1.0);
  EXPECT_EQ(camera.distance_m, before.distance_m) << "the person has taken the camera";
}

TEST(Camera, StaysWhereItIsUnlessItFollows) {
  Camera camera;
  camera.is_following = false;
  follow(camera, vec3(0.0, 0.8, 0.5), 0.1);
  EXPECT_EQ(camera.target_m.z, 0.0);
}

}  // namespace
}  // namespace gaitpad
