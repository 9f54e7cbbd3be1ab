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
            GLuint shadow_texture);

 private:
  SceneFloor() = default;
  void draw_floor(const SceneContent& content, const SceneView& view,
                  const ShadowPlace& place) const;
  void draw_ground(const SceneContent& content, const SceneView& view, const ShadowPlace& place);
  void make_ground(const std::shared_ptr<const Terrain>& terrain, const vec2& centre_m,
                   double half_m);

  GlProgram floor_, ground_, sky_;
  GlVertexArray nothing_;  // corners are counted, not stored
  // Uneven ground, made anew when who is looked at has gone a way.
  GlVertexArray mesh_;
  GlBuffer mesh_rows_, mesh_indices_;
  GLsizei mesh_count_ = 0;
  std::shared_ptr<const Terrain> terrain_;
  vec3 mesh_origin_m_{0.0};
  vec2 mesh_centre_m_{0.0};
  double mesh_half_m_ = 0.0;
};

}  // namespace gaitpad
