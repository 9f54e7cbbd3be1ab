#include "scene/scene.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "draw/theme.h"
#include "scene/camera.h"
#include "scene/gl_program.h"
#include "scene/ground_mesh.h"
#include "scene/scene_shaders.h"

namespace gaitpad {
namespace {

// Data that all parts of one picture share. The renderer gets positions as floats relative to
// `origin_m` near the camera's target, so that feet stay sharp 200 m from the start.
struct SceneView {
  Camera camera;
  vec3 origin_m{0.0};      // whole metres on the floor
  mat4 to_clip{1.0};       // transforms places relative to the origin to clip coordinates
  vec2 size_px{1.0, 1.0};  // size of the viewport
  double band_px = 0.0;    // lower edge of the drawn band, from the viewport's lower edge
  double scale = 1.0;      // factor of the display
  const Theme* theme = nullptr;

  vec3 eye_m() const noexcept { return camera.eye_m() - origin_m; }
  bool is_light() const noexcept { return theme->name == ThemeName::light; }
};

// Direction to the only light.
const vec3 kLightDirection = glm::normalize(vec3(0.42, 0.86, 0.36));

struct MeshDetail {
  // Triangles of a capsule: segments round its axis, rings of each cap.
  int segments = 36, rings = 8;
  int shadow_px = 1024;  // side of the texture that holds the shadows
};
// Square of the floor that the shadows' texture covers, relative to the view's origin.
struct ShadowPlace {
  vec2 centre_m{0.0};
  double half_m = 0.0;  // half the square's side; 0: there are no shadows
};

// Draws bodies of capsules, instanced, and renders their shadows into a texture of the floor.
class CapsuleScene {
 public:
  std::optional<Error> open(const MeshDetail& detail);
  // Uploads the bodies and lines of a picture, without those that are not finite.
  void load(const SceneContent& content, const SceneView& view);
  // Binds a frame buffer of its own and changes the viewport.
  ShadowPlace draw_shadows();
  void draw(const SceneView& view, int samples) const;
  bool has_layers() const noexcept { return has_layers_; }
  GLuint shadow_texture() const noexcept { return shadow_.get(); }

 private:
  void make_mesh(const MeshDetail& detail);
  void make_shadow_target(int size_px);
  ShadowPlace shadow_place() const noexcept;

  struct Instance {
    glm::vec4 a_radius, b_radius, across_width_a, colour_width_b;
    glm::vec3 ground_layer;  // heights of the floor below a and b, and the layer
    glm::vec3 across_b;
  };
  GlProgram program_, shadow_program_;
  GlRows bodies_;
  GlTexture shadow_;
  GlFrameBuffer shadow_target_;
  int shadow_px_ = 0;

