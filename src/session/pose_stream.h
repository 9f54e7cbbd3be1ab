// Sends the poses of a live session to other programs as datagrams: VMC messages over OSC, for
// avatar programs and add-ons of game engines, or the same bones as JSON. docs/embed.md describes
// both.
//
// A thread of its own wakes `fps` times a second and sends the newest pose that the loop has
// published. The loop copies its poses once a tick and never waits.
#pragma once
#include <array>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/latest.h"
#include "gaitpad/result.h"
#include "gaitpad/session_frame.h"
#include "session/humanoid.h"
#include "system/descriptors.h"

namespace gaitpad {

// `osc://HOST:PORT` or `json://HOST:PORT`. The default host is the loopback address; the default
// port is 39539 (VMC's) for osc and 39540 for json. `osc` and `json` alone use both defaults.
struct StreamAddress {
  enum class Format { osc, json } format = Format::osc;
  std::string host = "127.0.0.1";
  int port = 39539;
  static Result<StreamAddress> parse(const std::string& text);
};

// The poses of one tick, as the loop publishes them for the stream.
struct StreamedTick {
  struct Character {
    Pose pose;
    double heading_rad = 0.0;
  };
  std::int64_t tick = -1;  // tick of the frame; -1: none yet
  int walker_count = 0;
  std::array<Character, kMaxWalkers> walkers;
};
void copy_tick(const Simulation& simulation, StreamedTick& streamed) noexcept;

class PoseStream {
 public:
  // Character n (from 0) is sent to port + n. Nothing is sent before start(). Error: `address` is
  // invalid, its host cannot be resolved, too many ports, or built without OSC.
  static Result<std::unique_ptr<PoseStream>> open(const std::string& address, int fps,
                                                  const Cast& cast);
  ~PoseStream() { stop(); }

  void start();
  void stop();
  // The loop writes here.
  Latest<StreamedTick>& newest() noexcept { return newest_; }
  std::int64_t frames() const noexcept { return frames_.load(std::memory_order_relaxed); }

 private:
  struct Source {  // a character whose poses are sent
    std::string name;
    std::shared_ptr<const WalkModel> model;
    Humanoid humanoid;
    OwnedFd socket;
  };
  PoseStream(StreamAddress::Format format, int fps, int rate_hz)
      : format_(format), fps_(fps), rate_hz_(rate_hz) {}
  void run();
  void send(const StreamedTick& tick);

  const StreamAddress::Format format_;
  const int fps_, rate_hz_;
  std::vector<Source> sources_;
  Latest<StreamedTick> newest_;
  std::vector<BonePose> bones_;  // bones of the character that is being sent
  std::atomic<std::int64_t> frames_{0};
  std::mutex mutex_;
  std::condition_variable ending_;
  bool is_ending_ = false;
  std::thread thread_;
};

// One character's frame, to be encoded as datagrams.
struct StreamedFrame {
  int source = 1;  // number of the character; 1: the first one
  std::string_view character;
  std::int64_t tick = 0;
  double time_s = 0.0;
  BonePose root;
  const Humanoid* humanoid = nullptr;
  const std::vector<BonePose>* bones = nullptr;
};
std::string json_datagram(const StreamedFrame& frame);
// Each string is an OSC bundle that fits into an Ethernet packet. Empty if built without liblo.
std::vector<std::string> osc_datagrams(const StreamedFrame& frame);

}  // namespace gaitpad
