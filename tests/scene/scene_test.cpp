// Draws a scene without a display and checks its pixels: each part is where the camera projects it
// and looks as the header says.
#include "scene/scene.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "gaitpad/config_files.h"
#include "scene/gl_program.h"
#include "tests/folders.h"
#include "tests/value_of.h"
#include "view/offscreen.h"

namespace gaitpad {
namespace {

constexpr int kWidth = 320, kHeight = 240;
const Colour kRed = rgb(0xd02020);

Capsule bone(const vec3& a, const vec3& b, double radius_a_m, double radius_b_m) {
  return {a, b, radius_a_m, radius_b_m, vec3(0.0), 1.0, 1.0, kRed};
}
Capsule bone(const vec3& a, const vec3& b, double radius_m) {
  return bone(a, b, radius_m, radius_m);
}

// Brightness of a pixel, 0 .. 255.
double brightness(const Pixels& p, double x, double y) {
  const int px = std::clamp(static_cast<int>(x), 0, p.width - 1);
  const int py = std::clamp(static_cast<int>(y), 0, p.height - 1);
  const std::uint8_t* c = p.rgba.data() + 4 * (py * p.width + px);
  return (c[0] + c[1] + c[2]) / 3.0;
}
bool differs(const Pixels& a, const Pixels& b, int x, int y) {
  const std::size_t i = 4 * (static_cast<std::size_t>(y) * a.width + x);
  int sum = 0;
  for (int c = 0; c < 3; ++c) sum += std::abs(a.rgba[i + c] - b.rgba[i + c]);
  return sum > 6;
}
struct Extent {
  int left = kWidth, top = kHeight, right = -1, bottom = -1, pixels = 0;
};
Extent difference(const Pixels& a, const Pixels& b) {
  Extent e;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x) {
      if (!differs(a, b, x, y)) continue;
      e.left = std::min(e.left, x);
      e.right = std::max(e.right, x);
      e.top = std::min(e.top, y);
      e.bottom = std::max(e.bottom, y);
      ++e.pixels;
    }
  }
  return e;
}

class SceneTest : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = WindowSurface::open(hidden(kWidth, kHeight));
    if (!opened) GTEST_SKIP() << opened.error().message;
    surface_ = std::move(*opened);
    auto scene = Scene::create(Scene::Quality::low);
    ASSERT_TRUE(scene) << scene.error().message;
    scene_ = std::move(*scene);
    content_.has_axes = content_.has_shadows = false;
  }
  Pixels drawn(const SceneContent& content) {
    int width = 0, height = 0;
    surface_->size(width, height);
    surface_->begin();
    scene_->draw(content, camera_, theme_of(theme_), {0, 0, width, height}, height, scale_);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
    return read_pixels(width, height);
  }
  vec3 place(const vec3& world_m) const { return projected(camera_, world_m, kWidth, kHeight); }
  // Brightness of a place in picture `a` minus that in `b`, `right_px` pixels to the right of it.
  double brighter(const Pixels& a, const Pixels& b, const vec3& world_m, int right_px = 0) const {
    const vec3 p = place(world_m);
    return brightness(a, p.x + right_px, p.y) - brightness(b, p.x + right_px, p.y);
  }
  // The scene over a surface that is all magenta.
  Pixels over_magenta(const Viewport& viewport, int width, int height) {
    surface_->begin();
    glClearColor(1.0f, 0.0f, 1.0f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    scene_->draw(content_, camera_, theme_of(theme_), viewport, height, 1.0);
    return read_pixels(width, height);
  }
  void look_down() {
    orbit(camera_, -camera_.yaw_rad, 10.0);
    camera_.target_m.y = 0.0;
    content_.focus_m = camera_.target_m;
  }

  std::unique_ptr<WindowSurface> surface_;
  std::unique_ptr<Scene> scene_;
  SceneContent content_;
  Camera camera_;
  ThemeName theme_ = ThemeName::dark;
  double scale_ = 1.0;
};

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
const Colour kBlue = rgb(0x2020d0);