  std::vector<Instance> rows_;  // bodies near the floor, then the other bodies, then lines
  // Bodies that are not near the floor, until rows_ holds the others.
  std::vector<Instance> high_rows_;
  std::size_t low_capsules_ = 0, capsules_ = 0;
  bool has_layers_ = false;
};

constexpr double kLineShadow_m = 0.014;  // radius with which a stick figure's line casts its shadow
constexpr double kContact_m = 0.55;      // higher bodies cast no contact shadow
// The texture's size changes in steps of this length, so that shadows do not flicker.
constexpr double kShadowStep_m = 2.0;
constexpr double kLargestShadow_m = 16.0;

// A unit vector at right angles to the axis, towards `wide` if possible.
vec3 across(const vec3& axis, const vec3& wide) {
  const double length = glm::length(axis);
  const vec3 along = length > 1e-9 ? axis / length : kUp;
  const vec3 least = std::abs(along.x) < 0.7 ? kLeft : kForward;
  for (const vec3& towards : {wide, least}) {
    const vec3 side = towards - along * glm::dot(towards, along);
    if (glm::length(side) > 1e-6) return glm::normalize(side);
  }
  return kLeft;
}

bool is_drawable(const Capsule& c) {
  return is_finite(c.a_m) && is_finite(c.b_m) && is_finite(c.wide) &&
         std::isfinite(c.radius_a_m + c.radius_b_m + c.width_a + c.width_b);
}

// Height of the floor below a place; below a high place the mean over a step's length, so that the
// place's shadow does not jump at each riser.
double floor_below(const SceneContent& content, const vec3& place_m) {
  constexpr double kNear_m = 0.35;
  if (content.terrain == nullptr) return 0.0;
  const double height_m = ground_at(*content.terrain, place_m.x, place_m.z).height_m;
  if (place_m.y - height_m < kNear_m) return height_m;
  return mean_ground_m(*content.terrain, place_m.x, place_m.z);
}

std::optional<Error> CapsuleScene::open(const MeshDetail& detail) {
  if (auto problem = program_.link("bodies", shader::kBodyVertex,
                                   std::string(shader::kLight) + shader::kBodyFragment))
    return problem;
  if (auto problem =
          shadow_program_.link("shadows", shader::kShadowVertex, shader::kShadowFragment))
    return problem;
  make_mesh(detail);
  make_shadow_target(detail.shadow_px);
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_.get());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    return Error{"OpenGL: the renderer cannot draw into a picture of two colours"};
  return std::nullopt;
}

// Rows of latitude of the two caps, each from pole to seam or back; the triangles between the caps
// form the cone.
void CapsuleScene::make_mesh(const MeshDetail& detail) {
  const int columns = detail.segments, rows = 2 * (detail.rings + 1);
  std::vector<std::array<float, 4>> spots;
  for (int r = 0; r < rows; ++r) {
    const bool at_b = r > detail.rings;
    const int from_pole = at_b ? rows - 1 - r : r;
    for (int c = 0; c < columns; ++c) {
      const double angle = 2.0 * kPi * c / columns;
      spots.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                       static_cast<float>(from_pole) / static_cast<float>(detail.rings),
                       at_b ? 1.0f : 0.0f});
    }
  }
  std::vector<std::uint32_t> indices;
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const int a = r * columns + c, b = r * columns + (c + 1) % columns;
      for (const int i : {a, b, b + columns, a, b + columns, a + columns})
        indices.push_back(static_cast<std::uint32_t>(i));
    }
  }
  bodies_.add(GlRows::Of::vertex, {{0, 4}});
  bodies_.add(GlRows::Of::instance, {{1, 4}, {2, 4}, {3, 4}, {4, 4}, {5, 3}, {6, 3}});
  bodies_.load(GlRows::Of::vertex, spots);
  bodies_.load_triangles(indices);
}

void CapsuleScene::make_shadow_target(int size_px) {
  shadow_px_ = size_px;
  shadow_ = new_texture();
  glBindTexture(GL_TEXTURE_2D, shadow_.get());
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RG8, size_px, size_px, 0, GL_RG, GL_UNSIGNED_BYTE, nullptr);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  shadow_target_ = new_frame_buffer();
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, shadow_.get(), 0);
}

