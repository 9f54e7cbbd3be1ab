#include "pads/stand_in.h"

#include <errno.h>
#include <gtest/gtest.h>
#include <linux/input-event-codes.h>

#include <deque>

namespace gaitpad {
namespace {

using Events = std::vector<VirtualPadEvent>;

// Replaces an event node: X and Y of 8 bits and a button.
struct Node {
  bool is_gone = false, is_grabbed = false, is_open = false;
  int grab_problem = 0;
  std::deque<EvdevState> packets;
  std::vector<int> sent;  // codes of EV_FF that were sent to the pad
};
class FakeNode final : public EventNode {
 public:
  FakeNode(DeviceInfo info, Node& node) : info_(std::move(info)), node_(node) {
    node_.is_open = true;
    EvdevAbilities abilities;
    for (const int code : {ABS_X, ABS_Y})
      abilities.axes.push_back({static_cast<std::uint16_t>(code), 0, 255});
    abilities.keys = {BTN_A};
    layout_ = evdev_layout(abilities, {});
    info_.descriptor = layout_.descriptor;
    info_.driver = "evdev";
  }
  ~FakeNode() override { node_.is_open = node_.is_grabbed = false; }
  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return {}; }
  Status read(Report& report) noexcept override {
    if (node_.packets.empty()) return node_.is_gone ? Status::gone : Status::nothing;
    state_ = node_.packets.front();
    node_.packets.pop_front();
    put_state(layout_, state_, report);
    return Status::report;
  }
  int grab() noexcept override {
    node_.is_grabbed = node_.grab_problem == 0;
    return node_.grab_problem;
  }
  const EvdevState& state() const noexcept override { return state_; }
  const EvdevLayout& layout() const noexcept override { return layout_; }
  std::vector<std::uint16_t> effect_codes() const override { return {FF_RUMBLE, FF_GAIN}; }
  int upload(ff_effect& effect) noexcept override {
    if (effect.id < 0) effect.id = 5;
    return 0;
  }
  int erase(int) noexcept override { return 0; }
  int send(std::uint16_t code, std::int32_t) noexcept override {
    node_.sent.push_back(code);
    return 0;
  }

 private:
  DeviceInfo info_;
  Node& node_;
  EvdevLayout layout_;
  EvdevState state_;
};

// Replaces a virtual pad in the kernel.
struct Made {
  VirtualPadShape shape;
  Events events;
  int count = 0;
  std::vector<ff_effect> uploads;  // effects that a program uploads next
  std::vector<std::uint16_t> plays;
};
class FakeVirtualPad final : public VirtualPad {
 public:
  explicit FakeVirtualPad(Made& made) : made_(made) { ++made_.count; }
  std::string node() const override { return "/dev/input/event99"; }
  bool write(std::span<const VirtualPadEvent> events) noexcept override {
    made_.events.insert(made_.events.end(), events.begin(), events.end());
    return true;
  }
  pollfd fd() const noexcept override { return {-1, POLLIN, 0}; }
  void serve_effects(EffectTable& effects) noexcept override {
    for (const ff_effect& effect : std::exchange(made_.uploads, {}))
      static_cast<void>(effects.upload(effect));
    for (const std::uint16_t code : std::exchange(made_.plays, {})) effects.send(code, 1);
  }

