#include "pads/calibration_store.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "tests/own_folder.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

std::string folder_with(const char* config, const char* home) {
  const Environment xdg("XDG_CONFIG_HOME", config), user("HOME", home);
  return user_calibration_folder();
}

TEST(CalibrationFolder, IsTheXdgConfigFolderWhereItIsAbsolute) {
  EXPECT_EQ(folder_with("/c", "/home/u"), "/c/gaitpad/calibration");
  // By the XDG base directory specification a relative path is invalid and ignored; an empty one
  // counts as unset.
  for (const char* invalid : {"c", "./c", ""})
    EXPECT_EQ(folder_with(invalid, "/home/u"), "/home/u/.config/gaitpad/calibration");
  EXPECT_EQ(folder_with(nullptr, "/home/u"), "/home/u/.config/gaitpad/calibration");
  EXPECT_EQ(folder_with(nullptr, nullptr), "");
  EXPECT_EQ(folder_with(nullptr, "home/u"), "");
}

DeviceInfo pad(const std::string& unique_id, const std::string& port = "usb-1/input0",
               const std::string& driver = "hidraw") {
  DeviceInfo info;
  info.vendor = 0x054c;
  info.product = 0x0ce6;
  info.name = "Pad";
  info.unique_id = unique_id;
  info.physical_path = port;
  info.driver = driver;
  return info;
}
DeviceIdentity identity(const DeviceInfo& info) {
  return {info.vendor, info.product, info.unique_id, info.physical_path, info.driver};
}
std::string path_of(const DeviceInfo& info, bool has_factory_sticks = false) {
  return calibration_path("/f", calibration_for(info, has_factory_sticks));
}

TEST(CalibrationFor, ADeviceWithAnIdIsFoundByItOnAnyPortOthersOnTheirPort) {
  const CalibrationFile with_id = calibration_for(pad("a1:b2"), false);
  EXPECT_GT(calibration_fit(with_id, identity(pad("a1:b2", "elsewhere"))), 0);
  EXPECT_EQ(calibration_fit(with_id, identity(pad("a1:b3"))), 0);
  const CalibrationFile with_port = calibration_for(pad(""), false);
  EXPECT_GT(calibration_fit(with_port, identity(pad(""))), 0);
  EXPECT_EQ(calibration_fit(with_port, identity(pad("", "usb-2/input0"))), 0);
  DeviceInfo other = pad("a1:b2");
  other.product = 0x09cc;
  EXPECT_EQ(calibration_fit(with_id, identity(other)), 0);
}

TEST(CalibrationFor, AnIdOfZerosOrBlanksOrBytesThatAreNoTextIsNone) {
  for (const char* id :
       {"", " ", "0", "00:00:00:00:00:00", "000000000000", "0000-0000", "\xff\xfe"}) {
    const CalibrationFile file = calibration_for(pad(id), false);
    EXPECT_EQ(file.unique_id, "") << id;
    EXPECT_EQ(file.port, "usb-1/input0") << id;
  }
  EXPECT_EQ(calibration_for(pad("00:00:00:00:00:01"), false).port, "");
  // With neither a unique id nor a port, the file is for the pad's model.
  const CalibrationFile model = calibration_for(pad("", ""), false);
  EXPECT_GT(calibration_fit(model, identity(pad("x", "y"))), 0);
}

TEST(CalibrationFor, DriversAreNamedWhereTheOthersValuesDiffer) {
  using Names = std::vector<std::string>;
  const auto drivers = [](const char* driver, std::uint16_t version, bool has_factory_sticks) {
    DeviceInfo info = pad("a", "", driver);
    info.version = version;
    return calibration_for(info, has_factory_sticks).drivers;
  };
  EXPECT_EQ(drivers("hidraw", 0x0111, true), (Names{"hidraw", "usb"}));
  EXPECT_EQ(drivers("usb", 0x0111, true), (Names{"hidraw", "usb"}));
  EXPECT_EQ(drivers("evdev", 0x8111, false), (Names{"evdev", "sdl"}));
  EXPECT_EQ(drivers("sdl", 0x8111, false), (Names{"evdev", "sdl"}));
  for (const char* driver : {"hidraw", "usb", "evdev", "sdl"})
    EXPECT_EQ(drivers(driver, 0x0111, false), Names()) << driver;
  EXPECT_EQ(drivers("hidraw", 0x8111, false), Names());  // the bit counts only for nodes of evdev
}

