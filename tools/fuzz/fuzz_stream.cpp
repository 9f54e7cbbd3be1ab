// libFuzzer target: a line with a stream's target (osc://HOST:PORT, json://HOST:PORT), a line with
// a character's name, then numbers for its bones. The program sends valid JSON with that name, and
// OSC bundles that liblo accepts. The program itself receives nothing by OSC or JSON.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>
#ifdef GAITPAD_HAS_OSC
#include <lo/lo.h>
#endif

#include "base/text.h"
#include "session/pose_stream.h"

namespace {

using namespace gaitpad;

void check_address(std::string_view text) {
  const auto address = StreamAddress::parse(std::string(text));
  if (address && (address->port < 1 || address->port > 65535)) std::abort();
  if (!address && address.error().message.find('\n') != std::string::npos) std::abort();
}

// The next number of the input, made finite like the numbers of poses.
double next_number(std::string_view& bytes) {
  double number = 0.0;
  std::memcpy(&number, bytes.data(), std::min(bytes.size(), sizeof number));
  bytes.remove_prefix(std::min(bytes.size(), sizeof number));
  return std::isfinite(number) ? number : 0.0;
}

BonePose next_bone(std::string_view& bytes) {
  BonePose bone;
  for (int i = 0; i < 3; ++i) bone.place_m[i] = next_number(bytes);
  for (int i = 0; i < 4; ++i) bone.rotation[i] = next_number(bytes);
  return bone;
}

void check_json(const StreamedFrame& frame) {
  const auto sent = nlohmann::json::parse(json_datagram(frame), nullptr, false);
  if (sent.is_discarded() || !sent["character"].is_string()) std::abort();
  if (sent["bones"].size() != frame.bones->size() || sent["root"].size() != 7) std::abort();
}

// Checks that a bundle has its head and then messages, each after its length (OSC 1.0).
void check_bundle([[maybe_unused]] std::string& datagram) {
#ifdef GAITPAD_HAS_OSC
  constexpr std::size_t kHead = 16, kLength = 4;
  if (std::memcmp(datagram.data(), "#bundle", 8) != 0) std::abort();
  for (std::size_t at = kHead; at < datagram.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(datagram[at + i]); };
    const std::size_t length = std::size_t{byte(0)} << 24 | byte(1) << 16 | byte(2) << 8 | byte(3);
    at += kLength;
    if (length > datagram.size() - at) std::abort();
    const lo_message message = lo_message_deserialise(datagram.data() + at, length, nullptr);
    if (message == nullptr) std::abort();
    lo_message_free(message);
    at += length;
  }
#endif
}

void check_osc(const StreamedFrame& frame) {
  for (std::string& datagram : osc_datagrams(frame)) {
    if (datagram.size() > 1472 || datagram.size() % 4 != 0) std::abort();
    check_bundle(datagram);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr const char* kBones[] = {"Hips", "Spine", "LeftUpperLeg", "RightUpperLeg"};
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  check_address(take_line(rest));
  const std::string_view name = take_line(rest);
  Humanoid humanoid;
  std::vector<BonePose> bones;
  const BonePose root = next_bone(rest);
  humanoid.hips_m = next_number(rest);
  for (int i = 0; i < 16 && !rest.empty(); ++i) {
    humanoid.bones.push_back({.name = kBones[i % 4]});
    bones.push_back(next_bone(rest));
  }
  // Equal names would be one key of the JSON object, so at most four bones are named.
  humanoid.bones.resize(std::min<std::size_t>(bones.size(), 4));
  bones.resize(humanoid.bones.size());
  const StreamedFrame frame{
      .character = name, .root = root, .humanoid = &humanoid, .bones = &bones};
  check_json(frame);
  check_osc(frame);
  return 0;
}
