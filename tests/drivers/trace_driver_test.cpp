#include <gtest/gtest.h>

#include <chrono>

#include "drivers/driver_rows.h"
#include "gaitpad/driver_registry.h"
#include "tests/own_folder.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kNsInMs = 1'000'000;

std::int64_t now_ns() {
  // libstdc++'s steady clock is CLOCK_MONOTONIC, the clock of Report::time_ns.
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// A file that is removed after the test, with one byte per report and meaningless descriptors.
class TraceDriver : public testing::Test {
 protected:
  void write(const std::string& text) { own_.write("trace.hid", text); }

  std::unique_ptr<Device> opened(std::size_t device = 0) {
    auto listings = trace_listings(path_);
    if (!listings || device >= listings->size()) return nullptr;
    auto opened = open_trace_device((*listings)[device], Detach::never);
    return opened ? std::move(*opened) : nullptr;
  }

  // Reads every report until `gone`, by poll() and read() like the I/O thread.
  static std::vector<Report> all_reports(Device& device) {
    std::vector<Report> reports;
    while (true) {
      Report report;
      switch (device.read(report)) {
        case Device::Status::report:
          reports.push_back(report);
          break;
        case Device::Status::gone:
          return reports;
        case Device::Status::nothing: {
          pollfd fd = device.poll_fds().front();
          EXPECT_EQ(::poll(&fd, 1, 60'000), 1);
          break;
        }
      }
    }
  }

  OwnFolder own_;
  const std::string path_ = own_.at("trace.hid");
};

TEST_F(TraceDriver, HandsOnEventsAtTheirOwnTimesAndNeverTooEarly) {
  write("R: 1 00\nN: One\nE: 000007.000000 1 01\nE: 000007.030000 1 02\nQ: 000007.050000 1\n");
  const std::int64_t before_ns = now_ns();
  auto device = opened();
  ASSERT_NE(device, nullptr);
  EXPECT_EQ(device->info().name, "One");
  const std::vector<Report> reports = all_reports(*device);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(reports[0].kind, ReportKind::input);
  EXPECT_EQ(reports[0].size, 1);
  EXPECT_EQ(reports[0].bytes[0], 1);
  EXPECT_EQ(reports[1].bytes[0], 2);
  EXPECT_GE(reports[0].time_ns, before_ns);
  // The stamps differ by the times in the file, even if a read is late.
  EXPECT_EQ(reports[1].time_ns - reports[0].time_ns, 30 * kNsInMs);
  EXPECT_GE(now_ns() - reports[0].time_ns, 50 * kNsInMs);
  Report report;
  EXPECT_EQ(device->read(report), Device::Status::gone) << "the end stays the end";
}

TEST_F(TraceDriver, DevicesOfOneFileShareTheBeginning) {
  write(
      "D: 0\nR: 1 00\nD: 5\nR: 1 00\nD: 0\nE: 0.000000 1 01\nD: 5\nE: 0.020000 1 02\n"
      "Q: 0.030000 1\n");
  auto listings = trace_listings(path_);
  ASSERT_TRUE(listings) << listings.error().message;
  ASSERT_EQ(listings->size(), 2u);
  EXPECT_EQ((*listings)[0].node, path_);
  EXPECT_EQ((*listings)[1].node, path_ + "#2");
  auto first = opened(0);
  auto second = opened(1);
  ASSERT_NE(first, nullptr);
  ASSERT_NE(second, nullptr);
  const std::vector<Report> of_first = all_reports(*first), of_second = all_reports(*second);
  ASSERT_EQ(of_first.size(), 1u);
  ASSERT_EQ(of_second.size(), 1u);
  EXPECT_EQ(of_second[0].time_ns - of_first[0].time_ns, 20 * kNsInMs);
}

TEST_F(TraceDriver, PluggingIsHandedOnAndCommandsBelongToNoDevice) {
  write(
      "R: 1 00\nH: 0.000000 add\nE: 0.000001 1 01\nC: 0.000002 style even\n"
      "H: 0.000003 remove\nQ: 0.000004 1\n");
  auto device = opened();
  ASSERT_NE(device, nullptr);
  const std::vector<Report> reports = all_reports(*device);
  ASSERT_EQ(reports.size(), 3u);
  EXPECT_EQ(reports[0].kind, ReportKind::added);
  EXPECT_EQ(reports[1].kind, ReportKind::input);
  EXPECT_EQ(reports[2].kind, ReportKind::removed);
}

TEST_F(TraceDriver, WithoutAStatedEndTheLastReportLastsASecond) {
  write("R: 1 00\nE: 0.000000 1 01\n");
  auto device = opened();
  ASSERT_NE(device, nullptr);
  const std::vector<Report> reports = all_reports(*device);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_GE(now_ns() - reports[0].time_ns, 1000 * kNsInMs);
}

TEST_F(TraceDriver, AFileThatIsClosedBeginsAnewWhenOpenedAgain) {
  write("R: 1 00\nE: 9.000000 1 01\nQ: 9.000001 1\n");
  for (int i = 0; i < 2; ++i) {
    const std::int64_t before_ns = now_ns();
    auto device = opened();
    ASSERT_NE(device, nullptr);
    const std::vector<Report> reports = all_reports(*device);
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_GE(reports[0].time_ns, before_ns);
  }
}

TEST_F(TraceDriver, TheCalibrationOfTheRecordingIsKnown) {
  write("R: 1 00\nK: [left]\nK: inner = 0.3\nE: 0.000000 1 01\nQ: 0.000001 1\n");
  auto listings = trace_listings(path_);
  ASSERT_TRUE(listings);
  EXPECT_EQ(trace_calibration(listings->front()), "[left]\ninner = 0.3\n");
}

TEST_F(TraceDriver, MissingAndDamagedFilesAndDevicesAreErrors) {
  EXPECT_EQ(trace_listings("/nonexistent.hid").error().message,
            "/nonexistent.hid: there is no such file");
  DeviceListing listing;
  listing.node = "/nonexistent.hid";
  EXPECT_FALSE(open_trace_device(listing, Detach::never));
  write("R: 1 00\nE: 1\n");
  EXPECT_FALSE(trace_listings(path_));
  write("R: 1 00\n");
  listing.node = path_ + "#2";
  EXPECT_EQ(open_trace_device(listing, Detach::never).error().message,
            path_ + "#2: there are 1 devices in it");
}

TEST(Registry, EveryRowHasANameOfItsOwnAndBothFunctionsOrNone) {
  for (const DriverEntry& a : drivers()) {
    EXPECT_EQ(a.find == nullptr, a.open == nullptr) << a.name;
    EXPECT_EQ(find_driver(a.name), &a);
  }
  EXPECT_EQ(find_driver("none"), nullptr);
}

}  // namespace
}  // namespace gaitpad
