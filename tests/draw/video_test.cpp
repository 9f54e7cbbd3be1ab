// ffprobe and ffmpeg check the videos; without them these tests are skipped. Small scripts in place
// of ffmpeg produce the failures.
#include "draw/video.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

class Video : public testing::Test {
 protected:
  void TearDown() override { ::setenv("PATH", path_before_.c_str(), 1); }
  std::string file(const std::string& name) const { return own_.at(name); }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& e : fs::directory_iterator(folder_)) names.push_back(e.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
  // Makes VideoWriter run this script instead of ffmpeg.
  void pretend_ffmpeg(const std::string& script) {
    const std::string program = own_.write("bin/ffmpeg", "#!/bin/sh\n" + script + "\n");
    ::chmod(program.c_str(), 0755);
    ::setenv("PATH", (file("bin") + ":" + path_before_).c_str(), 1);
  }

  OwnFolder own_;
  const fs::path folder_ = own_.path;
  const std::string path_before_ = std::getenv("PATH");
};

Pixels plain(int width, int height, std::array<std::uint8_t, 3> upper,
             std::array<std::uint8_t, 3> lower) {
  Pixels pixels{width, height, {}};
  for (int i = 0; i < width * height; ++i) {
    const auto& c = i < width * (height / 2) ? upper : lower;
    pixels.rgba.insert(pixels.rgba.end(), {c[0], c[1], c[2], 255});
  }
  return pixels;
}

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = ::popen(command.c_str(), "r");
  std::array<char, 256> buffer{};
  std::size_t count = 0;
  while ((count = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0) {
    text.append(buffer.data(), count);
  }
  return ::pclose(pipe) == 0 ? text : "failed";
}
bool is_installed(const std::string& program) {
  return output_of("command -v " + program) != "failed";
}

TEST_F(Video, HoldsEveryFrameTheRightWayUpInItsColours) {
  if (!is_installed("ffmpeg") || !is_installed("ffprobe")) GTEST_SKIP() << "ffmpeg is missing";
  const std::string path = file("a walk.mp4");
  auto writer = VideoWriter::open(path, 97, 64, 30);  // an odd width
  ASSERT_TRUE(writer) << writer.error().message;
  const Pixels pixels = plain(97, 64, {230, 159, 0}, {0, 114, 178});
  for (int i = 0; i < 12; ++i) {
    const auto error = (*writer)->add(pixels);
    ASSERT_FALSE(error) << error->message;
  }
  EXPECT_FALSE(fs::exists(path));
  const auto error = (*writer)->finish();
  ASSERT_FALSE(error) << error->message;
  EXPECT_EQ(files(), std::vector<std::string>{"a walk.mp4"});
  EXPECT_EQ(output_of("ffprobe -v error -count_frames -show_entries "
                      "stream=codec_name,width,height,r_frame_rate,nb_read_frames -of csv=p=0 '" +
                      path + "'"),
            "h264,98,64,30/1,12\n");
  const std::string raw =
      output_of("ffmpeg -v error -i '" + path + "' -frames:v 1 -f rawvideo -pix_fmt rgb24 -");
  ASSERT_EQ(raw.size(), 98u * 64u * 3u);
  const auto expect_colour = [&raw](int x, int y, std::array<int, 3> colour) {
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(static_cast<unsigned char>(raw[(y * 98 + x) * 3 + c]), colour[c], 6);
    }
  };
  expect_colour(40, 8, {230, 159, 0});
  expect_colour(40, 56, {0, 114, 178});
}

// Without protection SIGPIPE would have ended this program.
TEST_F(Video, FfmpegsOwnReasonIsToldWhereItEndsEarly) {
  pretend_ffmpeg("echo 'first line' >&2; echo 'Unknown encoder libx264' >&2; exit 1");
  own_.write("a.mp4", "old");
  auto writer = VideoWriter::open(file("a.mp4"), 256, 256, 30);
  ASSERT_TRUE(writer) << writer.error().message;
  const Pixels pixels = plain(256, 256, {1, 2, 3}, {4, 5, 6});
  std::optional<Error> error;
  for (int i = 0; i < 50 && !error; ++i) error = (*writer)->add(pixels);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message,
            file("a.mp4") + ": cannot be written: ffmpeg says: Unknown encoder libx264");
  EXPECT_TRUE((*writer)->finish());
  *writer = nullptr;
  EXPECT_EQ(files(), (std::vector<std::string>{"a.mp4", "bin"}));
  EXPECT_EQ(text_in(file("a.mp4")), "old");
}

TEST_F(Video, AFailureAtTheEndIsNoVideo) {
  pretend_ffmpeg("cat > /dev/null; echo 'No space left on device' >&2; exit 1");
  auto writer = VideoWriter::open(file("a.mp4"), 64, 64, 30);
  ASSERT_TRUE(writer) << writer.error().message;
  EXPECT_FALSE((*writer)->add(plain(64, 64, {1, 2, 3}, {4, 5, 6})));
  const auto error = (*writer)->finish();
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("No space left on device"), std::string::npos);
  *writer = nullptr;
  EXPECT_FALSE(fs::exists(file("a.mp4")));
}

TEST_F(Video, WithoutFinishNothingIsLeft) {
  pretend_ffmpeg("exec cat > /dev/null");
  {
    auto writer = VideoWriter::open(file("a.mp4"), 64, 64, 30);
    ASSERT_TRUE(writer) << writer.error().message;
    EXPECT_FALSE((*writer)->add(plain(64, 64, {1, 2, 3}, {4, 5, 6})));
  }
  EXPECT_EQ(files(), std::vector<std::string>{"bin"});
}

TEST_F(Video, WhatCannotBeAVideoIsRefusedAtOnce) {
  EXPECT_FALSE(VideoWriter::open(file("no such folder/a.mp4"), 64, 64, 30));
  EXPECT_FALSE(VideoWriter::open(folder_.string(), 64, 64, 30));
  EXPECT_FALSE(VideoWriter::open(file("a.mp4"), 0, 64, 30));
  EXPECT_FALSE(VideoWriter::open(file("a.mp4"), 64, 64, 0));
  pretend_ffmpeg("exec cat > /dev/null");
  auto writer = VideoWriter::open(file("a.mp4"), 64, 64, 30);
  ASSERT_TRUE(writer) << writer.error().message;
  const auto error = (*writer)->add(plain(32, 64, {1, 2, 3}, {4, 5, 6}));
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("32 x 64"), std::string::npos);
}

}  // namespace
}  // namespace gaitpad
