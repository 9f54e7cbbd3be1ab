#include "motion/amc.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "motion/motion_text.h"

namespace gaitpad {
namespace {

constexpr double kMaxFrameNumber = 1e7;

// A line of digits alone begins a frame.
std::optional<int> frame_number(std::string_view line) {
  if (line.find_first_not_of("0123456789") != line.npos) return std::nullopt;
  const auto value = text_number(line);
  if (!value || *value >= kMaxFrameNumber) return std::nullopt;
  return static_cast<int>(*value);
}

// First error wins; every parsing function returns false once there is one.
class Parser {
 public:
  Parser(std::string_view text, const std::string& name, const Asf& asf,
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
        return fail(fmt::format("\"{}\" stands before the first frame's number", shown(line_)));
      }
      if (word == ":degrees") amc_.angle_unit = kDegree;
      if (word == ":radians") amc_.angle_unit = 1.0;
      if (word == ":fully-specified") is_full_ = true;
      if (word == ":samples-per-second") {
        const auto rate = text_number(rest);
        if (!rate || *rate < 0.1 || *rate > 1e5) {
          return fail(fmt::format("\"{}\" is no rate", shown(rest)));
        }
        amc_.frame_rate_hz = *rate;
      }
    }
    return !line_.empty() ||
           fail("no frame: a motion (.amc) has a line \"1\" where the first begins");
  }

  bool frame() {
    const auto number = frame_number(line_);
    if (!number) return fail(fmt::format("a frame's number expected, not \"{}\"", shown(line_)));
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
      return fail(fmt::format("frame {}: {} has no bone \"{}\"", number_, asf_name_, shown(word)));
    }
    const AsfBone& bone = asf_.bones[static_cast<std::size_t>(at->second)];
    if (seen_[static_cast<std::size_t>(at->second)]) {
      return fail(fmt::format("frame {}: \"{}\" stands twice", number_, shown(word)));
    }
    seen_[static_cast<std::size_t>(at->second)] = true;
    double* values = amc_.values.data() + amc_.values.size() - asf_.channels + bone.first_value;
    int count = 0;
    for (; !rest.empty(); ++count) {
      const std::string_view text = take_word(rest);
      const auto value = text_number(text);
      if (!value) {
        return fail(fmt::format("frame {}, \"{}\": \"{}\" is no usable number", number_,
                                shown(bone.name), shown(text)));
      }
      if (count < bone.channels) values[count] = *value;
    }
    if (count == bone.channels) return true;
    return fail(fmt::format("frame {}: \"{}\" has {} values, its skeleton says {}", number_,
                            shown(bone.name), count, bone.channels));
  }

  // The first frame says which bones move.
  bool is_complete() {
    if (amc_.frames == 1) {
      first_ = seen_;
      if (!seen_[0]) return fail(fmt::format("frame {} has no root", number_));
    }
    for (std::size_t i = 0; is_full_ && i < seen_.size(); ++i) {
      if (seen_[i] == first_[i]) continue;
      return fail(fmt::format("frame {} {} \"{}\", against the first one", number_,
                              first_[i] ? "lacks" : "has", shown(asf_.bones[i].name)));
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

Result<Amc> parse_amc(std::string_view text, const std::string& name, const Asf& asf,
                      const std::string& asf_name) {
  return Parser(text, name, asf, asf_name).amc();
}

}  // namespace gaitpad
