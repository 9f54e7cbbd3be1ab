#include "gaitpad/bvh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <optional>

#include "base/ranges.h"
#include "base/text.h"
#include "files/euler.h"
#include "files/input_files.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/skeleton.h"

namespace gaitpad {

namespace {

// Limits of the unit of a file that is written.
constexpr double kLeastUnit_m = 1e-9, kMostUnit_m = 1e6;

// Words and lines of a text, with the line number of the last word.
class Reader {
 public:
  explicit Reader(std::string_view text) : rest_(without_byte_order_mark(text)) {}
  int line() const { return line_; }
  std::size_t bytes_left() const { return rest_.size(); }

  // Next word across lines; braces are words of their own. Empty at the end.
  std::string_view word() {
    skip_blank();
    if (rest_.empty()) return {};
    std::size_t n = 1;
    if (!is_brace(rest_[0])) {
      while (n < rest_.size() && !is_blank(rest_[n]) && rest_[n] != '\n' && !is_brace(rest_[n]))
        ++n;
    }
    return take(n);
  }
  // The rest of this line up to a brace, trimmed: names may contain blanks.
  std::string_view name() {
    std::size_t n = 0;
    while (n < rest_.size() && rest_[n] != '\n' && !is_brace(rest_[n])) ++n;
    return trimmed(take(n));
  }
  // Next line that is not blank, trimmed. Empty at the end.
  std::string_view full_line() {
    skip_blank();
    return trimmed(take(std::min(rest_.find('\n'), rest_.size())));
  }

 private:
  static bool is_brace(char c) { return c == '{' || c == '}'; }
  void skip_blank() {
    while (!rest_.empty() && (is_blank(rest_[0]) || rest_[0] == '\n')) {
      if (rest_[0] == '\n') ++line_;
      rest_.remove_prefix(1);
    }
  }
  std::string_view take(std::size_t n) {
    const std::string_view taken = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return taken;
  }

  std::string_view rest_;
  int line_ = 1;
};

std::optional<BvhChannel> channel_named(std::string_view word) {
  constexpr std::array<std::string_view, 6> kNames = {"xposition", "yposition", "zposition",
                                                      "xrotation", "yrotation", "zrotation"};
  const std::string lower = lower_case(word.substr(0, 16));
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (lower == kNames[i]) return static_cast<BvhChannel>(i);
  }
  return std::nullopt;
}

// Reads a file. Its functions return false at the first error, which message_ then holds.
class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : in_(text), name_(name) {}

  Result<Bvh> bvh() {
    if (!hierarchy() || !motion_header() || !frames()) return Error{message_};
    return std::move(bvh_);
  }

 private:
  bool fail(const std::string& cause) {
    message_ = fmt::format("{}:{}: {}", name_, in_.line(), cause);
    return false;
  }

  bool hierarchy() {
    if (in_.word() != "HIERARCHY") return fail("the file does not begin with HIERARCHY");
    if (in_.word() != "ROOT") return fail("ROOT expected after HIERARCHY");
    if (!open_joint(-1)) return false;
    std::vector<int> open = {0};
    while (!open.empty()) {
      if (!item(open)) return false;
    }
    return true;
  }

  // Reads one keyword inside the braces of the innermost open joint, the last of `open`.
  bool item(std::vector<int>& open) {
    const int joint = open.back();
    const std::string_view word = in_.word();
    if (word == "OFFSET") return offset(joint);
    if (word == "CHANNELS") return channels(joint);
    if (word == "}") {
      open.pop_back();
      if (has_offset_[joint] || bvh_.joints[joint].is_end_site) return true;
      return fail(fmt::format("{} has no OFFSET", in_quotes(bvh_.joints[joint].name)));
    }
    if (word == "JOINT" || word == "End") {
      if (bvh_.joints[joint].is_end_site) return fail("an End Site has children");
      const bool opened = word == "JOINT" ? open_joint(joint) : open_end_site(joint);
      if (opened) open.push_back(static_cast<int>(bvh_.joints.size()) - 1);
      return opened;
    }
    if (word.empty()) return fail("the file ends inside the hierarchy");
    return fail(fmt::format("unexpected {} in joint {}", in_quotes(word),
                            in_quotes(bvh_.joints[joint].name)));
  }