void CapsuleScene::load(const SceneContent& content, const SceneView& view) {
  rows_.clear();
  high_rows_.clear();
  has_layers_ = false;
  for (const Capsule& c : content.capsules) {
    if (!is_drawable(c)) continue;
    const vec2 ground(floor_below(content, c.a_m), floor_below(content, c.b_m));
    const double low_m =
        std::min(c.a_m.y - c.radius_a_m - ground.x, c.b_m.y - c.radius_b_m - ground.y);
    const vec3 colour(c.colour.red, c.colour.green, c.colour.blue);
    has_layers_ = has_layers_ || c.layer != 0;
    const vec3 side = across(c.b_m - c.a_m, c.wide);
    (low_m < kContact_m ? rows_ : high_rows_)
        .push_back({row(c.a_m - view.origin_m, c.radius_a_m),
                    row(c.b_m - view.origin_m, c.radius_b_m), row(side, c.width_a),
                    row(colour, c.width_b), glm::vec3(ground.x, ground.y, c.layer),
                    glm::vec3(c.wide_b == vec3(0.0) ? side : across(c.b_m - c.a_m, c.wide_b))});
  }
  low_capsules_ = rows_.size();
  rows_.insert(rows_.end(), high_rows_.begin(), high_rows_.end());
  capsules_ = rows_.size();
  for (const SceneLine& l : content.lines) {
    if (!is_finite(l.a_m) || !is_finite(l.b_m)) continue;
    rows_.push_back({row(l.a_m - view.origin_m, kLineShadow_m),
                     row(l.b_m - view.origin_m, kLineShadow_m), row(kLeft, 1.0),
                     row(vec3(0.0), 1.0),
                     glm::vec3(floor_below(content, l.a_m), floor_below(content, l.b_m), 0.0),
                     glm::vec3(kLeft)});
  }
  bodies_.load(GlRows::Of::instance, rows_);
}

// The square that holds all bodies and their shadows. It moves by whole texels, so that shadows do
// not flicker.
ShadowPlace CapsuleScene::shadow_place() const noexcept {
  if (rows_.empty()) return {};
  vec2 low(1e9), high(-1e9);
  for (const Instance& i : rows_) {
    for (const auto& [end, ground] :
         {std::pair(i.a_radius, i.ground_layer.x), {i.b_radius, i.ground_layer.y}}) {
      const vec2 down(end.x, end.z);
      const vec2 thrown = down - vec2(kLightDirection.x, kLightDirection.z) *
                                     ((double{end.y} - ground) / kLightDirection.y);
      low = glm::min(low, glm::min(down, thrown));
      high = glm::max(high, glm::max(down, thrown));
    }
  }
  constexpr double kMargin_m = 0.4;
  const vec2 size = (high - low) * 0.5 + kMargin_m;
  ShadowPlace place;
  place.half_m = std::ceil(std::max(size.x, size.y) * 2.0 / kShadowStep_m) * kShadowStep_m * 0.5;
  place.half_m = std::min(place.half_m, kLargestShadow_m);
  const double texel_m = 2.0 * place.half_m / shadow_px_;
  place.centre_m = glm::round((low + high) * 0.5 / texel_m) * texel_m;
  return place;
}

// Red: the light's shadow. Green: contact shadow straight below, where the sky's light does not
// reach the floor. The darkest value counts, so that overlapping bones are not visible.
ShadowPlace CapsuleScene::draw_shadows() {
  const ShadowPlace place = shadow_place();
  if (place.half_m <= 0.0) return place;
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_.get());
  glViewport(0, 0, shadow_px_, shadow_px_);
  glDisable(GL_DEPTH_TEST);
  glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendEquation(GL_MAX);
  shadow_program_.use();
  shadow_program_.set("centre", place.centre_m);
  shadow_program_.set("half_size", place.half_m);
  const auto draw = [this](const vec2& slide, const vec2& edge_width, double fading_1_m,
                           std::size_t count) {
    shadow_program_.set("slide", slide);
    shadow_program_.set("edge_width", edge_width);
    shadow_program_.set("fading_1_m", fading_1_m);
    bodies_.draw_squares(static_cast<GLsizei>(count));
  };
  glColorMask(GL_TRUE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw(vec2(kLightDirection.x, kLightDirection.z) / kLightDirection.y, {0.02, 0.075}, 0.0,
       rows_.size());
  glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
  draw({0.0, 0.0}, {0.02, 0.55}, 6.0, low_capsules_);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
  return place;
}

// Sets the uniforms of a program that lights bodies and takes it into use.
void light_bodies(const GlProgram& program, const SceneView& view) {
  program.use();
  program.set("to_clip", view.to_clip);
  program.set("eye", view.eye_m());
  program.set("light", kLightDirection);
  program.set("sky_light", view.is_light() ? vec3(0.50, 0.54, 0.60) : vec3(0.36, 0.41, 0.50));
  program.set("ground_light", view.is_light() ? vec3(0.30, 0.29, 0.28) : vec3(0.15, 0.13, 0.135));
  program.set("key_strength", view.is_light() ? 0.80 : 0.86);
  program.set("rim_strength", view.is_light() ? 0.10 : 0.34);
}

