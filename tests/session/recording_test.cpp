#include "session/recording.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "session/live_loop.h"
#include "system/clock.h"
#include "tests/comes_true.h"
#include "tests/own_folder.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kStart_ns = 5'000'000'123;
constexpr std::int64_t kHour_ns = 3600 * kSecond_ns;

TraceDevice made_device(std::uint16_t index) {
  TraceDevice device;
  device.index = index;
  device.info = made_pad();
  device.info.driver = "hidraw";
  device.info.unique_id = index == 0 ? "" : "second";
  device.calibration = "name = \"mine\"\n";
  return device;
}

const TraceDevice& made_devices(std::uint16_t index) {
  static const std::vector<TraceDevice> devices = [] {
    std::vector<TraceDevice> all;
    for (std::uint16_t i = 0; i < kMaxTraceDevices; ++i) all.push_back(made_device(i));
    return all;
  }();
  return devices[index];
}

Report at(std::int64_t time_ns, Report report) {
  report.time_ns = time_ns;
  return report;
}

Trace parsed(const std::string& text) { return value_of(parse_trace(text, "recording")); }

// Collects the recorded lines of one session.
class Lines {
 public:
  explicit Lines(std::optional<int> rate_hz, const RecordingLines::Limits& limits = {})
      : lines(rate_hz, made_devices, limits) {}
  std::string text() { return all += lines.take_text(); }

  RecordingLines lines;
  std::string all;
};

TEST(RecordingLines, FollowTheTraceFormat) {
  Lines l(240);
  l.lines.clock(0, kStart_ns);
  l.lines.add(3, at(kStart_ns + 10'000'999, made_plug(ReportKind::added, 0)));
  l.lines.add(3, at(kStart_ns + 11'000'999, made_report(1, 2, 0)));
  l.lines.add(3, at(kStart_ns + 12'000'998, made_command("style even")));
  l.lines.add(5, at(kStart_ns + 20'000'999, made_plug(ReportKind::removed, 0)));
  l.lines.end(7, kStart_ns + 30'000'999);
  std::string header = "R: 54";
  for (std::uint8_t byte : made_pad().descriptor) {
    char hex[4];
    std::snprintf(hex, sizeof hex, " %02x", byte);
    header += hex;
  }
  EXPECT_EQ(l.text(),
            "V: 2 rate_hz=240\n# recorded by gaitpad: a session\n"
            "# tick 0 began at CLOCK_MONOTONIC 5.000000123\n" +
                header +
                "\nN: Example Walk Pad\nI: 3 1209 0001\nB: hidraw 0000\n"
                "K: name = \"mine\"\n"
                "# time 0 is CLOCK_MONOTONIC 5.010001122\n"
                "T: 3\nH: 000000.000000 add\nE: 000000.001000 6 01 02 80 80 08 00\n"
                "C: 000000.001999 style even\nT: 5\nH: 000000.010000 remove\n"
                "Q: 000000.020000 7\n");
}

TEST(RecordingLines, SayThePaceBehindTheRate) {
  RecordingLines lines(240, made_devices, {},
                       {.pace = Pace::own, .options = {}, .files = {}, .pad_file = {}});
  EXPECT_TRUE(lines.take_text().starts_with("V: 2 rate_hz=240\nO: pace own\n#"));
}

TEST(RecordingLines, ReadBackAsTheTicksThatUsedThem) {
  Lines l(240);
  l.lines.clock(0, kStart_ns);
  std::int64_t now_ns = kStart_ns;
  for (int tick = 0; tick < 3000; ++tick, now_ns += kSecond_ns / 240) {
    for (Report r : made_tick(tick)) {
      if (tick == 240) l.lines.add(tick, at(now_ns, made_plug(ReportKind::added)));
      l.lines.add(tick, at(now_ns, r));
    }
  }
  l.lines.end(3000, now_ns);
  Trace trace = parsed(l.text());
  EXPECT_EQ(*assign_ticks(trace, 240), 3000);
  EXPECT_EQ(trace.devices.at(0), made_device(0));
  std::vector<std::int64_t> ticks;
  for (const TraceEvent& e : trace.events) ticks.push_back(e.tick);
  EXPECT_EQ(ticks,
            (std::vector<std::int64_t>{240, 240, 700, 700, 1000, 1300, 1300, 1500, 1500, 1700, 1700,
                                       2100, 2300, 2300, 2301, 2301, 2600, 2600, 2800}));
}

