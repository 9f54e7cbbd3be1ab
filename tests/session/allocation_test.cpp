// Counts every operator new of this executable while a step runs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "tests/session/made_session.h"

namespace {

thread_local bool counting = false;
thread_local int allocations = 0;

void* counted(std::size_t size) {
  allocations += counting;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) { return counted(size); }
void* operator new[](std::size_t size) { return counted(size); }
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::size_t) noexcept { std::free(memory); }

namespace gaitpad {
namespace {

TEST(Allocation, IsCounted) {
  allocations = 0;
  counting = true;
  ::operator delete(::operator new(1));
  counting = false;
  EXPECT_EQ(allocations, 1);
}

TEST(Allocation, NoneIn10000StepsWithReportsCommandsAndReplugging) {
  for (const IkMode mode : {IkMode::robust, IkMode::paper}) {
    SimulationConfig config = made_config(4);
    config.ik = mode;
    auto simulation = Simulation::create(config);
    ASSERT_TRUE(simulation) << simulation.error().message;
    allocations = 0;
    for (int tick = 0; tick < 10000; ++tick) {
      const std::vector<Report> reports = made_tick(tick);
      counting = true;
      simulation->step(reports);
      counting = false;
    }
    EXPECT_EQ(allocations, 0);
    EXPECT_EQ(simulation->counts().ticks, 10000);
    EXPECT_GT(simulation->walkers()[0].state.frame.steps[kLeftSide], 10);
  }
}

}  // namespace
}  // namespace gaitpad