// Two half transparent bodies each cover one half of a pixel's samples, so that both are visible,
// whichever is in front.
void CapsuleScene::draw(const SceneView& view, int samples) const {
  light_bodies(program_, view);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  const GLbitfield half = (1u << (samples / 2)) - 1u, all = (1u << samples) - 1u;
  const std::array<GLbitfield, 3> shares = {all, half, all & ~half};
  if (has_layers_ && samples > 1) glEnable(GL_SAMPLE_MASK);
  for (std::size_t layer = 0; layer < (has_layers_ ? shares.size() : 1); ++layer) {
    program_.set("drawn_layer", static_cast<double>(layer));
    glSampleMaski(0, shares[layer]);
    bodies_.draw_triangles_of(static_cast<GLsizei>(capsules_));
  }
  glDisable(GL_SAMPLE_MASK);
  glDisable(GL_CULL_FACE);
}

// Draws the bodies of a crowd, instanced, each capsule as one rectangle, and their shades.
class CrowdScene {
 public:
  std::optional<Error> open();
  void draw(const SceneContent& content, const SceneView& view, int samples);
  // Call it while the floor is drawn.
  void draw_shades(const SceneContent& content, const SceneView& view);

 private:
  GlProgram body_, shade_;
  GlRows bodies_, shades_;
};

std::optional<Error> CrowdScene::open() {
  bodies_.add(GlRows::Of::instance, {{1, 4}, {2, 4}, {3, 4}, {4, 4}, {5, 1}});
  shades_.add(GlRows::Of::instance, {{1, 4}, {2, 4}, {3, 1}});
  if (auto problem = body_.link("crowd", shader::kCrowdVertex,
                                std::string(shader::kLight) + shader::kCrowdFragment))
    return problem;
  return shade_.link("crowd's shades", shader::kShadeVertex, shader::kShadeFragment);
}

