#include "system/cores.h"

namespace gaitpad {

Cores::Cores() noexcept {
  CPU_ZERO(&all_);
  CPU_ZERO(&one_);
  if (::sched_getaffinity(0, sizeof all_, &all_) != 0) return;
  for (int core = 0; core < CPU_SETSIZE; ++core)
    if (CPU_ISSET(core, &all_)) core_ = core;  // the last core: the first serves most interrupts
  if (core_ >= 0) CPU_SET(core_, &one_);
}

void Cores::use(const cpu_set_t& cores) const noexcept {
  if (core_ >= 0) ::sched_setaffinity(0, sizeof cores, &cores);
}

}  // namespace gaitpad
