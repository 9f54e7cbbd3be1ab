#include "drivers/realtime.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <fstream>
#include <string>
#include <thread>

namespace gaitpad {
namespace {

TEST(Realtime, WhatWasRefusedIsSaidInOneSentenceWithItsRemedy) {
  EXPECT_FALSE(realtime_remark(std::nullopt, std::nullopt));
  const auto both = realtime_remark("SCHED_FIFO: no", "mlockall: no");
  ASSERT_TRUE(both);
  for (const char* piece : {"(SCHED_FIFO: no, mlockall: no)", "- rtprio 20` and `",
                            "- memlock unlimited`", "/etc/security/limits.d/"}) {
    EXPECT_NE(both->find(piece), std::string::npos) << *both;
  }
  EXPECT_EQ(realtime_remark("SCHED_FIFO: no", std::nullopt)->find("memlock"), std::string::npos);
  EXPECT_EQ(realtime_remark(std::nullopt, "mlockall: no")->find("rtprio"), std::string::npos);
}

// A value of /proc/self/status in KiB.
long status_kib(const std::string& key) {
  std::ifstream file("/proc/self/status");
  std::string word;
  long value = -1;
  while (file >> word) {
    if (word == key + ":") file >> value;
  }
  return value;
}

// Sanitizers make mlockall() do nothing: their shadow memory is larger than any machine's.
#ifdef GAITPAD_SANITIZED
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif

TEST(Realtime, LockingTakesNoMemoryThatNobodyTouched) {
  if (kIsSanitized) GTEST_SKIP() << "a sanitizer locks nothing";
  constexpr std::size_t kBytes = std::size_t{2} << 30;
  void* reserved = ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE,
                          MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  ASSERT_NE(reserved, MAP_FAILED);
  const long before_kib = status_kib("VmRSS");
  const auto refused = lock_memory();
  const long taken_kib = status_kib("VmRSS") - before_kib;
  if (!refused) {
    EXPECT_GT(status_kib("VmLck"), 0);
    // Memory that is mapped later, by a renderer for example, is not locked.
    const long locked_kib = status_kib("VmLck");
    void* later = ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE,
                         MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    EXPECT_LT(status_kib("VmLck") - locked_kib, 1024);
    ::munmap(later, kBytes);
    ASSERT_FALSE(lock_memory());
    unlock_memory();
    EXPECT_GT(status_kib("VmLck"), 0) << "somebody else still needs it";
    unlock_memory();
    EXPECT_EQ(status_kib("VmLck"), 0);
  }
  ::munmap(reserved, kBytes);
  EXPECT_LT(taken_kib, 8 << 10) << "of two gigabytes that nobody has touched";
  if (refused) GTEST_SKIP() << *refused;
}

TEST(Realtime, ThreadsThatARealtimeThreadStartsAreOrdinaryOnes) {
  std::optional<std::string> refused;
  std::string own, pads, started, given_up;
  std::thread([&] {
    refused = take_priority(RealtimeRank::loop);
    own = time_policy();
    std::thread([&] { started = time_policy(); }).join();
    static_cast<void>(take_priority(RealtimeRank::pads));
    pads = time_policy();
    give_up_priority();
    given_up = time_policy();
  }).join();
  if (refused) {
    EXPECT_EQ(own, "normal priority");
    GTEST_SKIP() << *refused;
  }
  EXPECT_EQ(own, "SCHED_FIFO 20");
  EXPECT_EQ(pads, "SCHED_FIFO 19");
  EXPECT_EQ(started, "normal priority");
  EXPECT_EQ(given_up, "normal priority");
  EXPECT_EQ(time_policy(), "normal priority") << "the others are left alone";
}

}  // namespace
}  // namespace gaitpad
