#include <gtest/gtest.h>

#include <cmath>

#include "files/height_picture.h"
#include "gaitpad/config_files.h"
#include "tests/folders.h"
#include "tests/own_folder.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

Terrain terrain(const std::string& text) {
  return value_of(parsed_terrain(text, "somewhere/ramp.toml"));
}
std::string problem(const std::string& text) {
  return cause_of(parsed_terrain(text, "somewhere/ramp.toml"));
}
const std::string kFlat = "[[section]]\nkind = \"flat\"\nlength_m = 2\n";

TEST(TerrainFile, AnEmptyOneIsFlatAndNamedAfterTheFile) {
  EXPECT_EQ(terrain("").name, "ramp");
  EXPECT_TRUE(is_flat(terrain("")));
  EXPECT_EQ(terrain("name = \"my ramp\"").name, "my ramp");
}

TEST(TerrainFile, SectionsStandInTheOrderOfTheFile) {
  const Terrain t =
      terrain(kFlat +
              "[[section]]\nkind = \"slope\"\nlength_m = 4\nangle_deg = 10\n"
              "[[section]]\nkind = \"stairs\"\nrise_m = -0.15\ntread_m = 0.3\ncount = 2\n"
              "[[section]]\nkind = \"rough\"\nlength_m = 8\namplitude_m = 0.03\n");
  ASSERT_EQ(t.sections.size(), 4u);
  const double grade = std::tan(10.0 * kDegree);
  const double rounding_m = grade / 0.25;  // the rounding for the default bend
  const double top_m = grade * (4.0 - rounding_m);
  EXPECT_NEAR(ground_at(t, 0.0, 6.0).height_m, top_m, 1e-9);
  EXPECT_NEAR(ground_at(t, 0.0, 6.3).height_m, top_m - 0.15, 1e-9);
  EXPECT_NEAR(ground_at(t, 0.0, 6.6).height_m, top_m - 0.30, 1e-9);
  EXPECT_NEAR(length_m(t), 14.6, 1e-9);
  EXPECT_NE(ground_at(t, 0.0, 10.0).height_m, ground_at(t, 0.0, 6.6).height_m);
}

TEST(TerrainFile, ZonesHaveAStyleAndMayHaveSides) {
  const Terrain t =
      terrain(kFlat +
              "[[zone]]\nfrom_m = 1\nto_m = 2.5\nstyle = \"limp_left\"\n"
              "[[zone]]\nfrom_m = 3\nto_m = 4\nright_m = -1\nleft_m = 1\nstyle = \"tired\"\n");
  ASSERT_EQ(t.zones.size(), 2u);
  EXPECT_EQ(t.zones[0].style, "limp_left");
  EXPECT_EQ(t.zones[0].where, "somewhere/ramp.toml:7");
  EXPECT_TRUE(std::isinf(t.zones[0].left_m) && t.zones[0].left_m > 0.0);
  EXPECT_EQ(t.zones[1].right_m, -1.0);
  EXPECT_EQ(t.zones[1].to_m, 4.0);
}

TEST(TerrainFile, ErrorsNameFileAndLine) {
  const auto begins = [](const std::string& text, const std::string& with) {
    EXPECT_EQ(problem(text).substr(0, with.size()), with) << problem(text);
  };
  begins("[[section]]\nkind = \"hole\"\n",
         "somewhere/ramp.toml:2: there is no section of kind \"hole\" (known: flat, slope");
  begins("[[section]]\nlength_m = 2\n", "somewhere/ramp.toml:1: ");
  begins(kFlat + "wide_m = 3\n", "somewhere/ramp.toml:4: unknown key \"wide_m\"");
  begins(kFlat + "[[section]]\nkind = \"slope\"\nlength_m = 4\n", "somewhere/ramp.toml:4: ");
  begins("[[section]]\nkind = \"slope\"\nlength_m = 4\ngrade = 0.5\nrounding_m = 0.2\n",
         "somewhere/ramp.toml:2: a sole would not lie on ground that bends by 2.50 per metre");
  begins("[[section]]\nkind = \"slope\"\nlength_m = 4\ngrade = 0.1\nangle_deg = 3\n",
         "somewhere/ramp.toml:5: ");
  begins("[[section]]\nkind = \"rough\"\nlength_m = 8\namplitude_m = 0.5\n",
         "somewhere/ramp.toml:2: ");
  begins("[[zone]]\nfrom_m = 3\nto_m = 2\nstyle = \"tired\"\n",
         "somewhere/ramp.toml:3: the zone ends before it begins");
  begins("[[zone]]\nfrom_m = 1\nto_m = 2\n", "somewhere/ramp.toml:1: ");
  begins("[[zone]]\nfrom_m = 1\nto_m = 2\nleft_m = -1\nright_m = 1\nstyle = \"tired\"\n",
         "somewhere/ramp.toml:5: ");
  begins("[[section]]\nkind = \"picture\"\npicture = \"none.png\"\nlow_m = 0\nhigh_m = 1\n",
         "somewhere/ramp.toml:3: somewhere/none.png: ");
  std::string many;
  for (int i = 0; i <= kMaxSections; ++i) many += kFlat;
  EXPECT_NE(problem(many), "accepted");
}

