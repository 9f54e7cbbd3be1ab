// The shaders of the scene in GLSL 3.30. Lighting is computed in linear colours.
#pragma once

namespace gaitpad::shader {

// --- bodies --------------------------------------------------------------------------------------
// A vertex has the direction around the axis (cosine, sine), the position between a cap's pole and
// its seam, and the cap. The caps continue the cone between them tangentially.
inline constexpr const char* kBodyVertex = R"(#version 330 core
layout(location = 0) in vec4 direction_latitude_cap;
layout(location = 1) in vec4 a_radius;
layout(location = 2) in vec4 b_radius;
layout(location = 3) in vec4 across_width_a;
layout(location = 4) in vec4 colour_width_b;
layout(location = 5) in vec3 ground_layer;  // height of the floor below a, below b
layout(location = 6) in vec3 across_b;
uniform mat4 to_clip;
uniform float drawn_layer;
out vec3 place;
out vec3 normal;
out float above_floor_m;
flat out vec3 colour;
void main() {
  vec3 along = b_radius.xyz - a_radius.xyz;
  float span = length(along);
  vec3 axis = span > 1e-6 ? along / span : vec3(0.0, 1.0, 0.0);
  bool at_b = direction_latitude_cap.w > 0.5;
  vec3 side = at_b ? across_b : across_width_a.xyz;
  vec3 deep = cross(axis, side);
  float seam = asin(clamp((a_radius.w - b_radius.w) / max(span, 1e-6), -1.0, 1.0));
  float latitude = mix(at_b ? 1.5707963 : -1.5707963, seam, direction_latitude_cap.z);
  vec3 round = vec3(cos(latitude) * direction_latitude_cap.xy, sin(latitude));
  float radius = at_b ? b_radius.w : a_radius.w;
  float width = at_b ? colour_width_b.w : across_width_a.w;
  place = (at_b ? b_radius.xyz : a_radius.xyz) +
          radius * (side * (round.x * width) + deep * round.y + axis * round.z);
  normal = side * (round.x / width) + deep * round.y + axis * round.z;
  above_floor_m = place.y - (at_b ? ground_layer.y : ground_layer.x);
  colour = colour_width_b.rgb;
  bool is_drawn = ground_layer.z == drawn_layer;
  gl_Position = is_drawn ? to_clip * vec4(place, 1.0) : vec4(0.0, 0.0, 2.0, 1.0);
}
)";

// The light on bodies, prepended to two fragment shaders. `facing` is 1 where the surface faces the
// eye.
inline constexpr const char* kLight = R"(#version 330 core
uniform vec3 light;
uniform vec3 sky_light;
uniform vec3 ground_light;
uniform float key_strength;
uniform float rim_strength;
out vec4 shown;
vec3 lit(vec3 base, vec3 n, float facing, float near_floor, float gloss) {
  vec3 ambient = mix(ground_light, sky_light, 0.5 + 0.5 * n.y) * near_floor;
  float key = smoothstep(-0.25, 1.0, dot(n, light)) * key_strength;
  float edge = 1.0 - facing;
  float rim = edge * edge * edge * rim_strength * near_floor;
  return base * (ambient + key * vec3(1.0, 0.975, 0.93)) + rim * vec3(0.55, 0.68, 0.85) +
         gloss * key;
}
)";

inline constexpr const char* kBodyFragment = R"(
in vec3 place;
in vec3 normal;
in float above_floor_m;
flat in vec3 colour;
uniform vec3 eye;
void main() {
  vec3 n = normalize(normal);
  vec3 to_eye = normalize(eye - place);
  float near_floor = mix(0.55, 1.0, smoothstep(0.0, 0.35, above_floor_m));
  float gloss = 0.16 * pow(max(dot(n, normalize(light + to_eye)), 0.0), 46.0);
  vec3 base = colour * colour * (0.25 + 0.75 * colour);  // nearly the power 2.2
  vec3 seen = lit(base, n, max(dot(n, to_eye), 0.0), near_floor, gloss);
  shown = vec4(pow(seen, vec3(1.0 / 2.2)), 1.0);
}
)";

