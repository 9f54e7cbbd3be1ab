// Live sessions for tests: a made-up recording of two pads drives two characters.
#pragma once
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "session/live.h"
#include "session/replay.h"
#include "tests/own_folder.h"
#include "tests/session/made_session.h"

namespace gaitpad {

inline void sleep_for(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

// Until it is so; false after half a minute.
inline bool comes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 6000 && !condition(); ++i) sleep_for(5);
  return condition();
}

// Two equal pads, 125 reports a second each, for 2.4 s. The first walks ahead and in a curve, is
// lost while it is held and comes back; the second rests, takes over, is lost, comes back held.
inline Trace two_pads_trace() {
  Trace trace;
  for (int i : {0, 1}) {
    TraceDevice& device = trace.devices.emplace_back();
    device.index = i;
    device.info = made_pad();
    device.info.unique_id = i == 0 ? "one" : "two";
  }
  const auto add = [&trace](int ms, std::uint16_t device, ReportKind kind, int x, int y) {
    TraceEvent event;
    event.time_us = ms * 1000;
    event.device = device;
    event.kind = kind;
    event.first_byte = static_cast<std::uint32_t>(trace.bytes.size());
    if (kind == ReportKind::input) {
      const Report report = made_report(x, y);
      trace.bytes.insert(trace.bytes.end(), report.bytes.begin(), report.bytes.begin() + 6);
      event.size = 6;
    }
    trace.events.push_back(event);
  };
  for (int ms = 0; ms <= 2400; ms += 8) {
    const bool first_is_there = ms < 900 || ms >= 1400, second_is_there = ms < 1700 || ms >= 1900;
    if (ms == 904) add(ms, 0, ReportKind::removed, 0, 0);
    if (ms == 1400) add(ms, 0, ReportKind::added, 0, 0);
    if (ms == 1704) add(ms, 1, ReportKind::removed, 0, 0);
    if (ms == 1904) add(ms, 1, ReportKind::added, 0, 0);
    const int y = ms < 80 ? 0x80 : 0x10 + ms % 23;
    if (first_is_there) add(ms, 0, ReportKind::input, ms < 500 ? 0x80 : 0xb0, y);
    if (second_is_there) add(ms, 1, ReportKind::input, 0x80, ms < 1000 || ms >= 1700 ? 0x80 : 0x20);
    if (ms >= 1600 && ms < 1700) add(ms, 0, ReportKind::input, 0x80, 0x80);
  }
  trace.end_time_us = 2'400'000;
  trace.end_ticks = 576;
  return trace;
}

class Live : public testing::Test {
 protected:
  void SetUp() override {
    options_.session.config_folders = {GAITPAD_SOURCE_DIR "/config"};
    options_.session.styles = {"even", "limp_left"};
    options_.wish.pad = (folder_ / "pads.hid").string();
    options_.record = (folder_ / "session.hid").string();
    ASSERT_TRUE(write_trace(two_pads_trace(), options_.wish.pad));
  }

  std::unique_ptr<LiveSession> started() { return value_of(LiveSession::start(options_)); }
  // What a replay of the recording comes to.
  std::vector<nlohmann::ordered_json> replayed() const {
    ReplayOptions options;
    options.session = options_.session;
    options.trace = options_.record;
    return value_of(replay(options)).summaries;
  }

  OwnFolder own_;
  const std::filesystem::path folder_ = own_.path;
  LiveOptions options_;
};

}  // namespace gaitpad
