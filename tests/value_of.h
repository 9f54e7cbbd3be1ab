// Takes the value out of a Result, in a test.
#pragma once
#include <stdexcept>
#include <string>

#include "gaitpad/result.h"

namespace gaitpad {

// Returns the value; if there is none, the test ends here and fails with the cause.
template <class T>
T value_of(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(*result);
}

// The reason why there is no value; "accepted" if there is one.
template <class T>
std::string cause_of(const Result<T>& result) {
  return result ? "accepted" : result.error().message;
}

}  // namespace gaitpad
