// The body that a .glb shows: a rod for each bone, thicker where it begins.
#pragma once
#include <cstdint>
#include <vector>

#include "motion/skeleton.h"

namespace gaitpad {

// Triangles, three vertices each, none shared: flat shading. Bound to the bone's upper joint alone.
struct GltfBody {
  std::vector<vec3> place_m, normal;  // world, in the pose given
  std::vector<std::uint16_t> joint;   // index in the skeleton
};
// `world` holds where the joints are when the body is bound.
GltfBody gltf_body(const Skeleton& skeleton, const JointFrames& world);

}  // namespace gaitpad
