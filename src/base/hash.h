// FNV-1a, 64 bit: a hash of pose bits that is the same on every machine of one byte order.
#pragma once
#include <bit>
#include <cstdint>

namespace gaitpad {

class Fnv1a {
 public:
  void add(double value) noexcept {
    auto bits = std::bit_cast<std::uint64_t>(value);
    for (int i = 0; i < 8; ++i, bits >>= 8) {
      state_ = (state_ ^ (bits & 0xff)) * 0x100000001b3ull;
    }
  }
  std::uint64_t value() const noexcept { return state_; }

 private:
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

}  // namespace gaitpad