TEST_F(SceneTest, ACapsulesPixelsAreWhereItsBallsAreProjected) {
  camera_.target_m = {20.0, 0.8, -7.0};
  content_.focus_m = camera_.target_m;
  const Pixels empty = drawn(content_);
  const vec3 a = camera_.target_m + vec3(-0.4, 0.2, 0.0),
             b = camera_.target_m + vec3(0.5, 0.7, 0.2);
  content_.capsules = {bone(a, b, 0.10, 0.05)};
  const Extent seen = difference(empty, drawn(content_));
  const double half_height = kHeight / 2.0 / std::tan(camera_.field_of_view_rad / 2.0);
  const double ra = half_height * 0.10 / place(a).z, rb = half_height * 0.05 / place(b).z;
  EXPECT_NEAR(seen.left, place(a).x - ra, 1.5);
  EXPECT_NEAR(seen.bottom, place(a).y + ra, 1.5);
  EXPECT_NEAR(seen.right, place(b).x + rb, 1.5);
  EXPECT_NEAR(seen.top, place(b).y - rb, 1.5);
}

// A wall of four steps between the eye and a ball hides the ball; level floor never does.
TEST_F(SceneTest, UnevenGroundIsSeenAndHides) {
  camera_.yaw_rad = 0.0;
  camera_.pitch_rad = 0.1;
  const vec3 at(0.0, 0.2, -0.5);
  const Capsule ball = bone(at, at, 0.15);
  const Pixels level = drawn(content_);
  auto terrain = std::make_shared<Terrain>();
  ASSERT_FALSE(add_section(*terrain, StairsSection{0.3, 0.2, 4}));
  content_.terrain = terrain;
  const Pixels steps = drawn(content_);
  EXPECT_GT(difference(level, steps).pixels, kWidth * kHeight / 10);
  content_.capsules = {ball};
  EXPECT_LT(difference(steps, drawn(content_)).pixels, 20);
  content_.terrain = nullptr;
  EXPECT_GT(difference(level, drawn(content_)).pixels, 100);
}

// Seen from behind a climbing character, without the grid: the middle of the second riser, and the
// middles of the treads before and after it.
TEST_F(SceneTest, RisersAndTreadsHaveTwoTonesAndHigherGroundIsLighter) {
  auto terrain = std::make_shared<Terrain>();
  ASSERT_FALSE(add_section(*terrain, StairsSection{0.3, 0.4, 4}));
  content_.terrain = terrain;
  content_.has_grid = false;
  camera_.yaw_rad = kPi;
  camera_.pitch_rad = 0.45;
  camera_.target_m = content_.focus_m = {0.0, 0.45, 0.4};
  for (const ThemeName theme : {ThemeName::dark, ThemeName::light}) {
    theme_ = theme;
    const Pixels steps = drawn(content_);
    const auto at = [&](double height_m, double z_m) {
      const vec3 p = place({0.3, height_m, z_m});
      return brightness(steps, p.x, p.y);
    };
    const double lower = at(0.3, 0.2), riser = at(0.45, 0.4), upper = at(0.6, 0.6);
    EXPECT_GT(std::abs(riser - lower), 12.0);
    EXPECT_GT(std::abs(riser - upper), 12.0);
    EXPECT_GT(upper, lower + 2.0);
    EXPECT_GT(riser, 40.0) << "a riser can be seen in the dark";
  }
}

