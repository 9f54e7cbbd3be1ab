// Counts the calling thread's heap uses. allocation_test.cpp counts them for the executable.
#pragma once

namespace gaitpad {

void begin_counting_heap_use();
int heap_uses();  // allocations and frees since then; ends the counting

}  // namespace gaitpad
