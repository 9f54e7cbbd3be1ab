// std::bit_cast, which some standard libraries of C++20 lack (libc++ 13, which Emscripten 3 has).
#pragma once
#include <cstring>
#include <type_traits>

namespace gaitpad {

template <class To, class From>
inline To bits_as(const From& from) noexcept {
  static_assert(sizeof(To) == sizeof(From) && std::is_trivially_copyable_v<To> &&
                std::is_trivially_copyable_v<From>);
  To to;
  std::memcpy(static_cast<void*>(&to), &from, sizeof to);
  return to;
}

}  // namespace gaitpad
