// Finds the file descriptor of a device node that a library has opened without telling its number.
#pragma once
#include <sys/types.h>

#include <vector>

namespace gaitpad {

using OpenDescriptors = std::vector<int>;  // numbers of file descriptors, ascending

// The descriptors of this process, by /proc/self/fd, that are open on that character device.
OpenDescriptors open_descriptors(dev_t node);

// The descriptor that was opened between the two calls; -1: it cannot be identified. Another thread
// may close a descriptor of the same node meanwhile, and its number be reused: if only one is open
// afterwards, that is the new one, even if its number was there before.
int new_descriptor(const OpenDescriptors& before, const OpenDescriptors& after);

}  // namespace gaitpad
