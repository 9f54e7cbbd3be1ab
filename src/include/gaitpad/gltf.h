// Writes a walk as binary glTF 2.0 (.glb), which Blender and others open: the joints as nodes, one
// animation, and a plain body, one rod for each bone, skinned to them. Metres, y up, +z forward, as
// glTF defines them.
#pragma once
#include <array>
#include <fstream>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/skeleton.h"

namespace gaitpad {

// Format of a file that is written. The caller fills it.
struct GltfLayout {
  std::string name;    // name of the body
  double fps = 240.0;  // poses in a second, 0.001 .. 10,000
  // The local rotation of each joint, of length 1, in the pose in which the body is bound to the
  // joints.
  std::vector<quat> rest_local;
  vec3 rest_root_m{0.0};  // place of the root in that pose, world; coordinates at most 1e6
};
// Errors read `GltfLayout: fps is 0, outside [0.001, 10000]`.
std::optional<Error> check(const GltfLayout& layout, const Skeleton& skeleton);

// Writes a .glb. Its header holds lengths that are known at the end, and each joint's rotations are
// in one block. So the poses go to `scratch` in chunks and finish() puts the file together: memory
// does not grow with the walk.
class GltfWriter {
 public:
  // `out` and `skeleton` must live until finish(). `scratch` is an empty file, open for reading and
  // writing.
  GltfWriter(std::ostream& out, std::fstream scratch, const Skeleton& skeleton, GltfLayout layout);
  void write(const Pose& pose);  // Appends a frame.
  // Writes the file. Returns why it is incomplete: too many poses, a full disk, or what check()
  // says of the layout; then nothing was written.
  std::optional<std::string> finish();

 private:
  static constexpr std::size_t kChunkFrames = 1024;
  std::size_t joints() const { return skeleton_->joints.size(); }
  std::size_t turning() const { return turning_.size(); }
  std::size_t chunk_bytes() const;
  void write_chunk();
  // Copies the values of one joint over all frames (after the last joint: the root's place).
  bool copy_track(std::size_t track, std::size_t floats);

  std::ostream* out_;
  std::fstream scratch_;
  const Skeleton* skeleton_;
  GltfLayout layout_;
  std::vector<int> turning_;  // joints with rotations: all but the End Sites
  std::vector<quat> before_;
  std::vector<std::vector<float>> chunk_;  // values of each of these joints, then the root's places
  std::size_t frames_ = 0;
  std::optional<Error> problem_;  // why check() refuses the layout
};

}  // namespace gaitpad
