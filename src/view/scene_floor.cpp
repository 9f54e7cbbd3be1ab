#include "view/scene_floor.h"

#include "view/scene_shaders.h"

namespace gaitpad {
namespace {

constexpr double kFadesFrom_m = 3.0, kFadesTo_m = 9.0;  // at the camera's usual distance
constexpr double kUsualDistance_m = 6.0;

void set_background(const GlProgram& program, const SceneView& view) {
  program.set("sky_top", view.theme->sky_top);
  program.set("sky_bottom", view.theme->sky_bottom);
  program.set("vignette", view.is_light() ? 0.02 : 0.07);
  program.set("size_px", view.size_px);
}

}  // namespace

Result<SceneFloor> SceneFloor::create() {
  SceneFloor floor;
  const std::string background = shader::kBackground;
  auto ground = GlProgram::link("floor", shader::kFloorVertex, background + shader::kFloorFragment);
  if (!ground) return ground.error();
  auto sky = GlProgram::link("background", shader::kSkyVertex, background + shader::kSkyFragment);
  if (!sky) return sky.error();
  floor.floor_ = std::move(*ground);
  floor.sky_ = std::move(*sky);
  floor.nothing_ = new_vertex_array();
  return floor;
}

// A square round the focus; nothing of it can hide a body, which stands on it.
void SceneFloor::draw_floor(const SceneContent& content, const SceneView& view,
                            const ShadowPlace& place) const {
  const double size = std::max(1.0, view.camera.distance_m / kUsualDistance_m);
  const bool has_shadows = place.half_m > 0.0;
  floor_.use();
  set_background(floor_, view);
  floor_.set("to_clip", view.to_clip);
  floor_.set("focus",
             vec2(content.focus_m.x - view.origin_m.x, content.focus_m.z - view.origin_m.z));
  floor_.set("world_origin", -vec2(view.origin_m.x, view.origin_m.z));
  floor_.set("half_size", kFadesTo_m * size);
  floor_.set("fade_from", kFadesFrom_m * size);
  floor_.set("floor_near", view.theme->floor);
  floor_.set("floor_far", view.theme->floor_far);
  floor_.set("grid", view.theme->grid);
  floor_.set("grid_depth", content.has_grid ? vec2(0.75, 0.36) : vec2(0.0));
  floor_.set("pixel", view.scale);
  floor_.set("shadow_centre", place.centre_m);
  floor_.set("per_shadow", has_shadows ? 1.0 / place.half_m : 0.0);
  const vec2 depth = view.is_light() ? vec2(0.36, 0.42) : vec2(0.50, 0.55);
  floor_.set("shadow_depth", has_shadows ? depth : vec2(0.0));
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void SceneFloor::draw(const SceneContent& content, const SceneView& view, const ShadowPlace& place,
                      GLuint shadow_texture) const {
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, shadow_texture);
  glBindVertexArray(nothing_.get());
  draw_floor(content, view, place);
  sky_.use();
  set_background(sky_, view);
  glDrawArrays(GL_TRIANGLES, 0, 3);  // at the farthest depth
  glBindTexture(GL_TEXTURE_2D, 0);
}

}  // namespace gaitpad
