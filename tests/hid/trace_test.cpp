#include "gaitpad/trace.h"

#include <gtest/gtest.h>

#include "tests/own_folder.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

const std::string kHeader =
    "# a comment\n"
    "R: 6 05 01 09 05 a1 01\n"
    "N: Acme Test Pad\n"
    "I: 3 1209 0001\n";

Trace parsed(const std::string& text, Damage damage = Damage::refuse) {
  return value_of(parse_trace(text, "t.hid", damage));
}

std::string cause(const std::string& text) { return cause_of(parse_trace(text, "t.hid")); }

std::int64_t tick_of(Trace trace, int rate_hz, std::size_t event) {
  EXPECT_TRUE(assign_ticks(trace, rate_hz));
  return trace.events[event].tick;
}

TEST(Trace, ReadsWhatHidRecorderWrites) {
  const Trace t = parsed(kHeader + "E: 000000.004012 5 01 80 7f 80 FF\nE: 000001.000000 0\n");
  ASSERT_EQ(t.devices.size(), 1u);
  const DeviceInfo& info = t.devices[0].info;
  EXPECT_EQ(info.name, "Acme Test Pad");
  EXPECT_EQ(info.bus, BusType::usb);
  EXPECT_EQ(info.vendor, 0x1209);
  EXPECT_EQ(info.product, 0x0001);
  EXPECT_EQ(info.descriptor, (std::vector<std::uint8_t>{0x05, 0x01, 0x09, 0x05, 0xa1, 0x01}));
  ASSERT_EQ(t.events.size(), 2u);
  const Report r = report_of(t, t.events[0]);
  EXPECT_EQ(r.time_ns, 4'012'000);
  EXPECT_EQ(r.size, 5);
  EXPECT_EQ(r.bytes[4], 0xff);
  EXPECT_EQ(r.device, 0);
  EXPECT_EQ(t.events[1].size, 0) << "a short report is no damage of the file";
}

TEST(Trace, CarriageReturnsAndUnknownLettersAreNoHarm) {
  const Trace t = parsed("R: 1 c0\r\nN: x\r\nL: 00 00\r\n\r\nE: 000000.000001 1 07\r\n");
  EXPECT_EQ(t.devices[0].info.name, "x");
  EXPECT_EQ(t.events.size(), 1u);
}

TEST(Trace, WhatABpfProgramMadeOfAReportIsNoSecondReport) {
  const Trace t = parsed(kHeader + "B: 000000.000000 2 01 02\nE: 000000.000010 2 01 03\n");
  ASSERT_EQ(t.events.size(), 1u);
  EXPECT_EQ(report_of(t, t.events[0]).bytes[1], 0x03);
  EXPECT_EQ(t.devices[0].info.driver, "");
}

TEST(Trace, HoldsTheFilesAndOptionsOfItsSession) {
  const Trace t = parsed(
      "V: 2 rate_hz=240\nO: pace own\nO: style styles/a b.toml\n"
      "F: styles/a b.toml\nG: # a\nG:\nG:  x = 1\n"
      "F: hills.png\nX: 3 89 50 00\nX: 1 0d\n" +
      kHeader + "T: 3\nE: 000000.000000 1 07\nT: 5\nF: styles/a b.toml\nG: x = 2\n");
  EXPECT_EQ(t.pace, Pace::own);
  EXPECT_EQ(t.options, std::vector<std::string>{"style styles/a b.toml"});
  const std::string png("\x89\x50\0\x0d", 4);
  EXPECT_EQ(t.files, (std::vector<TraceFile>{{"styles/a b.toml", "# a\n\n x = 1\n", -1},
                                             {"hills.png", png, -1},
                                             {"styles/a b.toml", "x = 2\n", 5}}));
  const Trace again = parsed(trace_text(t) + "");
  EXPECT_EQ(again.files, (std::vector<TraceFile>{t.files[0], t.files[1]}))
      << "without an event behind it the last one has no effect";
  EXPECT_EQ(again.options, t.options);
}

