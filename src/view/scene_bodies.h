// Bodies of capsules, instanced, and the picture of the floor that holds their shadows.
#pragma once
#include <vector>

#include "view/gl_program.h"
#include "view/scene.h"
#include "view/scene_view.h"

namespace gaitpad {

struct MeshDetail {
  int segments = 36, rings = 8;  // round the axis; of each cap
  int shadow_px = 1024;          // the shadows' picture
};
// Where on the floor the shadows' picture lies, counted from the view's origin.
struct ShadowPlace {
  vec2 centre_m{0.0};
  double half_m = 0.0;  // 0: there are no shadows
};

class SceneBodies {
 public:
  static Result<SceneBodies> create(const MeshDetail& detail);
  // The bodies and lines of a picture; what is not finite is left out.
  void load(const SceneContent& content, const SceneView& view);
  // Binds a frame buffer of its own and changes the viewport.
  ShadowPlace draw_shadows();
  void draw(const SceneView& view) const;
  GLuint shadow_texture() const noexcept { return shadow_.get(); }

 private:
  SceneBodies() = default;
  void make_mesh(const MeshDetail& detail);
  void make_shadow_target(int size_px);
  ShadowPlace shadow_place() const noexcept;

  struct Instance {
    glm::vec4 a_radius, b_radius, across_width_a, colour_width_b;
    glm::vec2 ground;  // below a, below b
  };
  GlProgram body_, shadow_program_;
  GlVertexArray vertices_;
  GlBuffer mesh_, indices_, instances_;
  GlTexture shadow_;
  GlFrameBuffer shadow_target_;
  GLsizei index_count_ = 0;
  int shadow_px_ = 0;
  void add_rows(const SceneContent& content, const SceneView& view, double from_m, double to_m);

  std::vector<Instance> rows_;  // bodies near the floor, the others, lines
  std::size_t low_bodies_ = 0, bodies_ = 0;
};

}  // namespace gaitpad
