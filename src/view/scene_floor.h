// The floor with its grid and shadows, and the background that it fades into.
#pragma once
#include "view/gl_program.h"
#include "view/scene.h"
#include "view/scene_bodies.h"
#include "view/scene_view.h"

namespace gaitpad {

class SceneFloor {
 public:
  static Result<SceneFloor> create();
  // Behind the bodies that are drawn already. Without shadows `place.half_m` is 0.
  void draw(const SceneContent& content, const SceneView& view, const ShadowPlace& place,
            GLuint shadow_texture) const;

 private:
  SceneFloor() = default;
  void draw_floor(const SceneContent& content, const SceneView& view,
                  const ShadowPlace& place) const;

  GlProgram floor_, sky_;
  GlVertexArray nothing_;  // corners are counted, not stored
};

}  // namespace gaitpad
