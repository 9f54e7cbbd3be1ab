// Sends a pad's packets from a thread of its own, for ports whose writing waits for the pad: hidraw
// returns when the pad has taken the packet, and the kernel gives up only after five seconds.
#pragma once
#include <functional>
#include <memory>
#include <thread>

#include "drivers/pads/pad_model.h"

namespace gaitpad {

class PacketSender {
 public:
  using Write = std::function<bool(std::span<const std::uint8_t>)>;

  // `write` is called by the thread alone, and destroyed when it has ended. Null where no thread
  // can be started.
  static std::unique_ptr<PacketSender> create(Write write);
  // The packet that waits is still sent. A pad that does not take it within a tenth of a second
  // keeps the thread and what `write` owns until its write returns, but not the caller.
  ~PacketSender();

  // Never waits; replaces a packet that has not left yet. False where the last one failed to leave.
  bool send(const OutPacket& packet) noexcept;

 private:
  struct State;
  PacketSender(std::shared_ptr<State> state, std::thread thread);
  static void run(const std::shared_ptr<State>& state);

  std::shared_ptr<State> state_;
  std::thread thread_;
};

}  // namespace gaitpad
