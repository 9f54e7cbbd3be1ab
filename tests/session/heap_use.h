// Counts the calling thread's heap uses. allocation_test.cpp counts them for the executable.
#pragma once

namespace gaitpad {

void begin_counting_heap_use();
// Number of allocations and frees since begin_counting_heap_use(); ends the counting.
int heap_uses();

}  // namespace gaitpad
