#include "check/pose_track.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "gaitpad/hash.h"
#include "gaitpad/trace.h"

namespace gaitpad {
namespace {

constexpr std::string_view kMagic = "gaitpad poses 1\n";
constexpr std::size_t kMaxNameBytes = 512;
constexpr std::size_t kMaxChannels = (kMaxJoints + 1) * kMaxWalkers + 1;
// Most bytes of a pose file after decompression.
constexpr std::size_t kMaxBytes = std::size_t{256} << 20;

std::uint16_t print_of(std::uint64_t hash) {
  return static_cast<std::uint16_t>(hash ^ (hash >> 16) ^ (hash >> 32) ^ (hash >> 48));
}

std::uint16_t print_of(std::initializer_list<double> values) {
  WordHash hash;
  for (const double x : values) hash.add(x);
  return print_of(hash.value());
}

std::int32_t stepped(double value, double step) {
  constexpr double kMost = 2e9;
  const double steps = std::nearbyint(value / step);
  return static_cast<std::int32_t>(std::isfinite(steps) ? std::clamp(steps, -kMost, kMost) : kMost);
}

void add_cell(PoseChannel& channel, std::uint16_t print, const vec3& value, double step) {
  channel.prints.push_back(print);
  for (int k = 0; k < 3; ++k) channel.values[k].push_back(stepped(value[k], step));
}

}  // namespace

PoseTrack::PoseTrack(const Simulation& simulation, int rate_hz, std::int64_t ticks)
    : rate_hz_(rate_hz), ticks_(ticks), hash_(simulation.pose_hash()) {
  for (std::size_t i = 0; i < simulation.walkers().size(); ++i) {
    const int character = static_cast<int>(i) + 1;
    channels_.push_back({character, "", {}, {}});
    for (const Joint& joint : simulation.walkers()[i].model->cycle.skeleton.joints)
      channels_.push_back({character, joint.name, {}, {}});
  }
  if (simulation.followers().size() > 0) channels_.push_back({0, "", {}, {}});
  most_ = std::min<std::size_t>(static_cast<std::size_t>(ticks), kMaxCells / channels_.size());
}

void PoseTrack::add(const Simulation& simulation) {
  hash_ = simulation.pose_hash();
  if (kept_ == most_) return;
  ++kept_;
  auto channel = channels_.begin();
  for (const Walker& walker : simulation.walkers()) {
    const vec3& root_m = walker.pose.root_m;
    add_cell(*channel++, print_of({root_m.x, root_m.y, root_m.z}), root_m, kLengthStep_m);
    for (int j = 0; j < walker.pose.joint_count; ++j) {
      const quat& q = walker.pose.local[j];
      const double sign = q.w < 0.0 ? -1.0 : 1.0;
      add_cell(*channel++, print_of({q.w, q.x, q.y, q.z}), sign * vec3(q.x, q.y, q.z), kAngleStep);
    }
  }
  if (channel == channels_.end()) return;
  const Crowd& crowd = simulation.followers().crowd();
  WordHash hash;
  for (int i = 0; i < crowd.size(); ++i) {
    const vec3& root_m = crowd.root_m(i);
    for (const double x : {root_m.x, root_m.y, root_m.z}) hash.add(x);
    for (const quat& q : crowd.local(i))
      for (const double x : {q.w, q.x, q.y, q.z}) hash.add(x);
  }
  add_cell(*channel, print_of(hash.value()), vec3(0.0), kLengthStep_m);
}

// --- the file

namespace {

void write_fixed(std::string& out, std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += static_cast<char>((value >> (8 * i)) & 0xff);
}

void write_number(std::string& out, std::uint64_t value) {
  for (; value >= 0x80; value >>= 7) out += static_cast<char>((value & 0x7f) | 0x80);
  out += static_cast<char>(value);
}

void write_column(std::string& out, const std::vector<std::int32_t>& column) {
  std::int64_t last = 0, slope = 0;
  for (const std::int64_t value : column) {
    const std::int64_t bend = value - last - slope;
    write_number(out,
                 (static_cast<std::uint64_t>(bend) << 1) ^ static_cast<std::uint64_t>(bend >> 63));
    slope = value - last;
    last = value;
  }
}

// Reads the output of the functions above. After the end of the bytes, or a number out of bounds,
// it returns zeros and is_sound() is false.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : rest_(bytes) {}
  bool is_sound() const { return is_sound_; }
  bool is_at_end() const { return rest_.empty(); }