// --- the crowd -----------------------------------------------------------------------------------
// A rectangle from one ball's far end to the other's, turned around the capsule's axis to the eye.
// Its width depends on the visible side.
inline constexpr const char* kCrowdVertex = R"(#version 330 core
layout(location = 1) in vec4 a_radius;
layout(location = 2) in vec4 b_radius;
layout(location = 3) in vec4 wide_width_a;
layout(location = 4) in vec4 colour_width_b;
layout(location = 5) in float ground;  // height of the floor below it
uniform mat4 to_clip;
uniform vec3 eye;
uniform vec3 light;
uniform vec3 moved;
out float above_floor_m;
out vec2 aside_along_m;  // aside of the axis, and along it from a as it is seen
flat out vec3 aside;
flat out vec3 upwards;
flat out vec3 radii;  // at a, at b; and the seen length
flat out vec3 base;
flat out vec3 half_way;
flat out float cap;  // how much of a cap's curve shows
void main() {
  vec3 a = a_radius.xyz + moved, b = b_radius.xyz + moved, along = b - a;
  float span = length(along);
  vec3 axis = span > 1e-6 ? along / span : vec3(0.0, 1.0, 0.0);
  vec3 to_eye = normalize(eye - 0.5 * (a + b));
  aside = cross(axis, to_eye);
  if (dot(aside, aside) < 1e-4) aside = cross(axis.zxy, to_eye);
  aside = normalize(aside);
  upwards = cross(to_eye, aside);
  vec3 side = wide_width_a.xyz - axis * dot(axis, wide_width_a.xyz);
  vec2 widths = vec2(wide_width_a.w, abs(colour_width_b.w));
  cap = colour_width_b.w < 0.0 ? 0.15 : 1.0;
  float seen = 0.0;  // the share of the wide side that is seen, squared
  if (dot(side, side) > 1e-6) seen = pow(dot(aside, normalize(side)), 2.0);
  vec2 wide = sqrt(mix(vec2(1.0), widths * widths, seen));
  radii = vec3(a_radius.w * wide.x, b_radius.w * wide.y, max(dot(along, upwards), 0.0));
  float reach = max(radii.x, radii.y) * 1.05;
  bool at_b = gl_VertexID > 1;
  float aside_m = (gl_VertexID & 1) == 1 ? reach : -reach;
  aside_along_m = vec2(aside_m, at_b ? radii.z + radii.y * 1.05 : -radii.x * 1.05);
  vec3 place = (at_b ? b + upwards * radii.y * 1.05 : a - upwards * radii.x * 1.05) + aside * aside_m;
  above_floor_m = place.y - moved.y - ground;
  half_way = normalize(light + to_eye);
  vec3 c = colour_width_b.rgb;
  base = c * c * (0.25 + 0.75 * c);
  gl_Position = to_clip * vec4(place, 1.0);
}
)";

