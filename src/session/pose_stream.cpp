#include "session/pose_stream.h"

#include <fmt/format.h>
#ifdef GAITPAD_HAS_OSC
#include <lo/lo.h>
#endif

#include <algorithm>
#include <chrono>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/text.h"
#include "session/live_loop.h"
#include "system/clock.h"
#include "system/datagrams.h"
#include "system/threads.h"

namespace gaitpad {

// --- the address

namespace {

constexpr int kOscPort = 39539, kJsonPort = 39540, kLastPort = 65535;

Error address_error(const std::string& text, std::string_view cause) {
  return Error{fmt::format("{} {}: osc://HOST:PORT or json://HOST:PORT was expected",
                           in_quotes(text), cause)};
}

}  // namespace

Result<StreamAddress> StreamAddress::parse(const std::string& text) {
  StreamAddress address;
  const std::size_t divider = text.find("://");
  const std::string scheme = text.substr(0, divider);
  if (scheme != "osc" && scheme != "json") return address_error(text, "is no stream");
  const bool is_osc = scheme == "osc";
  address.format = is_osc ? Format::osc : Format::json;
  address.port = is_osc ? kOscPort : kJsonPort;
  if (divider == std::string::npos) return address;
  std::string_view rest = std::string_view(text).substr(divider + 3);
  if (rest.starts_with('[')) {  // an IPv6 address contains colons
    const std::size_t end = rest.find(']');
    if (end == std::string_view::npos) return address_error(text, "has no ]");
    address.host = rest.substr(1, end - 1);
    rest.remove_prefix(end + 1);
  } else {
    const std::string_view host = rest.substr(0, rest.find(':'));
    if (!host.empty()) address.host = host;
    rest.remove_prefix(host.size());
  }
  if (rest.empty()) return address;
  const auto port = rest.front() == ':' ? parse_number<int>(rest.substr(1)) : std::nullopt;
  if (!port || *port < 1 || *port > kLastPort)
    return address_error(text, fmt::format("has no port within 1 .. {}", kLastPort));
  address.port = *port;
  return address;
}

// --- the formats

std::string json_datagram(const StreamedFrame& frame) {
  fmt::memory_buffer out;
  const auto end = std::back_inserter(out);
  const auto append_place = [&end](const BonePose& bone) {
    const vec3& p = bone.place_m;
    const quat& q = bone.rotation;
    // + 0.0 avoids "-0"
    fmt::format_to(end, "[{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}]", p.x + 0.0, p.y + 0.0,
                   p.z + 0.0, q.x + 0.0, q.y + 0.0, q.z + 0.0, q.w + 0.0);
  };
  const nlohmann::json name = frame.character;  // written as JSON, which escapes quotes in the name
  fmt::format_to(
      end, R"({{"source":{},"character":{},"tick":{},"time_s":{:.6f},"hips_m":{:.6f},"root":)",
      frame.source, name.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), frame.tick,
      frame.time_s, frame.humanoid->hips_m);
  append_place(frame.root);
  fmt::format_to(end, R"(,"bones":{{)");
  for (std::size_t b = 0; b < frame.bones->size(); ++b) {
    fmt::format_to(end, R"({}"{}":)", b == 0 ? "" : ",", frame.humanoid->bones[b].name);
    append_place((*frame.bones)[b]);
  }
  fmt::format_to(end, "}}}}");
  return fmt::to_string(out);
}

#ifdef GAITPAD_HAS_OSC

namespace {

constexpr std::size_t kMaxBundleBytes = 1400;  // below 1500 with the headers of IP and UDP

constexpr lo_timetag kAtOnce = {.sec = 0, .frac = 1};  // LO_TT_IMMEDIATE is not valid C++

// Collects messages into bundles.
class OscBundles {
 public:
  ~OscBundles() { close(); }
  void add(const char* path, lo_message message) {
    if (bundle_ != nullptr &&
        lo_bundle_length(bundle_) + lo_message_length(message, path) > kMaxBundleBytes) {
      close();
    }
    if (bundle_ == nullptr) bundle_ = lo_bundle_new(kAtOnce);
    lo_bundle_add_message(bundle_, path, message);
  }
  std::vector<std::string> take() {
    close();
    return std::move(datagrams_);
  }

 private:
  void close() {
    if (bundle_ == nullptr) return;
    std::string bytes(lo_bundle_length(bundle_), '\0');
    lo_bundle_serialise(bundle_, bytes.data(), nullptr);
    datagrams_.push_back(std::move(bytes));
    lo_bundle_free_recursive(std::exchange(bundle_, nullptr));
  }
  lo_bundle bundle_ = nullptr;
  std::vector<std::string> datagrams_;
};

// Unity's world is left-handed with +x to the right, so x is mirrored.
lo_message placed(const char* name, const BonePose& bone) {
  lo_message message = lo_message_new();
  lo_message_add_string(message, name);
  const vec3& p = bone.place_m;
  const quat& q = bone.rotation;
  for (const double value : {-p.x, p.y, p.z, q.x, -q.y, -q.z, q.w})
    lo_message_add_float(message, static_cast<float>(value));
  return message;
}

}  // namespace

