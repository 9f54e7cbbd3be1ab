// A value or one sentence that says why there is none. For set-up code; the loop uses statuses.
#pragma once
#include <string>
#include <utility>
#include <variant>

namespace gaitpad {

// `message` names the thing, the place and the cause: `config/pads/sony.toml:12: unknown axis
// "left_z"`.
struct Error {
  std::string message;
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(std::move(error)) {}
  explicit operator bool() const { return content_.index() == 0; }
  T& operator*() { return std::get<0>(content_); }
  const T& operator*() const { return std::get<0>(content_); }
  T* operator->() { return &std::get<0>(content_); }
  const T* operator->() const { return &std::get<0>(content_); }
  const Error& error() const { return std::get<1>(content_); }

 private:
  std::variant<T, Error> content_;
};

}  // namespace gaitpad
