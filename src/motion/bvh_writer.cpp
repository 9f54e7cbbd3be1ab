#include "motion/bvh_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace gaitpad {
namespace {

constexpr double kPoleLimit = 0.5;  // sine of 30 degrees
constexpr int kCountWidth = 10;

double worst_closeness(const EulerOrder& order, std::span<const quat> local, std::size_t joint,
                       std::size_t joints) {
  double worst = 0.0;
  for (std::size_t i = joint; i < local.size(); i += joints) {
    worst = std::max(worst, pole_closeness(order, local[i]));
  }
  return worst;
}

void append_offset(std::string& text, const vec3& offset) {
  fmt::format_to(std::back_inserter(text), "OFFSET {:.8f} {:.8f} {:.8f}\n", offset.x, offset.y,
                 offset.z);
}

std::string channel_names(const EulerOrder& order) {
  return fmt::format("{}rotation {}rotation {}rotation", "XYZ"[order[0]], "XYZ"[order[1]],
                     "XYZ"[order[2]]);
}

}  // namespace

std::vector<EulerOrder> euler_orders(const Skeleton& skeleton, std::span<const quat> local) {
  const std::size_t joints = skeleton.joints.size();
  std::vector<EulerOrder> orders(joints, kEulerZyx);
  for (std::size_t j = 0; j < joints; ++j) {
    double least = j == 0 ? 2.0 : worst_closeness(kEulerZyx, local, j, joints);
    if (least < kPoleLimit) continue;
    for (const EulerOrder& order : kEulerOrders) {
      if (j == 0 && order[0] != 1) continue;
      const double closeness = worst_closeness(order, local, j, joints);
      if (closeness >= least) continue;
      least = closeness;
      orders[j] = order;
    }
  }
  return orders;
}

BvhWriter::BvhWriter(std::ostream& out, const Skeleton& skeleton, const BvhLayout& layout)
    : out_(out), skeleton_(skeleton), layout_(layout) {
  if (layout_.orders.empty()) {
    layout_.orders.assign(skeleton.joints.size(), kEulerZyx);
    layout_.orders[0] = kEulerYxz;
  }
  previous_rad_.assign(skeleton.joints.size(), EulerAngles{});
  write_hierarchy();
}

bool BvhWriter::is_joint(int joint) const {
  return !skeleton_.joints[joint].is_end_site ||
         std::ranges::find(layout_.end_sites_as_joints, joint) != layout_.end_sites_as_joints.end();
}

void BvhWriter::write_hierarchy() {
  out_ << "HIERARCHY\n";
  write_joint(0, 0);
  out_ << "MOTION\nFrames: ";
  count_at_ = out_.tellp();
  out_ << fmt::format("{:<{}}\nFrame Time: {:.12f}\n", 0, kCountWidth, layout_.frame_time_s);
}

// Recursion is bounded by kMaxJoints.
void BvhWriter::write_joint(int joint, int depth) {
  const Joint& j = skeleton_.joints[joint];
  const std::string indent(static_cast<std::size_t>(depth), '\t');
  const bool has_channels = is_joint(joint);
  std::string text = indent;
  if (!has_channels)
    text += "End Site\n";
  else
    text += fmt::format("{} {}\n", joint == 0 ? "ROOT" : "JOINT", j.name);
  text += indent + "{\n" + indent + "\t";
  append_offset(text, joint == 0 ? vec3(0.0) : j.offset_m / layout_.metres_per_unit);
  if (has_channels) {
    joints_.push_back(joint);
    const std::string rotations = channel_names(layout_.orders[joint]);
    text += indent + (joint == 0 ? "\tCHANNELS 6 Xposition Yposition Zposition " : "\tCHANNELS 3 ");
    text += rotations + "\n";
  }
  out_ << text;
  bool is_leaf = true;
  for (int child = joint + 1; child < static_cast<int>(skeleton_.joints.size()); ++child) {
    if (skeleton_.joints[child].parent != joint) continue;
    is_leaf = false;
    write_joint(child, depth + 1);
  }
  if (is_leaf && has_channels) {  // a chain must end in an End Site
    out_ << indent << "\tEnd Site\n" << indent << "\t{\n" << indent << "\t\t";
    std::string end;
    append_offset(end, vec3(0.0));
    out_ << end << indent << "\t}\n";
  }
  out_ << indent << "}\n";
}

void BvhWriter::write(const Pose& pose) {
  const vec3 root = pose.root_m / layout_.metres_per_unit;
  line_.clear();
  auto end = std::back_inserter(line_);
  fmt::format_to(end, "{:.8f} {:.8f} {:.8f}", root.x, root.y, root.z);
  for (const int joint : joints_) {
    EulerAngles& angles = previous_rad_[joint];
    angles = nearest_euler(layout_.orders[joint], pose.local[joint], angles);
    fmt::format_to(end, " {:.7f} {:.7f} {:.7f}", angles[0] / kDegree, angles[1] / kDegree,
                   angles[2] / kDegree);
  }
  line_ += '\n';
  out_ << line_;
  ++frames_;
}

bool BvhWriter::finish() {
  const auto end = out_.tellp();
  out_.seekp(count_at_);
  out_ << frames_;
  out_.seekp(end);
  out_.flush();
  return out_.good();
}

}  // namespace gaitpad
