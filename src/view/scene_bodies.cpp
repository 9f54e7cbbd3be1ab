#include "view/scene_bodies.h"

#include <array>
#include <cstdint>
#include <limits>

#include "view/scene_ground.h"
#include "view/scene_shaders.h"

namespace gaitpad {
namespace {

constexpr double kLineShadow_m = 0.014;  // radius of a stick figure's line in its shadow
constexpr double kContact_m = 0.55;      // what is higher leaves no shadow straight below
constexpr double kShadowStep_m = 2.0;    // the shadows' picture grows in such steps: no flicker
constexpr double kLargestShadow_m = 16.0;

glm::vec4 row(const vec3& v, double w) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z),
          static_cast<float>(w)};
}

// Unit vector at right angles to the axis, towards `wide` where there is such a direction.
vec3 across(const vec3& axis, const vec3& wide) {
  const double length = glm::length(axis);
  const vec3 along = length > 1e-9 ? axis / length : kUp;
  const vec3 least = std::abs(along.x) < 0.7 ? kLeft : kForward;
  for (const vec3& wish : {wide, least}) {
    const vec3 side = wish - along * glm::dot(wish, along);
    if (glm::length(side) > 1e-6) return glm::normalize(side);
  }
  return kLeft;
}

bool is_drawable(const Capsule& c) {
  return is_finite(c.a_m) && is_finite(c.b_m) && is_finite(c.wide) &&
         std::isfinite(c.radius_a_m + c.radius_b_m + c.width_a + c.width_b);
}

// What throws its shadow from higher up does not feel each riser.
double floor_below(const SceneContent& content, const vec3& place_m) {
  constexpr double kNear_m = 0.35;
  if (content.terrain == nullptr) return 0.0;
  const double height_m = ground_at(*content.terrain, place_m.x, place_m.z).height_m;
  if (place_m.y - height_m < kNear_m) return height_m;
  return mean_ground_m(*content.terrain, place_m.x, place_m.z);
}

}  // namespace

Result<SceneBodies> SceneBodies::create(const MeshDetail& detail) {
  SceneBodies bodies;
  auto body = GlProgram::link("bodies", shader::kBodyVertex, shader::kBodyFragment);
  if (!body) return body.error();
  auto shadow = GlProgram::link("shadows", shader::kShadowVertex, shader::kShadowFragment);
  if (!shadow) return shadow.error();
  bodies.body_ = std::move(*body);
  bodies.shadow_program_ = std::move(*shadow);
  bodies.make_mesh(detail);
  bodies.make_shadow_target(detail.shadow_px);
  glBindFramebuffer(GL_FRAMEBUFFER, bodies.shadow_target_.get());
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    return Error{"OpenGL: the renderer cannot draw into a picture of two colours"};
  }
  return bodies;
}

// Rows of latitude from one pole to the seam, then from the seam to the other pole; between the
// two caps the same triangles make the cone.
void SceneBodies::make_mesh(const MeshDetail& detail) {
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
  std::vector<std::uint16_t> indices;
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const int a = r * columns + c, b = r * columns + (c + 1) % columns;
      for (const int i : {a, b, b + columns, a, b + columns, a + columns}) {
        indices.push_back(static_cast<std::uint16_t>(i));
      }
    }
  }
  index_count_ = static_cast<GLsizei>(indices.size());
  mesh_ = new_buffer();
  indices_ = new_buffer();
  instances_ = new_buffer();
  vertices_ = new_vertex_array();
  glBindVertexArray(vertices_.get());
  upload(mesh_, spots.data(), spots.size() * sizeof(spots[0]));
  constexpr VertexPart kSpot[] = {{0, 4}};
  set_vertex_parts(kSpot, 1, 0);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.get());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * 2), indices.data(),
               GL_STATIC_DRAW);
  glBindBuffer(GL_ARRAY_BUFFER, instances_.get());
  constexpr VertexPart kInstance[] = {{1, 4}, {2, 4}, {3, 4}, {4, 4}, {5, 2}};
  set_vertex_parts(kInstance, 5, 1);
  glBindVertexArray(0);
}