TEST(Trace, AFileThatIsNoTextIsHeldAsBytes) {
  for (const std::string& bytes : {std::string(3000, '\0'), std::string("a\rb\n"), std::string()}) {
    TraceWriter writer;
    writer.file("x", bytes);
    EXPECT_EQ(parsed(writer.text() + kHeader).files.at(0).bytes, bytes);
  }
  TraceWriter writer;
  writer.file("x", "a\r\nb");
  EXPECT_EQ(parsed(writer.text() + kHeader).files.at(0).bytes, "a\nb\n") << "the same lines";
}

TEST(Trace, EventsBelongToTheDeviceOfTheLastIndex) {
  const Trace t = parsed(
      "D: 4\nR: 1 c0\nN: a\nI: 3 1 2\nD: 9\nR: 2 c0 c0\nN: b\nI: 5 3 4\n"
      "D: 4\nE: 000000.000000 1 01\nD: 9\nE: 000000.000001 1 02\nE: 000000.000001 1 03\n");
  ASSERT_EQ(t.devices.size(), 2u);
  EXPECT_EQ(t.devices[1].index, 9);
  EXPECT_EQ(t.devices[1].info.bus, BusType::bluetooth);
  EXPECT_EQ(t.events[0].device, 0);
  EXPECT_EQ(t.events[2].device, 1);
}

TEST(Trace, CommandsAndPluggingAreEvents) {
  const Trace t = parsed(kHeader +
                         "H: 000000.000000 add\nC: 000000.500000 style limp_left\n"
                         "H: 000001.000000 remove\nQ: 000002.000000 480\n");
  ASSERT_EQ(t.events.size(), 3u);
  EXPECT_EQ(t.events[0].kind, ReportKind::added);
  const Report command = report_of(t, t.events[1]);
  EXPECT_EQ(command.kind, ReportKind::command);
  EXPECT_EQ(text_of(command), "style limp_left");
  EXPECT_EQ(command.device, kNoDevice);
  EXPECT_EQ(t.events[2].kind, ReportKind::removed);
  EXPECT_EQ(t.end_ticks, 480);
}

// Tick k starts at k/240 s; an event at exactly that time belongs to it, one microsecond later to
// the next.
TEST(Trace, AnEventBelongsToTheFirstTickThatStartsAtOrAfterIt) {
  const Trace t = parsed(kHeader +
                         "E: 000007.000000 1 00\nE: 000007.000001 1 00\nE: 000007.004166 1 00\n"
                         "E: 000007.004167 1 00\nE: 000007.012500 1 00\nE: 000007.012501 1 00\n");
  EXPECT_EQ(tick_of(t, 240, 0), 0);
  EXPECT_EQ(tick_of(t, 240, 1), 1);
  EXPECT_EQ(tick_of(t, 240, 2), 1) << "4166 us * 240 = 999,840 <= 1,000,000";
  EXPECT_EQ(tick_of(t, 240, 3), 2) << "4167 us * 240 = 1,000,080";
  EXPECT_EQ(tick_of(t, 240, 4), 3) << "12500 us * 240 = 3,000,000";
  EXPECT_EQ(tick_of(t, 240, 5), 4);
  EXPECT_EQ(tick_of(t, 1000, 5), 13);
}

TEST(Trace, ReplayEndsOneSecondAfterTheLastEventOrAtTheEndLine) {
  Trace t = parsed(kHeader + "E: 000000.000000 1 00\nE: 000000.500000 1 00\n");
  EXPECT_EQ(*assign_ticks(t, 240), 120 + 240);
  t = parsed(kHeader + "E: 000000.000000 1 00\nQ: 000000.750000 180\n");
  EXPECT_EQ(*assign_ticks(t, 240), 180);
  t = parsed(kHeader);
  EXPECT_EQ(*assign_ticks(t, 100), 100) << "no event at all";
}

TEST(Trace, TickLinesBindEventsWhateverTheirTime) {
  Trace t = parsed("V: 1 rate_hz=240\n" + kHeader +
                   "T: 2\nE: 000000.100000 1 00\nC: 000000.000500 style even\nT: 9\n"
                   "E: 000000.100001 1 00\n");
  EXPECT_TRUE(t.has_ticks);
  EXPECT_EQ(*assign_ticks(t, 240), 9 + 240);
  EXPECT_EQ(t.events[0].tick, 2);
  EXPECT_EQ(t.events[1].tick, 2);
  EXPECT_EQ(t.events[2].tick, 9);
}

