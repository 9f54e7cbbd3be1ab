#include "files/acclaim.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "base/text.h"
#include "files/euler.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/skeleton.h"

namespace gaitpad {
namespace {

// Lines of a text without comments (# to the end), trimmed, with their numbers.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(without_byte_order_mark(text)) {}

  // Next line that is not blank; empty at the end.
  std::string_view next() {
    while (!rest_.empty()) {
      ++line_;
      const std::string_view line = trimmed(without_comment(take_line(rest_)));
      if (!line.empty()) return line;
    }
    return {};
  }
  int line() const { return line_; }  // Number of the last line that was returned.

 private:
  // A comment begins at the line's beginning or after a blank.
  static std::string_view without_comment(std::string_view line) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      if (line[i] == '#' && (i == 0 || is_blank(line[i - 1]))) return line.substr(0, i);
    }
    return line;
  }

  std::string_view rest_;
  int line_ = 0;
};

// A bone as read. Angles may precede their unit in the file.
struct RawBone {
  AsfBone bone;
  EulerOrder order = {0, 1, 2};
  vec3 angles{0.0};  // turn of the bone's axes, in the file's angle unit
  bool has_direction = false, has_length = false;
  int line = 0;
};

std::optional<EulerOrder> axis_order(std::string_view word) {
  const std::string letters = lower_case(word);
  EulerOrder order{};
  std::array<bool, 3> seen{};
  if (letters.size() != 3) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    const int axis = letters[i] - 'x';
    if (axis < 0 || axis > 2 || seen[axis]) return std::nullopt;
    seen[axis] = true;
    order[i] = axis;
  }
  return order;
}

std::optional<AsfChannel> channel_named(const std::string& word) {
  constexpr std::array<std::string_view, 6> kNames = {"rx", "ry", "rz", "tx", "ty", "tz"};
  const auto at = std::find(kNames.begin(), kNames.end(), word);
  if (at == kNames.end()) return std::nullopt;
  return static_cast<AsfChannel>(at - kNames.begin());
}

// The first letter's rotation is applied first, so it is the rightmost factor.
quat in_order(const EulerOrder& order, const vec3& angles_rad) {
  quat q = kIdentity;
  for (const int axis : order) q = rotation_about_axis(axis, angles_rad[axis]) * q;
  return glm::normalize(q);
}

// Reads a skeleton. Its functions return false at the first error, which message_ then holds.
class AsfParser {
 public:
  AsfParser(std::string_view text, const std::string& name) : in_(text), name_(name) {
    bones_.emplace_back().bone.name = "root";
    by_name_["root"] = 0;
    advance();
  }

  Result<Asf> asf() {
    while (!line_.empty()) {
      if (!section()) return Error{message_};
    }
    if (!in_depth_first_order()) return Error{message_};
    return std::move(asf_);
  }

 private:
  bool fail(const std::string& cause) { return fail_at(in_.line(), cause); }
  bool fail_at(int line, const std::string& cause) {
    message_ = fmt::format("{}:{}: {}", name_, line, cause);
    return false;
  }
  void advance() { line_ = in_.next(); }
  bool is_inside() const { return !line_.empty() && line_.front() != ':'; }

  // Reads from a line that begins with a colon up to the next one.
  bool section() {
    std::string_view rest = line_;
    const std::string keyword = lower_case(take_word(rest));
    if (keyword.empty() || keyword.front() != ':') {
      return fail(fmt::format("{} is outside of a section (\":bonedata\" ...)", in_quotes(line_)));
    }
    advance();
    if (keyword == ":units")
      return each_line([this](auto word, auto more) { return unit(word, more); });
    if (keyword == ":root") {
      bones_[0].line = in_.line();
      return each_line([this](auto word, auto more) { return root(word, more); });
    }
    if (keyword == ":bonedata") return bone_data();
    if (keyword == ":hierarchy") return hierarchy();
    return each_line(
        [](auto, auto) { return true; });  // :version, :name, :documentation, :skin ... are ignored
  }

  template <class Take>
  bool each_line(Take take) {
    for (; is_inside(); advance()) {
      std::string_view rest = line_;
      const std::string word = lower_case(take_word(rest));
      if (!take(word, rest)) return false;
    }
    return true;
  }