// The light of kLight with cheaper powers, for the crowd.
inline constexpr const char* kCrowdFragment = R"(
in float above_floor_m;
in vec2 aside_along_m;
flat in vec3 aside;
flat in vec3 upwards;
flat in vec3 radii;
flat in vec3 base;
flat in vec3 half_way;
flat in float cap;
uniform float samples;  // more than 1: the cover becomes samples
void main() {
  float along = clamp(aside_along_m.y, 0.0, radii.z);
  float radius = mix(radii.x, radii.y, radii.z > 1e-5 ? along / radii.z : 0.5);
  vec2 off = vec2(aside_along_m.x, aside_along_m.y - along) / radius;
  float far = dot(off, off);
  float cover = 1.0;
  if (samples > 1.0) {
    float edge = length(off);
    cover = clamp((1.0 - edge) / max(fwidth(edge), 1e-4) + 0.5, 0.0, 1.0);
    if (cover <= 0.0) discard;
  } else if (far > 1.0) {
    discard;
  }
  vec3 to_eye = cross(aside, upwards);
  float bent = off.y * cap;
  float facing = sqrt(max(1.0 - off.x * off.x - bent * bent, 0.0));
  vec3 n = aside * off.x + upwards * bent + to_eye * facing;
  float near_floor = mix(0.55, 1.0, clamp(above_floor_m * 3.0, 0.0, 1.0));
  float gloss = max(dot(n, half_way), 0.0);
  gloss *= gloss;
  gloss *= gloss;
  gloss *= gloss;
  gloss *= gloss;
  gloss *= gloss;  // the power 32
  vec3 root = sqrt(lit(base, n, facing, near_floor, 0.12 * gloss));
  shown = vec4(mix(root, sqrt(root), 0.15), cover);  // nearly the power 1 / 2.2
}
)";

inline constexpr const char* kShadeVertex = R"(#version 330 core
layout(location = 1) in vec4 a_radius;
layout(location = 2) in vec4 b_radius;
layout(location = 3) in float dark_in;
uniform mat4 to_clip;
uniform vec3 moved;
out vec2 from_a_m;
flat out vec2 along;
flat out vec2 radii;
flat out float dark;
void main() {
  along = b_radius.xz - a_radius.xz;
  float span = length(along), reach = max(a_radius.w, b_radius.w);
  vec2 u = span > 1e-5 ? along / span : vec2(1.0, 0.0);
  bool at_b = gl_VertexID > 1;
  vec2 corner = u * (at_b ? reach : -reach) +
                vec2(-u.y, u.x) * ((gl_VertexID & 1) == 1 ? reach : -reach);
  from_a_m = (at_b ? along : vec2(0.0)) + corner;
  radii = vec2(a_radius.w, b_radius.w);
  dark = dark_in;
  vec3 place = (at_b ? b_radius.xyz : a_radius.xyz) + vec3(corner.x, 0.0, corner.y) + moved;
  gl_Position = to_clip * vec4(place, 1.0);
}
)";

inline constexpr const char* kShadeFragment = R"(#version 330 core
in vec2 from_a_m;
flat in vec2 along;
flat in vec2 radii;
flat in float dark;
out vec4 shown;
void main() {
  float part = clamp(dot(from_a_m, along) / max(dot(along, along), 1e-8), 0.0, 1.0);
  float off = length(from_a_m - along * part) / mix(radii.x, radii.y, part);
  float fading = max(1.0 - off * off, 0.0);
  shown = vec4(0.0, 0.0, 0.0, dark * fading * fading * (1.0 - 0.5 * part));
}
)";

// --- shadows -------------------------------------------------------------------------------------
// One square for each bone, drawn into a texture of the floor. Each end is projected along `slide`
// to a disc; its edge is softer the higher the end is.
inline constexpr const char* kShadowVertex = R"(#version 330 core
layout(location = 1) in vec4 a_radius;
layout(location = 2) in vec4 b_radius;
layout(location = 3) in vec4 across_width_a;
layout(location = 4) in vec4 colour_width_b;
layout(location = 5) in vec2 ground;
uniform vec2 slide;       // metres on the floor per metre of height
uniform vec2 edge_width;  // metres at the floor, more metres per metre of height
uniform vec2 centre;
uniform float half_size;
uniform float fading_1_m;  // of a metre of edge
out vec2 from_a_m;
flat out vec2 along;
flat out float per_span;
flat out vec4 discs;  // radius and edge at a, at b
flat out vec2 dark;   // at a, at b
void main() {
  vec2 above = vec2(a_radius.y, b_radius.y) - ground;
  vec2 a = a_radius.xz - slide * above.x, b = b_radius.xz - slide * above.y;
  vec2 radius = vec2(a_radius.w * (0.5 + 0.5 * across_width_a.w),
                     b_radius.w * (0.5 + 0.5 * colour_width_b.w));
  vec2 height = max(above - vec2(a_radius.w, b_radius.w), 0.0);
  vec2 edge = edge_width.x + edge_width.y * height;
  float reach = max(radius.x + edge.x, radius.y + edge.y);
  along = b - a;
  float span = length(along);
  per_span = 1.0 / max(span * span, 1e-8);
  vec2 u = span > 1e-5 ? along / span : vec2(1.0, 0.0);
  vec2 v = vec2(-u.y, u.x);
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  from_a_m = 0.5 * along + u * corner.x * (0.5 * span + reach) + v * corner.y * reach;
  discs = vec4(radius.x, edge.x, radius.y, edge.y);
  // What is thin hardly hides a light that has a size.
  dark = min(vec2(1.0), 0.45 + radius / edge) * exp(-fading_1_m * edge);
  gl_Position = vec4((a + from_a_m - centre) / half_size, 0.0, 1.0);
}
)";

