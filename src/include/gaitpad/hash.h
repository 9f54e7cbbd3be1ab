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
    // The new word and the shift of the product before it do not wait for each other.
    product_ = (product_ ^ bits ^ product_ >> 32) * 0x100000001b3ull;
  }
  std::uint64_t value() const noexcept { return product_ ^ product_ >> 32; }

 private:
  static constexpr std::uint64_t kOffset = 0xcbf29ce484222325ull;
  // The hash before its shift, which undoes itself.
  std::uint64_t product_ = kOffset ^ kOffset >> 32;
};

}  // namespace gaitpad
