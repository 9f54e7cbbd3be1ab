#include "gaitpad/pad_overrides.h"

#include <gtest/gtest.h>

#include "tests/hid/made_pads.h"

namespace gaitpad {
namespace {

std::string cause(const std::string& text) { return cause_of(parse_pad_file(text, "p.toml")); }

TEST(PadFile, SourcesNameUsagesButtonsBitsAndAlternatives) {
  auto sources = parse_sources("-0001:0031");
  ASSERT_TRUE(sources);
  EXPECT_EQ((*sources)[0].usage, usage::kY);
  EXPECT_TRUE((*sources)[0].reversed);
  sources = parse_sources("button 11 | 000c:0081&4 | 0001:0030/4");
  ASSERT_TRUE(sources);
  ASSERT_EQ(sources->size(), 3u);
  EXPECT_EQ((*sources)[0].usage, 0x0009000bu);
  EXPECT_EQ((*sources)[1].mask, 4u);
  EXPECT_EQ((*sources)[2].occurrence, 4u);
  EXPECT_TRUE(parse_sources("")->empty());
  for (const char* bad : {"x", "button 0", "1", "1:", ":1", "1:10000", "1:2&0", "1:2/0", "a|", "|",
                          "button", "1:2&", "--1:2"}) {
    EXPECT_FALSE(parse_sources(bad)) << bad;
  }
}

TEST(PadFile, BadFilesAreRefusedWithTheirLine) {
  EXPECT_EQ(cause(""), "p.toml:1: there is no [[pad]]");
  EXPECT_EQ(cause("[[pad]]\nstream = true\n").substr(0, 28), "p.toml:2: unknown key \"strea");
  EXPECT_EQ(cause("[[pad]]\n[pad.axes]\nleft_z = \"0001:0032\"\n").substr(0, 29),
            "p.toml:3: unknown key \"left_z");
  EXPECT_EQ(cause("[[pad]]\n[pad.buttons]\na = \"cross\"\n").substr(0, 17), "p.toml:3: \"cross\"");
  EXPECT_EQ(cause("[[pad]]\nvendor = 70000\n").substr(0, 9), "p.toml:2:");
  EXPECT_EQ(
      cause("[[pad]]\nbutton_order = \"sega\"\n"),
      "p.toml:2: unknown button order \"sega\"; one of direct_input, android, top_first, xinput");
  EXPECT_EQ(cause("[[pad]]\n[pad.replace]\nlengths = [3]\ndescriptor = \"c0\"\n").substr(0, 18),
            "p.toml:4: byte 0: ");
  EXPECT_EQ(cause("[[pad]]\n[pad.replace]\nlengths = [3]\n").substr(0, 9), "p.toml:2:");
}

TEST(PadFile, TheFirstMatchByIdsBusAndDriverCounts) {
  const auto pads = parse_pad_file(
      "[[pad]]\nname = \"usb\"\nvendor = 0x45e\nproducts = [0x28e]\ndrivers = [\"usb\"]\n"
      "[[pad]]\nname = \"bt\"\nvendor = 0x45e\nbus = 5\n"
      "[[pad]]\nname = \"all\"\nvendor = 0x45e\n",
      "p.toml");
  ASSERT_TRUE(pads);
  DeviceInfo device;
  EXPECT_EQ(find_override(*pads, device), nullptr);
  device.vendor = 0x45e;
  device.product = 0x28e;
  EXPECT_EQ(find_override(*pads, device)->name, "all") << "no driver named: hidraw";
  device.driver = "usb";
  EXPECT_EQ(find_override(*pads, device)->name, "usb");
  device.product = 0x28f;
  device.bus = BusType::bluetooth;
  EXPECT_EQ(find_override(*pads, device)->name, "bt");
}

TEST(PadFile, VersionsTellWhoArrangedThePad) {
  const auto pads = parse_pad_file(
      "[[pad]]\nname = \"special\"\nversions = [0x8000, 0xffff]\n[[pad]]\nname = \"plain\"\n",
      "p.toml");
  ASSERT_TRUE(pads) << pads.error().message;
  DeviceInfo device;
  device.version = 0x8000;
  EXPECT_EQ(find_override(*pads, device)->name, "special");
  device.version = 0x0111;
  EXPECT_EQ(find_override(*pads, device)->name, "plain");
  EXPECT_EQ(cause("[[pad]]\nversions = [1]\n").substr(0, 9), "p.toml:2:");
  EXPECT_EQ(cause("[[pad]]\nversions = [0, 70000]\n").substr(0, 9), "p.toml:2:");
}

TEST(PadFile, IdsNamePadsOfSeveralVendors) {
  const auto pads = parse_pad_file("[[pad]]\nids = [\"0e8f:0003\", \"2563:0523\"]\n", "p.toml");
  ASSERT_TRUE(pads) << pads.error().message;
  DeviceInfo device;
  device.vendor = 0x2563;
  device.product = 0x0523;
  EXPECT_NE(find_override(*pads, device), nullptr);
  device.product = 0x0003;
  EXPECT_EQ(find_override(*pads, device), nullptr);
  EXPECT_EQ(cause("[[pad]]\nids = [\"0e8f\"]\n"),
            "p.toml:2: \"0e8f\" is no vendor:product such as 054c:0268");
}

}  // namespace
}  // namespace gaitpad
