#include "drivers/registry.h"

#include "drivers/trace_driver.h"

namespace gaitpad {

namespace {

constexpr DriverEntry kDrivers[] = {
    {.name = "trace", .make = &make_trace_driver},
};

}  // namespace

std::span<const DriverEntry> drivers() noexcept { return kDrivers; }

const DriverEntry* find_driver(std::string_view name) noexcept {
  for (const DriverEntry& entry : kDrivers) {
    if (name == entry.name) return &entry;
  }
  return nullptr;
}

}  // namespace gaitpad
