// The window and files: opened, dropped, typed, played, calibrated, and pictures made of it.
#include <algorithm>
#include <array>
#include <cstdio>

#include "pads/calibration_store.h"
#include "tests/view/window_script.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;
using Glance = WindowGlance;

// A motion file: the bundled recording's walk, as replay exports it.
std::string exported_walk(const Window&, const fs::path& folder, const SessionSpec& session,
                          const std::string& trace) {
  SessionSpec spec;
  spec.config_folders = session.config_folders;
  spec.replay.trace = trace;
  spec.replay.out = (folder / "out").string();
  spec.replay.fps = 60;
  value_of(replay(spec));
  return spec.replay.out + "/pose.bvh";
}

class WindowFiles : public Window {};

TEST_F(WindowFiles, DroppedFilesChangeTheSessionAndDamagedOnesDoNot) {
  const std::string walk = exported_walk(*this, folder_, options_.session, round_);
  const std::string damaged = make("damaged.bvh", text_in(walk).substr(0, 3000));
  const std::string style = make("styles/own.toml", "fatigue = 0.75\n");
  const std::string bad_style = make("styles/bad.toml", "fatigue = \"very\"\n");
  const std::string build = make("characters/small.toml", "scale = 0.5\n");
  Script script;
  script.drop(walk);
  script.until("it walks by the motion",
               [](const Glance& g) { return g.cast.motion != "procedural"; });
  for (const std::string& bad : {damaged, bad_style, make("notes.txt", "x"), folder_.string(),
                                 make("cut.hid", "R: 3 05\n"), (folder_ / "none.bvh").string()}) {
    script.drop(bad);
    script.until("it tells of " + bad, [bad](const Glance& g) { return says(g, bad); });
    script.then([](const Glance& g) {
      EXPECT_NE(g.cast.motion, "procedural");
      EXPECT_FALSE(g.is_playback);
    });
    script.until("it runs on", [](const Glance& g) { return g.session.tick > 0; });
  }
  script.drop(style);
  script.until("all are tired", [](const Glance& g) {
    return g.cast.members.size() == 1 && g.cast.members[0].style == "own";
  });
  script.drop(build);
  script.until("it is small", [](const Glance& g) { return g.cast.members[0].character != ""; });
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  script.then([](const Glance& g) {
    EXPECT_NEAR(g.cast.members[0].model->leg_length_m,
                0.5 * g.cast.members[0].model->source_leg_length_m, 1e-3);
  });
  run(script);
}

TEST_F(WindowFiles, AKeyTurnsToTheNextGroundAndADroppedOneIsWalkedOn) {
  const std::string ramp =
      make("terrain/ramp.toml", "[[section]]\nkind = \"slope\"\nlength_m = 5\ngrade = 0.1\n");
  const std::string bad = make("terrain/bad.toml", "[[section]]\nkind = \"hole\"\n");
  Script script;
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  script.then([](const Glance& g) { EXPECT_TRUE(is_flat(*g.cast.terrain)); });
  script.tap(SDLK_m);
  script.until("it has turned on", [](const Glance& g) { return g.cast.terrain->name == "rough"; });
  script.drop(bad);
  script.until("it tells of it", [bad](const Glance& g) { return says(g, "bad.toml:2"); });
  script.drop(ramp);
  script.until("the ramp", [](const Glance& g) { return g.cast.terrain->name == "ramp"; });
  script.until("it runs on", [](const Glance& g) { return g.session.tick > 0; });
  run(script);
}

TEST_F(WindowFiles, ADroppedRecordingPlaysAndEscapeGoesBack) {
  Script script;
  script.drop(round_);
  script.until("it plays", [](const Glance& g) { return g.is_playback && g.session.tick > 20; });
  script.then([](const Glance& g) { EXPECT_EQ(g.cast.members.size(), 4u); });
  script.tap(SDLK_ESCAPE);
  script.until("it is live again", [](const Glance& g) { return !g.is_playback; });
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  run(script);
}