  bool open_joint(int parent) {
    const std::string_view name = in_.name();
    if (name.empty()) return fail("a joint without a name");
    return open_braces({.name = std::string(name), .parent = parent});
  }

  bool open_end_site(int parent) {
    in_.name();  // skips "Site", which some files replace by a name
    int siblings = 0;
    for (const BvhJoint& joint : bvh_.joints)
      siblings += joint.is_end_site && joint.parent == parent;
    std::string name = bvh_.joints[parent].name + "_End";
    if (siblings > 0) name += std::to_string(siblings + 1);
    return open_braces({.name = std::move(name), .parent = parent, .is_end_site = true});
  }

  bool open_braces(BvhJoint joint) {
    if (bvh_.joints.size() >= static_cast<std::size_t>(kMaxJoints)) {
      return fail(fmt::format("more than {} joints and end sites", kMaxJoints));
    }
    if (in_.word() != "{")
      return fail(fmt::format("\"{{\" expected after {}", in_quotes(joint.name)));
    bvh_.joints.push_back(std::move(joint));
    has_offset_.push_back(false);
    return true;
  }

  bool offset(int joint) {
    if (has_offset_[joint]) {
      return fail(fmt::format("{} has OFFSET twice", in_quotes(bvh_.joints[joint].name)));
    }
    has_offset_[joint] = true;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = in_.word();
      const auto value = parse_bounded(word);
      if (!value) {
        return fail(fmt::format("OFFSET of {}: {} is not a number",
                                in_quotes(bvh_.joints[joint].name), in_quotes(word)));
      }
      bvh_.joints[joint].offset[axis] = *value;
    }
    return true;
  }

  bool channels(int index) {
    BvhJoint& joint = bvh_.joints[index];
    if (joint.is_end_site) return fail("an End Site has CHANNELS");
    if (joint.channels > 0)
      return fail(fmt::format("{} has CHANNELS twice", in_quotes(joint.name)));
    const std::string_view word = in_.word();
    const auto count = parse_bounded(word);
    if (!count || *count < 0 || *count > 6 || *count != std::floor(*count)) {
      return fail(fmt::format("CHANNELS of {}: {} is not a count from 0 to 6",
                              in_quotes(joint.name), in_quotes(word)));
    }
    joint.first_value = bvh_.channels;
    while (joint.channels < static_cast<int>(*count)) {
      if (!channel(joint)) return false;
    }
    bvh_.channels += joint.channels;
    return true;
  }

  bool channel(BvhJoint& joint) {
    const std::string_view word = in_.word();
    const auto kind = channel_named(word);
    if (!kind) {
      return fail(
          fmt::format("{} is not a channel (joint {})", in_quotes(word), in_quotes(joint.name)));
    }
    for (int i = 0; i < joint.channels; ++i) {
      if (joint.channel[i] == *kind) {
        return fail(fmt::format("{} has {} twice", in_quotes(joint.name), word));
      }
    }
    joint.channel[joint.channels++] = *kind;
    return true;
  }

  bool motion_header() {
    if (in_.word() != "MOTION") return fail("MOTION expected after the hierarchy");
    const auto frames = parse_bounded(behind("Frames:"));
    if (!frames || *frames < 1 || *frames != std::floor(*frames)) {
      return fail("\"Frames:\" with a count of 1 or more expected");
    }
    const auto time_s = parse_bounded(behind("Frame Time:"));
    if (!time_s || *time_s < 1e-5 || *time_s > 10.0) {
      return fail("\"Frame Time:\" with a time from 0.00001 to 10 s expected");
    }
    bvh_.frame_time_s = *time_s;
    return plausible(static_cast<long long>(*frames));
  }

  // The text after this key on the next line; empty if the line has another key.
  std::string_view behind(std::string_view key) {
    const std::string_view line = in_.full_line();
    return line.starts_with(key) ? trimmed(line.substr(key.size())) : std::string_view();
  }

  // A number and a blank take at least two bytes, so the length of the text limits the number of
  // frames.
  bool plausible(long long frames) {
    if (bvh_.channels == 0) return fail("no joint has channels");
    if (frames * bvh_.channels > static_cast<long long>(in_.bytes_left() / 2 + 1)) {
      return fail(fmt::format("{} frames of {} channels do not fit in the {} bytes left", frames,
                              bvh_.channels, in_.bytes_left()));
    }
    if (frames * static_cast<long long>(bvh_.joints.size()) > kMaxFrameJoints) {
      return fail(fmt::format("{} frames of {} joints are more than the {} that this program takes",
                              frames, bvh_.joints.size(), kMaxFrameJoints));
    }
    bvh_.frames = static_cast<int>(frames);
    return true;
  }

  bool frames() {
    bvh_.values.reserve(static_cast<std::size_t>(bvh_.frames) * bvh_.channels);
    for (int frame = 0; frame < bvh_.frames; ++frame) {
      const std::string_view line = in_.full_line();
      if (line.empty()) {
        return fail(fmt::format("the motion ends after {} of {} frames", frame, bvh_.frames));
      }
      if (!frame_values(line, frame)) return false;
    }
    if (const std::string_view more = in_.full_line(); !more.empty()) {
      return fail(fmt::format("{} after the last of {} frames", in_quotes(more), bvh_.frames));
    }
    return true;
  }

  bool frame_values(std::string_view line, int frame) {
    int count = 0;
    while (!line.empty()) {
      std::size_t n = 0;
      while (n < line.size() && !is_blank(line[n])) ++n;
      const auto value = parse_bounded(line.substr(0, n));
      if (!value) {
        return fail(fmt::format("frame {}, value {}: {} is not a usable number", frame, count,
                                in_quotes(line.substr(0, n))));
      }
      if (++count > bvh_.channels) break;
      bvh_.values.push_back(*value);
      line = trimmed(line.substr(n));
    }
    if (count == bvh_.channels) return true;
    if (count > bvh_.channels) {
      return fail(fmt::format("frame {} has more than {} values", frame, bvh_.channels));
    }
    return fail(fmt::format("frame {} has {} of {} values", frame, count, bvh_.channels));
  }

  Reader in_;
  std::string name_;
  std::string message_;
  Bvh bvh_;
  std::vector<bool> has_offset_;  // the joint has an OFFSET, one for each joint
};

