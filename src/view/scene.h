// The three-dimensional picture: floor with a metre grid, bodies of tapered capsules with light and
// soft shadows, stick figures, trails. OpenGL 3.3 core; every call needs the context that was
// current at create().
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "draw/theme.h"
#include "gaitpad/math.h"
#include "gaitpad/result.h"
#include "gaitpad/terrain.h"
#include "view/camera.h"

namespace gaitpad {

// The hull of two balls. A trunk is wider than deep: across, along `wide` as far as that is at
// right angles to a-b, it is stretched by a factor.
struct Capsule {
  vec3 a_m{0.0}, b_m{0.0};  // world
  double radius_a_m = 0.05, radius_b_m = 0.05;
  vec3 wide{0.0};  // zero: round
  double width_a = 1.0, width_b = 1.0;
  Colour colour;
};
struct SceneLine {  // a round bar of constant width in pixels, for stick figures; a faint shadow
  vec3 a_m{0.0}, b_m{0.0};
  Colour colour;
  double width_px = 3.0;  // at scale 1
};
struct Trail {  // oldest first; fades towards the old end
  std::vector<vec3> points_m;
  Colour colour;
};
struct SceneContent {
  std::vector<Capsule> bodies;  // these cast shadows
  std::vector<SceneLine> lines;
  std::vector<vec3> joints_m;  // dots of the stick figures
  Colour joint_colour;
  std::vector<Trail> trails;
  std::shared_ptr<const Terrain> terrain;  // the floor; null: level at height 0
  vec3 focus_m{0.0};  // the floor is drawn round it, the grid stays where it is in the world
  bool has_grid = true, has_shadows = true, has_axes = true;
};

// Where in the window, pixels from its upper left corner.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
};

class Scene {
 public:
  // automatic: anti-aliasing and fine meshes where the renderer affords them, not on a software
  // rasterizer. high: for pictures that may take their time.
  enum class Quality { automatic, low, high };
  // One sentence where a shader does not compile or the renderer lacks something.
  static Result<std::unique_ptr<Scene>> create(Quality quality);
  ~Scene();

  // Into the frame buffer that is bound, which is `window_height_px` high; it stays bound, outside
  // the viewport nothing changes. `scale`: of the display. Leaves depth test and blending off.
  void draw(const SceneContent& content, const Camera& camera, const Theme& theme,
            const Viewport& viewport, int window_height_px, double scale);
  // "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 3.3, 4x anti-aliasing"
  const std::string& renderer() const noexcept;
  bool is_software() const noexcept;

 private:
  Scene();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
