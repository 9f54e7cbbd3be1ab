// A value, or one sentence that says why there is none. Set-up code returns it, since loading may
// fail; nothing that runs in a tick does.
//
//   const gaitpad::Result<gaitpad::Motion> motion = gaitpad::load_motion(path);
//   if (!motion) return std::puts(motion.error().message.c_str());
//   walk(*motion);
#pragma once
#include <string>
#include <utility>
#include <variant>

namespace gaitpad {

// `message` is one sentence for a user. It names the thing, the place and the cause:
// `config/pads/sony.toml:12: unknown axis "left_z"`.
struct Error {
  std::string message;
};

template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::move(value)) {}
  Result(Error error) : content_(std::move(error)) {}
  explicit operator bool() const { return content_.index() == 0; }  // True if there is a value.
  // The value; call it only if there is one.
  T& operator*() { return std::get<0>(content_); }
  const T& operator*() const { return std::get<0>(content_); }
  T* operator->() { return &std::get<0>(content_); }
  const T* operator->() const { return &std::get<0>(content_); }
  // The error; call it only if there is no value.
  const Error& error() const { return std::get<1>(content_); }

 private:
  std::variant<T, Error> content_;
};

}  // namespace gaitpad
