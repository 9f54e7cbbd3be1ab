#include "drivers/trace_driver.h"

#include <gtest/gtest.h>

#include "drivers/registry.h"

namespace gaitpad {
namespace {

using namespace std::chrono_literals;

TEST(TraceDriver, HandsOnDevicesAndReportsThenEnds) {
  const DriverEntry* entry = find_driver("trace");
  ASSERT_NE(entry, nullptr);
  auto driver = entry->make(GAITPAD_SOURCE_DIR "/tests/data/pads/046d_c216.hid");
  ASSERT_TRUE(driver) << driver.error().message;
  ASSERT_EQ((*driver)->device_count(), 1u);
  EXPECT_EQ((*driver)->device(0).vendor, 0x046d);
  EXPECT_FALSE((*driver)->device(0).descriptor.empty());
  Report report;
  int reports = 0;
  std::int64_t before = -1;
  while ((*driver)->read(report, 1s) == Driver::Status::report) {
    EXPECT_EQ(report.kind, ReportKind::input);
    EXPECT_GT(report.time_ns, before);
    before = report.time_ns;
    ++reports;
  }
  EXPECT_EQ(reports, 4);
  EXPECT_EQ((*driver)->read(report, 1s), Driver::Status::ended);
}

TEST(TraceDriver, AMissingFileIsAnError) {
  const auto driver = make_trace_driver("/nonexistent.hid");
  ASSERT_FALSE(driver);
  EXPECT_EQ(driver.error().message, "/nonexistent.hid: there is no such file");
}

TEST(Registry, EveryRowHasANameOfItsOwnAndAMaker) {
  for (const DriverEntry& a : drivers()) {
    EXPECT_NE(a.make, nullptr);
    EXPECT_EQ(find_driver(a.name), &a);
  }
  EXPECT_EQ(find_driver("none"), nullptr);
}

}  // namespace
}  // namespace gaitpad
