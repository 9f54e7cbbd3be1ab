#include "system/cores.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

cpu_set_t allowed() {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  EXPECT_EQ(::sched_getaffinity(0, sizeof cores, &cores), 0);
  return cores;
}

TEST(Cores, AThreadIsPinnedToOneOfItsCoresAndUnpinned) {
  const cpu_set_t before = allowed();
  {
    const Cores cores;
    ASSERT_GE(cores.core(), 0);
    EXPECT_TRUE(CPU_ISSET(cores.core(), &before));
    cores.use_one();
    const cpu_set_t one = allowed();
    EXPECT_EQ(CPU_COUNT(&one), 1);
    EXPECT_EQ(::sched_getcpu(), cores.core());
    cores.use_all();
    const cpu_set_t all = allowed();
    EXPECT_TRUE(CPU_EQUAL(&all, &before));
    cores.use_one();
  }
  const cpu_set_t after = allowed();
  EXPECT_TRUE(CPU_EQUAL(&after, &before)) << "the destructor unpins";
}

}  // namespace
}  // namespace gaitpad
