// A walk as binary glTF 2.0, for Blender and all else that opens .glb: joints as nodes, one
// animation, and a plain body (a rod a bone) skinned to them. Metres, y up, +z forward, as glTF has
// it too.
#pragma once
#include <array>
#include <fstream>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "gaitpad/skeleton.h"

namespace gaitpad {

struct GltfLayout {
  std::string name;              // of the body
  double fps = 240.0;            // poses a second
  std::vector<quat> rest_local;  // one a joint: the pose in which body and joints are bound
  vec3 rest_root_m{0.0};
};

// A .glb begins with what only its end knows, and has each joint's rotations in one piece. So poses
// go to `scratch` (open for reading and writing, empty) in pieces of kChunkFrames, and finish()
// puts the file together: memory does not grow with the walk.
class GltfWriter {
 public:
  // `out` and `skeleton` are the caller's, alive until finish().
  GltfWriter(std::ostream& out, std::fstream scratch, const Skeleton& skeleton, GltfLayout layout);
  void write(const Pose& pose);  // appends a frame
  // The sentence's end where nothing whole was written: too many poses, or a full disk.
  std::optional<std::string> finish();

 private:
  static constexpr std::size_t kChunkFrames = 1024;
  std::size_t joints() const { return skeleton_->joints.size(); }
  std::size_t turning() const { return turning_.size(); }
  std::size_t chunk_bytes() const;
  void write_chunk();
  // Values of one joint (or, behind the last, of the root's place) over all frames.
  bool copy_track(std::size_t track, std::size_t floats);

  std::ostream* out_;
  std::fstream scratch_;
  const Skeleton* skeleton_;
  GltfLayout layout_;
  std::vector<int> turning_;  // joints that have a rotation: no End Sites
  std::vector<quat> before_;
  std::vector<std::vector<float>> chunk_;  // one a turning joint, then the root's places
  std::size_t frames_ = 0;
};

}  // namespace gaitpad
