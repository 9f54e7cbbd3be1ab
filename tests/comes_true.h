// Waits for the effects of other threads.
#pragma once
#include <chrono>
#include <functional>
#include <thread>

namespace gaitpad {

// Never reached on a machine that works, however busy it is.
constexpr std::chrono::seconds kPatience{60};

inline void sleep_for(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

// Waits until the condition is true; false if kPatience ends first.
inline bool comes_true(const std::function<bool()>& condition) {
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    sleep_for(1);
  }
  return true;
}

}  // namespace gaitpad