TEST(RecordingLines, NameTheDeviceFromTheSecondOneOn) {
  Lines l(240);
  l.lines.add(0, at(kStart_ns, made_plug(ReportKind::added, 0)));
  l.lines.add(0, at(kStart_ns, made_report(1, 1, 0)));
  l.lines.add(1, at(kStart_ns, made_plug(ReportKind::added, 1)));
  l.lines.add(1, at(kStart_ns, made_report(2, 2, 0)));
  l.lines.add(1, at(kStart_ns, made_report(3, 3, 1)));
  l.lines.end(2, kStart_ns);
  const Trace trace = parsed(l.text());
  ASSERT_EQ(trace.devices.size(), 2u);
  EXPECT_EQ(trace.devices[1].info.unique_id, "second");
  ASSERT_EQ(trace.events.size(), 5u);
  EXPECT_EQ(trace.events[3].device, 0);
  EXPECT_EQ(report_of(trace, trace.events[4]).bytes[0], 3);
  EXPECT_EQ(trace.events[4].device, 1);
}

TEST(RecordingLines, KeepTheOrderOfPluggingForAnyIndex) {
  Lines l(240);
  l.lines.add(0, at(kStart_ns, made_plug(ReportKind::added, 4)));
  l.lines.add(0, at(kStart_ns, made_plug(ReportKind::added, 0)));
  l.lines.end(1, kStart_ns);
  const Trace trace = parsed(l.text());
  ASSERT_EQ(trace.devices.size(), 2u);
  EXPECT_EQ(trace.devices[0].index, 4);
  EXPECT_EQ(trace.events[0].device, 0);
}

// Runs a day of ticks by hand within a second; the last report comes after a pause of three hours.
TEST(RecordingLines, TicksFasterOrSlowerThanTheTimeReadBack) {
  Lines l(240);
  const std::int64_t day = 24 * 3600 * 240;
  l.lines.clock(0, kStart_ns);
  l.lines.add(0, at(kStart_ns, made_plug(ReportKind::added)));
  l.lines.add(day - 10, at(kStart_ns + kSecond_ns, made_report(1, 2)));
  l.lines.clock(day - 9, kStart_ns + 2 * kSecond_ns, 0.0);
  l.lines.clock(day - 9, kStart_ns + 3 * kHour_ns, 0.25);
  l.lines.add(day - 9, at(kStart_ns + 3 * kHour_ns, made_report(3, 4)));
  l.lines.end(day, kStart_ns + 3 * kHour_ns + kSecond_ns);
  const std::string text = l.text();
  EXPECT_NE(text.find(fmt::format("# before tick {} it stood still from", day - 9)), text.npos);
  Trace trace = parsed(text);
  EXPECT_EQ(*assign_ticks(trace, 240), day);
  std::erase_if(trace.events, [](const auto& e) { return e.kind != ReportKind::input; });
  ASSERT_EQ(trace.events.size(), 2u);
  EXPECT_EQ(trace.events[0].tick, day - 10);
  EXPECT_EQ(trace.events[1].tick, day - 9);
}

// A report may have an earlier kernel time stamp than another device's report that was read before.
TEST(RecordingLines, TimesMayDecreaseBetweenDevicesButNotWithinOne) {
  Lines l(240);
  l.lines.add(0, at(kStart_ns, made_plug(ReportKind::added, 0)));
  l.lines.add(0, at(kStart_ns - 5'000'000, made_plug(ReportKind::added, 1)));
  l.lines.add(1, at(kStart_ns + 9'000'000, made_report(1, 1, 0)));
  l.lines.add(1, at(kStart_ns + 8'000'000, made_report(1, 1, 1)));
  l.lines.add(1, at(kStart_ns + 7'000'000, made_report(1, 1, 0)));
  l.lines.end(2, kStart_ns);
  const Trace trace = parsed(l.text());
  ASSERT_EQ(trace.events.size(), 5u);
  EXPECT_EQ(trace.events[1].time_us, 0);
  EXPECT_EQ(trace.events[2].time_us, 9000);
  EXPECT_EQ(trace.events[3].time_us, 8000);
  EXPECT_EQ(trace.events[4].time_us, 9000);
  EXPECT_EQ(trace.end_time_us, 9000) << "the end is not before the last event";
}

TEST(RecordingLines, HaveOnlyTimesWithoutARate) {
  Lines l(std::nullopt);
  l.lines.add(0, at(kStart_ns, made_plug(ReportKind::added, 0)));
  l.lines.add(0, at(kStart_ns + 9'000'000, made_report(1, 1, 0)));
  l.lines.add(0, at(kStart_ns + 8'000'000, made_plug(ReportKind::added, 1)));
  l.lines.end(0, kStart_ns + kSecond_ns);
  const std::string text = l.text();
  const Trace trace = parsed(text);
  EXPECT_FALSE(trace.rate_hz);
  EXPECT_FALSE(trace.has_ticks);
  ASSERT_EQ(trace.events.size(), 3u);
  EXPECT_EQ(trace.events[2].time_us, 9000) << "without ticks the times give the order";
  EXPECT_EQ(text.find("\nQ:"), std::string::npos);
}