TEST(Trace, AnotherRateThanTheRecordedOneIsAnError) {
  Trace t = parsed("V: 1 rate_hz=500\n" + kHeader);
  EXPECT_EQ(replay_rate_hz(t, {}), 500);
  EXPECT_TRUE(assign_ticks(t, 500));
  const auto wrong = assign_ticks(t, 240);
  ASSERT_FALSE(wrong);
  EXPECT_EQ(wrong.error().message,
            "t.hid: was recorded at 500 Hz and cannot be replayed at 240 Hz");
  Trace free = parsed(kHeader);
  EXPECT_EQ(replay_rate_hz(free, {}), 240);
  EXPECT_FALSE(assign_ticks(free, 0));
}

TEST(Trace, DamageIsRefusedWithFileAndLine) {
  EXPECT_EQ(cause(""), "t.hid: no device: there is no R: line");
  EXPECT_EQ(cause("# only a comment\n"), "t.hid: no device: there is no R: line");
  EXPECT_EQ(cause("\x7f"
                  "ELF\x02"),
            "t.hid:1: \"\\x7fELF\\x02\" is no line of a trace");
  EXPECT_EQ(cause("R: 2 c0\n"), "t.hid:1: report descriptor: the length says 2 but 1 bytes follow");
  EXPECT_EQ(cause("R: 1 cg\n"),
            "t.hid:1: report descriptor: \"cg\" is no byte of two hexadecimal digits");
  EXPECT_EQ(cause("N: a\rb\n"), "t.hid:1: a carriage return inside the line");
  EXPECT_EQ(cause("R: 0\n"), "t.hid:1: the report descriptor is empty");
  EXPECT_EQ(cause("R: 1 c0\nR: 1 c0\n"), "t.hid:2: a second R: line for device 0");
  EXPECT_EQ(cause("E: 000000.000000 1 00\n"), "t.hid:1: a report before its device's R: line");
  EXPECT_EQ(cause("R: 1 c0\nD: 1\nE: 000000.000000 1 00\n"),
            "t.hid:3: a report before its device's R: line");
  EXPECT_EQ(cause("R: 1 c0\nD: 1\nN: x\n"), "t.hid: device 1 has no R: line");
  const std::string good = "R: 1 c0\nE: 000005.000000 1 00\n";
  EXPECT_EQ(cause(good + "E: 000004.999999 1 00\n"),
            "t.hid:3: time goes back from 5.000000 to 4.999999");
  EXPECT_EQ(cause(good + "E: 000605.000001 1 00\n"),
            "t.hid:3: a gap of more than ten minutes: 600 s");
  EXPECT_EQ(cause(good + "E: 000605.000000 1 00\n"), "accepted");
  EXPECT_EQ(cause(good + "E: 000006.000000 2 00\n"),
            "t.hid:3: report: the length says 2 but 1 bytes follow");
  EXPECT_EQ(cause(good + "E: 000006.000000 1 00 00\n"),
            "t.hid:3: report: the length says 1 but 2 bytes follow");
  EXPECT_EQ(cause(good + "E: 000006.000000 1 0\n"),
            "t.hid:3: report: \"0\" is no byte of two hexadecimal digits");
  EXPECT_EQ(cause(good + "E: 6.5 1 00\n"),
            "t.hid:3: \"6.5\" is no time SECONDS.MICROSECONDS with six digits after the point");
  EXPECT_EQ(cause(good + "E: 000006.000000 1025\n"),
            "t.hid:3: report: 1025 bytes, at most 1024 are read");
  EXPECT_EQ(cause(good + "C: 000006.000000\n"), "t.hid:3: a command without text");
  EXPECT_EQ(cause(good + "H: 000006.000000 gone\n"), "t.hid:3: \"gone\" is neither add nor remove");
  EXPECT_EQ(cause(good + "Q: 000006.000000 240\nE: 000006.000000 1 00\n"),
            "t.hid:4: a line after the end of the recording (Q:)");
  EXPECT_EQ(cause(good + "Q: 000001.000000 240\n"),
            "t.hid:3: the recording ends before its last event");
  EXPECT_EQ(cause(good + "T: 4\n"), "t.hid:3: the first T: line comes after events");
  for (const char* version : {"0", "3", "x", ""})
    EXPECT_EQ(cause(std::string("V: ") + version + " rate_hz=240\n"),
              "t.hid:1: unknown version of the format; 1 and 2 are known");
  EXPECT_EQ(cause("V: 1 rate_hz=0\n"), "t.hid:1: \"rate_hz=0\" is no rate within 10 .. 10000");
  EXPECT_EQ(cause("R: 1 c0\nT: 5\nV: 1 rate_hz=10\n"),
            "t.hid:3: a V: line must be the first line, and only there");
  EXPECT_EQ(cause("R: 1 c0\nT: 5\nT: 4\n"), "t.hid:3: tick 4 comes after tick 5");
  EXPECT_EQ(cause("R: 1 c0\nT: 144001\n"),
            "t.hid:2: a gap of more than ten minutes: tick 144001 after tick 0");
  EXPECT_EQ(cause("R: 1 c0\nT: 100000\nT: 200000\n"),
            "t.hid:3: a gap of more than ten minutes: tick 200000 after tick 0");
  EXPECT_EQ(cause("R: 1 c0\nT: 5\nE: 000000.000000 1 00\nQ: 000001.000000 5\n"),
            "t.hid:4: the recording has 5 ticks but tick 5 has events");
  EXPECT_EQ(
      cause("I: 3 12345 0001\n"),
      "t.hid:1: an I: line holds bus, vendor and product as hexadecimal numbers of up to four "
      "digits");
}