// The ground has humps and hollows of 6 cm; drawn without the grid.
TEST_F(SceneTest, RoughGroundLooksRough) {
  const auto terrain = std::make_shared<const Terrain>(
      value_of(load_terrain(kSourceFolder + "/config/terrain/rough.toml")));
  content_.has_grid = false;
  content_.focus_m = camera_.target_m = {0.0, 0.0, 8.0};
  camera_.pitch_rad = 1.2;
  for (const ThemeName theme : {ThemeName::dark, ThemeName::light}) {
    theme_ = theme;
    const auto contrast = [&](std::shared_ptr<const Terrain> ground) {
      content_.terrain = std::move(ground);
      const Pixels seen = drawn(content_);
      std::vector<double> all;
      for (int y = kHeight / 4; y < kHeight * 3 / 4; y += 3)
        for (int x = kWidth / 4; x < kWidth * 3 / 4; x += 3) all.push_back(brightness(seen, x, y));
      std::ranges::sort(all);
      return all[all.size() * 9 / 10] / all[all.size() / 10];
    };
    EXPECT_LT(contrast(nullptr), 1.08);
    EXPECT_GT(contrast(terrain), 1.2);
  }
}

TEST_F(SceneTest, AShadowFallsOnTheGroundThatIsThere) {
  camera_.pitch_rad = 1.2;
  content_.has_shadows = true;
  const auto shadow = [&](double height_m) {
    camera_.target_m.y = height_m + 0.8;
    content_.capsules.clear();
    const Pixels empty = drawn(content_);
    const vec3 at(0.0, height_m + 0.05, 0.0);
    content_.capsules = {bone(at, at, 0.05)};
    return difference(empty, drawn(content_));
  };
  const Extent level = shadow(0.0);
  auto terrain = std::make_shared<Terrain>();
  ASSERT_FALSE(add_section(*terrain, SlopeSection{10.0, 0.06, 5.0}));
  ASSERT_FALSE(add_section(*terrain, FlatSection{20.0}));
  // The ground here is level at 0.3 m.
  for (TerrainSection& s : terrain->sections) s.begin_m -= 20.0;
  content_.terrain = terrain;
  const Extent raised = shadow(0.3);
  EXPECT_NEAR(raised.pixels, level.pixels, 0.1 * level.pixels);
  EXPECT_NEAR(raised.left, level.left, 2);
}

TEST_F(SceneTest, ABallInABallIsTheLargerOne) {
  const Pixels empty = drawn(content_);
  const vec3 at = camera_.target_m;
  content_.capsules = {bone(at, at, 0.2)};
  const Extent ball = difference(empty, drawn(content_));
  content_.capsules = {bone(at, at + vec3(0.05, 0.0, 0.0), 0.2, 0.04)};
  const Extent both = difference(empty, drawn(content_));
  // Capsules are meshes that are rotated, so the areas differ a little.
  EXPECT_NEAR(both.pixels, ball.pixels, 0.1 * ball.pixels);
  EXPECT_NEAR(ball.right - ball.left, ball.bottom - ball.top, 2);
}

TEST_F(SceneTest, AWideCapsuleIsWideAcrossOnly) {
  camera_.yaw_rad = camera_.pitch_rad = 0.0;
  const Pixels empty = drawn(content_);
  const vec3 a = camera_.target_m, b = a + vec3(0.0, 0.6, 0.0);
  const auto width_from = [&](double yaw_rad) {
    camera_.yaw_rad = yaw_rad;
    content_.capsules.clear();
    const Pixels before = drawn(content_);
    content_.capsules = {{a, b, 0.1, 0.1, kLeft, 1.8, 1.8, kRed}};
    const Extent e = difference(before, drawn(content_));
    return e.right - e.left + 1;
  };
  const double from_front = width_from(0.0), from_side = width_from(kPi / 2.0);
  EXPECT_NEAR(from_front / from_side, 1.8, 0.15);
}

TEST_F(SceneTest, AShadowDarkensTheFloorAwayFromTheLight) {
  look_down();
  content_.has_grid = false;
  content_.capsules = {bone({0.0, 0.05, 0.0}, {0.0, 0.9, 0.0}, 0.05)};
  const Pixels without = drawn(content_);
  content_.has_shadows = true;
  const Pixels with = drawn(content_);
  const auto darker = [&](const vec3& floor_m) { return brighter(without, with, floor_m); };
  // The light comes from +x and +z. A bone at 0.45 m casts its shadow 0.3 m aside.
  EXPECT_GT(darker({-0.2, 0.0, -0.17}), 12.0);
  EXPECT_LT(darker({0.35, 0.0, 0.3}), 2.0);
  EXPECT_NEAR(darker({1.2, 0.0, -1.0}), 0.0, 1.0);
}

