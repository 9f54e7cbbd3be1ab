// One sentence of the paper as a number: what was measured, what it has to be.
#pragma once
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/walk.h"

namespace gaitpad {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

struct Bound {
  enum class Kind { at_most, less, at_least, more, within, equal } kind = Kind::at_most;
  double limit = 0.0;
  double low = 0.0;  // within: from here to `limit`
};
inline constexpr Bound at_most(double v) { return {Bound::Kind::at_most, v}; }
inline constexpr Bound less_than(double v) { return {Bound::Kind::less, v}; }
inline constexpr Bound at_least(double v) { return {Bound::Kind::at_least, v}; }
inline constexpr Bound more_than(double v) { return {Bound::Kind::more, v}; }
inline constexpr Bound within(double low, double high) { return {Bound::Kind::within, high, low}; }
inline constexpr Bound equal_to(double v) { return {Bound::Kind::equal, v}; }

bool holds(const Bound& bound, double value) noexcept;  // false for what is no number
std::string text_of(const Bound& bound);                // "<= 0.95"

struct Claim {
  std::string name;     // begins with its number among the thirty
  std::string section;  // of the paper
  IkMode mode = IkMode::robust;
  std::optional<double> value;
  std::string bound;
  std::optional<bool> pass;  // none: this motion cannot test it, `note` says why
  std::string note;
};

// What a group of claims has in common; it adds them one by one.
class ClaimList {
 public:
  ClaimList(std::string section, IkMode mode) : section_(std::move(section)), mode_(mode) {}
  Claim& add(std::string name, double value, const Bound& bound, std::string note = {});
  Claim& add_untested(std::string name, const Bound& bound, std::string why);
  std::vector<Claim> take() { return std::move(claims_); }

 private:
  std::string section_;
  IkMode mode_;
  std::vector<Claim> claims_;
};

const char* name_of(IkMode mode) noexcept;
// {"motion", "claims": [...]} as interface.md states it.
std::string claims_json(const std::string& motion, const std::vector<Claim>& claims);
// A line a claim, for people.
std::string claims_table(const std::vector<Claim>& claims);

}  // namespace gaitpad