inline constexpr const char* kShadowFragment = R"(#version 330 core
in vec2 from_a_m;
flat in vec2 along;
flat in float per_span;
flat in vec4 discs;
flat in vec2 dark;
out vec4 shown;
void main() {
  float share = clamp(dot(from_a_m, along) * per_span, 0.0, 1.0);
  vec2 disc = mix(discs.xy, discs.zw, share);
  float inside = clamp(0.5 + 0.5 * (disc.x - length(from_a_m - share * along)) / disc.y, 0.0, 1.0);
  shown = vec4(inside * inside * (3.0 - 2.0 * inside) * mix(dark.x, dark.y, share));
}
)";

// --- floor and background ------------------------------------------------------------------------
// Both use the same background colour, so that the floor fades into it without blending.
// `in_picture` goes from -1 to 1 over the picture.
inline constexpr const char* kBackground = R"(#version 330 core
uniform vec3 sky_top;
uniform vec3 sky_bottom;
uniform float vignette;
uniform vec2 size_px;
uniform float band_px;
out vec4 shown;
vec2 picture_px() { return gl_FragCoord.xy + vec2(0.0, band_px); }
vec3 background() {
  vec2 in_picture = picture_px() / size_px * 2.0 - 1.0;
  return mix(sky_bottom, sky_top, 0.5 + 0.5 * in_picture.y) *
         (1.0 - vignette * dot(in_picture, in_picture));
}
// Half a step of noise, against bands.
void show(vec3 colour) {
  float noise = fract(52.9829189 * fract(dot(picture_px(), vec2(0.06711056, 0.00583715))));
  shown = vec4(colour + (noise - 0.5) / 255.0, 1.0);
}
)";

inline constexpr const char* kSkyVertex = R"(#version 330 core
void main() {
  vec2 in_picture = vec2(float((gl_VertexID & 1) * 4), float((gl_VertexID >> 1) * 4)) - 1.0;
  gl_Position = vec4(in_picture, 1.0, 1.0);
}
)";

inline constexpr const char* kSkyFragment = R"(
void main() { show(background()); }
)";

inline constexpr const char* kFloorVertex = R"(#version 330 core
uniform mat4 to_clip;
uniform vec2 focus;
uniform vec2 shadow_centre;
uniform float per_shadow;
uniform float half_size;
out vec2 from_focus;
out vec2 world;
out vec2 in_shadow;
void main() {
  vec2 corner = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  from_focus = corner * half_size;
  vec2 place = focus + from_focus;
  world = place;  // counted from whole metres
  in_shadow = 0.5 + 0.5 * (place - shadow_centre) * per_shadow;
  // Behind everything but the background: what lies on it or stands there is never hidden by it.
  gl_Position = to_clip * vec4(place.x, 0.0, place.y, 1.0);
  gl_Position.z = 0.99999 * gl_Position.w;
}
)";

