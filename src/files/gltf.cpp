#include "gaitpad/gltf.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/ranges.h"
#include "gaitpad/skeleton.h"

namespace gaitpad {
namespace {

// The visible body: a rod for each bone, thickest near its upper joint and skinned to that joint
// only. Triangles share no vertices, for flat shading.
struct GltfBody {
  std::vector<vec3> place_m, normal;  // places and normals in the world, in the rest pose
  std::vector<std::uint16_t> joint;   // index of each vertex's joint in the skeleton
};

constexpr double kShortestBone_m = 1e-3;
constexpr double kWaist = 0.15;  // share of the rod's length at which it is thickest
constexpr double kThickness = 0.09, kThinnest_m = 0.004, kThickest_m = 0.032;

void add_triangle(const vec3& a, const vec3& b, const vec3& c, int joint, GltfBody& body) {
  const vec3 normal = glm::normalize(glm::cross(b - a, c - a));
  for (const vec3& corner : {a, b, c}) {
    body.place_m.push_back(corner);
    body.normal.push_back(normal);
    body.joint.push_back(static_cast<std::uint16_t>(joint));
  }
}

// An octahedron from joint to joint.
void add_rod(const vec3& from, const vec3& to, int joint, GltfBody& body) {
  const double length_m = glm::distance(from, to);
  if (!(length_m > kShortestBone_m)) return;
  const vec3 along = (to - from) / length_m;
  const vec3 aside = std::abs(along.x) < 0.7 ? kLeft : kForward;
  const double half_m = std::clamp(kThickness * length_m, kThinnest_m, kThickest_m);
  const vec3 u = half_m * glm::normalize(glm::cross(along, aside));
  const vec3 v = glm::cross(along, u);
  const vec3 waist = from + kWaist * (to - from);
  const std::array<vec3, 4> ring = {waist + u, waist + v, waist - u, waist - v};
  for (std::size_t k = 0; k < 4; ++k) {
    const vec3 &here = ring[k], &next = ring[(k + 1) % 4];
    add_triangle(from, next, here, joint, body);
    add_triangle(here, next, to, joint, body);
  }
}

// `world` holds the joints in the rest pose.
GltfBody gltf_body(const Skeleton& skeleton, const JointFrames& world) {
  GltfBody body;
  for (std::size_t j = 1; j < skeleton.joints.size(); ++j) {
    const int upper = skeleton.joints[j].parent;
    add_rod(world.position_m[upper], world.position_m[j], upper, body);
  }
  return body;
}

using nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedByte = 5121, kArrayBuffer = 34962;
// Up to this number of frames, times in seconds stay distinct as 32-bit floats at any rate.
constexpr std::size_t kMostFrames = std::size_t{1} << 23;
constexpr std::uint64_t kMostBytes = std::numeric_limits<std::uint32_t>::max();

void append_word(std::string& bytes, std::uint32_t word) {
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>((word >> shift) & 0xff);
}
void append_float(std::string& bytes, double value) {
  const float f = static_cast<float>(value);
  std::uint32_t word = 0;
  std::memcpy(&word, &f, sizeof word);
  append_word(bytes, word);
}
double rounded(double value) { return static_cast<float>(value); }

ordered_json json_of(const vec3& v) { return {rounded(v.x), rounded(v.y), rounded(v.z)}; }
ordered_json json_of(const quat& q) {
  return {rounded(q.x), rounded(q.y), rounded(q.z), rounded(q.w)};
}

// The JSON document and the current length of its binary part.
class Document {
 public:
  ordered_json json;
  std::uint64_t bytes = 0;

  // Appends a buffer view and an accessor of it; returns the accessor's index. `view_target` 0:
  // none.
  int add(std::uint64_t byte_length, int component, const char* type, std::size_t count,
          int view_target) {
    ordered_json view = {{"buffer", 0}, {"byteOffset", bytes}, {"byteLength", byte_length}};
    if (view_target != 0) view["target"] = view_target;
    json["bufferViews"].push_back(view);
    json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                 {"componentType", component},
                                 {"count", count},
                                 {"type", type}});
    bytes += byte_length;
    return static_cast<int>(json["accessors"].size()) - 1;
  }
};

