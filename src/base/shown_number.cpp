#include "base/shown_number.h"

#include <cmath>

#include "base/text.h"

namespace gaitpad {

std::string shown_number(double value, int decimals) {
  if (!std::isfinite(value)) return "-";
  const std::string text = fixed(value, decimals);
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return is_zero && text.front() == '-' ? text.substr(1) : text;
}

std::string signed_number(double value, int decimals) {
  const std::string text = shown_number(value, decimals);
  return text.front() == '-' ? text : '+' + text;
}

}  // namespace gaitpad
