// How often the calling thread used the heap; counted in allocation_test.cpp for the executable.
#pragma once

namespace gaitpad {

void begin_counting_heap_use();
int heap_uses();  // since then: what was allocated and what was freed; ends the counting

}  // namespace gaitpad