  bool unit(const std::string& key, std::string_view rest) {
    const std::string_view word = take_word(rest);
    if (key == "angle") {
      const std::string angle = lower_case(word);
      if (angle.starts_with("deg"))
        asf_.angle_unit = kDegree;
      else if (angle.starts_with("rad"))
        asf_.angle_unit = 1.0;
      else
        return fail(fmt::format("angles in {}: only deg and rad are known", in_quotes(word)));
    }
    if (key == "length") {
      const auto value = parse_bounded(word);
      if (!value || *value <= 0.0)
        return fail(fmt::format("length {} is not a unit", in_quotes(word)));
      asf_.length_unit = *value;
    }
    return true;
  }

  bool root(const std::string& key, std::string_view rest) {
    RawBone& root = bones_[0];
    if (key == "order") return channels(root.bone, rest);
    if (key == "position") return vector(key, rest, asf_.root_position);
    if (key == "orientation") return vector(key, rest, root.angles);
    if (key == "axis") return order_of(rest, root);
    return true;
  }

  bool vector(const std::string& key, std::string_view& rest, vec3& out) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = take_word(rest);
      const auto value = parse_bounded(word);
      if (!value) return fail(fmt::format("{}: {} is not a number", key, in_quotes(word)));
      out[axis] = *value;
    }
    return true;
  }

  bool order_of(std::string_view rest, RawBone& raw) {
    const std::string_view word = take_word(rest);
    if (word.empty()) return true;  // no order is given: XYZ
    const auto order = axis_order(word);
    if (!order) return fail(fmt::format("axis: {} is not an order of X, Y and Z", in_quotes(word)));
    raw.order = *order;
    return true;
  }

  bool channels(AsfBone& bone, std::string_view rest) {
    if (bone.channels > 0) return fail(fmt::format("{} has its dof twice", in_quotes(bone.name)));
    while (!rest.empty()) {
      const std::string word = lower_case(take_word(rest));
      const auto channel = channel_named(word);
      if (word == "l") {
        return fail(fmt::format("{} changes its length (dof l), which no joint here can",
                                in_quotes(bone.name)));
      }
      if (!channel)
        return fail(fmt::format("dof {} is not one of rx ry rz tx ty tz", in_quotes(word)));
      const auto end = bone.channel.begin() + bone.channels;
      if (std::find(bone.channel.begin(), end, *channel) != end) {
        return fail(fmt::format("{} has dof {} twice", in_quotes(bone.name), word));
      }
      bone.channel[bone.channels++] = *channel;
    }
    return true;
  }

  bool bone_data() {
    while (is_inside()) {
      if (lower_case(line_) != "begin")
        return fail(fmt::format("begin expected, not {}", in_quotes(line_)));
      RawBone raw;
      raw.line = in_.line();
      for (advance(); is_inside() && lower_case(line_) != "end"; advance()) {
        std::string_view rest = line_;
        const std::string key = lower_case(take_word(rest));
        if (!bone_key(key, rest, raw)) return false;
      }
      if (!is_inside()) return fail_at(raw.line, "a bone without \"end\"");
      advance();
      if (!add(std::move(raw))) return false;
    }
    return true;
  }

  bool bone_key(const std::string& key, std::string_view rest, RawBone& raw) {
    if (key == "name") {
      raw.bone.name = std::string(take_word(rest));
      return true;
    }
    if (key == "direction") {
      raw.has_direction = true;
      return vector(key, rest, raw.bone.direction);
    }
    if (key == "length") {
      const auto value = parse_bounded(trimmed(rest));
      if (!value || *value < 0.0)
        return fail(fmt::format("length {} is not a length", in_quotes(trimmed(rest))));
      raw.bone.length = *value;
      raw.has_length = true;
    }
    if (key == "axis") return vector(key, rest, raw.angles) && order_of(rest, raw);
    if (key == "dof") return channels(raw.bone, rest);
    return true;  // skips id, limits with their further lines, masses
  }

  bool add(RawBone raw) {
    AsfBone& bone = raw.bone;
    if (bone.name.empty()) return fail_at(raw.line, "a bone without a name");
    if (!raw.has_direction || !raw.has_length) {
      return fail_at(raw.line, fmt::format("{} has no {}", in_quotes(bone.name),
                                           raw.has_direction ? "length" : "direction"));
    }
    const double size = glm::length(bone.direction);
    if (size > 0.0) bone.direction /= size;
    if (!(size > 0.0) && bone.length > 0.0) {
      return fail_at(raw.line, fmt::format("the direction of {} is 0", in_quotes(bone.name)));
    }
    if (bones_.size() >= static_cast<std::size_t>(kMaxJoints)) {
      return fail_at(raw.line, fmt::format("more than {} bones", kMaxJoints));
    }
    if (!by_name_.emplace(bone.name, static_cast<int>(bones_.size())).second) {
      return fail_at(raw.line, fmt::format("a second bone {}", in_quotes(bone.name)));
    }
    bones_.push_back(std::move(raw));
    return true;
  }

  bool hierarchy() {
    children_.resize(bones_.size());
    return each_line([this](const std::string& first, std::string_view) {
      if (first == "begin" || first == "end") return true;
      std::string_view rest = line_;
      const auto parent = bone_named(take_word(rest));
      if (!parent) return false;
      while (!rest.empty()) {
        const auto child = bone_named(take_word(rest));
        if (!child) return false;
        if (*child == 0 || bones_[*child].bone.parent >= 0) {
          return fail(fmt::format("{} has two parents", in_quotes(bones_[*child].bone.name)));
        }
        bones_[*child].bone.parent = *parent;
        children_[*parent].push_back(*child);
      }
      return true;
    });
  }

  std::optional<int> bone_named(std::string_view name) {
    const auto at = by_name_.find(std::string(name));
    if (at != by_name_.end() && static_cast<std::size_t>(at->second) < children_.size()) {
      return at->second;
    }
    fail(fmt::format("no bone {} in :bonedata above", in_quotes(name)));
    return std::nullopt;
  }

  // Orders the bones from the root down. Bones that are not reached have no parent or form a ring.
  bool in_depth_first_order() {
    if (bones_.size() < 2) return fail("no bones: not a skeleton (.asf)");
    if (children_.size() != bones_.size()) return fail("no :hierarchy after :bonedata");
    // Pairs of a bone and its parent's new index.
    std::vector<std::pair<int, int>> open = {{0, -1}};
    std::size_t leaves = 0;
    while (!open.empty()) {
      const auto [index, parent] = open.back();
      open.pop_back();
      RawBone& raw = bones_[index];
      AsfBone& bone = raw.bone;
      bone.parent = parent;
      bone.axes = in_order(raw.order, raw.angles * asf_.angle_unit);
      bone.first_value = asf_.channels;
      asf_.channels += bone.channels;
      raw.line = -raw.line;  // marks the bone as reached
      leaves += children_[index].empty();
      const int here = static_cast<int>(asf_.bones.size());
      asf_.bones.push_back(std::move(bone));
      for (auto child = children_[index].rbegin(); child != children_[index].rend(); ++child)
        open.emplace_back(*child, here);
    }
    for (const RawBone& raw : bones_) {
      if (raw.line > 0) {
        return fail_at(raw.line, fmt::format("{} has no parent", in_quotes(raw.bone.name)));
      }
    }
    if (asf_.bones.size() + leaves > static_cast<std::size_t>(kMaxJoints)) {
      return fail(fmt::format("more than {} joints and ends", kMaxJoints));
    }
    return asf_.channels > 0 || fail("no bone has a dof");
  }

  LineReader in_;
  std::string name_;
  std::string_view line_;
  std::string message_;
  Asf asf_;
  std::vector<RawBone> bones_;
  std::map<std::string, int> by_name_;
  std::vector<std::vector<int>> children_;
};