void SceneBodies::make_shadow_target(int size_px) {
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

// Those bodies whose lower end is at such a height.
void SceneBodies::add_rows(const SceneContent& content, const SceneView& view, double from_m,
                           double to_m) {
  for (const Capsule& c : content.bodies) {
    if (!is_drawable(c)) continue;
    const vec2 ground(floor_below(content, c.a_m), floor_below(content, c.b_m));
    const double low_m =
        std::min(c.a_m.y - c.radius_a_m - ground.x, c.b_m.y - c.radius_b_m - ground.y);
    if (low_m < from_m || low_m >= to_m) continue;
    const vec3 colour(c.colour.red, c.colour.green, c.colour.blue);
    rows_.push_back(
        {row(c.a_m - view.origin_m, c.radius_a_m), row(c.b_m - view.origin_m, c.radius_b_m),
         row(across(c.b_m - c.a_m, c.wide), c.width_a), row(colour, c.width_b), glm::vec2(ground)});
  }
}

void SceneBodies::load(const SceneContent& content, const SceneView& view) {
  constexpr double kAnywhere = std::numeric_limits<double>::infinity();
  rows_.clear();
  add_rows(content, view, -kAnywhere, kContact_m);
  low_bodies_ = rows_.size();
  add_rows(content, view, kContact_m, kAnywhere);
  bodies_ = rows_.size();
  for (const SceneLine& l : content.lines) {
    if (!is_finite(l.a_m) || !is_finite(l.b_m)) continue;
    rows_.push_back({row(l.a_m - view.origin_m, kLineShadow_m),
                     row(l.b_m - view.origin_m, kLineShadow_m), row(kLeft, 1.0),
                     row(vec3(0.0), 1.0),
                     glm::vec2(floor_below(content, l.a_m), floor_below(content, l.b_m))});
  }
  upload(instances_, rows_.data(), rows_.size() * sizeof(Instance));
}

// Round everybody, and where the light throws them; in whole steps, so that it does not swim.
ShadowPlace SceneBodies::shadow_place() const noexcept {
  if (rows_.empty()) return {};
  vec2 low(1e9), high(-1e9);
  for (const Instance& i : rows_) {
    for (const auto& [end, ground] :
         {std::pair(i.a_radius, i.ground.x), {i.b_radius, i.ground.y}}) {
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

// Red: thrown by the light. Green: straight below, what keeps the sky's light off the floor. The
// darkest counts, so bones that overlap do not show.
ShadowPlace SceneBodies::draw_shadows() {
  const ShadowPlace place = shadow_place();
  if (place.half_m <= 0.0) return place;
  glBindFramebuffer(GL_FRAMEBUFFER, shadow_target_.get());
  glViewport(0, 0, shadow_px_, shadow_px_);
  glDisable(GL_DEPTH_TEST);
  glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  glClear(GL_COLOR_BUFFER_BIT);
  glEnable(GL_BLEND);
  glBlendEquation(GL_MAX);
  glBindVertexArray(vertices_.get());
  shadow_program_.use();
  shadow_program_.set("centre", place.centre_m);
  shadow_program_.set("half_size", place.half_m);
  const auto draw = [this](const vec2& slide, const vec2& softness, double fading,
                           std::size_t count) {
    shadow_program_.set("slide", slide);
    shadow_program_.set("softness", softness);
    shadow_program_.set("fading", fading);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
  };
  glColorMask(GL_TRUE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw(vec2(kLightDirection.x, kLightDirection.z) / kLightDirection.y, {0.02, 0.075}, 0.0,
       rows_.size());
  glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_FALSE);
  draw({0.0, 0.0}, {0.02, 0.55}, 6.0, low_bodies_);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
  return place;
}

void SceneBodies::draw(const SceneView& view) const {
  body_.use();
  body_.set("to_clip", view.to_clip);
  body_.set("eye", view.eye_m());
  body_.set("light", kLightDirection);
  body_.set("sky_light", view.is_light() ? vec3(0.50, 0.54, 0.60) : vec3(0.36, 0.41, 0.50));
  body_.set("ground_light", view.is_light() ? vec3(0.30, 0.29, 0.28) : vec3(0.15, 0.13, 0.135));
  body_.set("key_strength", view.is_light() ? 0.80 : 0.86);
  body_.set("rim_strength", view.is_light() ? 0.10 : 0.34);
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  glFrontFace(GL_CCW);
  glBindVertexArray(vertices_.get());
  glDrawElementsInstanced(GL_TRIANGLES, index_count_, GL_UNSIGNED_SHORT, nullptr,
                          static_cast<GLsizei>(bodies_));
  glDisable(GL_CULL_FACE);
}

}  // namespace gaitpad