TEST(CalibrationPath, TellsTheDeviceInItsName) {
  EXPECT_EQ(path_of(pad("AB12.x_y-z")), "/f/054c_0ce6-AB12.x_y-z.toml");
  EXPECT_EQ(path_of(pad("", "1-2")), "/f/054c_0ce6-port-1-2.toml");
  EXPECT_EQ(path_of(pad("", "")), "/f/054c_0ce6.toml");
  DeviceInfo arranged = pad("AB", "", "evdev");
  arranged.version = 0x8111;
  EXPECT_EQ(path_of(arranged), "/f/054c_0ce6-AB-evdev.toml");
  EXPECT_EQ(path_of(pad("AB"), true), "/f/054c_0ce6-AB.toml");
}

TEST(CalibrationPath, IsTheSameForTheSameDeviceAndAnotherForEveryOther) {
  const std::string longer(200, 'x');
  std::set<std::string> paths;
  int devices = 0;
  const auto add = [&](const DeviceInfo& info) {
    const std::string path = path_of(info);
    EXPECT_EQ(path, path_of(info));
    EXPECT_TRUE(paths.insert(path).second) << path;
    EXPECT_LE(path.size(), 3u + 90u);
    EXPECT_EQ(path.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                     "0123456789._-/"),
              std::string::npos);
    EXPECT_EQ(path.rfind('/'), 2u) << path;
    ++devices;
  };
  for (const char* id : {"a:b", "a-b", "a/b", "a b", "../../etc", "..", "a\nb", "AB", "ab",
                         "port-1-2", "AB-evdev", "\xc3\xa4", "\xc3\xb6"})
    add(pad(id));
  add(pad(longer));
  add(pad(longer + "y"));
  for (const char* port : {"1-2", "1/2", "1:2"}) add(pad("", port));
  DeviceInfo other = pad("a-b");
  other.vendor = 0x054d;
  add(other);
  other.product = 0x0ce7;
  add(other);
  DeviceInfo arranged = pad("AB", "", "sdl");
  arranged.version = 0x8000;
  add(arranged);
  EXPECT_EQ(paths.size(), static_cast<std::size_t>(devices));
}

CalibrationFile made_file(double inner) {
  CalibrationFile file = calibration_for(pad("a1"), true);
  file.calibration.left.inner = inner;
  file.measured[0] = StickMeasured{0.002, 0.01, 0.0, 8.0};
  return file;
}

class SaveCalibration : public testing::Test {
 protected:
  static std::string problem(const std::string& path, double inner) {
    const auto error = save_calibration(path, made_file(inner), {});
    return error ? error->message : "none";
  }
  static double inner_of(const std::string& path) {
    return value_of(load_calibration_file(path)).calibration.left.inner;
  }
  // Runs in a child process, because it changes the permissions of the whole process.
  template <typename Test>
  static bool holds_in_child(Test test) {
    ::fflush(nullptr);
    const pid_t child = ::fork();
    if (child == 0) ::_exit(test() ? 0 : 1);
    int status = -1;
    ::waitpid(child, &status, 0);
    return status == 0;
  }

  OwnFolder own_;
  const std::string top_ = own_.path.string();
  std::string path_ = top_ + "/pad.toml";
};

TEST_F(SaveCalibration, ReadsBackAsItWasAndMakesItsFolder) {
  const std::string path = top_ + "/a/b/pad.toml";
  ASSERT_FALSE(save_calibration(path, made_file(0.1), {"Made by a test", "", "two\nlines \xff"}));
  auto file = load_calibration_file(path);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(*file, made_file(0.1));
  EXPECT_EQ(text_in(path).find("# Made by a test\n#\n# two\\x0alines \\xff\n\nname = \"Pad\"\n"),
            0u)
      << text_in(path);
  EXPECT_EQ(entries_in(top_ + "/a/b"), 1);
}

TEST_F(SaveCalibration, TheFileBeforeIsKeptEvenADamagedOne) {
  EXPECT_EQ(problem(path_, 0.1), "none");
  EXPECT_FALSE(fs::exists(path_ + ".old"));
  const std::string first = text_in(path_);
  EXPECT_EQ(problem(path_, 0.2), "none");
  EXPECT_EQ(text_in(path_ + ".old"), first);
  EXPECT_EQ(inner_of(path_), 0.2);
  std::ofstream(path_) << "damaged";
  EXPECT_EQ(problem(path_, 0.3), "none");
  EXPECT_EQ(inner_of(path_), 0.3);
  EXPECT_EQ(text_in(path_ + ".old"), "damaged");
  EXPECT_EQ(own_.entries(), 2);
}

