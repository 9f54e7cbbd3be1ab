// Live sessions for tests: a made-up recording of two pads drives two characters.
#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/live.h"
#include "gaitpad/replay.h"
#include "tests/comes_true.h"
#include "tests/folders.h"
#include "tests/own_folder.h"
#include "tests/session/made_session.h"

namespace gaitpad {

// Two equal pads send 125 reports a second each, for 2.4 s. The first one drives forward and in a
// curve, is unplugged while it is held, and is plugged in again. The second one rests, takes over,
// is unplugged, and comes back held.
inline Trace two_pads_trace() {
  Trace trace;
  for (int i : {0, 1}) {
    TraceDevice& device = trace.devices.emplace_back();
    device.index = i;
    device.info = made_pad();
    device.info.unique_id = i == 0 ? "one" : "two";
  }
  for (int ms = 0; ms <= 2400; ms += 8) {
    const bool first_is_there = ms < 900 || ms >= 1400, second_is_there = ms < 1700 || ms >= 1900;
    if (ms == 904) add_event(trace, ms * 1000, made_plug(ReportKind::removed, 0));
    if (ms == 1400) add_event(trace, ms * 1000, made_plug(ReportKind::added, 0));
    if (ms == 1704) add_event(trace, ms * 1000, made_plug(ReportKind::removed, 1));
    if (ms == 1904) add_event(trace, ms * 1000, made_plug(ReportKind::added, 1));
    const int y = ms < 80 ? 0x80 : 0x10 + ms % 23;
    if (first_is_there) add_event(trace, ms * 1000, made_report(ms < 500 ? 0x80 : 0xb0, y, 0));
    if (second_is_there)
      add_event(trace, ms * 1000, made_report(0x80, ms < 1000 || ms >= 1700 ? 0x80 : 0x20, 1));
    if (ms >= 1600 && ms < 1700) add_event(trace, ms * 1000, made_report(0x80, 0x80, 0));
  }
  trace.end_time_us = 2'400'000;
  trace.end_ticks = 576;
  return trace;
}

class Live : public testing::Test {
 protected:
  void SetUp() override {
    options_.config_folders = {kSourceFolder + "/config"};
    options_.walk.styles = {"even", "limp_left"};
    options_.pad.selector.pad = (folder_ / "pads.hid").string();
    options_.live.record = (folder_ / "session.hid").string();
    ASSERT_TRUE(write_trace(two_pads_trace(), options_.pad.selector.pad));
  }

  std::unique_ptr<LiveSession> started() { return value_of(LiveSession::start(options_)); }
  // Waits until a tick has taken a report, so that there is something to record.
  static bool comes_to_be_driven(LiveSession& session) {
    return comes_true([&] {
      bool is_new = false;
      return session.latest(is_new).pad.device == 0;
    });
  }
  // Ends the session and checks that its recording replays to the same summary.
  RunSummary stopped(LiveSession& session) const {
    const RunSummary run = value_of(session.stop());
    EXPECT_EQ(run, replayed());
    return run;
  }
  // The summary of a replay of the recording.
  RunSummary replayed() const {
    SessionSpec spec = options_;
    spec.rate_hz.reset();
    spec.replay.trace = spec.live.record;
    return value_of(replay(spec)).summary;
  }

  OwnFolder own_;
  const std::filesystem::path folder_ = own_.path;
  SessionSpec options_;
};

}  // namespace gaitpad