TEST_F(SceneTest, AFootDarkensTheFloorRoundItAndALiftedFootDoesNot) {
  look_down();
  dolly(camera_, 0.33);
  content_.has_grid = false;
  const auto darker_beside = [&](double height_m) {
    const vec3 heel(-0.1, height_m, 0.0), toe(0.1, height_m, 0.0);
    content_.capsules = {bone(heel, toe, 0.03)};
    content_.has_shadows = false;
    const Pixels without = drawn(content_);
    content_.has_shadows = true;
    const Pixels with = drawn(content_);
    // The place is towards the light, where there is no shadow.
    return brighter(without, with, {0.0, 0.0, 0.042});
  };
  EXPECT_GT(darker_beside(0.03), 3.0);
  EXPECT_LT(darker_beside(0.60), 1.0);
}

TEST_F(SceneTest, OutsideTheViewportNothingChanges) {
  const Pixels pixels = over_magenta({40, 30, 200, 120}, kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const std::uint8_t* c = pixels.rgba.data() + 4 * (y * kWidth + x);
      const bool is_untouched = c[0] == 255 && c[1] == 0 && c[2] == 255;
      const bool is_inside = x >= 40 && x < 240 && y >= 30 && y < 150;
      ASSERT_EQ(is_untouched, !is_inside) << x << ", " << y;
    }
  }
}

TEST_F(SceneTest, EveryViewportSizeIsFilled) {
  for (const auto& [width, height] :
       {std::pair(500, 300), std::pair(101, 77), std::pair(640, 90)}) {
    SDL_SetWindowSize(surface_->window(), width, height);
    SDL_PumpEvents();
    const Pixels pixels = over_magenta({0, 0, width, height}, width, height);
    for (std::size_t i = 0; i < pixels.rgba.size(); i += 4) {
      ASSERT_FALSE(pixels.rgba[i] == 255 && pixels.rgba[i + 1] == 0) << i;
    }
  }
}

TEST_F(SceneTest, WhatIsNotFiniteIsLeftOut) {
  const Pixels without = drawn(content_);
  content_.has_shadows = true;
  const vec3 nowhere(kNan, 0.0, 0.0), at = camera_.target_m;
  content_.capsules = {bone(nowhere, at, 0.1), bone(at, at, kNan, 0.1)};
  content_.lines = {{at, nowhere, kRed, 3.0}};
  content_.joints_m = {nowhere};
  content_.trails = {{{nowhere, nowhere, at}, kRed}};
  EXPECT_EQ(difference(without, drawn(content_)).pixels, 0);
}

TEST_F(SceneTest, AnotherSceneDrawsTheSameInAnotherContext) {
  content_.has_shadows = content_.has_axes = true;
  const vec3 at = camera_.target_m;
  content_.capsules = {bone(at, at - kUp * 0.7, 0.1)};
  const Pixels first = drawn(content_);
  scene_.reset();
  surface_.reset();
  SetUp();
  content_.has_shadows = content_.has_axes = true;
  EXPECT_EQ(difference(first, drawn(content_)).pixels, 0);
}

// An edge has more than two shades with four samples per pixel.
TEST_F(SceneTest, HighQualitySmoothsEdges) {
  camera_.yaw_rad = camera_.pitch_rad = 0.0;
  content_.has_grid = false;
  const vec3 at = camera_.target_m;
  content_.capsules = {{at - vec3(2.0, 0.0, 0.0), at + vec3(2.0, 0.3, 0.0), 0.1, 0.1, vec3(0.0),
                        1.0, 1.0, rgb(0xffffff)}};
  const auto shades = [&] {  // shades of the upper edge, where it crosses a row of pixels
    const Pixels pixels = drawn(content_);
    int between = 0;
    for (int x = 40; x < kWidth - 40; ++x) {
      for (int y = 60; y < kHeight / 2; ++y) {
        const double above = brightness(pixels, x, y - 1), here = brightness(pixels, x, y),
                     below = brightness(pixels, x, y + 1);
        if (below - above < 60.0) continue;
        between += here > above + 15.0 && here < below - 15.0;
      }
    }
    return between;
  };
  const int rough = shades();
  auto scene = Scene::create(Scene::Quality::high);
  ASSERT_TRUE(scene) << scene.error().message;
  scene_ = std::move(*scene);
  if (scene_->renderer().find("4x") == std::string::npos) GTEST_SKIP() << scene_->renderer();
  EXPECT_GT(shades(), rough + 60);
}