 private:
  Made& made_;
};

struct StandInTest : testing::Test {
  StandIn stand_in(StandIn::Look look) {
    StandIn::Options options;
    options.look = look;
    options.files.calibration = CalibrationFile{};
    options.files.calibration->calibration.left.shape = ZoneShape::axial;
    options.open = [this](const DeviceListing& listing) -> Result<std::unique_ptr<EventNode>> {
      return std::unique_ptr<EventNode>(std::make_unique<FakeNode>(listing.info, node));
    };
    options.create = [this](const VirtualPadShape& shape) -> Result<std::unique_ptr<VirtualPad>> {
      EXPECT_TRUE(node.is_grabbed) << "programs must never see two pads";
      made.shape = shape;
      return std::unique_ptr<VirtualPad>(std::make_unique<FakeVirtualPad>(made));
    };
    return StandIn(std::move(options));
  }
  void SetUp() override {
    listing.node = "/dev/input/event7";
    listing.info.name = "Made Pad";
    listing.info.bus = BusType::usb;
    listing.info.vendor = 0x1209;
    listing.info.product = 0x0001;
    listing.info.version = 0x0111;
    listing.info.physical_path = "usb-1/input0";
  }
  void send(int x, int y, bool a = false) {
    EvdevState state;
    state.axis[ABS_X] = x;
    state.axis[ABS_Y] = y;
    state.keys[BTN_A] = a;
    node.packets.push_back(state);
  }
  DeviceListing listing;
  Node node;
  Made made;
};

TEST_F(StandInTest, LooksLikeThePadAndSendsItsCalibratedStick) {
  StandIn pad = stand_in(StandIn::Look::own);
  EXPECT_TRUE(pad.poll_fds().empty());
  ASSERT_EQ(pad.plug(listing), std::nullopt);
  EXPECT_EQ(made.shape.name, "Made Pad");
  EXPECT_EQ(made.shape.version, 0x0111);
  EXPECT_EQ(made.shape.port, "usb-1/input0");
  EXPECT_EQ(made.shape.effects, (std::vector<std::uint16_t>{FF_RUMBLE, FF_GAIN}));
  send(140, 128);  // a tenth of the way, which is inside the zone
  send(255, 128, true);
  send(255, 128, false);
  pad.serve();
  EXPECT_EQ(made.events, (Events{{EV_ABS, ABS_X, 32767}, {EV_KEY, BTN_A, 1}, {EV_KEY, BTN_A, 0}}))
      << "every packet by itself: no press is missed";
}

// The first button of an unknown pad is assumed to be the left one.
constexpr std::uint16_t kFirstByPlace = BTN_X;

TEST_F(StandInTest, LooksLikeAnXbox360PadIfAsked) {
  StandIn pad = stand_in(StandIn::Look::xbox_360);
  ASSERT_EQ(pad.plug(listing), std::nullopt);
  EXPECT_EQ(made.shape.vendor, 0x045e);
  EXPECT_EQ(made.shape.product, 0x028e);
  EXPECT_EQ(made.shape.keys.size(), 11u);
  EXPECT_EQ(made.shape.effects.size(), 2u);
  send(128, 0, true);
  pad.serve();
  EXPECT_EQ(made.events, (Events{{EV_ABS, ABS_Y, -32767}, {EV_KEY, kFirstByPlace, 1}}));
}

TEST_F(StandInTest, RestsWhileThePadIsGoneAndGoesOnWhenItIsBack) {
  for (const StandIn::Look look : {StandIn::Look::own, StandIn::Look::xbox_360}) {
    node = {};
    made = {};
    StandIn pad = stand_in(look);
    const std::uint16_t button = look == StandIn::Look::own ? BTN_A : kFirstByPlace;
    ASSERT_EQ(pad.plug(listing), std::nullopt);
    send(0, 128, true);
    node.is_gone = true;
    pad.serve();
    EXPECT_FALSE(pad.has_pad());
    EXPECT_FALSE(node.is_open) << "the node of an unplugged pad is closed";
    EXPECT_EQ(made.events, (Events{{EV_ABS, ABS_X, -32767},
                                   {EV_KEY, button, 1},
                                   {EV_ABS, ABS_X, 0},
                                   {EV_KEY, button, 0}}));
    made.events.clear();
    node.is_gone = false;
    ASSERT_EQ(pad.plug(listing), std::nullopt);
    EXPECT_EQ(made.count, 1) << "programs keep the pad that they have";
    send(255, 128);
    pad.serve();
    EXPECT_EQ(made.events, (Events{{EV_ABS, ABS_X, 32767}}));
  }
}

TEST_F(StandInTest, AnotherPadUnderItsOwnNameIsAnotherVirtualPad) {
  StandIn pad = stand_in(StandIn::Look::own);
  ASSERT_EQ(pad.plug(listing), std::nullopt);
  node.is_gone = true;
  pad.serve();
  node.is_gone = false;
  listing.info.name = "Other Pad";
  ASSERT_EQ(pad.plug(listing), std::nullopt);
  EXPECT_EQ(made.count, 2);
  EXPECT_EQ(made.shape.name, "Other Pad");
}

TEST_F(StandInTest, RumbleGoesBackToThePad) {
  StandIn pad = stand_in(StandIn::Look::xbox_360);
  ASSERT_EQ(pad.plug(listing), std::nullopt);
  ff_effect effect{};
  effect.type = FF_RUMBLE;
  effect.id = 0;
  made.uploads = {effect};
  made.plays = {0, FF_GAIN};
  pad.serve();
  EXPECT_EQ(node.sent, (std::vector<int>{5, FF_GAIN})) << "the pad's own number";
}

TEST_F(StandInTest, APadOfAnotherProgramIsLeftAlone) {
  node.grab_problem = EBUSY;
  StandIn pad = stand_in(StandIn::Look::own);
  const auto problem = pad.plug(listing);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->message, "/dev/input/event7: another program has this pad for itself");
  EXPECT_FALSE(node.is_open);
  EXPECT_EQ(made.count, 0);
}

}  // namespace
}  // namespace gaitpad
