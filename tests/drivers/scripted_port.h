// A pad for tests of quirks: answers by rules, never waits, stores the packets written to it.
#pragma once
#include <algorithm>
#include <deque>
#include <functional>
#include <map>
#include <vector>

#include "drivers/pads/pad_quirks.h"

namespace gaitpad {

using Packet = std::vector<std::uint8_t>;

class ScriptedPort final : public PadPort {
 public:
  bool write(std::span<const std::uint8_t> packet) noexcept override {
    if (is_gone) return false;
    written.emplace_back(packet.begin(), packet.end());
    if (answer) answer(written.back(), waiting);
    return true;
  }
  std::size_t read(std::span<std::uint8_t> packet, std::chrono::milliseconds) noexcept override {
    ++reads;
    if (waiting.empty()) return 0;
    const std::size_t size = std::min(packet.size(), waiting.front().size());
    std::copy_n(waiting.front().begin(), size, packet.begin());
    if (!is_endless) waiting.pop_front();
    return size;
  }
  std::size_t feature(std::uint8_t id, std::span<std::uint8_t> packet) noexcept override {
    features_asked.push_back(id);
    const auto found = features.find(id);
    if (found == features.end()) return 0;
    const std::size_t size = std::min(packet.size(), found->second.size());
    std::copy_n(found->second.begin(), size, packet.begin());
    return size;
  }

  std::size_t command(std::span<const std::uint8_t> packet,
                      std::span<std::uint8_t> answered) noexcept override {
    commands.emplace_back(packet.begin(), packet.end());
    const Packet reply = answer_command ? answer_command(commands.back()) : Packet();
    std::copy_n(reply.begin(), std::min(reply.size(), answered.size()), answered.begin());
    return std::min(reply.size(), answered.size());
  }

  // Called for each packet written; adds answers to the queue.
  std::function<void(const Packet&, std::deque<Packet>&)> answer;
  // Called for each command; returns its answer.
  std::function<Packet(const Packet&)> answer_command;
  std::vector<Packet> commands;
  std::deque<Packet> waiting;  // input packets that have not been read
  std::map<std::uint8_t, Packet> features;
  bool is_gone = false;
  bool is_endless = false;  // the front packet repeats without end
  std::vector<Packet> written;
  std::vector<std::uint8_t> features_asked;
  int reads = 0;
};

inline Packet bytes_of(const OutPacket& packet) {
  return Packet(packet.bytes.begin(), packet.bytes.begin() + static_cast<long>(packet.size));
}
inline Packet rumble_of(PadQuirks& pad, const Rumble& rumble) {
  OutPacket packet;
  pad.rumble(rumble, packet);
  return bytes_of(packet);
}

}  // namespace gaitpad
