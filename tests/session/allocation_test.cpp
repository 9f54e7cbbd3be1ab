// Counts every operator new and delete of this executable while a step runs.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "tests/session/heap_use.h"
#include "tests/session/made_session.h"

namespace {

thread_local bool counting = false;
thread_local int allocations = 0;

void* counted(std::size_t size) noexcept {
  allocations += counting;
  return std::malloc(size);
}

void* counted_or_thrown(std::size_t size) {
  if (void* memory = counted(size)) return memory;
  throw std::bad_alloc();
}

void freed(void* memory) {
  allocations += counting && memory != nullptr;
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return counted_or_thrown(size); }
void* operator new[](std::size_t size) { return counted_or_thrown(size); }
// The nothrow new is replaced as well: AddressSanitizer's would not match the operators delete
// below.
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return counted(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept { return counted(size); }
void operator delete(void* memory) noexcept { freed(memory); }
void operator delete[](void* memory) noexcept { freed(memory); }
void operator delete(void* memory, std::size_t) noexcept { freed(memory); }
void operator delete[](void* memory, std::size_t) noexcept { freed(memory); }

namespace gaitpad {

void begin_counting_heap_use() {
  allocations = 0;
  counting = true;
}
int heap_uses() {
  counting = false;
  return allocations;
}

namespace {

TEST(Allocation, IsCounted) {
  begin_counting_heap_use();
  void* memory = ::operator new(1);
  EXPECT_EQ(heap_uses(), 1);
  begin_counting_heap_use();
  ::operator delete(memory);
  EXPECT_EQ(heap_uses(), 1);
}

void expect_no_heap_use(SimulationConfig config, IkMode mode) {
  config.ik = mode;
  auto simulation = Simulation::create(config);
  ASSERT_TRUE(simulation) << simulation.error().message;
  int uses = 0;
  for (int tick = 0; tick < 6000; ++tick) {
    const std::vector<Report> reports = made_tick(tick);
    begin_counting_heap_use();
    simulation->step(reports);
    uses += heap_uses();
  }
  EXPECT_EQ(uses, 0);
  EXPECT_EQ(simulation->counts().ticks, 6000);
  EXPECT_EQ(simulation->counts().bad_commands, 2);
  EXPECT_GT(walk_steps(simulation->walkers()[0].state).steps[kLeftSide], 10);
}

TEST(Allocation, NoneInStepsWithReportsCommandsAndReplugging) {
  for (const IkMode mode : {IkMode::robust, IkMode::paper})
    expect_no_heap_use(made_config(4), mode);
}

TEST(Allocation, NoneOverTerrainWithZonesBlendsTiringAndHeldHands) {
  for (const IkMode mode : {IkMode::robust, IkMode::paper})
    expect_no_heap_use(made_uneven_config(4), mode);
}

}  // namespace
}  // namespace gaitpad