// Sine of 30 degrees. A joint is written in the order ZYX if the second angle never reaches that;
// otherwise in the order whose second angle stays farthest from 90 degrees.
constexpr double kPoleLimit = 0.5;
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

Result<Bvh> parse_bvh(std::string_view text, const std::string& name) {
  return Parser(text, name).bvh();
}

Result<Bvh> read_bvh(const std::string& path) {
  const auto text = input_text(path, kMaxMotionFileBytes);
  if (!text) return text.error();
  return parse_bvh(*text, path);
}

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

std::optional<Error> check(const BvhLayout& layout, const Skeleton& skeleton) {
  const std::string what = "BvhLayout: ";
  const std::size_t joints = skeleton.joints.size();
  if (joints == 0) return Error{what + "the skeleton has no joints"};
  if (auto problem = range_problem(what + "metres_per_unit", layout.metres_per_unit, kLeastUnit_m,
                                   kMostUnit_m))
    return problem;
  if (auto problem = range_problem(what + "frame_time_s", layout.frame_time_s, 1e-5, 10.0))
    return problem;
  for (const int joint : layout.end_sites_as_joints) {
    if (auto problem = range_problem(what + "end_sites_as_joints, a joint,", joint, 0.0,
                                     static_cast<double>(joints - 1)))
      return problem;
  }
  if (!layout.orders.empty() && layout.orders.size() != joints) {
    return Error{
        fmt::format("{}orders: there are {}, not {} or 0", what, layout.orders.size(), joints)};
  }
  for (std::size_t j = 0; j < layout.orders.size(); ++j) {
    BvhOrder axes = layout.orders[j];
    std::sort(axes.begin(), axes.end());
    if (axes != BvhOrder{0, 1, 2})
      return Error{fmt::format("{}orders[{}] does not have each of 0, 1 and 2 once", what, j)};
  }
  return std::nullopt;
}

