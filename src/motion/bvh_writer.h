// Poses as a BVH file that Blender and others open.
#pragma once
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "motion/euler.h"
#include "motion/skeleton.h"

namespace gaitpad {

// For each joint the rotation order whose pole is far from all sampled rotations: z y x where that
// stays below 30 degrees, else the best of the six. The root turns about y first, so that a heading
// has no pole. `local` holds samples x joints.
std::vector<EulerOrder> euler_orders(const Skeleton& skeleton, std::span<const quat> local);

struct BvhLayout {
  double metres_per_unit = 1.0;
  double frame_time_s = 1.0 / 240.0;
  // End Sites to be written as joints (a foot's toe, where the skeleton has no toe joint).
  std::vector<int> end_sites_as_joints;
  std::vector<EulerOrder> orders;  // one a joint; empty: y x z for the root, z y x for the others
};

// Root OFFSET 0 0 0 and six channels, three rotations for every other joint. Of the equal Euler
// triples the one nearest to the frame before is written, so that no channel flips. Writes as it
// goes; the number of frames is filled in by finish(), so `out` must be able to seek.
class BvhWriter {
 public:
  BvhWriter(std::ostream& out, const Skeleton& skeleton, const BvhLayout& layout);
  void write(const Pose& pose);  // appends a frame
  bool finish();                 // false if anything could not be written

 private:
  void write_hierarchy();
  void write_joint(int joint, int depth);
  bool is_joint(int joint) const;

  std::ostream& out_;
  const Skeleton& skeleton_;  // the caller's, alive until finish()
  BvhLayout layout_;
  std::vector<int> joints_;  // those with channels, in the order of the file
  std::vector<EulerAngles> previous_rad_;
  std::string line_;
  std::ostream::pos_type count_at_;
  long long frames_ = 0;
};

}  // namespace gaitpad
