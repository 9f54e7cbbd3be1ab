// A real stream over fake drivers: plugs pads in and out and reads the stream's reports.
#pragma once
#include <gtest/gtest.h>

#include <string>

#include "gaitpad/pad_stream.h"
#include "tests/comes_true.h"
#include "tests/own_folder.h"
#include "tests/pads/fake_drivers.h"

namespace gaitpad {

class PadStreamTest : public testing::Test {
 protected:
  void start(PadStreamOptions options = {}) {
    options.drivers = FakeBus::table();
    options.changes_fd = bus_.changes_fd();
    stream_ = value_of(PadStream::start(std::move(options)));
  }
  // Starts the stream with a ring of `reports` reports.
  void start_with_ring(std::size_t reports) {
    PadStreamOptions options;
    options.ring_reports = reports;
    start(std::move(options));
  }
  // The next report; an empty one of kind command if none came in time.
  Report next() {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (stream_->front() == nullptr) {
      if (std::chrono::steady_clock::now() > end) {
        ADD_FAILURE() << "no report came";
        return made_command("");
      }
      stream_->wait(std::chrono::milliseconds(1000));
    }
    const Report report = *stream_->front();
    stream_->pop();
    return report;
  }
  void expect(ReportKind kind, int device) {
    const Report report = next();
    EXPECT_EQ(report.kind, kind);
    EXPECT_EQ(report.device, device);
  }
  void expect_x(int device, int x) {
    const Report report = next();
    EXPECT_EQ(report.kind, ReportKind::input);
    EXPECT_EQ(report.device, device);
    EXPECT_EQ(report.bytes[0], x);
  }
  // Unplugs a pad and expects its `removed` report.
  void take_away(const FakeBus::Pad& pad, int device) {
    bus_.unplug(pad);
    expect(ReportKind::removed, device);
  }
  // Plugs in a pad that hidraw sees, and expects its `added` report.
  FakeBus::Pad plugged(const std::string& unique_id, const std::string& port, int device) {
    auto pad = bus_.plug(kHidraw, unique_id, port);
    expect(ReportKind::added, device);
    return pad;
  }
  bool is_told(const std::string& part) {
    return comes_true([&] {
      for (std::string& remark : stream_->take_remarks()) told_ += remark + "\n";
      return told_.find(part) != std::string::npos;
    });
  }
  // Makes a user folder with this calibration.
  std::string user_folder(const std::string& text) const {
    own_.write("user/a.toml", text);
    return own_.at("user");
  }

  OwnFolder own_;
  FakeBus bus_;
  std::unique_ptr<PadStream> stream_;
  std::string told_;
};

}  // namespace gaitpad