struct RestPose {
  Pose pose;
  JointFrames world;
};
std::unique_ptr<RestPose> rest_of(const Skeleton& skeleton, const GltfLayout& layout) {
  auto rest = std::make_unique<RestPose>();
  rest->pose.joint_count = static_cast<int>(skeleton.joints.size());
  rest->pose.root_m = layout.rest_root_m;
  std::copy(layout.rest_local.begin(), layout.rest_local.end(), rest->pose.local.begin());
  forward_kinematics(skeleton, rest->pose, rest->world);
  return rest;
}

void add_nodes(const Skeleton& skeleton, const GltfLayout& layout, ordered_json& json) {
  const std::size_t joints = skeleton.joints.size();
  std::vector<std::vector<std::size_t>> children(joints);
  for (std::size_t j = 1; j < joints; ++j) children[skeleton.joints[j].parent].push_back(j);
  for (std::size_t j = 0; j < joints; ++j) {
    ordered_json node = {{"name", skeleton.joints[j].name}};
    node["translation"] = json_of(j == 0 ? layout.rest_root_m : skeleton.joints[j].offset_m);
    node["rotation"] = json_of(layout.rest_local[j]);
    if (!children[j].empty()) node["children"] = children[j];
    json["nodes"].push_back(std::move(node));
  }
}

// World-to-joint matrices of the rest pose, column-major.
void append_inverse_bind(const JointFrames& world, std::size_t joints, std::string& bytes) {
  for (std::size_t j = 0; j < joints; ++j) {
    const quat back = glm::conjugate(world.rotation[j]);
    const mat3 turn = glm::mat3_cast(back);
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) append_float(bytes, turn[column][row]);
      append_float(bytes, 0.0);
    }
    const vec3 shift = back * -world.position_m[j];
    for (int row = 0; row < 3; ++row) append_float(bytes, shift[row]);
    append_float(bytes, 1.0);
  }
}

void append_vectors(const std::vector<vec3>& list, std::string& bytes) {
  for (const vec3& v : list) {
    for (int axis = 0; axis < 3; ++axis) append_float(bytes, v[axis]);
  }
}

void add_bounds(const std::vector<vec3>& list, ordered_json& accessor) {
  vec3 low = list.front(), high = list.front();
  for (const vec3& v : list) {
    low = glm::min(low, v);
    high = glm::max(high, v);
  }
  accessor["min"] = json_of(low);
  accessor["max"] = json_of(high);
}

// Adds skin, mesh and the node that shows them; returns their bytes.
std::string add_body(const Skeleton& skeleton, const GltfLayout& layout, Document& doc) {
  const std::size_t joints = skeleton.joints.size();
  const auto rest = rest_of(skeleton, layout);
  const GltfBody body = gltf_body(skeleton, rest->world);
  const std::size_t n = body.place_m.size();
  std::string bytes;
  ordered_json& json = doc.json;
  json["scenes"] = {{{"nodes", {0}}}};
  if (n == 0) return bytes;  // there is no body, because no bone has a length
  append_inverse_bind(rest->world, joints, bytes);
  const int bind = doc.add(64 * joints, kFloat, "MAT4", joints, 0);
  append_vectors(body.place_m, bytes);
  const int place = doc.add(12 * n, kFloat, "VEC3", n, kArrayBuffer);
  add_bounds(body.place_m, json["accessors"].back());
  append_vectors(body.normal, bytes);
  const int normal = doc.add(12 * n, kFloat, "VEC3", n, kArrayBuffer);
  for (const std::uint16_t joint : body.joint) {
    append_word(bytes, joint);
    append_word(bytes, 0);
  }
  const int joint = doc.add(8 * n, kUnsignedShort, "VEC4", n, kArrayBuffer);
  for (std::size_t i = 0; i < n; ++i) append_word(bytes, 0xff);
  const int weight = doc.add(4 * n, kUnsignedByte, "VEC4", n, kArrayBuffer);
  json["accessors"].back()["normalized"] = true;
  ordered_json list = ordered_json::array();
  for (std::size_t j = 0; j < joints; ++j) list.push_back(j);
  json["skins"] = {{{"inverseBindMatrices", bind}, {"skeleton", 0}, {"joints", list}}};
  json["materials"] = {{{"name", "body"},
                        {"pbrMetallicRoughness",
                         {{"baseColorFactor", {0.34, 0.71, 0.91, 1.0}},
                          {"metallicFactor", 0.0},
                          {"roughnessFactor", 0.7}}}}};
  const ordered_json attributes = {
      {"POSITION", place}, {"NORMAL", normal}, {"JOINTS_0", joint}, {"WEIGHTS_0", weight}};
  json["meshes"] = {
      {{"name", "body"}, {"primitives", {{{"attributes", attributes}, {"material", 0}}}}}};
  json["nodes"].push_back({{"name", layout.name}, {"mesh", 0}, {"skin", 0}});
  json["scenes"][0]["nodes"].push_back(joints);
  return bytes;
}