// A save that is killed between its two renames leaves two names of one file, for which rename()
// does nothing.
TEST_F(SaveCalibration, ASaveThatWasKilledBetweenItsStepsLeavesNothingOdd) {
  EXPECT_EQ(problem(path_, 0.1), "none");
  fs::create_hard_link(path_, path_ + ".old");
  EXPECT_EQ(problem(path_, 0.2), "none");
  EXPECT_EQ(inner_of(path_ + ".old"), 0.1);
  EXPECT_EQ(inner_of(path_), 0.2);
  EXPECT_EQ(own_.entries(), 2);
}

TEST_F(SaveCalibration, AFullDiskIsToldAndTheOldFileStays) {
  ASSERT_EQ(problem(path_, 0.1), "none");
  ASSERT_EQ(problem(path_, 0.2), "none");
  EXPECT_TRUE(holds_in_child([this] {
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100, 100};
    return ::setrlimit(RLIMIT_FSIZE, &limit) == 0 &&
           problem(path_, 0.3) == path_ + ": cannot be written: File too large";
  }));
  EXPECT_EQ(inner_of(path_), 0.2);
  EXPECT_EQ(inner_of(path_ + ".old"), 0.1);
  EXPECT_EQ(own_.entries(), 2);
}

TEST_F(SaveCalibration, AReadOnlyFolderIsToldAndTheOldFileStays) {
  ASSERT_EQ(problem(path_, 0.1), "none");
  fs::permissions(top_, fs::perms(0555));
  EXPECT_TRUE(holds_in_child([this] {
    constexpr uid_t kNobody = 65534;  // another user, because root may write into every folder
    if (::geteuid() == 0 && ::setuid(kNobody) != 0) return false;
    return problem(path_, 0.2) == path_ + ": cannot be written: Permission denied";
  }));
  EXPECT_EQ(inner_of(path_), 0.1);
  EXPECT_EQ(own_.entries(), 1);
}

TEST_F(SaveCalibration, WhereNothingCanBeWrittenItSaysSo) {
  std::ofstream(top_ + "/file") << "x";
  EXPECT_EQ(problem(top_ + "/file/pad.toml", 0.1),
            top_ + "/file/pad.toml: cannot be written: Not a directory");
  EXPECT_EQ(problem("/proc/pad.toml", 0.1),
            "/proc/pad.toml: cannot be written: No such file or "
            "directory");
  fs::create_directories(path_);
  EXPECT_EQ(problem(path_, 0.1), path_ + ": cannot be written: Is a directory");
  EXPECT_EQ(problem("/dev/null", 0.1), "/dev/null: not a regular file, so it cannot be replaced");
  EXPECT_EQ(own_.entries(), 2);
}

TEST_F(SaveCalibration, WhereTheOldFileCannotBeKeptNothingIsChanged) {
  ASSERT_EQ(problem(path_, 0.1), "none");
  fs::create_directories(path_ + ".old");
  EXPECT_EQ(problem(path_, 0.2), path_ + ".old: cannot be written: Is a directory");
  EXPECT_EQ(inner_of(path_), 0.1);
  EXPECT_EQ(own_.entries(), 2);
}

TEST_F(SaveCalibration, WhatCouldNotBeReadBackIsNotWritten) {
  ASSERT_EQ(problem(path_, 0.1), "none");
  EXPECT_EQ(problem(path_, 0.95).find("was not saved, since it could not be read back: "), 0u);
  EXPECT_EQ(inner_of(path_), 0.1);
}

// At any moment of a kill, the file and its old version are each one of the two saved texts.
TEST_F(SaveCalibration, AProcessKilledAtAnyMomentLeavesAWholeFile) {
  ASSERT_EQ(problem(path_, 0.1), "none");
  ASSERT_EQ(problem(path_, 0.2), "none");
  const std::set<std::string> whole = {text_in(path_), text_in(path_ + ".old")};
  ::fflush(nullptr);
  for (int round = 0; round < 40; ++round) {
    const pid_t child = ::fork();
    if (child == 0) {
      for (int i = 0;; ++i) {
        if (save_calibration(path_, made_file(i % 2 ? 0.1 : 0.2), {})) ::_exit(1);
      }
    }
    ::usleep(static_cast<useconds_t>(700 + 173 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status));
    ASSERT_EQ(whole.count(text_in(path_)), 1u) << round;
    ASSERT_EQ(whole.count(text_in(path_ + ".old")), 1u) << round;
  }
}

// --- changes_since()

CalibrationFile measured_file() {
  CalibrationFile file;
  for (StickCalibration* stick : {&file.calibration.left, &file.calibration.right}) {
    stick->x = {-0.95, 0.01, 0.97};
    stick->y = {-0.96, -0.02, 0.95};
    stick->inner = 0.05;
  }
  for (auto& measured : file.measured) measured = StickMeasured{0.002, 0.01, 0.0, 8.0};
  return file;
}
TEST(ChangesSince, TheSameStickHasNone) {
  EXPECT_EQ(changes_since(measured_file(), measured_file()), std::vector<std::string>());
  // A second measurement with usual differences gives no remark either.
  CalibrationFile again = measured_file();
  again.calibration.left.x = {-0.94, 0.014, 0.98};
  again.measured[0] = StickMeasured{0.0023, 0.013, 0.0, 8.5};
  EXPECT_EQ(changes_since(measured_file(), again), std::vector<std::string>());
}

