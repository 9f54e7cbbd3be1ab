// Numbers: report 0x30 of dekuNukem's Nintendo_Switch_Reverse_Engineering.
#include "drivers/pads/joy_con_pair.h"

#include <gtest/gtest.h>

#include <deque>

#include "tests/value_of.h"

namespace gaitpad {
namespace {

// One Joy-Con; it gives the reports that the test queues.
class OneSide final : public Device {
 public:
  OneSide(std::uint16_t product, FactorySticks sticks) : sticks_(sticks) {
    info_.vendor = 0x057e;
    info_.product = product;
    info_.name = product == 0x2006 ? "Joy-Con (L)" : "Joy-Con (R)";
    info_.unique_id = product == 0x2006 ? "aa" : "bb";
    fd_.fd = product;
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return {&fd_, 1}; }
  Status read(Report& report) noexcept override {
    if (reports.empty()) return is_gone ? Status::gone : Status::nothing;
    report.size = 49;
    report.bytes.fill(0);
    std::copy(reports.front().begin(), reports.front().end(), report.bytes.begin());
    reports.pop_front();
    return Status::report;
  }
  bool rumble(const Rumble& rumble) noexcept override {
    strong = rumble.strong;
    return true;
  }
  std::optional<FactorySticks> factory_sticks() const override { return sticks_; }

  std::deque<std::vector<std::uint8_t>> reports;
  bool is_gone = false;
  std::uint16_t strong = 0;

 private:
  DeviceInfo info_;
  FactorySticks sticks_;
  pollfd fd_{-1, POLLIN, 0};
};

class JoyCons : public testing::Test {
 protected:
  JoyCons() {
    // As a single one tells them: turned.
    FactorySticks left_sticks, right_sticks;
    left_sticks.left_x = {-0.7, 0.01, 0.6};
    left_sticks.left_y = {-0.5, 0.02, 0.4};
    right_sticks.left_x = {-0.9, 0.03, 0.8};
    right_sticks.left_y = {-0.55, 0.04, 0.45};
    auto left = std::make_unique<OneSide>(0x2006, left_sticks);
    auto right = std::make_unique<OneSide>(0x2007, right_sticks);
    left_ = left.get();
    right_ = right.get();
    pair_ = value_of(join_joy_cons(std::move(right), std::move(left)));
  }
  std::vector<std::uint8_t> next() {
    Report report;
    if (pair_->read(report) != Device::Status::report) return {};
    return {report.bytes.begin(), report.bytes.begin() + 12};
  }
  OneSide* left_;
  OneSide* right_;
  std::unique_ptr<Device> pair_;
};

TEST_F(JoyCons, EachReportHasTheNewestOfBothSides) {
  EXPECT_EQ(pair_->info().product, 0x2008);
  EXPECT_EQ(pair_->info().unique_id, "aa+bb");
  EXPECT_EQ(pair_->poll_fds().size(), 2u);
  // The left one presses minus and its D-pad; what it sends for the right half does not count.
  left_->reports.push_back({0x30, 1, 0x8e, 0xff, 0xff, 0x02, 0x11, 0x22, 0x33, 0xff, 0xff, 0xff});
  const std::vector<std::uint8_t> first = {0x30, 1,    0x8e, 0x00, 0x29, 0x02,
                                           0x11, 0x22, 0x33, 0x00, 0x08, 0x80};
  EXPECT_EQ(next(), first);
  right_->reports.push_back({0x30, 7, 0x8c, 0x08, 0x02, 0xff, 0, 0, 0, 0x44, 0x55, 0x66});
  const std::vector<std::uint8_t> second = {0x30, 7,    0x8c, 0x08, 0x2b, 0x02,
                                            0x11, 0x22, 0x33, 0x44, 0x55, 0x66};
  EXPECT_EQ(next(), second);
  EXPECT_TRUE(next().empty());
}

TEST_F(JoyCons, OtherReportsAreLeftOutBothRumbleAndOneThatIsGoneEndsThePair) {
  left_->reports.push_back({0x3f, 0, 0, 8});
  right_->reports.push_back({0x30, 7, 0x8c, 0x08, 0x00, 0x00, 0, 0, 0, 0x44, 0x55, 0x66});
  EXPECT_EQ(next()[3], 0x08);
  EXPECT_TRUE(pair_->rumble({40000, 0}));
  EXPECT_EQ(left_->strong, 40000);
  EXPECT_EQ(right_->strong, 40000);
  right_->is_gone = true;
  Report report;
  EXPECT_EQ(pair_->read(report), Device::Status::gone);
}

TEST_F(JoyCons, TheSticksAreThoseOfJoyConsHeldUpright) {
  const FactorySticks sticks = pair_->factory_sticks().value();
  EXPECT_DOUBLE_EQ(sticks.left_x.min, -0.5);
  EXPECT_DOUBLE_EQ(sticks.left_y.min, -0.6);
  EXPECT_DOUBLE_EQ(sticks.left_y.centre, -0.01);
  EXPECT_DOUBLE_EQ(sticks.left_y.max, 0.7);
  EXPECT_DOUBLE_EQ(sticks.right_x.min, -0.45);
  EXPECT_DOUBLE_EQ(sticks.right_x.max, 0.55);
  EXPECT_DOUBLE_EQ(sticks.right_y.max, 0.8);
}

TEST(JoyConPairs, TwoOfOneSideAreNoPair) {
  auto joined = join_joy_cons(std::make_unique<OneSide>(0x2006, FactorySticks()),
                              std::make_unique<OneSide>(0x2006, FactorySticks()));
  EXPECT_FALSE(joined);
}

DeviceListing listed(std::uint16_t product, const std::string& node,
                     const std::string& name = "Joy-Con") {
  DeviceListing listing;
  listing.info.vendor = 0x057e;
  listing.info.product = product;
  listing.info.name = name;
  listing.node = node;
  listing.pad_path = "/sys" + node;
  return listing;
}

TEST(JoyConPairs, ALeftAndARightOneThatCanBeOpenedAreListedAsAPair) {
  std::vector<DeviceListing> singles = {listed(0x2006, "/a"), listed(0x2009, "/p"),
                                        listed(0x2007, "/b"), listed(0x2006, "/c")};
  auto pairs = joy_con_pairs(singles);
  ASSERT_EQ(pairs.size(), 1u);
  EXPECT_EQ(pairs[0].node, "/a+/b");
  EXPECT_EQ(pairs[0].parts, (std::vector<std::string>{"/sys/a", "/sys/b"}));
  EXPECT_EQ(pairs[0].info.product, 0x2008);
  singles[2].problem = "/b: permission denied";
  EXPECT_TRUE(joy_con_pairs(singles).empty());
}

TEST(JoyConPairs, NesControllersStaySingleAndTheHalvesOfAGripArePaired) {
  EXPECT_TRUE(joy_con_pairs(
                  {listed(0x2006, "/a", "NES Controller"), listed(0x2007, "/b", "NES Controller")})
                  .empty());
  EXPECT_EQ(
      joy_con_pairs({listed(0x200e, "/a"), listed(0x200e, "/b"), listed(0x200e, "/c")}).size(), 1u);
}

}  // namespace
}  // namespace gaitpad
