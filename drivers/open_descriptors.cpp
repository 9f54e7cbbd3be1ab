#include "drivers/open_descriptors.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <string>
#include <system_error>

#include "base/text.h"

namespace gaitpad {

OpenDescriptors open_descriptors(dev_t node) {
  OpenDescriptors found;
  std::error_code error;
  for (std::filesystem::directory_iterator it("/proc/self/fd", error), end; !error && it != end;
       it.increment(error)) {
    const std::string name = it->path().filename().string();
    const auto fd = parse_number<int>(name);
    if (!fd) continue;
    struct stat status {};
    if (::fstat(*fd, &status) == 0 && S_ISCHR(status.st_mode) && status.st_rdev == node)
      found.push_back(*fd);
  }
  std::sort(found.begin(), found.end());
  return found;
}

int new_descriptor(const OpenDescriptors& before, const OpenDescriptors& after) {
  OpenDescriptors fresh;
  std::set_difference(after.begin(), after.end(), before.begin(), before.end(),
                      std::back_inserter(fresh));
  if (fresh.size() == 1) return fresh.front();
  return fresh.empty() && after.size() == 1 ? after.front() : -1;
}

}  // namespace gaitpad