void CrowdScene::draw(const SceneContent& content, const SceneView& view, int samples) {
  if (content.crowd.empty()) return;
  bodies_.load(GlRows::Of::instance, content.crowd);
  light_bodies(body_, view);
  body_.set("moved", content.crowd_origin_m - view.origin_m);
  body_.set("samples", static_cast<double>(samples));
  if (samples > 1) glEnable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  bodies_.draw_squares();
  if (samples > 1) glDisable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void CrowdScene::draw_shades(const SceneContent& content, const SceneView& view) {
  if (content.crowd_shades.empty() || !content.has_shadows) return;
  shades_.load(GlRows::Of::instance, content.crowd_shades);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  shade_.use();
  shade_.set("to_clip", view.to_clip);
  shade_.set("moved", content.crowd_origin_m - view.origin_m);
  shades_.draw_squares();
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

// Draws the floor with its grid and shadows, and the background that it fades into.
class FloorScene {
 public:
  std::optional<Error> open();
  // Call it after the bodies are drawn. `place.half_m` is 0 if there are no shadows.
  void draw(const SceneContent& content, const SceneView& view, const ShadowPlace& place,
            GLuint shadow_texture);

 private:
  void draw_floor(const SceneContent& content, const SceneView& view,
                  const ShadowPlace& place) const;
  void draw_ground(const SceneContent& content, const SceneView& view, const ShadowPlace& place);
  void make_ground(const std::shared_ptr<const Terrain>& terrain, const vec2& centre_m,
                   double half_m);

  GlProgram floor_, ground_, sky_;
  GlVertexArray nothing_;  // without data: the shader computes the corners
  // Uneven ground, rebuilt when the focus has moved far enough.
  GlRows mesh_;
  std::shared_ptr<const Terrain> terrain_;
  vec3 mesh_origin_m_{0.0};
  vec2 mesh_centre_m_{0.0};
  double mesh_half_m_ = 0.0;
};

// Distances between which the grid fades, at the camera's usual distance.
constexpr double kFadesFrom_m = 3.0, kFadesTo_m = 9.0;
constexpr double kUsualDistance_m = 6.0;
// Size of a cell and way of the focus until the mesh is rebuilt, at the camera's usual distance.
constexpr double kMeshStep_m = 0.125, kMeshMoves_m = 1.0;
constexpr double kBehind_m = 0.05;  // the ground is drawn slightly behind its place, so that it
                                    // does not cut what stands on it

void set_background(const GlProgram& program, const SceneView& view) {
  program.set("sky_top", view.theme->sky_top);
  program.set("sky_bottom", view.theme->sky_bottom);
  program.set("vignette", view.is_light() ? 0.02 : 0.07);
  program.set("size_px", view.size_px);
  program.set("band_px", view.band_px);
}

double size_of(const SceneContent& content, const SceneView& view) {
  return std::max(
      {1.0, view.camera.distance_m / kUsualDistance_m, 1.3 * content.reach_m / kFadesTo_m});
}

// Sets the uniforms that floor and ground share; the program has to be in use.
void set_floor(const GlProgram& program, const SceneContent& content, const SceneView& view,
               const ShadowPlace& place) {
  const bool has_shadows = place.half_m > 0.0;
  set_background(program, view);
  program.set("to_clip", view.to_clip);
  program.set("focus",
              vec2(content.focus_m.x - view.origin_m.x, content.focus_m.z - view.origin_m.z));
  program.set("half_size", kFadesTo_m * size_of(content, view));
  program.set("fade_from", kFadesFrom_m * size_of(content, view));
  program.set("floor_near", view.theme->floor);
  program.set("floor_far", view.theme->floor_far);
  program.set("riser", view.theme->riser);
  program.set("nose", view.theme->nose);
  program.set("grid", view.theme->grid);
  program.set("grid_depth", content.has_grid ? vec2(0.75, 0.36) : vec2(0.0));
  program.set("pixel", view.scale);
  program.set("shadow_centre", place.centre_m);
  program.set("per_shadow", has_shadows ? 1.0 / place.half_m : 0.0);
  const vec2 depth = view.is_light() ? vec2(0.36, 0.42) : vec2(0.50, 0.55);
  program.set("shadow_depth", has_shadows ? depth : vec2(0.0));
}

std::optional<Error> FloorScene::open() {
  nothing_ = new_vertex_array();
  mesh_.add(GlRows::Of::vertex, {{0, 3}, {1, 3}, {2, 2}});
  const std::string background = shader::kBackground;
  const std::string floor = background + shader::kFloorColour;
  if (auto problem = floor_.link("floor", shader::kFloorVertex, floor + shader::kFloorFragment))
    return problem;
  if (auto problem = ground_.link("ground", shader::kGroundVertex, floor + shader::kGroundFragment))
    return problem;
  return sky_.link("background", shader::kSkyVertex, background + shader::kSkyFragment);
}

// Draws level floor as a square around the focus, behind all bodies, because they stand on it.
void FloorScene::draw_floor(const SceneContent& content, const SceneView& view,
                            const ShadowPlace& place) const {
  floor_.use();
  set_floor(floor_, content, view, place);
  glBindVertexArray(nothing_.get());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void FloorScene::make_ground(const std::shared_ptr<const Terrain>& terrain, const vec2& centre_m,
                             double half_m) {
  if (terrain == terrain_ && centre_m == mesh_centre_m_ && half_m == mesh_half_m_) return;
  const double step_m = kMeshStep_m * std::max(1.0, half_m / (kFadesTo_m + kMeshMoves_m));
  const GroundMesh mesh = ground_mesh(*terrain, centre_m, half_m, step_m);
  mesh_.load(GlRows::Of::vertex, mesh.vertices);
  mesh_.load_triangles(mesh.indices);
  mesh_origin_m_ = mesh.origin_m;
  terrain_ = terrain;
  mesh_centre_m_ = centre_m;
  mesh_half_m_ = half_m;
}

void FloorScene::draw_ground(const SceneContent& content, const SceneView& view,
                             const ShadowPlace& place) {
  if (!is_finite(content.focus_m)) return;
  const vec2 focus_m(content.focus_m.x, content.focus_m.z);
  const double moves_m = kMeshMoves_m * size_of(content, view);
  make_ground(content.terrain, glm::round(focus_m / moves_m) * moves_m,
              kFadesTo_m * size_of(content, view) + moves_m);
  ground_.use();
  set_floor(ground_, content, view, place);
  ground_.set("moved", mesh_origin_m_ - view.origin_m);
  ground_.set("light", kLightDirection);
  // On light ground the tone stays below 1, so that higher parts can be brighter.
  ground_.set("tone", view.is_light() ? 0.92 : 1.0);
  ground_.set("relief", view.is_light() ? 5.0 : 10.0);
  ground_.set("level", mesh_origin_m_.y - view.origin_m.y);
  ground_.set("behind_m", kBehind_m);
  mesh_.draw_triangles();
}

void FloorScene::draw(const SceneContent& content, const SceneView& view, const ShadowPlace& place,
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
  // Three vertices at the largest depth, so that everything else hides the background.
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindTexture(GL_TEXTURE_2D, 0);
}

// Draws lines with round ends, dots and trails: flat strokes of constant width in pixels with
// smooth edges, hidden by bodies in front of them.
class StrokeScene {
 public:
  std::optional<Error> open();
  void draw(const SceneContent& content, const SceneView& view);

 private:
  void draw_trails(const std::vector<Trail>& trails, const SceneView& view);
  void draw_lines(const SceneContent& content, const SceneView& view);

  struct Stroke {
    glm::vec4 a_radius;
    glm::vec3 b;
    glm::vec4 colour;
  };
  struct Edge {  // one side of a ribbon at one point of the trail
    glm::vec4 clip;
    glm::vec3 edge, colour;
  };
  void add_ribbon(const Trail& trail, const SceneView& view);

  GlProgram line_, trail_;
  GlRows line_rows_, trail_rows_;
  std::vector<Stroke> strokes_;
  // Each two successive edges give two triangles, which share no vertices with the next ones.
  std::vector<Edge> ribbon_;
};

constexpr double kAxisRadius_px = 1.5, kDotRadius_px = 3.6, kTrailHalf_px = 2.4,
                 kTrailTail_px = 1.0;
constexpr double kTrailStrength = 0.95;
constexpr double kNear_m = 0.1;

// A place in the picture: normalised device coordinates, and pixels from its middle.
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

// Distance from the previous point; 0 if it is not finite.
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

std::optional<Error> StrokeScene::open() {
  line_rows_.add(GlRows::Of::instance, {{1, 4}, {2, 3}, {3, 4}});
  trail_rows_.add(GlRows::Of::vertex, {{0, 4}, {1, 3}, {2, 3}});
  if (auto problem = line_.link("lines", shader::kLineVertex, shader::kLineFragment))
    return problem;
  return trail_.link("trails", shader::kTrailVertex, shader::kTrailFragment);
}

void StrokeScene::draw(const SceneContent& content, const SceneView& view) {
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  draw_trails(content.trails, view);
  draw_lines(content, view);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

// A trail fades with length, not time, so that a standing foot does not divide it. The triangles
// share their edges without overlap, so that corners are not darker than the rest.
void StrokeScene::add_ribbon(const Trail& trail, const SceneView& view) {
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
    const double share = passed_m / whole_m;  // 1 at the newest point
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

void StrokeScene::draw_trails(const std::vector<Trail>& trails, const SceneView& view) {
  ribbon_.clear();
  for (const Trail& trail : trails) add_ribbon(trail, view);
  if (ribbon_.empty()) return;
  trail_rows_.load(GlRows::Of::vertex, ribbon_);
  trail_.use();
  trail_rows_.draw_triangles();
}

void StrokeScene::draw_lines(const SceneContent& content, const SceneView& view) {
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
  line_rows_.load(GlRows::Of::instance, strokes_);
  line_.use();
  line_.set("to_clip", view.to_clip);
  line_.set("size_px", view.size_px);
  line_rows_.draw_squares();
}

constexpr int kSamples = 4;
constexpr int kLargestPicture_px = 16384;
// A picture with several samples per pixel is drawn in bands of at most this area: at double size
// all samples at once would take 120 MB.
constexpr int kBandArea_px = 1 << 19, kLowestBand_px = 16;

// Software rasterizers of Mesa, Google and Windows.
bool is_software_renderer(const std::string& name) {
  for (const char* part : {"llvmpipe", "softpipe", "swrast", "SwiftShader", "Software"}) {
    if (name.find(part) != std::string::npos) return true;
  }
  return false;
}

// A frame buffer with colour and depth, with one or several samples per pixel.
class Target {
 public:
  // Returns false if the renderer does not support it.
  bool resize(int width, int height, int samples) {
    if (width == width_ && height == height_ && samples == samples_) return is_complete_;
    width_ = width;
    height_ = height;
    samples_ = samples;
    frame_ = new_frame_buffer();
    colour_ = new_render_buffer();
    depth_ = new_render_buffer();
    glBindFramebuffer(GL_FRAMEBUFFER, frame_.get());
    attach(colour_, GL_RGBA8, GL_COLOR_ATTACHMENT0);
    attach(depth_, GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
    is_complete_ = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    return is_complete_;
  }
  GLuint name() const noexcept { return frame_.get(); }

 private:
  void attach(const GlRenderBuffer& buffer, GLenum format, GLenum place) const {
    glBindRenderbuffer(GL_RENDERBUFFER, buffer.get());
    if (samples_ > 1) {
      glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples_, format, width_, height_);
    } else {
      glRenderbufferStorage(GL_RENDERBUFFER, format, width_, height_);
    }
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, place, GL_RENDERBUFFER, buffer.get());
  }
  GlFrameBuffer frame_;
  GlRenderBuffer colour_, depth_;
  int width_ = 0, height_ = 0, samples_ = 0;
  bool is_complete_ = false;
};

void blit(GLuint from, GLuint to, int width, int height, int x, int y) {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
  glBlitFramebuffer(0, 0, width, height, x, y, x + width, y + height, GL_COLOR_BUFFER_BIT,
                    GL_NEAREST);
}

SceneView view_of(const Camera& camera, const SceneContent& content, const Theme& theme,
                  const Viewport& viewport, double scale) {
  SceneView view;
  view.camera = camera;
  view.origin_m = glm::round(vec3(camera.target_m.x, 0.0, camera.target_m.z));
  if (!is_finite(content.focus_m) || !is_finite(view.origin_m)) view.origin_m = vec3(0.0);
  mat4 moved(1.0);
  moved[3] = glm::dvec4(view.origin_m, 1.0);
  view.size_px = vec2(viewport.width, viewport.height);
  view.to_clip = camera.projection(view.size_px.x / view.size_px.y) * camera.view() * moved;
  view.scale = scale;
  view.theme = &theme;
  return view;
}

}  // namespace

struct Scene::Impl {
  CapsuleScene capsules;
  CrowdScene crowd;
  FloorScene floor;
  StrokeScene strokes;
  Target target, resolved;
  std::string renderer;
  // Samples per pixel: usually, and with half transparent bodies.
  int samples = 1, most_samples = 1;
  bool is_software = false, has_bands = false;
};

Scene::Scene() = default;
Scene::~Scene() = default;
const std::string& Scene::renderer() const noexcept { return impl_->renderer; }
bool Scene::is_software() const noexcept { return impl_->is_software; }

Result<std::unique_ptr<Scene>> Scene::create(Quality quality) {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  if (!name) return Error{"OpenGL: there is no context to draw with"};
  const bool is_software = is_software_renderer(name);
  const bool is_fine = quality == Quality::high || (quality == Quality::automatic && !is_software);
  GLint most = 1;
  glGetIntegerv(GL_MAX_SAMPLES, &most);
  std::unique_ptr<Scene> scene(new Scene);
  scene->impl_ = std::make_unique<Impl>();
  Impl& s = *scene->impl_;
  if (auto problem = s.capsules.open(is_fine ? MeshDetail{36, 8, 1024} : MeshDetail{16, 4, 384}))
    return *problem;
  if (auto problem = s.crowd.open()) return *problem;
  if (auto problem = s.strokes.open()) return *problem;
  if (auto problem = s.floor.open()) return *problem;
  s.most_samples = std::clamp(most, 1, kSamples);
  s.samples = is_fine ? s.most_samples : 1;
  s.is_software = is_software;
  s.has_bands = quality == Quality::high;
  const int version = epoxy_gl_version();
  s.renderer = fmt::format("{}, OpenGL {}.{}, {} anti-aliasing", drawable(name), version / 10,
                           version % 10, s.samples > 1 ? fmt::format("{}x", s.samples) : "no");
  return scene;
}

void Scene::draw(const SceneContent& content, const Camera& camera, const Theme& theme,
                 const Viewport& viewport, int window_height_px, double scale) {
  Impl& s = *impl_;
  const int width = viewport.width, height = viewport.height;
  if (width < 1 || height < 1 || width > kLargestPicture_px || height > kLargestPicture_px) return;
  GLint window = 0;
  std::array<GLint, 4> before{};
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &window);
  glGetIntegerv(GL_VIEWPORT, before.data());
  glDisable(GL_SCISSOR_TEST);
  const int band =
      s.has_bands ? std::min(height, std::max(kBandArea_px / width, kLowestBand_px)) : height;
  SceneView view = view_of(camera, content, theme, viewport, scale);
  s.capsules.load(content, view);
  int samples = s.capsules.has_layers() ? s.most_samples : s.samples;
  // If the memory is too small for several samples per pixel, use one.
  if (!s.target.resize(width, band, samples)) samples = s.samples = s.most_samples = 1;
  if (s.target.resize(width, band, samples)) {
    const ShadowPlace shadow = content.has_shadows ? s.capsules.draw_shadows() : ShadowPlace{};
    for (int begin = 0; begin < height; begin += band) {
      view.band_px = begin;
      glBindFramebuffer(GL_FRAMEBUFFER, s.target.name());
      glViewport(0, -begin, width, height);
      glEnable(GL_DEPTH_TEST);
      glDepthFunc(GL_LEQUAL);
      glDepthMask(GL_TRUE);
      glClear(GL_DEPTH_BUFFER_BIT);
      s.capsules.draw(view, samples);
      s.crowd.draw(content, view, samples);
      s.floor.draw(content, view, shadow, s.capsules.shadow_texture());
      s.crowd.draw_shades(content, view);
      s.strokes.draw(content, view);
      glDisable(GL_DEPTH_TEST);
      GLuint ready = s.target.name();
      const int rows = std::min(band, height - begin);
      if (samples > 1 && s.resolved.resize(width, band, 1)) {
        blit(ready, s.resolved.name(), width, rows, 0, 0);
        ready = s.resolved.name();
      }
      blit(ready, static_cast<GLuint>(window), width, rows, viewport.x,
           window_height_px - viewport.y - height + begin);
    }
  }
  glBindVertexArray(0);
  glUseProgram(0);
  glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(window));
  glViewport(before[0], before[1], before[2], before[3]);
}

}  // namespace gaitpad
