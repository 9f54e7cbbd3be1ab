// Bad values for the fields of public structs, made from a field's range, and the number of values
// that were fed.
#pragma once
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace gaitpad {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Numbers that a field with the range [least, most] must refuse.
inline std::vector<double> bad_numbers(double least, double most) {
  std::vector<double> bad = {kNaN, kInfinity, -kInfinity};
  for (const double value :
       {0.0, -0.0, 1e-310, -1e-310, -1.0, 1e300, -1e300, least - 0.001 * (1.0 + std::abs(least)),
        most + 0.001 * (1.0 + std::abs(most))}) {
    if (!(value >= least && value <= most)) bad.push_back(value);
  }
  return bad;
}
// Whole numbers (counts and indices, all of type int) that a field with the range [least, most]
// must refuse.
inline std::vector<double> bad_counts(double least, double most) {
  std::vector<double> bad;
  for (const double value :
       {-1.0, 0.0, least - 1.0, most + 1.0, double(std::numeric_limits<int>::min()),
        double(std::numeric_limits<int>::max())}) {
    if (!(value >= least && value <= most) && value >= std::numeric_limits<int>::min() &&
        value <= std::numeric_limits<int>::max())
      bad.push_back(value);
  }
  return bad;
}

// A field of T: its name in sentences, how it is set, and its bad values.
template <class T>
struct FedField {
  std::string name;
  std::function<void(T&, double)> set;
  std::vector<double> bad;
};

}  // namespace gaitpad
