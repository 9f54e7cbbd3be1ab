#include "session/file_kind.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "tests/own_folder.h"

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

}  // namespace
}  // namespace gaitpad
