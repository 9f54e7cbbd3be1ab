// A hash of the bits of poses, equal on every machine: two walks are the same bit by bit if their
// hashes are equal. It is FNV-1a on 64-bit words instead of bytes, with FNV's offset and prime, and
// a shift after each product, because a product alone never carries upper bits down. It takes an
// eighth of the steps of FNV-1a. It does not resist an adversary.
#pragma once
#include <cstdint>
#include <cstring>

namespace gaitpad {

class WordHash {
 public:
  void add(double value) noexcept {
    std::uint64_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    state_ = (state_ ^ bits) * 0x100000001b3ull;
    state_ ^= state_ >> 32;
  }
  std::uint64_t value() const noexcept { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

}  // namespace gaitpad
