#include "session/undo.h"

#include "tests/walking_fixture.h"

namespace gaitpad {
namespace {

using Commands = std::vector<std::string>;

// Two characters; commands go through the undo list, as in the window.
class Undo : public WalkingTest {
 protected:
  void SetUp() override {
    start({"even", "limp_left"});
    step(2);
  }
  void send(const std::string& command) {
    undo_.add(command, *frame, cast);
    step(2, {command});
  }
  double value(int walker, const char* key) const {
    return *value_of(frame->walkers[static_cast<std::size_t>(walker)].style, key);
  }
  std::string style(int walker) const {
    const int index = frame->walkers[static_cast<std::size_t>(walker)].style_index;
    return cast.styles[static_cast<std::size_t>(index)];
  }
  bool is_overridden(int walker, GaitKey key) const {
    const auto& set = frame->walkers[static_cast<std::size_t>(walker)].overrides.is_set;
    return set[static_cast<std::size_t>(key)];
  }

  UndoList undo_;
};

TEST_F(Undo, ASliderGoesBackForEachCharacterToItsOwnValue) {
  send("set left_leg.stride_length 1.2");
  EXPECT_EQ(value(0, "left_leg.stride_length"), 1.2);
  step(2, undo_.undo());
  EXPECT_EQ(value(0, "left_leg.stride_length"), 1.0);
  EXPECT_EQ(value(1, "left_leg.stride_length"), 0.5);  // the style limp_left has this value
  step(2, undo_.redo());
  EXPECT_EQ(value(0, "left_leg.stride_length"), 1.2);
  EXPECT_EQ(value(1, "left_leg.stride_length"), 1.2);
}

TEST_F(Undo, ADragIsOneChangeAndTheNextDragAnother) {
  for (const char* command : {"set 1 fatigue 0.1", "set 1 fatigue 0.2", "set 1 fatigue 0.3"}) {
    send(command);
  }
  step(200);
  send("set 1 fatigue 0.8");
  step(2, undo_.undo());
  EXPECT_EQ(value(0, "fatigue"), 0.3);
  step(2, undo_.undo());
  EXPECT_EQ(value(0, "fatigue"), 0.0);
  EXPECT_TRUE(undo_.undo().empty());
}

TEST_F(Undo, AStyleComesBackWithWhatWasChangedOfIt) {
  send("set 2 hip_sway 0.4");
  step(200);
  send("style 2 even");
  EXPECT_EQ(style(1), "even");
  step(2, undo_.undo());
  EXPECT_EQ(style(1), "limp_left");
  EXPECT_EQ(value(1, "hip_sway"), 0.4);
  EXPECT_EQ(style(0), "even") << "the other character keeps its own";
}

TEST_F(Undo, OverridesComeBackAndGoBackToTheStick) {
  send("gait 1 speed_m_s 0.7");
  step(200);
  send("gait stick");
  EXPECT_FALSE(is_overridden(0, GaitKey::speed_m_s));
  step(2, undo_.undo());
  EXPECT_TRUE(is_overridden(0, GaitKey::speed_m_s));
  step(2, undo_.undo());
  EXPECT_FALSE(is_overridden(0, GaitKey::speed_m_s));
}

TEST_F(Undo, ANewChangeForgetsWhatWasUndone) {
  send("set 1 fatigue 0.5");
  step(2, undo_.undo());
  send("style 1 tired");
  EXPECT_TRUE(undo_.redo().empty());
  EXPECT_EQ(undo_.undo(), (Commands{"style 1 even"}));
}

TEST_F(Undo, WhatChangesNothingOfACharacterIsNoChange) {
  for (const char* command :
       {"mark", "reset", "set", "foo", "style 7 even", "set 1 no_such_key 1"}) {
    undo_.add(command, *frame, cast);
    EXPECT_TRUE(undo_.undo().empty()) << command;
  }
}

}  // namespace
}  // namespace gaitpad
