// A hash of the bits of poses, equal on every machine: two walks are the same bit by bit if their
// hashes are. It is FNV-1a on 64-bit words instead of bytes, with FNV's offset and prime, and a
// shift after each product, because a product alone never carries upper bits down. Eight times
// fewer steps than FNV-1a. It does not resist an adversary.
#pragma once
#include <bit>
#include <cstdint>

namespace gaitpad {

class WordHash {
 public:
  void add(double value) noexcept {
    state_ = (state_ ^ std::bit_cast<std::uint64_t>(value)) * 0x100000001b3ull;
    state_ ^= state_ >> 32;
  }
  std::uint64_t value() const noexcept { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

}  // namespace gaitpad
