// The three-dimensional picture: a floor with a metre grid, bodies of tapered capsules with light
// and soft shadows, stick figures, trails. Needs OpenGL 3.3 core; the context that was current at
// create() has to be current in every call.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "draw/theme.h"
#include "gaitpad/math.h"
#include "gaitpad/result.h"
#include "gaitpad/terrain.h"
#include "scene/camera.h"

namespace gaitpad {

// The convex hull of two balls. Along the component of `wide` that is perpendicular to a-b it is
// stretched by `width`, because a trunk is wider than deep.
struct Capsule {
  vec3 a_m{0.0}, b_m{0.0};  // ends in the world
  double radius_a_m = 0.05, radius_b_m = 0.05;
  vec3 wide{0.0};  // direction in which the capsule is wider; zero: it is round
  double width_a = 1.0, width_b = 1.0;
  Colour colour;
  // 1, 2: half transparent, one body over the other. Bodies of the same layer occlude each other.
  int layer = 0;
  // `wide` at the end b, so that two capsules share a seam; zero: the same as at a.
  vec3 wide_b{0.0};
};
struct SceneLine {  // a line of constant width in pixels, for stick figures; casts a faint shadow
  vec3 a_m{0.0}, b_m{0.0};
  Colour colour;
  double width_px = 3.0;  // width of the line at scale 1
};
struct Trail {  // a line of past places, oldest first; it fades towards the old end
  std::vector<vec3> points_m;
  Colour colour;
};
// A vector as the shaders read it.
inline glm::vec4 row(const vec3& v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
          static_cast<float>(w)};
}
// A capsule of a crowd's body: drawn as a rectangle that faces the eye and shaded as if it were
// round, for a fraction of the cost. It casts no shadow. Relative to SceneContent::crowd_origin_m.
struct FlatCapsule {
  glm::vec4 a_radius{0.0f}, b_radius{0.0f};
  // Direction and widths as in Capsule, and the colour. A negative width at b: both ends are inside
  // other capsules and have no caps.
  glm::vec4 wide_width_a{0.0f}, colour_width_b{0.0f};
  float ground_m = 0.0f;  // height of the ground below the capsule
};
// A soft dark strip on the floor with a radius at each end; also relative to crowd_origin_m.
struct FloorShade {
  glm::vec4 a_radius{0.0f}, b_radius{0.0f};
  float dark = 0.0f;  // darkness in the middle, 0 .. 1
};
struct SceneContent {
  std::vector<Capsule> capsules;  // bodies, which cast shadows
  std::vector<SceneLine> lines;
  std::vector<vec3> joints_m;  // dots of the stick figures
  Colour joint_colour;
  std::vector<FlatCapsule> crowd;
  std::vector<FloorShade> crowd_shades;
  vec3 crowd_origin_m{0.0};
  double reach_m = 0.0;  // least radius of the floor around the focus
  std::vector<Trail> trails;
  std::shared_ptr<const Terrain> terrain;  // the floor; null: level at height 0
  vec3 focus_m{0.0};  // the floor is drawn around it; the grid is fixed to the world
  bool has_grid = true, has_shadows = true, has_axes = true;
};

// Pixels from the window's upper left corner.
struct Viewport {
  int x = 0, y = 0, width = 0, height = 0;
};

class Scene {
 public:
  // automatic: anti-aliasing and fine meshes, except on a software rasterizer. high: always, for
  // single pictures.
  enum class Quality { automatic, low, high };
  // Fails if a shader does not compile or the renderer lacks a feature.
  static Result<std::unique_ptr<Scene>> create(Quality quality);
  ~Scene();

  // Draws into the bound frame buffer of height `window_height_px`, inside the viewport only; it
  // stays bound. `scale`: of the display. Turns depth test and blending off.
  void draw(const SceneContent& content, const Camera& camera, const Theme& theme,
            const Viewport& viewport, int window_height_px, double scale);
  // The renderer and its settings: "llvmpipe (LLVM 15.0.6, 256 bits), OpenGL 3.3, 4x
  // anti-aliasing".
  const std::string& renderer() const noexcept;
  bool is_software() const noexcept;

 private:
  Scene();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace gaitpad
