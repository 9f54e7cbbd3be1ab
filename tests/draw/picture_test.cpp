// A PNG holds the given pixels; cairo's own reader reads it.
#include "draw/picture.h"

#include <cairo/cairo.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

TEST(PictureFile, HoldsThePixelsThatWereGiven) {
  const OwnFolder folder;
  Pixels pixels{3, 2, {}};
  for (int i = 0; i < 6; ++i) {
    for (const int v : {i * 40, 255 - i * 40, 7 * i, 255}) {
      pixels.rgba.push_back(static_cast<std::uint8_t>(v));
    }
  }
  const std::string path = folder.at("a.png");
  const auto error = write_png(path, pixels);
  ASSERT_FALSE(error) << error->message;
  const Surface read(cairo_image_surface_create_from_png(path.c_str()));
  ASSERT_EQ(cairo_image_surface_get_width(read.get()), 3);
  ASSERT_EQ(cairo_image_surface_get_height(read.get()), 2);
  for (int i = 0; i < 6; ++i) {
    std::uint32_t pixel = 0;
    std::memcpy(&pixel,
                cairo_image_surface_get_data(read.get()) +
                    i / 3 * cairo_image_surface_get_stride(read.get()) + i % 3 * 4,
                4);
    EXPECT_EQ(pixel >> 16 & 0xff, static_cast<unsigned>(i * 40));
    EXPECT_EQ(pixel >> 8 & 0xff, static_cast<unsigned>(255 - i * 40));
    EXPECT_EQ(pixel & 0xff, static_cast<unsigned>(7 * i));
  }
}

TEST(PictureFile, WhatCannotBeWrittenLeavesTheOldFileAndSaysWhy) {
  const OwnFolder folder;
  const Pixels pixels{1, 1, {1, 2, 3, 255}};
  fs::create_directory(folder.at("folder.png"));
  const auto is_folder = write_png(folder.at("folder.png"), pixels);
  ASSERT_TRUE(is_folder);
  EXPECT_NE(is_folder->message.find("folder.png: "), std::string::npos);
  const auto below_file = write_png("/dev/null/a.png", pixels);
  ASSERT_TRUE(below_file);
  EXPECT_NE(below_file->message.find("/dev/null"), std::string::npos);
  EXPECT_TRUE(write_png(folder.at("empty.png"), Pixels{}));
  EXPECT_TRUE(write_png(folder.at("short.png"), Pixels{2, 2, {1, 2, 3, 4}}));
  EXPECT_EQ(folder.entries(), 1);
}

}  // namespace
}  // namespace gaitpad
