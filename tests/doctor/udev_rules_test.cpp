#include "doctor/udev_rules.h"

#include <gtest/gtest.h>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

constexpr std::uint16_t kUsb = 3, kBluetooth = 5;
constexpr RuleSubject kDualSense = {kUsb, 0x054c, 0x0ce6, std::nullopt};

TEST(UdevRules, ALineLetsInTheDevicesThatAllOfItsKeysFit) {
  const std::string rules =
      "# SUBSYSTEM==\"hidraw\", KERNELS==\"*:1209:*\", MODE=\"0660\"\n"
      "SUBSYSTEM==\"usb\", KERNELS==\"*:045E:*\"\n"
      "SUBSYSTEM==\"hidraw\", KERNELS==\"*:054C:0CE6.*|*:054C:09CC.*\", MODE=\"0660\"\n"
      "SUBSYSTEM==\"hidraw\", KERNELS==\"0005:*\", KERNELS==\"*:057E:*\", MODE=\"0660\"\n";
  EXPECT_TRUE(opens_hidraw(rules, kDualSense));
  EXPECT_TRUE(opens_hidraw(rules, {kBluetooth, 0x054c, 0x09cc, std::nullopt}));
  EXPECT_FALSE(opens_hidraw(rules, {kUsb, 0x054c, 0x05c4, std::nullopt})) << "another model";
  EXPECT_TRUE(opens_hidraw(rules, {kBluetooth, 0x057e, 0x2009, std::nullopt}));
  EXPECT_FALSE(opens_hidraw(rules, {kUsb, 0x057e, 0x2009, std::nullopt})) << "one key of two";
  EXPECT_FALSE(opens_hidraw(rules, {kUsb, 0x1209, 0x0001, std::nullopt})) << "a comment";
  EXPECT_FALSE(opens_hidraw(rules, {kUsb, 0x045e, 0x028e, std::nullopt})) << "no hidraw node";
  EXPECT_FALSE(opens_hidraw("", kDualSense));
}

TEST(UdevRules, ALineForAModelOpensThatModelAndNamesItsInterface) {
  EXPECT_TRUE(opens_hidraw(hidraw_rule(kDualSense), kDualSense));
  EXPECT_FALSE(opens_hidraw(hidraw_rule(kDualSense), {kUsb, 0x054c, 0x0ce7, std::nullopt}));
  RuleSubject third = kDualSense;
  third.interface = 3;
  EXPECT_NE(hidraw_rule(third).find("DEVPATH==\"*.3/0003:*\""), std::string::npos);
  EXPECT_NE(usb_rule(kDualSense).find("ATTR{idVendor}==\"054c\", ATTR{idProduct}==\"0ce6\""),
            std::string::npos);
}

TEST(UdevRules, TheShippedFileIsTheFirstFoldersThatHasIt) {
  const OwnFolder folder;
  folder.write("b/udev/60-gaitpad.rules", "# mine\n");
  const std::string a = folder.at("a"), b = folder.at("b");
  const auto found = shipped_rules({a, b});
  ASSERT_TRUE(found);
  EXPECT_EQ(found->text, "# mine\n");
  EXPECT_FALSE(shipped_rules({a}));
  EXPECT_FALSE(shipped_rules({a, b}, kUinputRules)) << "another file";
}

}  // namespace
}  // namespace gaitpad