TEST(Trace, WithTickLinesTimeMayGoBackBetweenDevicesOnly) {
  const std::string two = "D: 0\nR: 1 c0\nD: 1\nR: 1 c0\nT: 0\nE: 000001.000000 1 00\nD: 0\n";
  EXPECT_EQ(cause(two + "E: 000000.900000 1 00\n"), "accepted");
  EXPECT_EQ(cause(two + "E: 000000.900000 1 00\nE: 000000.899999 1 00\n"),
            "t.hid:9: time goes back from 0.900000 to 0.899999");
}

TEST(Trace, LenientSkipsDamagedLinesAndCountsThem) {
  const Trace t =
      parsed(kHeader +
                 "E: 000001.000000 1 00\nE: 000000.000000 1 00\nE: 000002.000000 9 00\n"
                 "rubbish\nE: 000003.000000 1 00\nD: 1\nR: 3 00\nE: 000004.000000 1 00\n",
             Damage::skip);
  EXPECT_EQ(t.skipped_lines, 5);
  EXPECT_EQ(t.first_damage, "t.hid:6: time goes back from 1.000000 to 0.000000");
  EXPECT_EQ(t.events.size(), 2u);
  EXPECT_EQ(t.devices.size(), 1u) << "the second device has no descriptor";
}

TEST(Trace, TheOLineIsThePaceOfTheSession) {
  const Trace own = parsed("O: pace own\n" + kHeader + "T: 0\nE: 000000.000000 1 00\n");
  EXPECT_EQ(own.pace, Pace::own);
  EXPECT_EQ(replay_pace(own, {}), Pace::own);
  EXPECT_EQ(replay_pace(own, Pace::adult), Pace::adult) << "what is asked goes first";
  EXPECT_EQ(replay_pace(parsed(kHeader + "T: 0\nE: 000000.000000 1 00\n"), {}), Pace::adult)
      << "a session from before there was a choice";
  EXPECT_EQ(replay_pace(parsed("V: 1 rate_hz=240\n" + kHeader), {}), std::nullopt);
  EXPECT_EQ(parsed("O: weather rain\n" + kHeader).pace, std::nullopt);
  EXPECT_EQ(cause("O: pace fast\n"), "t.hid:1: \"fast\" is no pace: own or adult");
  EXPECT_EQ(cause("O: pace own\nO: pace own\n"),
            "t.hid:2: an O: line for the pace must come before events, and only once");
}

TEST(Trace, NothingOfADamagedLineCounts) {
  const Trace t = parsed("V: 1 rate_hz=500 rate_hz=x\n" + kHeader, Damage::skip);
  EXPECT_EQ(t.skipped_lines, 1);
  EXPECT_EQ(t.rate_hz, std::nullopt);
}

