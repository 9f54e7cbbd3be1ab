#include "drivers/process_memory.h"

#include <unistd.h>

#include <fstream>

namespace gaitpad {
namespace {

struct Pages {
  std::int64_t mapped = 0, resident = 0;
};
Pages pages() {
  Pages pages;
  std::ifstream("/proc/self/statm") >> pages.mapped >> pages.resident;
  return pages;
}

}  // namespace

std::int64_t mapped_bytes() { return pages().mapped * ::sysconf(_SC_PAGESIZE); }
std::int64_t resident_bytes() { return pages().resident * ::sysconf(_SC_PAGESIZE); }

}  // namespace gaitpad