ordered_json channel(std::size_t sampler, int node, const char* path) {
  return {{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}};
}

// Accessors of the animation: times, positions of the root, rotations of each turning joint.
void add_animation(const std::vector<int>& turning, std::size_t frames, double fps, Document& doc) {
  if (frames == 0) return;
  const int times = doc.add(4 * frames, kFloat, "SCALAR", frames, 0);
  ordered_json& json = doc.json;
  json["accessors"].back()["min"] = {0.0};
  json["accessors"].back()["max"] = {rounded(static_cast<double>(frames - 1) / fps)};
  ordered_json samplers, channels;
  const auto add = [&](int output, int node, const char* path) {
    samplers.push_back({{"input", times}, {"interpolation", "LINEAR"}, {"output", output}});
    channels.push_back(channel(samplers.size() - 1, node, path));
  };
  add(doc.add(12 * frames, kFloat, "VEC3", frames, 0), 0, "translation");
  for (const int joint : turning) {
    add(doc.add(16 * frames, kFloat, "VEC4", frames, 0), joint, "rotation");
  }
  json["animations"] = {{{"name", "walk"}, {"samplers", samplers}, {"channels", channels}}};
}

// The file up to its binary part of `bytes_behind` bytes.
std::string head(ordered_json& json, std::uint64_t bytes_behind) {
  json["buffers"] = {{{"byteLength", bytes_behind}}};
  // Joint names may contain any bytes; invalid UTF-8 is replaced.
  std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  text.append((4 - text.size() % 4) % 4, ' ');
  std::string out = "glTF";
  append_word(out, 2);
  append_word(out, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + bytes_behind));
  append_word(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  append_word(out, static_cast<std::uint32_t>(bytes_behind));
  out += std::string("BIN\0", 4);
  return out;
}

}  // namespace

std::optional<Error> check(const GltfLayout& layout, const Skeleton& skeleton) {
  if (auto problem = range_problem("GltfLayout: fps", layout.fps, 1e-3, 1e4)) return problem;
  const std::size_t joints = skeleton.joints.size();
  if (joints == 0 || layout.rest_local.size() != joints) {
    return Error{fmt::format("GltfLayout: rest_local: there are {}, not the skeleton's {}",
                             layout.rest_local.size(), joints)};
  }
  for (std::size_t j = 0; j < joints; ++j) {
    const quat& q = layout.rest_local[j];
    if (!(std::abs(glm::dot(q, q) - 1.0) < 1e-3)) {
      return Error{
          fmt::format("GltfLayout: rest_local[{}] is no rotation: its length is not 1", j)};
    }
  }
  return vector_problem("GltfLayout: rest_root_m", layout.rest_root_m, 1e6);
}

