// A bounded queue from exactly one writing to one reading thread: wait-free on both sides, no heap
// after construction. A full ring refuses new items instead of overwriting old ones.
#pragma once
#include <atomic>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace gaitpad {

inline constexpr std::size_t kCacheLineBytes = 64;

template <class T>
class SpscRing {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  // Holds `capacity` items, a power of two.
  explicit SpscRing(std::size_t capacity)
      : mask_(capacity - 1), items_(std::make_unique_for_overwrite<T[]>(capacity)) {}

  // Writer. Returns false if the ring is full; nothing is written then.
  bool push(const T& item) noexcept {
    const std::size_t at = written_.load(std::memory_order_relaxed);
    if (at - read_seen_ > mask_) {
      read_seen_ = read_.load(std::memory_order_acquire);
      if (at - read_seen_ > mask_) return false;
    }
    items_[at & mask_] = item;
    written_.store(at + 1, std::memory_order_release);
    return true;
  }

  // Reader. The oldest item, valid until pop(); null if the ring is empty.
  const T* front() noexcept {
    const std::size_t at = read_.load(std::memory_order_relaxed);
    if (at == written_seen_) {
      written_seen_ = written_.load(std::memory_order_acquire);
      if (at == written_seen_) return nullptr;
    }
    return &items_[at & mask_];
  }
  void pop() noexcept {  // Call it only after front() has returned an item.
    read_.store(read_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }
  bool pop(T& item) noexcept {
    const T* oldest = front();
    if (oldest == nullptr) return false;
    item = *oldest;
    pop();
    return true;
  }

 private:
  const std::size_t mask_;
  const std::unique_ptr<T[]> items_;
  alignas(kCacheLineBytes) std::atomic<std::size_t> written_{0};
  std::size_t read_seen_ = 0;  // read_ when the writer looked at it last
  alignas(kCacheLineBytes) std::atomic<std::size_t> read_{0};
  std::size_t written_seen_ = 0;  // written_ when the reader looked at it last
};

}  // namespace gaitpad