TEST_F(SceneTest, AShaderThatDoesNotCompileIsNamed) {
  GlProgram program;
  const auto problem = program.link("thing", "#version 330 core\nvoid main() { nonsense(); }",
                                    "#version 330 core\nvoid main() {}");
  ASSERT_TRUE(problem);
  EXPECT_NE(problem->message.find("vertex shader of the thing"), std::string::npos);
  EXPECT_NE(problem->message.find("nonsense"), std::string::npos);
}

// Lines are where the camera projects them: lines of the grid, trails, single lines.

TEST_F(SceneTest, GridLinesLieAtWholeMetresOfTheWorld) {
  look_down();
  for (const double x_m : {0.0, 0.3, 150.6}) {
    camera_.target_m.x = content_.focus_m.x = x_m;
    content_.has_grid = false;
    const Pixels without = drawn(content_);
    content_.has_grid = true;
    const Pixels with = drawn(content_);
    const auto line_at = [&](double x, double z) {
      // The greatest difference near the place, because a line is one or two pixels wide.
      double most = 0.0;
      for (const int off : {-1, 0, 1})
        most = std::max(most, brighter(with, without, {x, 0.0, z}, off));
      return most;
    };
    const double metre = std::round(x_m);
    EXPECT_GT(line_at(metre, 0.5), 20.0) << x_m;
    EXPECT_GT(line_at(metre + 1.0, 0.5), 20.0) << x_m;
    const double twenty = line_at(metre + 0.4, 0.5);
    EXPECT_GT(twenty, 3.0) << x_m;
    EXPECT_LT(twenty, 0.7 * line_at(metre, 0.5)) << x_m;
    EXPECT_LT(line_at(metre + 0.5, 0.5), 1.5) << x_m;
  }
}

TEST_F(SceneTest, ATrailFadesTowardsItsOldEnd) {
  look_down();
  content_.has_grid = false;
  const Pixels without = drawn(content_);
  Trail trail;
  for (int i = 0; i <= 40; ++i) trail.points_m.emplace_back(-1.0 + i * 0.05, 0.01, 0.0);
  trail.colour = rgb(0xffffff);
  content_.trails = {trail};
  const Pixels with = drawn(content_);
  const auto strength = [&](double x_m) { return brighter(with, without, {x_m, 0.01, 0.0}); };
  EXPECT_GT(strength(0.95), 100.0);
  EXPECT_GT(strength(0.95), strength(0.3) + 20.0);
  EXPECT_GT(strength(0.3), strength(-0.4) + 20.0);
  EXPECT_LT(strength(-0.95), 5.0);
}

TEST_F(SceneTest, ALineIsAsWideAsItsPixelsTimesTheScale) {
  camera_.yaw_rad = camera_.pitch_rad = 0.0;
  const vec3 a = camera_.target_m - kUp * 0.5, b = camera_.target_m + kUp * 0.5;
  for (const double scale : {1.0, 2.0}) {
    scale_ = scale;
    content_.lines.clear();
    const Pixels without = drawn(content_);
    content_.lines = {{a, b, rgb(0xffffff), 4.0}};
    const Pixels with = drawn(content_);
    double covered = 0.0;  // number of covered pixels in one row
    const int row = kHeight / 2;
    for (int x = 0; x < kWidth; ++x) covered += differs(with, without, x, row);
    EXPECT_NEAR(covered, 4.0 * scale, 1.1);
  }
}