TEST(HeightPicture, ReadsTheShippedOne) {
  const auto picture = load_height_picture(kSourceFolder + "/config/terrain/hills.png");
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->columns, 64);
  EXPECT_EQ(picture->rows, 48);
  const auto [low, high] = std::ranges::minmax(picture->samples);
  EXPECT_EQ(low == 0 || high == 65535, true);  // true only if the picture is read with sixteen bits
  EXPECT_GT(high - low, 32768);
}

// PNG files. Two by two samples: 8 bits, black and white above, 128 and 64 below; the same size in
// colours; a header of 100,000 samples a side.
const std::uint8_t kSmall[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x00, 0x00, 0x00, 0x00, 0x57,
    0xdd, 0x52, 0xf8, 0x00, 0x00, 0x00, 0x0e, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63, 0x60,
    0xf8, 0xcf, 0xd0, 0xe0, 0x00, 0x00, 0x05, 0x42, 0x01, 0xc0, 0x6d, 0x5e, 0x78, 0xa0, 0x00,
    0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
const std::uint8_t kColours[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00,
    0x00, 0xfd, 0xd4, 0x9a, 0x73, 0x00, 0x00, 0x00, 0x0b, 0x49, 0x44, 0x41, 0x54, 0x78,
    0xda, 0x63, 0x60, 0x40, 0x06, 0x00, 0x00, 0x0e, 0x00, 0x01, 0x3a, 0x35, 0x04, 0x56,
    0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
const std::uint8_t kHuge[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
    0x44, 0x52, 0x00, 0x01, 0x86, 0xa0, 0x00, 0x01, 0x86, 0xa0, 0x10, 0x00, 0x00, 0x00,
    0x00, 0xdd, 0xa9, 0x88, 0x57, 0x00, 0x00, 0x00, 0x0c, 0x49, 0x44, 0x41, 0x54, 0x78,
    0x9c, 0x63, 0x60, 0xa0, 0x3d, 0x00, 0x00, 0x00, 0x64, 0x00, 0x01, 0x86, 0x64, 0x3c,
    0x35, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

template <std::size_t n>
std::string_view bytes(const std::uint8_t (&array)[n]) {
  return {reinterpret_cast<const char*>(array), n};
}

TEST(HeightPicture, EightBitsSpanTheSameRange) {
  const auto picture = height_picture(bytes(kSmall), "small.png");
  ASSERT_TRUE(picture) << picture.error().message;
  EXPECT_EQ(picture->columns, 2);
  EXPECT_EQ(picture->samples, (std::vector<std::uint16_t>{0, 65535, 128 * 257, 64 * 257}));
}

TEST(HeightPicture, DamageAndColoursAreErrors) {
  const std::string sound = text_in(kSourceFolder + "/config/terrain/hills.png");
  ASSERT_TRUE(height_picture(sound, "hills.png"));
  for (std::size_t size = 0; size < sound.size(); size += 97) {
    const auto cut = height_picture(sound.substr(0, size), "hills.png");
    ASSERT_FALSE(cut) << size;
    EXPECT_EQ(cut.error().message.substr(0, 11), "hills.png: ");
  }
  std::string broken = sound;
  broken[broken.size() / 2] ^= 1;
  EXPECT_FALSE(height_picture(broken, "hills.png"));
  EXPECT_NE(height_picture(bytes(kColours), "c.png").error().message.find("it is not grey"),
            std::string::npos);
  EXPECT_FALSE(height_picture(bytes(kHuge), "huge.png"));
  EXPECT_FALSE(height_picture("", "hills.png"));
  EXPECT_FALSE(load_height_picture(kSourceFolder + "/config"));
}

}  // namespace
}  // namespace gaitpad
