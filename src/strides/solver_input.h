// The numbers that a family of strides depends on, and the numbers that it consists of.
#pragma once
#include <vector>

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
  const auto each_of = [&each](auto& v) { each(v.x), each(v.y), each(v.z); };
  for (auto* tables : {&family.table, &family.back})
    for (auto& table : *tables) {
      each(table.stride_m);
      for (auto& place : table.footprint_m) each_of(place);
      each(table.low_m), each(table.high_m);
      for (auto& cell : table.knot) {
        each_of(cell.pelvis_m);
        each(cell.pelvis_yaw_rad);
        each_of(cell.pelvis_tilt);
        for (auto& foot : cell.foot) {
          each_of(foot.heel_m);
          each(foot.pitch_rad), each(foot.twist_rad), each(foot.roll_rad);
        }
        for (auto& angles : cell.leg_rad) {
          for (auto& angle : angles) each(angle);
        }
      }
    }
}

}  // namespace gaitpad