TEST_F(WindowFiles, APlaybackIsPausedSteppedSoughtAndTakesNoStyles) {
  options_.session.replay.trace = round_;
  Script script;
  std::int64_t tick = 0;
  script.until("it plays", [](const Glance& g) { return g.session.tick > 10; });
  script.tap(SDLK_SPACE);
  script.until("it stands", [](const Glance& g) { return g.pace == 0.0; });
  script.wait(2);
  script.then([&](const Glance& g) { tick = g.session.tick; });
  script.tap(SDLK_PERIOD);
  script.until("one tick on", [&](const Glance& g) { return g.session.tick == tick + 1; });
  script.click("timeline", 0.5f);
  script.until("half-way", [](const Glance& g) {  // of 4800 ticks
    return std::abs(static_cast<double>(g.session.tick) - 2400.0) < 120.0;
  });
  script.tap(SDLK_3);
  script.until("it says why not", [](const Glance& g) { return says(g, "own styles"); });
  script.tap(SDLK_BACKSPACE);
  script.until("it is at the beginning", [](const Glance& g) { return g.session.tick == 0; });
  script.tap(SDLK_F9);
  script.until("it records nothing", [](const Glance& g) { return says(g, "nothing to record"); });
  run(script);
  EXPECT_TRUE(files(".hid").empty());
}

TEST_F(WindowFiles, TheBrowserOpensWhatIsTypedOrClicked) {
  make("walks/limp.hid", text_in(round_));
  make("walks/other.txt", "x");
  Script script;
  script.tap(SDLK_o);
  script.until("it is open", [](const Glance& g) { return g.is_browsing; });
  script.click("browser filter Recordings");
  script.click("browser entry walks");
  script.until("the folder is open", [](const Glance&) {
    return Script::find("browser entry limp.hid") && !Script::find("browser entry other.txt");
  });
  script.click("browser entry limp.hid");
  script.click("browser open");
  script.until("it plays", [](const Glance& g) { return g.is_playback && !g.is_browsing; });
  script.tap(SDLK_o);
  script.click("browser recent 0");
  script.until("it plays again", [](const Glance& g) { return g.is_playback && !g.is_browsing; });
  script.tap(SDLK_o);
  script.click("browser path");
  script.type("none.bvh");
  script.tap(SDLK_RETURN);
  script.wait(2);
  script.then([](const Glance& g) { EXPECT_TRUE(g.is_browsing); });
  script.click("browser up");
  script.click("browser cancel");
  script.until("it is closed", [](const Glance& g) { return !g.is_browsing; });
  options_.recent_file = (folder_ / "recent").string();
  run(script);
  EXPECT_EQ(text_in(options_.recent_file), (folder_ / "walks/limp.hid").string() + "\n");
}

// A pad with one stick that is let go four times from all sides, at once and often enough to be
// measured: sooner than any thumb.
std::string thumb_trace() {
  std::string text =
      "R: 54 05 01 09 05 a1 01 15 00 26 ff 00 75 08 95 04 09 30 09 31 09 32 09 35 81 02 15 00 25 "
      "07 "
      "75 04 95 01 09 39 81 42 05 09 15 00 25 01 75 01 95 0c 19 01 29 0c 81 02 c0\n"
      "N: Thumb Pad\nI: 3 1209 0002\n";
  int ms = 0;
  const auto report = [&](int x, int y) {
    char line[80];
    std::snprintf(line, sizeof line, "E: %06d.%06d 6 %02x %02x 80 80 08 00\n", ms / 1000,
                  ms % 1000 * 1000, x, y);
    text += line;
    ms += 8;
  };
  for (int i = 0; i < 120; ++i) report(0x80 + i % 2, 0x80);
  constexpr std::array<std::array<int, 2>, 4> kSides = {
      {{0x80, 0}, {0xff, 0x80}, {0x80, 0xff}, {0, 0x80}}};
  for (const auto& side : kSides) {
    for (int i = 0; i < 25; ++i) report(side[0], side[1]);
    for (int i = 0; i < 100; ++i) report(0x80 + i % 2, 0x80);
  }
  return text;
}