  std::uint64_t fixed(int bytes) {
    std::uint64_t value = 0;
    for (int i = 0; i < bytes; ++i) value |= std::uint64_t{byte()} << (8 * i);
    return value;
  }
  std::uint64_t number(std::uint64_t most) {
    std::uint64_t value = 0;
    for (int shift = 0; shift < 63; shift += 7) {
      const std::uint8_t next = byte();
      value |= std::uint64_t{next & 0x7fu} << shift;
      if (next < 0x80) return value <= most ? value : fault();
    }
    return fault();
  }
  std::string text(std::size_t most) {
    const std::size_t size = number(most);
    if (size > rest_.size()) fault();
    const std::string value(rest_.substr(0, is_sound_ ? size : 0));
    rest_.remove_prefix(value.size());
    return value;
  }
  std::vector<std::int32_t> column(std::size_t count) {
    std::vector<std::int32_t> values;
    std::int64_t last = 0, slope = 0;
    for (std::size_t i = 0; i < count && is_sound_; ++i) {
      const std::uint64_t coded = number(std::uint64_t{1} << 36);
      slope += static_cast<std::int64_t>(coded >> 1) ^ -static_cast<std::int64_t>(coded & 1);
      last += slope;
      if (std::abs(last) > std::numeric_limits<std::int32_t>::max()) fault();
      values.push_back(static_cast<std::int32_t>(is_sound_ ? last : 0));
    }
    return values;
  }

 private:
  std::uint8_t byte() {
    if (rest_.empty()) return static_cast<std::uint8_t>(fault());
    const auto value = static_cast<std::uint8_t>(rest_.front());
    rest_.remove_prefix(1);
    return value;
  }
  std::uint64_t fault() {
    is_sound_ = false;
    return 0;
  }
  std::string_view rest_;
  bool is_sound_ = true;
};

std::optional<std::string> unpacked(std::string_view bytes) {
  // A larger ratio shows a damaged file: zlib compresses at most 1032 : 1.
  constexpr std::size_t kMostPacking = 1100;
  if (!bytes.starts_with(kMagic)) return std::nullopt;
  bytes.remove_prefix(kMagic.size());
  Reader head(bytes.substr(0, 8));
  const std::uint64_t size = head.fixed(8);
  if (!head.is_sound() || size > kMaxBytes || size > bytes.size() * kMostPacking)
    return std::nullopt;
  bytes.remove_prefix(8);
  std::string text(size, '\0');
  uLongf written = text.size();
  const int status = ::uncompress(reinterpret_cast<Bytef*>(text.data()), &written,
                                  reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
  if (status != Z_OK || written != size) return std::nullopt;
  return text;
}

}  // namespace

std::string PoseTrack::bytes() const {
  std::string text;
  write_number(text, static_cast<std::uint64_t>(rate_hz_));
  write_number(text, static_cast<std::uint64_t>(ticks_));
  write_fixed(text, hash_, 8);
  write_number(text, channels_.size());
  write_number(text, kept_);
  for (const PoseChannel& channel : channels_) {
    write_number(text, static_cast<std::uint64_t>(channel.character));
    write_number(text, channel.joint.size());
    text += channel.joint;
    for (const std::uint16_t print : channel.prints) write_fixed(text, print, 2);
    for (const auto& column : channel.values) write_column(text, column);
  }
  uLongf size = ::compressBound(text.size());
  std::string packed(size, '\0');
  ::compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
              reinterpret_cast<const Bytef*>(text.data()), text.size(), Z_DEFAULT_COMPRESSION);
  packed.resize(size);
  std::string bytes(kMagic);
  write_fixed(bytes, text.size(), 8);
  return bytes + packed;
}