// The reader refuses gaps of more than ten minutes, so the recorder fills them.
TEST(RecordingLines, AnHourOfRestAnywhereCanBeRead) {
  Lines l(240);
  const std::int64_t hour_ticks = 3600 * 240;
  std::int64_t now_ns = kStart_ns, tick = 0;
  l.lines.clock(0, now_ns);
  now_ns += kHour_ns, tick += hour_ticks;
  l.lines.add(tick, at(now_ns, made_plug(ReportKind::added, 0)));
  now_ns += kHour_ns, tick += hour_ticks;
  l.lines.add(tick, at(now_ns, made_report(1, 2)));
  l.lines.add(tick, at(now_ns - 1000, made_command("style even")));
  now_ns += kHour_ns, tick += hour_ticks;
  l.lines.end(tick, now_ns);
  Trace trace = parsed(l.text());
  EXPECT_EQ(*assign_ticks(trace, 240), 3 * hour_ticks);
  EXPECT_EQ(trace.end_time_us, std::int64_t{3} * 3'600'000'000);
  int others = 0;
  for (const TraceEvent& e : trace.events) {
    const Report r = report_of(trace, e);
    if (r.kind == ReportKind::command && text_of(r) == "mark") continue;
    ++others;
    EXPECT_EQ(e.tick, e.kind == ReportKind::added ? hour_ticks : 2 * hour_ticks);
  }
  EXPECT_EQ(others, 3);

  Lines alone(std::nullopt);
  alone.lines.add(0, at(kStart_ns, made_plug(ReportKind::added, 0)));
  alone.lines.add(0, at(kStart_ns + kHour_ns, made_report(1, 2)));
  EXPECT_EQ(parsed(alone.text()).events.back().time_us, 3'600'000'000);
}

TEST(RecordingLines, AStandstillOfAnHourCanBeRead) {
  Lines l(240);
  l.lines.clock(0, kStart_ns);
  l.lines.add(0, at(kStart_ns, made_plug(ReportKind::added, 0)));
  l.lines.clock(10, kStart_ns + kHour_ns);
  l.lines.add(10, at(kStart_ns + kHour_ns, made_report(1, 2)));
  l.lines.end(11, kStart_ns + kHour_ns);
  const std::string text = l.text();
  Trace trace = parsed(text);
  EXPECT_EQ(*assign_ticks(trace, 240), 11);
  EXPECT_EQ(trace.events.back().tick, 10);
  EXPECT_NE(text.find("# tick 10 began at CLOCK_MONOTONIC 3605.000000123\n"), std::string::npos);
}

TEST(RecordingLines, EndWithAWholeTickBeforeTheFileIsTooLarge) {
  Lines l(240, {.bytes = 4000, .events = 1000});
  l.lines.clock(0, kStart_ns);
  l.lines.add(0, at(kStart_ns, made_plug(ReportKind::added, 0)));
  int refused_from = -1;
  for (int tick = 1; tick < 200; ++tick) {
    int taken = 0;
    for (int i = 0; i < 5; ++i) {
      taken += l.lines.add(tick, at(kStart_ns + tick * 4'000'000, made_report(i, tick)));
    }
    EXPECT_TRUE(taken == 5 || taken == 0) << "only a part of tick " << tick;
    if (taken == 0 && refused_from < 0) refused_from = tick;
  }
  EXPECT_TRUE(l.lines.is_full());
  l.lines.end(200, kStart_ns + kSecond_ns);
  Trace trace = parsed(l.text());
  EXPECT_EQ(*assign_ticks(trace, 240), refused_from);
  EXPECT_EQ(trace.events.size(), static_cast<std::size_t>(5 * (refused_from - 1) + 1));
  EXPECT_LT(l.all.size(), 4500u);
}

TEST(RecordingLines, RefuseWhatCouldNotBeReadBack) {
  Lines l(240);
  EXPECT_FALSE(l.lines.add(0, made_report(1, 2, kMaxTraceDevices)));
  EXPECT_TRUE(l.lines.add(0, made_command("  "))) << "a blank command does nothing";
  RecordingLines nameless(240,
                          [](std::uint16_t) -> const TraceDevice& {
                            static const TraceDevice none;
                            return none;
                          },
                          {});
  EXPECT_FALSE(nameless.add(0, made_plug(ReportKind::added, 0))) << "the device has no descriptor";
  EXPECT_FALSE(nameless.has_devices());
}

TEST(RecordingLines, LongNamesAreCutToTheReadersLimit) {
  TraceDevice device = made_device(0);
  device.info.name = std::string(5000, 'x') + "\nE: ";
  RecordingLines lines(240, [&](std::uint16_t) -> const TraceDevice& { return device; }, {});
  lines.add(0, made_plug(ReportKind::added, 0));
  EXPECT_EQ(parsed(lines.take_text()).devices.at(0).info.name, std::string(512, 'x'));
}

class RecordingFile : public testing::Test {
 protected:
  std::unique_ptr<Recording> started() const {
    return value_of(Recording::start({file_.string(), 240, {}}, made_devices));
  }
  // Waits until the text is in FILE.part.
  bool is_written(const std::string& piece) const {
    return comes_true([&] { return text_in(part_).find(piece) != std::string::npos; });
  }

  OwnFolder own_;
  const fs::path folder_ = own_.path;
  const fs::path file_ = folder_ / "walk.hid", part_ = folder_ / "walk.hid.part";
};

TEST_F(RecordingFile, GetsItsNameAtTheEnd) {
  std::ofstream(file_) << "old";
  auto recording = started();
  recording->clock(0, now_ns());
  recording->add(0, at(now_ns(), made_plug(ReportKind::added)));
  recording->add(1, at(now_ns(), made_report(7, 8)));
  EXPECT_TRUE(is_written("6 07 08"));
  EXPECT_EQ(text_in(file_), "old");
  auto remarks = recording->finish(2, now_ns());
  ASSERT_TRUE(remarks) << remarks.error().message;
  EXPECT_TRUE(remarks->empty());
  EXPECT_FALSE(fs::exists(part_));
  Trace trace = parsed(text_in(file_));
  EXPECT_EQ(*assign_ticks(trace, 240), 2);
  EXPECT_EQ(trace.events.size(), 2u);
}

TEST_F(RecordingFile, AnUnfinishedOneLeavesAPartThatReplays) {
  std::ofstream(file_) << "old";
  {
    auto recording = started();
    recording->add(0, at(now_ns(), made_plug(ReportKind::added)));
    recording->add(1, at(now_ns(), made_report(7, 8)));
  }
  EXPECT_EQ(text_in(file_), "old");
  EXPECT_EQ(parsed(text_in(part_)).events.size(), 2u);
  started()->add(0, made_plug(ReportKind::added));
  EXPECT_EQ(parsed(text_in(part_)).events.size(), 1u) << "the next recording starts from nothing";
}

TEST_F(RecordingFile, IsNotWrittenWithoutAPad) {
  auto recording = started();
  recording->add(0, made_command("style even"));
  const auto remarks = recording->finish(10, now_ns());
  ASSERT_FALSE(remarks);
  EXPECT_NE(remarks.error().message.find("no pad"), std::string::npos);
  EXPECT_FALSE(fs::exists(file_));
  EXPECT_FALSE(fs::exists(part_));
}

TEST_F(RecordingFile, LostReportsAreCountedAndReported) {
  auto recording = started();
  const std::int64_t now_ns = gaitpad::now_ns();
  for (int i = 0; i < 100'000; ++i) recording->add(i / 100, at(now_ns, made_report(1, 2)));
  const auto remarks = recording->finish(1000, now_ns);
  ASSERT_TRUE(remarks);
  EXPECT_EQ(remarks->size(), recording->lost() > 0 ? 1u : 0u);
  const Trace trace = parsed(text_in(file_));
  EXPECT_EQ(static_cast<std::int64_t>(trace.events.size()) + recording->lost(), 100'000);
}

// A limit of the file's size stands in for a full disk.
TEST_F(RecordingFile, AFullDiskIsReportedAndKeepsTheOldFileAndAReadablePart) {
  std::ofstream(file_) << "old";
  auto recording = started();
  ASSERT_TRUE(is_written("recorded by"));
  ::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small = {50'000, before.rlim_max};
  ::setrlimit(RLIMIT_FSIZE, &small);
  recording->add(0, made_plug(ReportKind::added));
  for (int i = 0; i < 4000; ++i) recording->add(i, made_report(1, 2));
  const auto result = recording->finish(4000, now_ns());
  ::setrlimit(RLIMIT_FSIZE, &before);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, part_.string() + ": cannot be written: File too large");
  EXPECT_EQ(text_in(file_), "old");
  EXPECT_EQ(text_in(part_).back(), '\n');
}

TEST_F(RecordingFile, ErrorsNameUnusablePaths) {
  EXPECT_EQ(Recording::start({folder_.string(), 240, {}}, made_devices).error().message,
            folder_.string() + ": not a regular file; choose another name");
  const std::string nowhere = (folder_ / "none" / "x.hid").string();
  EXPECT_EQ(Recording::start({nowhere, 240, {}}, made_devices).error().message,
            nowhere + ".part: cannot be written: No such file or directory");
  EXPECT_FALSE(Recording::start({"/dev/null", 240, {}}, made_devices));
}

TEST_F(RecordingFile, TwoSessionsDoNotWriteIntoOneFile) {
  auto first = started();
  const auto second = Recording::start({file_.string(), 240, {}}, made_devices);
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().message, part_.string() + ": another session is recording into it");
}

}  // namespace
}  // namespace gaitpad
