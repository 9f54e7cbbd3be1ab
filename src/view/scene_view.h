// What all parts of one picture share. Positions go to the renderer as floats, counted from
// `origin_m` near the camera's target: 200 m from where it began a walk still has its feet sharp.
#pragma once
#include "view/camera.h"
#include "view/theme.h"

namespace gaitpad {

struct SceneView {
  Camera camera;
  vec3 origin_m{0.0};      // whole metres on the floor
  mat4 to_clip{1.0};       // from places counted from the origin
  vec2 size_px{1.0, 1.0};  // of the viewport
  double scale = 1.0;      // of the display
  const Theme* theme = nullptr;

  vec3 eye_m() const noexcept { return camera.eye_m() - origin_m; }
  bool is_light() const noexcept { return theme->name == ThemeName::light; }
};

// Towards the one light.
inline const vec3 kLightDirection = glm::normalize(vec3(0.42, 0.86, 0.36));

inline bool is_finite(const vec3& v) noexcept {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace gaitpad