GltfWriter::GltfWriter(std::ostream& out, std::fstream scratch, const Skeleton& skeleton,
                       GltfLayout layout)
    : out_(&out), scratch_(std::move(scratch)), skeleton_(&skeleton), layout_(std::move(layout)) {
  problem_ = check(layout_, skeleton);
  if (problem_) return;
  for (std::size_t j = 0; j < joints(); ++j) {
    if (!skeleton.joints[j].is_end_site) turning_.push_back(static_cast<int>(j));
  }
  before_ = layout_.rest_local;
  chunk_.resize(turning() + 1);
}

std::size_t GltfWriter::chunk_bytes() const {
  return kChunkFrames * sizeof(float) * (4 * turning() + 3);
}

void GltfWriter::write(const Pose& pose) {
  if (problem_) return;
  for (std::size_t t = 0; t < turning(); ++t) {
    const auto joint = static_cast<std::size_t>(turning_[t]);
    quat q = glm::normalize(pose.local[joint]);
    // Of q and -q, which are the same rotation, writes the one nearer to the last: players
    // interpolate the numbers.
    if (glm::dot(q, before_[joint]) < 0.0) q = -q;
    before_[joint] = q;
    for (const double v : {q.x, q.y, q.z, q.w}) chunk_[t].push_back(static_cast<float>(v));
  }
  for (int axis = 0; axis < 3; ++axis) {
    chunk_.back().push_back(static_cast<float>(pose.root_m[axis]));
  }
  if (++frames_ % kChunkFrames == 0) write_chunk();
}

// Every track has a fixed place in a chunk, even in the partly filled last one.
void GltfWriter::write_chunk() {
  const std::size_t chunk = (frames_ - 1) / kChunkFrames;
  for (std::size_t t = 0; t < chunk_.size(); ++t) {
    scratch_.seekp(
        static_cast<std::streamoff>(chunk * chunk_bytes() + t * kChunkFrames * 4 * sizeof(float)));
    scratch_.write(reinterpret_cast<const char*>(chunk_[t].data()),
                   static_cast<std::streamsize>(chunk_[t].size() * sizeof(float)));
    chunk_[t].clear();
  }
}

bool GltfWriter::copy_track(std::size_t track, std::size_t floats) {
  std::vector<float> values;
  std::string bytes;
  for (std::size_t first = 0; first < frames_; first += kChunkFrames) {
    const std::size_t count = std::min(kChunkFrames, frames_ - first);
    values.resize(count * floats);
    scratch_.seekg(static_cast<std::streamoff>(first / kChunkFrames * chunk_bytes() +
                                               track * kChunkFrames * 4 * sizeof(float)));
    scratch_.read(reinterpret_cast<char*>(values.data()),
                  static_cast<std::streamsize>(values.size() * sizeof(float)));
    if (!scratch_) return false;
    bytes.clear();
    for (const float v : values) append_float(bytes, v);
    out_->write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  return out_->good();
}

std::optional<std::string> GltfWriter::finish() {
  if (problem_) return problem_->message;
  if (frames_ % kChunkFrames != 0) write_chunk();
  scratch_.flush();
  Document doc;
  doc.json["asset"] = {{"version", "2.0"}, {"generator", "gaitpad"}};
  doc.json["scene"] = 0;
  add_nodes(*skeleton_, layout_, doc.json);
  const std::string body = add_body(*skeleton_, layout_, doc);
  add_animation(turning_, frames_, layout_.fps, doc);
  const std::string begin = head(doc.json, doc.bytes);
  if (frames_ > kMostFrames || begin.size() + doc.bytes > kMostBytes) {
    return fmt::format("{} poses are too many for a .glb file; write fewer with --fps", frames_);
  }
  *out_ << begin << body;
  std::string times;
  for (std::size_t f = 0; f < frames_; ++f) {
    append_float(times, static_cast<double>(f) / layout_.fps);
    if (times.size() < kChunkFrames * sizeof(float) && f + 1 < frames_) continue;
    *out_ << times;
    times.clear();
  }
  bool is_whole = copy_track(turning(), 3);
  for (std::size_t t = 0; is_whole && t < turning(); ++t) is_whole = copy_track(t, 4);
  if (is_whole) return std::nullopt;
  return "the poses could not be kept while running (is the disk full?)";
}

}  // namespace gaitpad