TEST_F(WindowFiles, ACalibrationIsMeasuredShownSavedAndInForce) {
  options_.session.pad.wish.pad = make("thumb.hid", thumb_trace());
  options_.calibration_folder = (folder_ / "config/gaitpad/calibration").string();
  Script script;
  script.until("it runs", [](const Glance& g) { return g.session.tick > 0; });
  script.tap(SDLK_F8);
  script.until("it calibrates", [](const Glance& g) { return g.is_calibrating; });
  script.click("calibration repeat");
  script.until("the recording is over", [](const Glance& g) { return says(g, "has ended"); });
  script.until("the result is there",
               [](const Glance&) { return Script::find("calibration save"); });
  script.click("calibration save");
  script.until("it is kept", [](const Glance& g) { return says(g, "is kept in"); });
  script.until("it runs again",
               [](const Glance& g) { return !g.is_calibrating && g.session.tick > 0; });
  run(script);
  const auto found = fs::directory_iterator(options_.calibration_folder);
  ASSERT_NE(found, fs::directory_iterator());
  const auto file = load_calibration_file(found->path().string());
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->name, "Thumb Pad");
  // 0x80 and 0x81 by turns, in fractions of half of 0 .. 255.
  EXPECT_NEAR(file->calibration.left.x.centre, (128.5 - 127.5) / 127.5, 0.004);
}

TEST_F(WindowFiles, ACalibrationIsGivenUp) {
  Script script;
  script.until("it runs", [](const Glance& g) { return g.session.tick > 20; });
  script.tap(SDLK_F8);
  script.until("it waits for a pad", [](const Glance& g) { return g.is_calibrating; });
  script.drop(round_);
  script.until("files wait", [](const Glance& g) { return says(g, "open files afterwards"); });
  script.click("calibration give up");
  script.until("it walks on",
               [](const Glance& g) { return !g.is_calibrating && g.session.tick > 0; });
  run(script);
}

TEST_F(WindowFiles, ASavedStyleIsKnownToTheNextSession) {
  options_.are_panels_given = true;
  options_.panels = {Panel::style};
  Script script;
  script.tap(SDLK_TAB);
  script.until("the first one is chosen", [](const Glance& g) { return g.ui.walker == 0; });
  script.click("style slider fatigue", 0.75f);
  script.until("it is tired", [](const Glance& g) {
    return g.session.walkers[0].style.fatigue > 0.5 && g.session.walkers[1].style.fatigue == 0.0;
  });
  script.click("style name");
  script.type("worn_out");
  script.click("save style");
  script.until("it is kept", [](const Glance& g) { return says(g, "worn_out.toml"); });
  script.drop(make("x.toml", "fatigue = 0\nhip_sway = 1\n"));  // another session
  script.until("it is known",
               [](const Glance& g) { return std::ranges::count(g.cast.styles, "worn_out") == 1; });
  run(script);
}

TEST_F(WindowFiles, PicturesOfATraceAreTheSameEveryTime) {
  std::array<std::string, 2> pictures;
  std::array<std::uint64_t, 2> hashes{};
  options_.session.replay.trace = round_;
  options_.is_hidden = true;
  options_.frames = 45;
  for (std::size_t i = 0; i < 2; ++i) {
    options_.screenshot = (folder_ / (std::to_string(i) + ".png")).string();
    const auto result = run_window(options_);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->frames, 45);
    pictures[i] = text_in(options_.screenshot);
    hashes[i] = result->summary.pose_hash;
    EXPECT_EQ(result->summary.ticks, 45 * 240 / 60);
  }
  EXPECT_GT(pictures[0].size(), 50'000u);
  EXPECT_EQ(pictures[0], pictures[1]);
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(WindowFiles, ALiveSessionIsPicturedByHandTheSameEveryTime) {
  std::array<std::string, 2> pictures;
  options_.is_hidden = true;
  options_.are_panels_given = true;
  options_.panels = {Panel::pad, Panel::loop};
  options_.frames = 30;
  for (std::string& picture : pictures) {
    options_.screenshot = (folder_ / "live.png").string();
    const auto result = run_window(options_);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->summary.ticks, 30 * 240 / 60);
    picture = text_in(options_.screenshot);
  }
  EXPECT_FALSE(pictures[0].empty());
  EXPECT_EQ(pictures[0], pictures[1]);
}

TEST_F(WindowFiles, APictureThatCannotBeWrittenIsAnError) {
  options_.screenshot = (folder_ / "none/x.png/y.png").string();
  make("none/x.png", "a file");
  options_.is_hidden = true;
  options_.frames = 2;
  const auto result = run_window(options_);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("x.png"), std::string::npos);
}

}  // namespace
}  // namespace gaitpad