Result<PoseTrack> PoseTrack::parse(std::string_view bytes, const std::string& name) {
  const auto text = unpacked(bytes);
  if (!text) return Error{name + ": does not hold poses that gaitpad check kept"};
  Reader reader(*text);
  PoseTrack track;
  track.rate_hz_ = static_cast<int>(reader.number(kMaxRateHz));
  track.ticks_ = static_cast<std::int64_t>(reader.number(std::uint64_t{1} << 40));
  track.hash_ = reader.fixed(8);
  const std::size_t channels = reader.number(kMaxChannels);
  track.kept_ = track.most_ = reader.number(kMaxCells / std::max<std::size_t>(channels, 1));
  for (std::size_t i = 0; i < channels && reader.is_sound(); ++i) {
    PoseChannel& channel = track.channels_.emplace_back();
    channel.character = static_cast<int>(reader.number(kMaxWalkers));
    channel.joint = reader.text(kMaxNameBytes);
    for (std::size_t t = 0; t < track.kept_ && reader.is_sound(); ++t)
      channel.prints.push_back(static_cast<std::uint16_t>(reader.fixed(2)));
    for (auto& column : channel.values) column = reader.column(track.kept_);
  }
  if (reader.is_sound() && reader.is_at_end() && track.rate_hz_ > 0) return track;
  return Error{name + ": its poses are damaged"};
}

// --- comparing

namespace {

vec3 value_of(const PoseChannel& channel, std::size_t tick) {
  return {channel.values[0][tick], channel.values[1][tick], channel.values[2][tick]};
}

// Unit length, except for rounding.
quat rotation_of(const PoseChannel& channel, std::size_t tick) {
  const vec3 v = PoseTrack::kAngleStep * value_of(channel, tick);
  return {std::sqrt(std::max(0.0, 1.0 - glm::dot(v, v))), v.x, v.y, v.z};
}

bool is_same_channel(const PoseChannel& a, const PoseChannel& b) {
  return a.character == b.character && a.joint == b.joint;
}

}  // namespace

vec3 shown_value(const PoseChannel& channel, std::size_t tick) {
  if (channel.joint.empty()) return PoseTrack::kLengthStep_m * value_of(channel, tick);
  return kDegrees * rotation_vector(rotation_of(channel, tick));
}

double distance_of(const PoseChannel& a, const PoseChannel& b, std::size_t tick) {
  if (value_of(a, tick) == value_of(b, tick)) return 0.0;
  if (a.joint.empty())
    return PoseTrack::kLengthStep_m * glm::length(value_of(a, tick) - value_of(b, tick));
  const quat turn = glm::conjugate(rotation_of(a, tick)) * rotation_of(b, tick);
  const double sine = glm::length(vec3(turn.x, turn.y, turn.z));
  return kDegrees * 2.0 * std::atan2(sine, std::abs(turn.w));
}

Result<std::optional<PoseDifference>> difference(const PoseTrack& before, const PoseTrack& after) {
  const std::vector<PoseChannel>&a = before.channels(), &b = after.channels();
  if (!std::ranges::equal(a, b, is_same_channel))
    return Error{"the characters have other joints than the poses that are kept"};
  if (before.rate_hz() != after.rate_hz())
    return Error{fmt::format("the poses that are kept are of {} ticks a second", before.rate_hz())};
  // Report an angle before a length: joints move the root.
  const auto is_farther = [&a](const PoseDifference::Place& p, const PoseDifference::Place& than) {
    const auto rank = [&a](const PoseDifference::Place& place) {
      return std::pair(!a[place.channel].joint.empty() && place.distance > 0.0, place.distance);
    };
    return rank(p) > rank(than);
  };
  PoseDifference found;
  const std::size_t ticks = std::min(before.kept(), after.kept());
  int differing = 0;  // number of channels that differ in the first differing tick
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const bool is_first = differing == 0;
    for (std::size_t c = 0; c < a.size(); ++c) {
      if (a[c].prints[tick] == b[c].prints[tick]) continue;
      const PoseDifference::Place place = {tick, c, distance_of(a[c], b[c], tick)};
      if (is_first && (differing == 0 || is_farther(place, found.first))) found.first = place;
      differing += is_first;
      if (is_farther(place, found.largest)) found.largest = place;
    }
  }
  if (differing == 0) return std::optional<PoseDifference>();
  found.others = differing - 1;
  return std::optional(found);
}

}  // namespace gaitpad