constexpr double kMaxFrameNumber = 1e7;

// A frame begins with a line of digits alone.
std::optional<int> frame_number(std::string_view line) {
  if (line.find_first_not_of("0123456789") != line.npos) return std::nullopt;
  const auto value = parse_bounded(line);
  if (!value || *value >= kMaxFrameNumber) return std::nullopt;
  return static_cast<int>(*value);
}

// Reads the frames of a motion. Its functions return false at the first error.
class AmcParser {
 public:
  AmcParser(std::string_view text, const std::string& name, const Asf& asf,
            const std::string& asf_name)
      : in_(text), name_(name), asf_(asf), asf_name_(asf_name) {
    for (std::size_t i = 0; i < asf.bones.size(); ++i)
      by_name_.emplace(asf.bones[i].name, static_cast<int>(i));
    amc_.angle_unit = asf.angle_unit;
    line_ = in_.next();
  }

  Result<Amc> amc() {
    if (!header()) return Error{message_};
    while (!line_.empty()) {
      if (!frame()) return Error{message_};
    }
    return std::move(amc_);
  }

 private:
  bool fail(const std::string& cause) {
    message_ = fmt::format("{}:{}: {}", name_, in_.line(), cause);
    return false;
  }

  bool header() {
    for (; !line_.empty() && !frame_number(line_); line_ = in_.next()) {
      std::string_view rest = line_;
      const std::string word = lower_case(take_word(rest));
      if (word.front() != ':') {
        return fail(fmt::format("{} is before the number of the first frame", in_quotes(line_)));
      }
      if (word == ":degrees") amc_.angle_unit = kDegree;
      if (word == ":radians") amc_.angle_unit = 1.0;
      if (word == ":fully-specified") is_full_ = true;
      if (word == ":samples-per-second") {
        const auto rate = parse_bounded(trimmed(rest));
        if (!rate || *rate < 0.1 || *rate > 1e5) {
          return fail(fmt::format("{} is not a rate", in_quotes(trimmed(rest))));
        }
        amc_.frame_rate_hz = *rate;
      }
    }
    return !line_.empty() ||
           fail("no frame: a motion (.amc) has a line \"1\" where the first begins");
  }

