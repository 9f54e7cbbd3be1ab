// A pad that takes every packet, says nothing and keeps what it was sent.
#pragma once
#include <vector>

#include "drivers/pads/pad_model.h"

namespace gaitpad {

using Bytes = std::vector<std::uint8_t>;

class RecordingPort final : public PadPort {
 public:
  bool write(std::span<const std::uint8_t> packet) noexcept override {
    written.emplace_back(packet.begin(), packet.end());
    return true;
  }
  std::size_t read(std::span<std::uint8_t>, std::chrono::milliseconds) noexcept override {
    return 0;
  }
  std::size_t feature(std::uint8_t, std::span<std::uint8_t>) noexcept override { return 0; }

  std::vector<Bytes> written;
};

inline Bytes bytes_of(const OutPacket& packet) {
  return {packet.bytes.begin(), packet.bytes.begin() + static_cast<std::ptrdiff_t>(packet.size)};
}

}  // namespace gaitpad