// Appended to the background's text and followed by one of the two fragment shaders that use it.
// `light`: 1 on level ground; `mark`: strength of an edge; `rise`: 1 on a riser's face.
inline constexpr const char* kFloorColour = R"(
in vec2 from_focus;
in vec2 in_shadow;
uniform vec3 floor_near;
uniform vec3 floor_far;
uniform vec3 riser;
uniform vec3 nose;
uniform vec3 grid;
uniform float fade_from;
uniform float half_size;
uniform vec2 shadow_depth;  // of the light's shadow, of the contact
uniform vec2 grid_depth;    // of the metre lines, of the 20 cm lines
uniform float pixel;        // of scale 1
uniform sampler2D shadow;

// How much of a pixel lines `width_px` wide, one a cell, cover. Gone where they would be too dense.
float lines(vec2 place, vec2 cell_px, float width_px) {
  vec2 apart_px = abs(fract(place - 0.5) - 0.5) * cell_px;
  vec2 cover = clamp(0.5 * width_px + 0.5 - apart_px, 0.0, 1.0) *
               clamp((cell_px - 2.5) * 0.15, 0.0, 1.0);
  return max(cover.x, cover.y);
}
void show_floor(vec2 world, float light, float mark, float rise) {
  vec2 metre_px = 1.0 / max(fwidth(world), vec2(1e-5));
  float distance_m = length(from_focus);
  vec3 ground = mix(mix(floor_near, riser, rise), floor_far, min(distance_m / half_size, 1.0));
  float fine = lines(world * 5.0, metre_px * 0.2, pixel) * grid_depth.y;
  float coarse = lines(world, metre_px, 1.9 * pixel) * grid_depth.x;
  ground = mix(mix(ground, grid, max(fine, coarse) * (1.0 - 0.7 * rise)) * light, nose, mark);
  vec2 dark = textureLod(shadow, in_shadow, 0.0).rg * shadow_depth;
  ground *= (1.0 - dark.r) * (1.0 - dark.g);
  show(mix(ground, background(), smoothstep(fade_from, half_size, distance_m)));
}
)";

inline constexpr const char* kFloorFragment = R"(
in vec2 world;
void main() { show_floor(world, 1.0, 0.0, 0.0); }
)";

inline constexpr const char* kGroundVertex = R"(#version 330 core
layout(location = 0) in vec3 vertex_m;
layout(location = 1) in vec3 normal_in;
layout(location = 2) in vec2 edges_in;
uniform mat4 to_clip;
uniform vec3 moved;
uniform vec2 focus;
uniform vec2 shadow_centre;
uniform float per_shadow;
uniform float behind_m;
out vec2 from_focus;
out vec2 in_shadow;
out vec3 place;
out vec3 normal;
out vec2 edges;  // metres to a riser's upper and to its lower edge
void main() {
  place = vertex_m + moved;
  normal = normal_in;
  edges = edges_in;
  from_focus = place.xz - focus;
  in_shadow = 0.5 + 0.5 * (place.xz - shadow_centre) * per_shadow;
  gl_Position = to_clip * vec4(place, 1.0);
  gl_Position.z += 0.2 * behind_m / max(gl_Position.w, 0.1);  // of a near plane at 0.1 m
}
)";

// Treads and risers have two tones, and higher parts are brighter, so that steps are easy to see.
// Gentle slopes are shaded more than by the light, so that humps of 6 cm show. A riser shows only
// the grid lines across it; lines along it would be at arbitrary heights.
inline constexpr const char* kGroundFragment = R"(
in vec3 place;
in vec3 normal;
in vec2 edges;
uniform vec3 light;
uniform float level;  // height of the ground below the focus
uniform float tone;
uniform float relief;  // of slopes, over what the light would do
void main() {
  vec3 n = normalize(normal);
  bool is_riser = abs(n.z) > 0.8;
  float facing = dot(n, light) / light.y;
  float slope = relief * (facing - 1.0);
  float lit = is_riser ? mix(0.8, 1.0, clamp(facing, 0.0, 1.0))
                       : 1.0 + slope / (1.0 + 1.2 * abs(slope));
  lit *= tone * (1.0 + 0.14 * clamp(place.y - level, -1.2, 1.2));
  lit *= 1.0 - 0.4 * exp(-edges.y * 14.0);  // what a riser keeps of the sky's light
  float edge_px = edges.x / max(fwidth(edges.x), 1e-6);
  float mark = 0.8 * clamp(1.6 * pixel + 0.5 - edge_px, 0.0, 1.0);
  show_floor(is_riser ? vec2(place.x, 0.5) : place.xz, lit, mark, is_riser ? 1.0 : 0.0);
}
)";

