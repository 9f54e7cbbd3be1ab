#include "files/folder_list.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "tests/own_folder.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

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