  bool frame() {
    const auto number = frame_number(line_);
    if (!number) return fail(fmt::format("a frame's number expected, not {}", in_quotes(line_)));
    if (amc_.frames > 0 && *number != number_ + 1) {
      return fail(fmt::format("frame {} follows frame {}", *number, number_));
    }
    number_ = *number;
    if ((amc_.frames + 1LL) * static_cast<long long>(asf_.bones.size()) > kMaxFrameJoints) {
      return fail(fmt::format("more than {} frames of {} bones", amc_.frames, asf_.bones.size()));
    }
    begin_frame();
    for (line_ = in_.next(); !line_.empty() && !frame_number(line_); line_ = in_.next()) {
      if (!bone()) return false;
    }
    return is_complete();
  }

  void begin_frame() {
    const auto width = static_cast<std::size_t>(asf_.channels);
    const std::size_t begin = amc_.frames * width;
    amc_.values.resize(begin + width, 0.0);
    if (amc_.frames > 0) {
      std::copy_n(amc_.values.begin() + static_cast<std::ptrdiff_t>(begin - width), width,
                  amc_.values.begin() + static_cast<std::ptrdiff_t>(begin));
    }
    ++amc_.frames;
    seen_.assign(asf_.bones.size(), false);
  }

  bool bone() {
    std::string_view rest = line_;
    const std::string_view word = take_word(rest);
    const auto at = by_name_.find(word);
    if (at == by_name_.end()) {
      return fail(fmt::format("frame {}: {} has no bone {}", number_, asf_name_, in_quotes(word)));
    }
    const AsfBone& bone = asf_.bones[static_cast<std::size_t>(at->second)];
    if (seen_[static_cast<std::size_t>(at->second)]) {
      return fail(fmt::format("frame {}: {} occurs twice", number_, in_quotes(word)));
    }
    seen_[static_cast<std::size_t>(at->second)] = true;
    double* values = amc_.values.data() + amc_.values.size() - asf_.channels + bone.first_value;
    int count = 0;
    for (; !rest.empty(); ++count) {
      const std::string_view text = take_word(rest);
      const auto value = parse_bounded(text);
      if (!value) {
        return fail(fmt::format("frame {}, {}: {} is not a usable number", number_,
                                in_quotes(bone.name), in_quotes(text)));
      }
      if (count < bone.channels) values[count] = *value;
    }
    if (count == bone.channels) return true;
    return fail(fmt::format("frame {}: {} has {} values, its skeleton says {}", number_,
                            in_quotes(bone.name), count, bone.channels));
  }

  // The first frame defines which bones move.
  bool is_complete() {
    if (amc_.frames == 1) {
      first_ = seen_;
      if (!seen_[0]) return fail(fmt::format("frame {} has no root", number_));
    }
    for (std::size_t i = 0; is_full_ && i < seen_.size(); ++i) {
      if (seen_[i] == first_[i]) continue;
      return fail(fmt::format("frame {} {} {}, against the first one", number_,
                              first_[i] ? "lacks" : "has", in_quotes(asf_.bones[i].name)));
    }
    return true;
  }

  LineReader in_;
  std::string name_;
  const Asf& asf_;
  std::string asf_name_;
  std::string_view line_;
  std::string message_;
  std::map<std::string_view, int> by_name_;
  std::vector<bool> seen_, first_;
  bool is_full_ = false;
  int number_ = 0;
  Amc amc_;
};

}  // namespace

Result<Asf> parse_asf(std::string_view text, const std::string& name) {
  return AsfParser(text, name).asf();
}

Result<Amc> parse_amc(std::string_view text, const std::string& name, const Asf& asf,
                      const std::string& asf_name) {
  return AmcParser(text, name, asf, asf_name).amc();
}

}  // namespace gaitpad
