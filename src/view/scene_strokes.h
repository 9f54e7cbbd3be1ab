// Lines with round ends, dots and trails: flat strokes of constant width in pixels, blended with
// smooth edges over what is there, hidden by bodies before them.
#pragma once
#include <vector>

#include "view/gl_program.h"
#include "view/scene.h"
#include "view/scene_view.h"

namespace gaitpad {

class SceneStrokes {
 public:
  static Result<SceneStrokes> create();
  void draw(const SceneContent& content, const SceneView& view);

 private:
  SceneStrokes() = default;
  void draw_trails(const std::vector<Trail>& trails, const SceneView& view);
  void draw_lines(const SceneContent& content, const SceneView& view);

  struct Stroke {
    glm::vec4 a_radius;
    glm::vec3 b;
    glm::vec4 colour;
  };
  struct Edge {  // one side of a ribbon
    glm::vec4 clip;
    glm::vec3 edge, colour;
  };
  void add_ribbon(const Trail& trail, const SceneView& view);

  GlProgram line_, trail_;
  GlVertexArray line_vertices_, trail_vertices_;
  GlBuffer line_rows_, trail_rows_;
  std::vector<Stroke> strokes_;
  std::vector<Edge> ribbon_;  // pairs of edges as separate triangles
};

}  // namespace gaitpad