BvhWriter::BvhWriter(std::ostream& out, const Skeleton& skeleton, const BvhLayout& layout)
    : out_(out), skeleton_(skeleton), layout_(layout), is_sound_(!check(layout, skeleton)) {
  if (!is_sound_) return;
  if (layout_.orders.empty()) {
    layout_.orders.assign(skeleton.joints.size(), kEulerZyx);
    layout_.orders[0] = kEulerYxz;
  }
  written_.resize(skeleton.joints.size());
  line_.resize(3 * (1 + skeleton.joints.size()) * (kMostFixedBytes + 1));
  write_hierarchy();
}

bool BvhWriter::is_joint(int joint) const {
  const std::vector<int>& tips = layout_.end_sites_as_joints;
  return !skeleton_.joints[joint].is_end_site ||
         std::find(tips.begin(), tips.end(), joint) != tips.end();
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
  if (is_leaf && has_channels) {  // BVH requires an End Site at the end of a chain
    out_ << indent << "\tEnd Site\n" << indent << "\t{\n" << indent << "\t\t";
    std::string end;
    append_offset(end, vec3(0.0));
    out_ << end << indent << "\t}\n";
  }
  out_ << indent << "}\n";
}

void BvhWriter::write(const Pose& pose) {
  if (!is_sound_) return;
  const vec3 root = pose.root_m / layout_.metres_per_unit;
  char* end = line_.data();
  for (const double value : {root.x, root.y, root.z}) {
    end = put_fixed(end, value, 8);
    *end++ = ' ';
  }
  for (const int joint : joints_)
    end = written_[joint].put(layout_.orders[joint], pose.local[joint], end);
  end[-1] = '\n';
  out_.write(line_.data(), end - line_.data());
  ++frames_;
}

namespace {

// Compares bits, because 0 and -0 are written differently.
template <class T>
bool has_same_bits(const T& a, const T& b) noexcept {
  using Bits = std::array<std::uint64_t, sizeof(T) / sizeof(double)>;
  return std::bit_cast<Bits>(a) == std::bit_cast<Bits>(b);
}

}  // namespace

// Angles depend only on the rotation and the previous angles: skip joints in which neither has
// changed.
char* BvhWriter::Written::put(const BvhOrder& order, const quat& turned, char* out) {
  const bool is_same = has_same_bits(turned, rotation);
  if (is_same && is_settled) return std::copy(text.begin(), text.end(), out);
  const EulerAngles next_rad = nearest_euler(order, turned, angles_rad);
  is_settled = is_same && has_same_bits(next_rad, angles_rad);
  rotation = turned;
  angles_rad = next_rad;
  char* end = out;
  for (const double angle_rad : angles_rad) {
    end = put_fixed(end, angle_rad / kDegree, 7);
    *end++ = ' ';
  }
  if (is_settled) text.assign(out, end);
  return end;
}

bool BvhWriter::finish() {
  if (!is_sound_) return false;
  const auto end = out_.tellp();
  out_.seekp(count_at_);
  out_ << frames_;
  out_.seekp(end);
  out_.flush();
  return out_.good();
}

}  // namespace gaitpad