TEST(Trace, ReportsBelowADamagedDeviceIndexBelongToNoDevice) {
  const Trace t = parsed(
      "D: 0\nR: 1 c0\nD: 1\nR: 1 c0\nD: x\nE: 000000.000000 1 01\nD: 0\nE: 000000.000001 1 02\n",
      Damage::skip);
  EXPECT_EQ(t.skipped_lines, 2);
  ASSERT_EQ(t.events.size(), 1u);
  EXPECT_EQ(t.events[0].device, 0);
}

TEST(Trace, TheWriterGivesBackWhatTheReaderTook) {
  const std::string text =
      "V: 1 rate_hz=240\nO: pace adult\n"
      "D: 0\nR: 2 c0 c0\nN:  spaces at both ends \nP: usb-1/input0\nI: 5 054c 0ce6\nU: aa:bb\n"
      "B: hidraw 0111\nM: 0300,Pad,a:b0,leftx:a0,\nK: [left]\nK: \nK: centre_x = 0.5\n"
      "D: 3\nR: 1 c0\nN: \nI: 3 0001 0002\n"
      "T: 0\nH: 000000.000000 add\nE: 000000.000100 3 01 02 ff\nD: 0\nE: 000000.000050 0\n"
      "T: 7\nC: 000000.025000 style limp_left\nH: 000000.026000 remove\n"
      "Q: 000001.000000 240\n";
  const Trace t = parsed(text);
  EXPECT_EQ(t.version, 1);
  EXPECT_EQ(trace_text(t), text);
  EXPECT_EQ(trace_text(parsed("V: 2" + text.substr(4))), "V: 2" + text.substr(4));
  EXPECT_EQ(t.devices[0].info.unique_id, "aa:bb");
  EXPECT_EQ(t.devices[0].info.driver, "hidraw");
  EXPECT_EQ(t.devices[0].info.version, 0x0111);
  EXPECT_EQ(t.devices[0].info.mapping, "0300,Pad,a:b0,leftx:a0,");
  EXPECT_EQ(t.devices[1].info.mapping, "");
  EXPECT_EQ(t.devices[0].calibration, "[left]\n\ncentre_x = 0.5\n");
}

// hid-replay knows D R N P I E, ignores lines with other letters, and reads each word of E: as hex.
TEST(Trace, ForeignToolsCanReplayWhatWeWrite) {
  Trace t = parsed("V: 1 rate_hz=240\n" + kHeader +
                   "T: 0\nE: 000000.000001 2 01 80\nQ: 000001.000000 240\n");
  t.devices[0].info.name = "two\nlines";
  const std::string text = trace_text(t);
  EXPECT_NE(text.find("\nE: 000000.000001 2 01 80\n"), std::string::npos);
  EXPECT_NE(text.find("\nR: 6 05 01 09 05 a1 01\n"), std::string::npos);
  EXPECT_NE(text.find("\nI: 3 1209 0001\n"), std::string::npos);
  EXPECT_NE(text.find("\nN: two lines\n"), std::string::npos);
}

TEST(Trace, FilesThatAreNoneAreNamed) {
  EXPECT_EQ(read_trace("/nonexistent/x.hid").error().message,
            "/nonexistent/x.hid: there is no such file");
  EXPECT_EQ(read_trace("/").error().message, "/: not a regular file (a folder)");
  EXPECT_EQ(write_trace(parsed(kHeader), "/dev/null/x.hid").error().message,
            "/dev/null: cannot be created: Not a directory");
}

TEST(Trace, AFileOfSeveralReadsIsReadAsOneText) {
  std::string text = kHeader;
  for (int i = 0; i < 20000; ++i) text += "E: 000000.000000 5 01 80 7f 80 80\n";
  const Trace t = parsed(text);
  const OwnFolder own;
  const std::string path = own.at("trace.hid");
  ASSERT_TRUE(write_trace(t, path));
  const auto back = read_trace(path);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->events, t.events);
  EXPECT_EQ(back->bytes, t.bytes);
  EXPECT_EQ(back->devices, t.devices);
}

TEST(Trace, TooLongALineIsDamageUnlessItIsAComment) {
  const std::string long_text(3 << 20, 'x');
  EXPECT_EQ(cause("#" + long_text + "\nR: 1 c0\n"), "accepted");
  EXPECT_EQ(cause("R: 1 c0\nZ: " + long_text), "t.hid:2: the line is longer than 1048576 bytes");
}

}  // namespace
}  // namespace gaitpad
