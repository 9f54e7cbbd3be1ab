#include "view/scene_floor.h"

#include "view/scene_ground.h"
#include "view/scene_shaders.h"

namespace gaitpad {
namespace {

constexpr double kFadesFrom_m = 3.0, kFadesTo_m = 9.0;  // at the camera's usual distance
constexpr double kUsualDistance_m = 6.0;
constexpr double kMeshStep_m = 0.125, kMeshMoves_m = 1.0;  // at the camera's usual distance
constexpr double kBehind_m = 0.05;  // the ground lies farther off than it is: what stands on it is
                                    // not cut by it

void set_background(const GlProgram& program, const SceneView& view) {
  program.set("sky_top", view.theme->sky_top);
  program.set("sky_bottom", view.theme->sky_bottom);
  program.set("vignette", view.is_light() ? 0.02 : 0.07);
  program.set("size_px", view.size_px);
}

double size_of(const SceneView& view) {
  return std::max(1.0, view.camera.distance_m / kUsualDistance_m);
}

// Of a program in use: what floor and ground share.
void set_floor(const GlProgram& program, const SceneContent& content, const SceneView& view,
               const ShadowPlace& place) {
  const bool has_shadows = place.half_m > 0.0;
  set_background(program, view);
  program.set("to_clip", view.to_clip);
  program.set("focus",
              vec2(content.focus_m.x - view.origin_m.x, content.focus_m.z - view.origin_m.z));
  program.set("half_size", kFadesTo_m * size_of(view));
  program.set("fade_from", kFadesFrom_m * size_of(view));
  program.set("floor_near", view.theme->floor);
  program.set("floor_far", view.theme->floor_far);
  program.set("grid", view.theme->grid);
  program.set("grid_depth", content.has_grid ? vec2(0.75, 0.36) : vec2(0.0));
  program.set("pixel", view.scale);
  program.set("shadow_centre", place.centre_m);
  program.set("per_shadow", has_shadows ? 1.0 / place.half_m : 0.0);
  const vec2 depth = view.is_light() ? vec2(0.36, 0.42) : vec2(0.50, 0.55);
  program.set("shadow_depth", has_shadows ? depth : vec2(0.0));
}

}  // namespace

Result<SceneFloor> SceneFloor::create() {
  SceneFloor floor;
  const std::string background = shader::kBackground;
  const std::string floor_text = background + shader::kFloorColour;
  auto level = GlProgram::link("floor", shader::kFloorVertex, floor_text + shader::kFloorFragment);
  if (!level) return level.error();
  auto ground =
      GlProgram::link("ground", shader::kGroundVertex, floor_text + shader::kGroundFragment);
  if (!ground) return ground.error();
  auto sky = GlProgram::link("background", shader::kSkyVertex, background + shader::kSkyFragment);
  if (!sky) return sky.error();
  floor.floor_ = std::move(*level);
  floor.ground_ = std::move(*ground);
  floor.sky_ = std::move(*sky);
  floor.nothing_ = new_vertex_array();
  floor.mesh_ = new_vertex_array();
  floor.mesh_rows_ = new_buffer();
  floor.mesh_indices_ = new_buffer();
  glBindVertexArray(floor.mesh_.get());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, floor.mesh_indices_.get());
  glBindBuffer(GL_ARRAY_BUFFER, floor.mesh_rows_.get());
  constexpr VertexPart kVertex[] = {{0, 3}, {1, 3}, {2, 2}};
  set_vertex_parts(kVertex, 3, 0);
  glBindVertexArray(0);
  return floor;
}

// A square round the focus; nothing of it can hide a body, which stands on it.
void SceneFloor::draw_floor(const SceneContent& content, const SceneView& view,
                            const ShadowPlace& place) const {
  floor_.use();
  set_floor(floor_, content, view, place);
  glBindVertexArray(nothing_.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void SceneFloor::make_ground(const std::shared_ptr<const Terrain>& terrain, const vec2& centre_m,
                             double half_m) {
  if (terrain == terrain_ && centre_m == mesh_centre_m_ && half_m == mesh_half_m_) return;
  const double step_m = kMeshStep_m * std::max(1.0, half_m / (kFadesTo_m + kMeshMoves_m));
  const GroundMesh mesh = ground_mesh(*terrain, centre_m, half_m, step_m);
  upload(mesh_rows_, mesh.vertices.data(), mesh.vertices.size() * sizeof(GroundVertex));
  glBindVertexArray(mesh_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(mesh.indices.size() * 4),
               mesh.indices.data(), GL_DYNAMIC_DRAW);
  mesh_count_ = static_cast<GLsizei>(mesh.indices.size());
  mesh_origin_m_ = mesh.origin_m;
  terrain_ = terrain;
  mesh_centre_m_ = centre_m;
  mesh_half_m_ = half_m;
}

void SceneFloor::draw_ground(const SceneContent& content, const SceneView& view,
                             const ShadowPlace& place) {
  if (!is_finite(content.focus_m)) return;
  const vec2 focus_m(content.focus_m.x, content.focus_m.z);
  const double moves_m = kMeshMoves_m * size_of(view);
  make_ground(content.terrain, glm::round(focus_m / moves_m) * moves_m,
              kFadesTo_m * size_of(view) + moves_m);
  ground_.use();
  set_floor(ground_, content, view, place);
  ground_.set("moved", mesh_origin_m_ - view.origin_m);
  ground_.set("light", kLightDirection);
  ground_.set("behind_m", kBehind_m);
  glBindVertexArray(mesh_.get());
  glDrawElements(GL_TRIANGLES, mesh_count_, GL_UNSIGNED_INT, nullptr);
}

void SceneFloor::draw(const SceneContent& content, const SceneView& view, const ShadowPlace& place,
                      GLuint shadow_texture) {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, shadow_texture);
  if (content.terrain == nullptr) {
    draw_floor(content, view, place);
  } else {
    draw_ground(content, view, place);
  }
  glBindVertexArray(nothing_.get());
  sky_.use();
  set_background(sky_, view);
  glDrawArrays(GL_TRIANGLES, 0, 3);  // at the farthest depth
  glBindTexture(GL_TEXTURE_2D, 0);
}

}  // namespace gaitpad
