// Which of this process's descriptors are of a certain device node, for libraries that open one and
// do not say which number it got.
#pragma once
#include <sys/types.h>

#include <vector>

namespace gaitpad {

using OpenDescriptors = std::vector<int>;  // ascending

// Those of a character device's node, by /proc/self/fd.
OpenDescriptors open_descriptors(dev_t node);

// The one that an opening between the two has made, -1 where that cannot be told. Another thread
// may close one of the same node meanwhile and its number be used again: so a single one that there
// is afterwards is the new one, however old it looks.
int new_descriptor(const OpenDescriptors& before, const OpenDescriptors& after);

}  // namespace gaitpad