TEST(ChangesSince, EachChangeHasBothNumbersAndWhatItMeans) {
  struct Row {
    void (*change)(CalibrationFile&);
    const char* says;  // a part of the remark
  };
  for (const Row& row : {
           Row{[](CalibrationFile& f) { f.calibration.left.x.centre = 0.04; },
               "left stick: the centre has moved by 0.030, from (0.010, -0.020) to (0.040, "
               "-0.020): more than half of the inner zone of 0.047, so it may soon walk by itself"},
           {[](CalibrationFile& f) { f.calibration.left.x.centre = 0.07; },
            "beyond the inner zone"},
           {[](CalibrationFile& f) { f.calibration.right.y.max = 0.80; },
            "right stick: it reaches 0.800 forward, 0.950 in the file: full deflection is not "
            "reached there any more"},
           {[](CalibrationFile& f) { f.calibration.right.y.max = 0.95 - 0.04; }, "barely"},
           {[](CalibrationFile& f) { f.calibration.right.x.min = -1.0; },
            "1.000 to the left, 0.950 in the file: full deflection comes before the rim"},
           {[](CalibrationFile& f) { f.measured[0]->sigma = 0.0085; },
            "left stick: its noise at rest is 0.0085 (sigma), 0.0020 in the file: the inner zone "
            "of 0.047 covers it"},
           {[](CalibrationFile& f) { f.measured[0]->sigma = 0.0130; }, "0.047 is too small for it"},
           {[](CalibrationFile& f) { f.measured[1]->hysteresis = 0.03; },
            "right stick: the places to which it returns lie 0.030 apart, 0.010 in the file: the "
            "inner zone of 0.047 covers it"},
           {[](CalibrationFile& f) { f.measured[1]->drift_per_s = 0.0075; },
            "right stick: at rest it drifts by 0.0075 a second, 0.0000 in the file: no dead zone "
            "cures that"},
           {[](CalibrationFile& f) { f.measured[0]->circularity_error = 12.25; },
            "left stick: its circularity error is 12.2 %, 8.0 % in the file: the directions differ "
            "more in how far it reaches"},
           // A turned frame gives one remark and no others.
           {[](CalibrationFile& f) {
              f.calibration.left.frame = {RawDirection::plus_y, RawDirection::plus_x};
              f.calibration.left.x.centre = 0.5;
            },
            "left stick: its axes differ from the file"},
       }) {
    CalibrationFile now = measured_file();
    row.change(now);
    const auto changes = changes_since(measured_file(), now);
    ASSERT_EQ(changes.size(), 1u) << row.says;
    EXPECT_NE(changes[0].find(row.says), std::string::npos) << changes[0];
  }
}

TEST(ChangesSince, WhatWasNotMeasuredTodayIsNotCompared) {
  CalibrationFile now;  // a calibration in which every value differs
  EXPECT_EQ(changes_since(measured_file(), now), std::vector<std::string>());
  now.measured[0] = StickMeasured{};
  EXPECT_EQ(changes_since(measured_file(), now), std::vector<std::string>());
  now.measured[0]->sigma = 0.002;  // the stick rested, but was not turned
  now.calibration.left.x.centre = 0.3;
  EXPECT_EQ(changes_since(measured_file(), now).size(), 1u);
}

TEST(ChangesSince, AFileMadeByHandIsComparedInWhatSteersAndNotANumberIsNoChange) {
  CalibrationFile then;
  then.calibration.left.inner = 0.1;
  CalibrationFile now = measured_file();
  now.calibration.left.x = {-0.8, 0.0, 1.0};
  now.calibration.left.y = {-1.0, 0.0, 1.0};
  now.measured[1].reset();
  const auto changes = changes_since(then, now);
  ASSERT_EQ(changes.size(), 1u);
  EXPECT_EQ(changes[0].find("left stick: it reaches 0.800 to the left, 1.000 in"), 0u);
  now = measured_file();
  const double nan = std::nan("");
  now.calibration.left.x = {nan, nan, nan};
  now.measured[0] = StickMeasured{nan, nan, nan, nan};
  EXPECT_EQ(changes_since(measured_file(), now), std::vector<std::string>());
}

}  // namespace
}  // namespace gaitpad
