// Sends packets to a pad from a separate thread, for ports whose write waits for the pad: hidraw
// returns when the pad has taken the packet, and the kernel gives up only after five seconds.
#pragma once
#include <functional>
#include <memory>
#include <thread>

#include "drivers/pads/pad_quirks.h"

namespace gaitpad {

class PacketSender {
 public:
  using Write = std::function<bool(const OutPacket&)>;

  // Only the thread calls `write`; `write` is destroyed when the thread has ended. Null: no thread
  // can be started.
  static std::unique_ptr<PacketSender> create(Write write);
  // Sends a waiting packet first. If the pad does not take it within a tenth of a second, the
  // thread goes on alone, with what `write` owns, until its write returns.
  ~PacketSender();

  // Never waits; replaces a packet that was not sent yet. False: sending the previous packet
  // failed.
  bool send(const OutPacket& packet) noexcept;

 private:
  struct State;
  PacketSender(std::shared_ptr<State> state, std::thread thread);
  static void run(const std::shared_ptr<State>& state);

  std::shared_ptr<State> state_;
  std::thread thread_;
};

}  // namespace gaitpad