TEST_F(SceneTest, ALineThatPassesTheEyeIsCutThere) {
  const vec3 behind = camera_.eye_m() + (camera_.eye_m() - camera_.target_m) * 0.5 + kUp * 0.1;
  const Pixels without = drawn(content_);
  content_.lines = {{camera_.target_m, behind, rgb(0xffffff), 3.0}};
  const Extent seen = difference(without, drawn(content_));
  EXPECT_GT(seen.pixels, 20);
  // The line begins in the picture's middle and rises above the eye.
  EXPECT_NEAR(seen.bottom, kHeight / 2.0, 12.0);
}

TEST_F(SceneTest, BodiesHideLinesBehindThem) {
  camera_.yaw_rad = 0.0;
  const vec3 at = camera_.target_m;
  content_.capsules = {bone(at, at, 0.3)};
  const Pixels without = drawn(content_);
  content_.lines = {{at - vec3(1.0, 0.0, 1.0), at + vec3(1.0, 0.0, -1.0), rgb(0xffffff), 4.0}};
  const Pixels with = drawn(content_);
  EXPECT_FALSE(differs(with, without, kWidth / 2, kHeight / 2));
  const vec3 beside = place(at + vec3(0.8, 0.0, -1.0));
  EXPECT_TRUE(differs(with, without, static_cast<int>(beside.x), static_cast<int>(beside.y)));
}

FlatCapsule flat(const vec3& a, const vec3& b, double radius_a_m, double radius_b_m) {
  return {glm::vec4(a, radius_a_m), glm::vec4(b, radius_b_m), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f),
          glm::vec4(kRed.red, kRed.green, kRed.blue, 1.0f)};
}

// A body near the ground, seen from the same side, has the same brightness on raised ground as on
// ground at height 0.
TEST_F(SceneTest, ABodysShadeNearTheGroundIsThatOfItsHeightAboveTheGround) {
  const auto shade_at = [this](double ground_m, bool is_crowd) {
    auto terrain = std::make_shared<Terrain>();
    if (ground_m != 0.0) {
      EXPECT_FALSE(add_section(*terrain, StairsSection{ground_m, 2.0, 1}));
    }
    content_.terrain = terrain;
    const vec3 at(0.0, ground_m + 0.06, 12.0);
    camera_ = Camera{.target_m = at, .distance_m = 3.0};
    content_.focus_m = at;
    content_.capsules.clear();
    content_.crowd.clear();
    if (is_crowd) {
      content_.crowd = {flat(at, at, 0.05, 0.05)};
      content_.crowd.front().ground_m = static_cast<float>(ground_m);
    } else {
      content_.capsules = {bone(at, at, 0.05)};
    }
    return brightness(drawn(content_), kWidth / 2.0, kHeight / 2.0);
  };
  for (const bool is_crowd : {false, true}) {
    const double level = shade_at(0.0, is_crowd);
    EXPECT_NEAR(shade_at(0.4, is_crowd), level, 1.0);
    EXPECT_NEAR(shade_at(-0.4, is_crowd), level, 1.0);
  }
}

TEST_F(SceneTest, AFlatCapsulesPixelsAreThoseOfARoundOne) {
  camera_.target_m = {20.0, 0.8, -7.0};
  content_.focus_m = camera_.target_m;
  const Pixels empty = drawn(content_);
  const vec3 a = camera_.target_m + vec3(-0.4, 0.2, 0.0),
             b = camera_.target_m + vec3(0.5, 0.7, 0.2);
  content_.capsules = {bone(a, b, 0.10, 0.09)};
  const Extent round = difference(empty, drawn(content_));
  content_.capsules.clear();
  content_.crowd_origin_m = {18.0, 0.0, -7.0};
  content_.crowd = {flat(a - content_.crowd_origin_m, b - content_.crowd_origin_m, 0.10, 0.09)};
  const Extent seen = difference(empty, drawn(content_));
  EXPECT_NEAR(seen.left, round.left, 2.0);
  EXPECT_NEAR(seen.right, round.right, 2.0);
  EXPECT_NEAR(seen.top, round.top, 2.0);
  EXPECT_NEAR(seen.bottom, round.bottom, 2.0);
  EXPECT_NEAR(seen.pixels, round.pixels, 0.06 * round.pixels);
}