// --- lines and trails ----------------------------------------------------------------------------
// A line is a rectangle in the picture, without perspective, wide enough for its round ends and
// half a pixel of soft edge.
inline constexpr const char* kLineVertex = R"(#version 330 core
layout(location = 1) in vec4 a_radius;  // pixels
layout(location = 2) in vec3 b;
layout(location = 3) in vec4 colour_in;
uniform mat4 to_clip;
uniform vec2 size_px;
out vec2 along_aside_px;
flat out float span;
flat out float radius;
flat out vec4 colour;
const float kNear = 0.1;
void main() {
  vec4 from = to_clip * vec4(a_radius.xyz, 1.0), to = to_clip * vec4(b, 1.0);
  colour = colour_in;
  radius = a_radius.w;
  span = 0.0;
  along_aside_px = vec2(0.0);
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (from.w < kNear && to.w < kNear) return;  // behind the eye
  if (from.w < kNear) from = mix(from, to, (kNear - from.w) / (to.w - from.w));
  if (to.w < kNear) to = mix(to, from, (kNear - to.w) / (from.w - to.w));
  vec3 start = from.xyz / from.w, end = to.xyz / to.w;
  vec2 along = (end.xy - start.xy) * 0.5 * size_px;
  span = length(along);
  vec2 u = span > 1e-3 ? along / span : vec2(1.0, 0.0);
  float reach = radius + 1.0;
  bool at_end = (gl_VertexID & 1) == 1;
  along_aside_px = vec2(at_end ? span + reach : -reach, (gl_VertexID >> 1) == 1 ? reach : -reach);
  vec2 moved = u * (at_end ? reach : -reach) + vec2(-u.y, u.x) * along_aside_px.y;
  vec3 place = at_end ? end : start;
  gl_Position = vec4(place.xy + moved * 2.0 / size_px, place.z, 1.0);
}
)";

inline constexpr const char* kLineFragment = R"(#version 330 core
in vec2 along_aside_px;
flat in float span;
flat in float radius;
flat in vec4 colour;
out vec4 shown;
void main() {
  float off = length(vec2(along_aside_px.x - clamp(along_aside_px.x, 0.0, span), along_aside_px.y));
  float cover = clamp(radius + 0.5 - off, 0.0, 1.0);
  if (cover <= 0.0) discard;
  float round = 1.0 - 0.28 * smoothstep(0.25, 1.0, off / max(radius, 0.5));
  shown = vec4(colour.rgb * round, colour.a * cover);
}
)";

// A ribbon that faces the eye, built by the caller.
inline constexpr const char* kTrailVertex = R"(#version 330 core
layout(location = 0) in vec4 clip;
layout(location = 1) in vec3 edge_in;  // pixels from the middle, half width, strength
layout(location = 2) in vec3 colour_in;
out vec3 edge;
out vec3 colour;
void main() {
  edge = edge_in;
  colour = colour_in;
  gl_Position = clip;
}
)";

inline constexpr const char* kTrailFragment = R"(#version 330 core
in vec3 edge;
in vec3 colour;
out vec4 shown;
void main() {
  float cover = clamp(edge.y + 0.5 - abs(edge.x), 0.0, 1.0);
  shown = vec4(colour, cover * edge.z);
}
)";

}  // namespace gaitpad::shader
