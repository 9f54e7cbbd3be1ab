// An engine that drives a walk through the library (docs/control.md): it reads the state and sends
// commands. Replaying its commands gives the same walk without the engine.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "gaitpad/simulation.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

// Walks until it is tired, then limps, rests when it is very tired, and walks again when rested.
class Engine {
 public:
  // The commands when the engine's mood changes; empty if it stays.
  std::vector<std::string> thoughts(const Walker& walker) {
    const Mood mood = mood_of(walker);
    if (mood == mood_) return {};
    mood_ = mood;
    if (mood == Mood::rests) return {"gait speed_m_s 0"};
    if (mood == Mood::limps) return {"style limp"};
    return {"style even", "gait speed_m_s 1.2"};
  }

 private:
  enum class Mood { begins, walks, limps, rests };
  Mood mood_of(const Walker& walker) const {
    if (mood_ == Mood::rests) return walker.tired > 0.02 ? Mood::rests : Mood::walks;
    if (walker.tired > 0.3) return Mood::rests;
    return walker.tired > 0.2 ? Mood::limps : Mood::walks;
  }
  Mood mood_ = Mood::begins;
};

TEST(AiEngine, DrivesByCommandsThatReplayWithoutIt) {
  SimulationConfig config = made_config(1);
  for (Style& style : config.styles) {
    style.fatigue_per_100_m = 8.0;
    style.fatigue_recovery_per_s = 0.2;
  }
  auto driven = Simulation::create(config);
  auto replayed = Simulation::create(config);
  ASSERT_TRUE(driven && replayed);
  struct Said {
    int tick;
    std::string command;
  };
  std::vector<Said> recording;
  Engine engine;
  constexpr int kTicks = 240 * 20;
  for (int tick = 0; tick < kTicks; ++tick) {
    for (const std::string& command : engine.thoughts(driven->walkers()[0])) {
      driven->take_report(made_command(command));
      recording.push_back({tick, command});
    }
    driven->step({});
  }
  EXPECT_GE(recording.size(), 8u);  // the character has walked, limped and rested at least twice
  EXPECT_EQ(driven->counts().bad_commands, 0);
  std::size_t next = 0;
  for (int tick = 0; tick < kTicks; ++tick) {
    for (; next < recording.size() && recording[next].tick == tick; ++next)
      replayed->take_report(made_command(recording[next].command));
    replayed->step({});
  }
  EXPECT_EQ(replayed->pose_hash(), driven->pose_hash());
}

}  // namespace
}  // namespace gaitpad