TEST_F(SceneTest, BodiesHideFlatCapsulesBehindThemAndAreHiddenByThoseInFront) {
  camera_.yaw_rad = 0.0;
  const vec3 at = camera_.target_m, behind(0.0, 0.0, -1.0);
  content_.capsules = {bone(at, at, 0.1)};
  const Pixels alone = drawn(content_);
  content_.crowd = {flat(at + behind, at + behind, 0.3, 0.3)};
  const Pixels with = drawn(content_);
  EXPECT_FALSE(differs(with, alone, kWidth / 2, kHeight / 2));
  const vec3 beside = place(at + behind + vec3(0.2, 0.0, 0.0));
  EXPECT_TRUE(differs(with, alone, static_cast<int>(beside.x), static_cast<int>(beside.y)));
  content_.crowd = {flat(at - behind, at - behind, 0.3, 0.3)};
  content_.crowd.front().colour_width_b = {0.0f, 0.0f, 1.0f, 1.0f};
  EXPECT_TRUE(differs(drawn(content_), alone, kWidth / 2, kHeight / 2));
}

TEST_F(SceneTest, OfTwoLayersEachIsHalfTransparentWhicheverIsInFront) {
  const vec3 there_m = camera_.target_m;
  const vec3 nearer_m = glm::normalize(camera_.eye_m() - there_m) * 0.8;
  Capsule red = bone(there_m, there_m, 0.3),
          green = bone(there_m + nearer_m, there_m + nearer_m, 0.3);
  green.colour = rgb(0x20d020);
  const auto picture = [&](const std::vector<Capsule>& capsules) {
    SceneContent content = content_;
    content.capsules = capsules;
    return drawn(content);
  };
  const Pixels nobody = picture({}), only_red = picture({red}), only_green = picture({green});
  const auto expect_mean = [&](const Pixels& seen, const Pixels& a, const Pixels& b) {
    const vec3 at = place(there_m);
    const std::size_t first =
        4 * (static_cast<std::size_t>(at.y) * kWidth + static_cast<std::size_t>(at.x));
    for (std::size_t c = first; c < first + 3; ++c)
      EXPECT_NEAR(seen.rgba[c], 0.5 * (a.rgba[c] + b.rgba[c]), 3.0);
  };
  red.layer = 1;
  expect_mean(picture({red}), only_red, nobody);
  for (const int layer : {1, 2}) {
    red.layer = layer;
    green.layer = 3 - layer;
    expect_mean(picture({red, green}), only_red, only_green);
  }
  green.layer = 0;  // an opaque body in front
  expect_mean(picture({red, green}), only_green, only_green);
}

TEST_F(SceneTest, AFloorShadeDarkensTheFloorWhereItLies) {
  look_down();
  content_.has_shadows = true;
  const Pixels without = drawn(content_);
  content_.crowd_shades = {
      {glm::vec4(0.0f, 0.006f, 0.0f, 0.3f), glm::vec4(0.8f, 0.006f, 0.0f, 0.3f), 0.5f}};
  const Pixels with = drawn(content_);
  EXPECT_LT(brighter(with, without, vec3(0.0)), -5.0);
  EXPECT_LT(brighter(with, without, vec3(0.5, 0.0, 0.0)), -2.0);
  EXPECT_NEAR(brighter(with, without, vec3(0.0, 0.0, 0.5)), 0.0, 0.5);
  content_.has_shadows = false;
  EXPECT_NEAR(brighter(drawn(content_), without, vec3(0.0)), 0.0, 0.5);
}

}  // namespace
}  // namespace gaitpad
