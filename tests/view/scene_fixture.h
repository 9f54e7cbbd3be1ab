// A scene drawn without a display, looked at pixel by pixel.
#pragma once
#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "view/offscreen.h"
#include "view/scene.h"

namespace gaitpad {

constexpr int kWidth = 320, kHeight = 240;
inline const Colour kRed = rgb(0xd02020);

inline Capsule bone(const vec3& a, const vec3& b, double radius_a_m, double radius_b_m) {
  return {a, b, radius_a_m, radius_b_m, vec3(0.0), 1.0, 1.0, kRed};
}
inline Capsule bone(const vec3& a, const vec3& b, double radius_m) {
  return bone(a, b, radius_m, radius_m);
}

// 0 .. 255
inline double brightness(const Pixels& p, double x, double y) {
  const int px = std::clamp(static_cast<int>(x), 0, p.width - 1);
  const int py = std::clamp(static_cast<int>(y), 0, p.height - 1);
  const std::uint8_t* c = p.rgba.data() + 4 * (py * p.width + px);
  return (c[0] + c[1] + c[2]) / 3.0;
}
inline bool differs(const Pixels& a, const Pixels& b, int x, int y) {
  const std::size_t i = 4 * (static_cast<std::size_t>(y) * a.width + x);
  int sum = 0;
  for (int c = 0; c < 3; ++c) sum += std::abs(a.rgba[i + c] - b.rgba[i + c]);
  return sum > 6;
}
struct Extent {
  int left = kWidth, top = kHeight, right = -1, bottom = -1, pixels = 0;
};
inline Extent difference(const Pixels& a, const Pixels& b) {
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
  // How much brighter a place of the world is on the one than on the other, `right_px` beside it.
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

}  // namespace gaitpad
