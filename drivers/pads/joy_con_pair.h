// A left and a right Joy-Con as one pad, with the reports of a Pro Controller.
#pragma once
#include <memory>
#include <vector>

#include "gaitpad/driver.h"

namespace gaitpad {

// A listing for each left Joy-Con and the right one that goes with it; both must be usable. `node`
// is `LEFT+RIGHT`, `parts` are both pad paths. Two halves of a charging grip count as well: which
// one is which they tell only when they are opened.
std::vector<DeviceListing> joy_con_pairs(const std::vector<DeviceListing>& singles);

// Joins two open Joy-Cons, in any order. Error: they are not a left and a right one.
Result<std::unique_ptr<Device>> join_joy_cons(std::unique_ptr<Device> one,
                                              std::unique_ptr<Device> other);

}  // namespace gaitpad
