#include "view/scene_strokes.h"

#include <optional>

#include "view/scene_shaders.h"

namespace gaitpad {
namespace {

constexpr double kAxisRadius_px = 1.5, kDotRadius_px = 3.6, kTrailHalf_px = 2.4,
                 kTrailTail_px = 1.0;
constexpr double kTrailStrength = 0.95;
constexpr double kNear_m = 0.1;

// A place in the picture: clip coordinates over w, depth of the place in `w`.
struct Spot {
  vec3 ndc{0.0};
  vec2 px{0.0};
};
std::optional<Spot> spot_of(const vec3& world_m, const SceneView& view) {
  if (!is_finite(world_m)) return std::nullopt;
  const glm::dvec4 clip = view.to_clip * glm::dvec4(world_m - view.origin_m, 1.0);
  if (clip.w < kNear_m) return std::nullopt;
  const vec3 ndc = vec3(clip) / clip.w;
  return Spot{ndc, vec2(ndc.x, ndc.y) * 0.5 * view.size_px};
}

// From the point before; what is not finite takes no length.
double step_m(const Trail& trail, std::size_t i) {
  const double length_m = glm::distance(trail.points_m[i - 1], trail.points_m[i]);
  return std::isfinite(length_m) ? length_m : 0.0;
}
double length_m(const Trail& trail) {
  double sum_m = 0.0;
  for (std::size_t i = 1; i < trail.points_m.size(); ++i) sum_m += step_m(trail, i);
  return sum_m;
}

vec2 direction(const vec2& from, const vec2& to, const vec2& otherwise) {
  const vec2 d = to - from;
  const double length = glm::length(d);
  return length > 1e-3 ? d / length : otherwise;
}

}  // namespace

Result<SceneStrokes> SceneStrokes::create() {
  SceneStrokes strokes;
  auto line = GlProgram::link("lines", shader::kLineVertex, shader::kLineFragment);
  if (!line) return line.error();
  auto trail = GlProgram::link("trails", shader::kTrailVertex, shader::kTrailFragment);
  if (!trail) return trail.error();
  strokes.line_ = std::move(*line);
  strokes.trail_ = std::move(*trail);
  strokes.line_vertices_ = new_vertex_array();
  strokes.line_rows_ = new_buffer();
  glBindVertexArray(strokes.line_vertices_.get());
  glBindBuffer(GL_ARRAY_BUFFER, strokes.line_rows_.get());
  constexpr VertexPart kStroke[] = {{1, 4}, {2, 3}, {3, 4}};
  set_vertex_parts(kStroke, 3, 1);
  strokes.trail_vertices_ = new_vertex_array();
  strokes.trail_rows_ = new_buffer();
  glBindVertexArray(strokes.trail_vertices_.get());
  glBindBuffer(GL_ARRAY_BUFFER, strokes.trail_rows_.get());
  constexpr VertexPart kEdge[] = {{0, 4}, {1, 3}, {2, 3}};
  set_vertex_parts(kEdge, 3, 0);
  glBindVertexArray(0);
  return strokes;
}

void SceneStrokes::draw(const SceneContent& content, const SceneView& view) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  draw_trails(content.trails, view);
  draw_lines(content, view);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

// It fades by its length, not by time: a foot that stands does not cut it in two.
// Two triangles between each point and the next, with shared edges: nothing overlaps, so a corner
// is not darker than the rest.
void SceneStrokes::add_ribbon(const Trail& trail, const SceneView& view) {
  const std::size_t count = trail.points_m.size();
  const glm::vec3 colour(trail.colour.red, trail.colour.green, trail.colour.blue);
  const double whole_m = std::max(length_m(trail), 1e-6);
  double passed_m = 0.0;
  std::optional<Spot> last;
  std::array<Edge, 2> before;
  vec2 along(1.0, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) passed_m += step_m(trail, i);
    const auto spot = spot_of(trail.points_m[i], view);
    if (!spot) {
      last.reset();
      continue;
    }
    const auto next = i + 1 < count ? spot_of(trail.points_m[i + 1], view) : std::nullopt;
    along = direction(last ? last->px : spot->px, next ? next->px : spot->px, along);
    const vec2 aside(-along.y, along.x);
    const double share = passed_m / whole_m;  // 1: the newest
    const double half = mix(kTrailTail_px, kTrailHalf_px, share) * view.scale, reach = half + 1.0;
    std::array<Edge, 2> edges;
    for (const int side : {0, 1}) {
      const double off = side == 0 ? -reach : reach;
      const vec2 at = vec2(spot->ndc.x, spot->ndc.y) + aside * off * 2.0 / view.size_px;
      edges[side] = {glm::vec4(at.x, at.y, spot->ndc.z, 1.0),
                     glm::vec3(off, half, kTrailStrength * trail.colour.alpha * share * share),
                     colour};
    }
    if (last) {
      for (const Edge& e : {before[0], before[1], edges[0], edges[0], before[1], edges[1]}) {
        ribbon_.push_back(e);
      }
    }
    before = edges;
    last = spot;
  }
}

void SceneStrokes::draw_trails(const std::vector<Trail>& trails, const SceneView& view) {
  ribbon_.clear();
  for (const Trail& trail : trails) add_ribbon(trail, view);
  if (ribbon_.empty()) return;
  upload(trail_rows_, ribbon_.data(), ribbon_.size() * sizeof(Edge));
  trail_.use();
  glBindVertexArray(trail_vertices_.get());
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(ribbon_.size()));
}

void SceneStrokes::draw_lines(const SceneContent& content, const SceneView& view) {
  strokes_.clear();
  const auto add = [&](const vec3& a_m, const vec3& b_m, double radius_px, const Colour& c) {
    if (!is_finite(a_m) || !is_finite(b_m)) return;
    strokes_.push_back({glm::vec4(a_m - view.origin_m, radius_px * view.scale),
                        glm::vec3(b_m - view.origin_m),
                        glm::vec4(c.red, c.green, c.blue, c.alpha)});
  };
  if (content.has_axes) {
    add(vec3(0.0), kLeft, kAxisRadius_px, view.theme->axis_x);
    add(vec3(0.0), kForward, kAxisRadius_px, view.theme->axis_z);
  }
  for (const SceneLine& l : content.lines) add(l.a_m, l.b_m, 0.5 * l.width_px, l.colour);
  for (const vec3& joint : content.joints_m) {
    add(joint, joint, kDotRadius_px, content.joint_colour);
  }
  if (strokes_.empty()) return;
  upload(line_rows_, strokes_.data(), strokes_.size() * sizeof(Stroke));
  line_.use();
  line_.set("to_clip", view.to_clip);
  line_.set("size_px", view.size_px);
  glBindVertexArray(line_vertices_.get());
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(strokes_.size()));
}

}  // namespace gaitpad
