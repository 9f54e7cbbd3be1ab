// The numbers that a family of strides depends on, and the numbers that it consists of.
#pragma once
#include <array>
#include <type_traits>
#include <vector>

#include "base/bits.h"
#include "gaitpad/stride_family.h"

namespace gaitpad {

// All numbers of a cycle that its family depends on: cycles with equal numbers have equal families.
std::vector<double> solver_input(const GaitCycle& cycle);

// Calls `each` with every number of a family, const or not, in a fixed order. The family has all of
// its tables.
template <class Family, class Each>
void for_each_number(Family& family, Each each) {
  each(family.stand_m);
  each(family.lead_m);
  each(family.stand_roll_rad);
  for (auto& angles : family.stand_rad) {
    for (auto& angle : angles) each(angle);
  }
  for (auto* tables : {&family.table, &family.back}) {
    for (auto& table : *tables) {
      // A table consists of doubles only.
      auto numbers = bits_as<std::array<double, sizeof table / sizeof(double)>>(table);
      for (auto& number : numbers) each(number);
      if constexpr (!std::is_const_v<Family>) table = bits_as<StrideTable>(numbers);
    }
  }
}

}  // namespace gaitpad
