#include "view/file_browser.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tests/own_folder.h"
#include "view/ui_fixture.h"
#include "view/widgets.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

class Opening : public testing::Test {
 protected:
  std::string make(const std::string& path, const std::string& text = "") {
    return own_.write(path, text);
  }

  OwnFolder own_;
  const fs::path folder_ = own_.path;
};

TEST_F(Opening, TheEndingTellsMotionsAndRecordings) {
  EXPECT_EQ(*kind_of_file(make("a.bvh")), FileKind::motion);
  EXPECT_EQ(*kind_of_file(make("A.AMC")), FileKind::motion);
  EXPECT_EQ(*kind_of_file(make("b.BVH")), FileKind::motion);
  EXPECT_EQ(*kind_of_file(make("c.hid")), FileKind::recording);
}

TEST_F(Opening, TheFolderTellsWhatATomlFileIs) {
  EXPECT_EQ(*kind_of_file(make("styles/x.toml")), FileKind::style);
  EXPECT_EQ(*kind_of_file(make("characters/x.toml")), FileKind::character);
  EXPECT_EQ(*kind_of_file(make("calibration/x.toml")), FileKind::calibration);
  EXPECT_EQ(*kind_of_file(make("terrain/x.toml")), FileKind::terrain);
  EXPECT_EQ(*kind_of_file(make("motions/x.toml")), FileKind::motion);
}

TEST_F(Opening, ElseItsContentTells) {
  EXPECT_EQ(*kind_of_file(make("x.toml", "fatigue = 0.5\n")), FileKind::style);
  EXPECT_EQ(*kind_of_file(make("x.toml", "leg_ratio = 0.6\n")), FileKind::character);
  EXPECT_EQ(*kind_of_file(make("x.toml", "devices = [\"*:*\"]\n[left]\ninner = 0.1\n")),
            FileKind::calibration);
  EXPECT_EQ(*kind_of_file(make("x.toml", "[[section]]\nkind = \"flat\"\nlength_m = 3\n")),
            FileKind::terrain);
}

TEST_F(Opening, WhatCannotBeToldApartSaysWhatToDo) {
  const auto kind = kind_of_file(make("x.toml", "name = \"which\"\n"));
  ASSERT_FALSE(kind);
  EXPECT_NE(kind.error().message.find("a folder named styles"), std::string::npos);
}

TEST_F(Opening, WhatIsNoneOfTheseIsOneSentenceWithItsName) {
  make("folder.bvh/inside");
  ::mkfifo((folder_ / "pipe.bvh").c_str(), 0600);
  for (const std::string& path :
       {make("x.txt"), make("x.toml", "nonsense = 1\n"), make("y.toml", "= broken"),
        (folder_ / "none.bvh").string(), (folder_ / "folder.bvh").string(),
        (folder_ / "pipe.bvh").string()}) {
    const auto kind = kind_of_file(path);
    ASSERT_FALSE(kind) << path;
    EXPECT_NE(kind.error().message.find(path), std::string::npos) << kind.error().message;
    EXPECT_EQ(kind.error().message.find('\n'), std::string::npos);
  }
}

SessionSpec four() {
  SessionSpec options;
  options.walk.styles = {"even", "stiff_hip", "stiff_knee", "limp_left"};
  options.live.record = "session.hid";
  return options;
}

TEST(WithFile, AStyleIsForTheChosenOneOrForAll) {
  using List = std::vector<std::string>;
  EXPECT_EQ(with_file(four(), "/x.toml", FileKind::style, 2, 4).walk.styles,
            (List{"even", "stiff_hip", "/x.toml", "limp_left"}));
  EXPECT_EQ(with_file(four(), "/x.toml", FileKind::style, -1, 4).walk.styles, (List{"/x.toml"}));
}

TEST(WithFile, AListThatRepeatsItsLastKeepsTheOthersAsTheyAre) {
  using List = std::vector<std::string>;
  SessionSpec options = four();
  options.walk.characters = {"adult", "child"};
  EXPECT_EQ(with_file(options, "/x.toml", FileKind::character, 2, 4).walk.characters,
            (List{"adult", "child", "/x.toml", "child"}));
  EXPECT_EQ(with_file(four(), "/x.toml", FileKind::character, 0, 2).walk.characters,
            (List{"/x.toml", "as_in_motion_file"}));
}

TEST(WithFile, NothingIsRecordedOverTheOldRecording) {
  for (const FileKind kind : {FileKind::motion, FileKind::style, FileKind::recording})
    EXPECT_EQ(with_file(four(), "/x", kind, -1, 4).live.record, "");
}

TEST(WithFile, ARecordingIsPlayedAndAMotionGoesOnBeingLive) {
  EXPECT_EQ(with_file(four(), "/x.hid", FileKind::recording, -1, 4).replay.trace, "/x.hid");
  const SessionSpec motion = with_file(four(), "/x.bvh", FileKind::motion, -1, 4);
  EXPECT_EQ(motion.replay.trace, "");
  EXPECT_EQ(motion.walk.motion, "/x.bvh");
  EXPECT_EQ(motion.walk.styles, four().walk.styles);
}

class Folder : public testing::Test {
 protected:
  void make(const std::string& name) { own_.write(name, "x"); }
  std::vector<std::string> names(FileFilter filter = FileFilter::all) {
    std::vector<std::string> all;
    for (const FolderEntry& entry : list_folder(folder_.string(), filter).entries)
      all.push_back(entry.name);
    return all;
  }