std::vector<std::string> osc_datagrams(const StreamedFrame& frame) {
  OscBundles bundles;
  lo_message ready = lo_message_new();
  lo_message_add_int32(ready, 1);  // 1: a model is loaded
  bundles.add("/VMC/Ext/OK", ready);
  lo_message time = lo_message_new();
  lo_message_add_float(time, static_cast<float>(frame.time_s));
  bundles.add("/VMC/Ext/T", time);
  bundles.add("/VMC/Ext/Root/Pos", placed("root", frame.root));
  for (std::size_t b = 0; b < frame.bones->size(); ++b)
    bundles.add("/VMC/Ext/Bone/Pos", placed(frame.humanoid->bones[b].name, (*frame.bones)[b]));
  return bundles.take();
}

constexpr bool kHasOsc = true;
#else
std::vector<std::string> osc_datagrams(const StreamedFrame&) { return {}; }
constexpr bool kHasOsc = false;
#endif

// --- the stream

void copy_tick(const Simulation& simulation, StreamedTick& streamed) noexcept {
  streamed.tick = simulation.counts().ticks - 1;
  const std::vector<Walker>& walkers = simulation.walkers();
  streamed.walker_count = static_cast<int>(walkers.size());
  for (std::size_t i = 0; i < walkers.size(); ++i) {
    copy_pose(walkers[i].pose, streamed.walkers[i].pose);
    streamed.walkers[i].heading_rad =
        moved(walkers[i].state.placed, walkers[i].state.root).heading_rad;
  }
}

Result<std::unique_ptr<PoseStream>> PoseStream::open(const std::string& text, int fps,
                                                     const Cast& cast) {
  const auto address = StreamAddress::parse(text);
  if (!address) return address.error();
  if (address->format == StreamAddress::Format::osc && !kHasOsc)
    return Error{text + ": this program was built without liblo"};
  std::unique_ptr<PoseStream> stream(new PoseStream(address->format, fps, cast.rate_hz));
  for (const CastMember& member : cast.members) {
    const int port = address->port + static_cast<int>(stream->sources_.size());
    if (port > kLastPort)
      return Error{fmt::format("{}: {} characters need as many ports from there on", text,
                               cast.members.size())};
    auto socket = datagram_socket(address->host, port);
    if (!socket) return socket.error();
    stream->sources_.push_back(
        {member.character, member.model, humanoid_of(*member.model), std::move(*socket)});
  }
  return stream;
}

void PoseStream::stop() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  ending_.notify_one();
  if (thread_.joinable()) thread_.join();
}

void PoseStream::start() {
  thread_ = std::thread([this] { run(); });
}

void PoseStream::run() {
  name_thread("gaitpad-stream");
  const std::int64_t start_ns = now_ns();
  const auto frame_at = [&](std::int64_t time_ns) {
    return (time_ns - start_ns) * fps_ / kSecond_ns;
  };
  std::int64_t frame = 0;
  std::unique_lock lock(mutex_);
  while (!is_ending_) {
    // Follow the clock, so that the frames keep their rate; missed frames are not sent later.
    frame = std::max(frame + 1, frame_at(now_ns()));
    const std::chrono::nanoseconds wait(start_ns + frame * kSecond_ns / fps_ - now_ns());
    if (ending_.wait_for(lock, wait, [this] { return is_ending_; })) break;
    bool is_new = false;
    const StreamedTick& tick = newest_.read(is_new);
    if (tick.tick >= 0) send(tick);
  }
}

void PoseStream::send(const StreamedTick& tick) {
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Source& source = sources_[i];
    const StreamedTick::Character& walker = tick.walkers[i];
    const vec3& hips_m = walker.pose.root_m;
    const BonePose root = {vec3(hips_m.x, 0.0, hips_m.z), rotation_y(walker.heading_rad)};
    humanoid_pose(source.humanoid, source.model->cycle.skeleton, walker.pose, root, bones_);
    const StreamedFrame frame = {.source = static_cast<int>(i) + 1,
                                 .character = source.name,
                                 .tick = tick.tick,
                                 .time_s = static_cast<double>(tick.tick) / rate_hz_,
                                 .root = root,
                                 .humanoid = &source.humanoid,
                                 .bones = &bones_};
    const bool is_json = format_ == StreamAddress::Format::json;
    for (const std::string& datagram :
         is_json ? std::vector{json_datagram(frame)} : osc_datagrams(frame)) {
      send_datagram(source.socket, datagram);
    }
  }
  frames_.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace gaitpad