  OwnFolder own_;
  const fs::path folder_ = own_.path;
};
using Names = std::vector<std::string>;

TEST_F(Folder, FoldersComeFirstThenFilesByNameWithoutCase) {
  for (const char* name : {"b.hid", "A.bvh", "d.amc", "d.asf", "c.toml"}) make(name);
  fs::create_directory(folder_ / "z");
  fs::create_directory(folder_ / "Y");
  EXPECT_EQ(names(), (Names{"Y", "z", "A.bvh", "b.hid", "c.toml", "d.amc"}));
}

TEST_F(Folder, TheFilterLeavesFoldersAndItsOwnKind) {
  for (const char* name : {"b.hid", "A.BVH", "c.toml", "d.txt", "none"}) make(name);
  fs::create_directory(folder_ / "z");
  EXPECT_EQ(names(FileFilter::all), (Names{"z", "A.BVH", "b.hid", "c.toml"}));
  EXPECT_EQ(names(FileFilter::motions), (Names{"z", "A.BVH"}));
  EXPECT_EQ(names(FileFilter::recordings), (Names{"z", "b.hid"}));
  EXPECT_EQ(names(FileFilter::settings), (Names{"z", "c.toml"}));
}

TEST_F(Folder, HiddenFilesAndBrokenLinksAreLeftOut) {
  make(".hidden.hid");
  fs::create_symlink("nowhere.hid", folder_ / "broken.hid");
  make("real.hid");
  fs::create_symlink("real.hid", folder_ / "link.hid");
  EXPECT_EQ(names(), (Names{"link.hid", "real.hid"}));
}

TEST_F(Folder, ANameThatIsNoTextKeepsItsBytes) {
  const std::string name = "\xff\xfe walk.hid";
  make(name);
  ASSERT_EQ(names(), Names{name});
  EXPECT_TRUE(fs::exists(folder_ / names().front()));
}

// Bytes that this process has read so far.
long long bytes_read() {
  std::ifstream file("/proc/self/io");
  std::string name;
  long long count = -1;
  file >> name >> count;
  return count;
}

class OpenBrowser : public UiTest {};

// What it says of bundled and recent files it read when it was opened.
TEST_F(OpenBrowser, ReadsNoFileWhileItIsShown) {
  if (bytes_read() < 0) GTEST_SKIP() << "this kernel does not count what a process reads";
  FileBrowser browser("");
  browser.open({kSourceFolder + "/config"});
  const auto draw_browser = [&] {
    const UiInput input{*frame, cast, history};
    UiOutput out;
    ImGui::NewFrame();
    clear_items();
    Ui ui{input, theme_of(state.theme), fonts, 1.0f, state, out};
    browser.draw(ui, {1280.0f, 720.0f});
    ImGui::Render();
  };
  draw_browser();
  draw_browser();
  EXPECT_NE(find("browser bundled 0"), nullptr);
  const long long before = bytes_read();
  for (int i = 0; i < 60; ++i) draw_browser();
  EXPECT_LT(bytes_read() - before, 4096) << "in 60 frames";
}

TEST_F(Folder, WhatCannotBeReadIsTold) {
  EXPECT_NE(list_folder((folder_ / "none").string(), FileFilter::all).problem.find("none"),
            std::string::npos);
  if (::geteuid() == 0) GTEST_SKIP() << "root may read every folder";
  fs::permissions(folder_, fs::perms::none);
  EXPECT_NE(list_folder(folder_.string(), FileFilter::all).problem, "");
}

TEST_F(Folder, AHugeFolderIsShownInPartAndSaysSo) {
  for (std::size_t i = 0; i < FolderList::kMostEntries + 10; ++i) make(std::to_string(i) + ".hid");
  const FolderList list = list_folder(folder_.string(), FileFilter::all);
  EXPECT_EQ(list.entries.size(), FolderList::kMostEntries);
  EXPECT_NE(list.problem.find("only some are shown"), std::string::npos);
}

TEST_F(Folder, RecentFilesAreRememberedNewestFirstEachOnce) {
  const std::string file = (folder_ / "recent").string();
  for (const char* name : {"a.hid", "b.hid"}) make(name);
  const std::string a = (folder_ / "a.hid").string(), b = (folder_ / "b.hid").string();
  {
    RecentFiles recent(file);
    recent.add(a);
    recent.add(b);
    recent.add(a);
    EXPECT_EQ(recent.paths(), (Names{a, b}));
  }
  EXPECT_EQ(RecentFiles(file).paths(), (Names{a, b}));
  fs::remove(a);
  EXPECT_EQ(RecentFiles(file).paths(), Names{b});
}

TEST_F(Folder, OnlySoManyRecentFilesAreKeptAndAStrangersListIsBounded) {
  const std::string file = (folder_ / "recent").string();
  RecentFiles recent(file);
  for (std::size_t i = 0; i < 2 * RecentFiles::kMost; ++i) {
    make(std::to_string(i) + ".hid");
    recent.add((folder_ / (std::to_string(i) + ".hid")).string());
  }
  EXPECT_EQ(recent.paths().size(), RecentFiles::kMost);
  std::ofstream(file) << std::string(10'000'000, 'x');
  EXPECT_TRUE(RecentFiles(file).paths().empty());
  EXPECT_TRUE(RecentFiles("").paths().empty());
}

}  // namespace
}  // namespace gaitpad
