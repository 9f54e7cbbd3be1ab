#include "drivers/effect_table.h"

#include <errno.h>
#include <gtest/gtest.h>

#include <map>
#include <utility>
#include <vector>

namespace gaitpad {
namespace {

// A pad that numbers its effects from 40 on and holds two.
class Pad final : public EffectTarget {
 public:
  int upload(ff_effect& effect) noexcept override {
    if (effect.id < 0 && strong.size() == 2) return ENOSPC;
    if (effect.id < 0) effect.id = next_++;
    strong[effect.id] = effect.u.rumble.strong_magnitude;
    return 0;
  }
  int erase(int id) noexcept override { return strong.erase(id) == 1 ? 0 : EINVAL; }
  int send(std::uint16_t code, std::int32_t value) noexcept override {
    sent.emplace_back(code, value);
    return 0;
  }
  std::map<int, int> strong;  // the strong motor's strength of each effect, by the pad's number
  std::vector<std::pair<int, int>> sent;

 private:
  std::int16_t next_ = 40;
};

ff_effect rumble(int id, int strong) {
  ff_effect effect{};
  effect.type = FF_RUMBLE;
  effect.id = static_cast<std::int16_t>(id);
  effect.u.rumble.strong_magnitude = static_cast<std::uint16_t>(strong);
  return effect;
}

using Sent = std::vector<std::pair<int, int>>;

TEST(EffectTable, TranslatesTheProgramsNumbersIntoThePads) {
  Pad pad;
  EffectTable table;
  table.set_target(&pad);
  EXPECT_EQ(table.upload(rumble(0, 100)), 0);
  EXPECT_EQ(table.upload(rumble(7, 200)), 0);
  EXPECT_EQ(table.upload(rumble(0, 300)), 0) << "changes it in place";
  EXPECT_EQ(pad.strong, (std::map<int, int>{{40, 300}, {41, 200}}));
  table.send(7, 1);
  table.send(7, 0);
  table.send(FF_GAIN, 0x8000);
  EXPECT_EQ(pad.sent, (Sent{{41, 1}, {41, 0}, {FF_GAIN, 0x8000}}));
  EXPECT_EQ(table.erase(0), 0);
  EXPECT_EQ(pad.strong, (std::map<int, int>{{41, 200}}));
  table.send(0, 1);
  EXPECT_EQ(pad.sent.size(), 3u) << "it was erased";
}

TEST(EffectTable, GivesThePadsRefusalToTheProgram) {
  Pad pad;
  EffectTable table;
  table.set_target(&pad);
  EXPECT_EQ(table.upload(rumble(0, 1)), 0);
  EXPECT_EQ(table.upload(rumble(1, 1)), 0);
  EXPECT_EQ(table.upload(rumble(2, 1)), ENOSPC);
  EXPECT_EQ(table.erase(2), EINVAL) << "it was never there";
  EXPECT_EQ(table.upload(rumble(-1, 1)), EINVAL);
  EXPECT_EQ(table.upload(rumble(FF_GAIN, 1)), EINVAL);
  EXPECT_EQ(table.erase(-1), EINVAL);
}

TEST(EffectTable, KeepsEffectsWhileThePadIsUnplugged) {
  Pad first, second;
  EffectTable table;
  table.set_target(&first);
  EXPECT_EQ(table.upload(rumble(3, 100)), 0);
  table.send(FF_GAIN, 0x4000);
  table.set_target(nullptr);
  EXPECT_EQ(table.upload(rumble(3, 500)), 0);
  EXPECT_EQ(table.upload(rumble(4, 600)), 0);
  EXPECT_EQ(table.upload(rumble(5, 700)), 0);
  EXPECT_EQ(table.erase(4), 0);
  table.send(3, 1);
  table.set_target(&second);
  EXPECT_EQ(second.strong, (std::map<int, int>{{40, 500}, {41, 700}}));
  EXPECT_EQ(second.sent, (Sent{{FF_GAIN, 0x4000}})) << "nothing runs by itself";
  EXPECT_EQ(first.strong, (std::map<int, int>{{40, 100}})) << "it is gone";
}

TEST(EffectTable, HandsOnNoMemoryOfAnotherProgram) {
  class Kept final : public EffectTarget {
   public:
    int upload(ff_effect& e) noexcept override {
      effect = e;
      return 0;
    }
    int erase(int) noexcept override { return 0; }
    int send(std::uint16_t, std::int32_t) noexcept override { return 0; }
    ff_effect effect{};
  } pad;
  std::int16_t samples[2] = {1, 2};
  ff_effect wave{};
  wave.type = FF_PERIODIC;
  wave.u.periodic.waveform = FF_SINE;
  wave.u.periodic.magnitude = 99;
  wave.u.periodic.custom_len = 2;
  wave.u.periodic.custom_data = samples;
  EffectTable table;
  table.set_target(&pad);
  EXPECT_EQ(table.upload(wave), 0);
  EXPECT_EQ(pad.effect.u.periodic.magnitude, 99);
  EXPECT_EQ(pad.effect.u.periodic.custom_len, 0u);
  EXPECT_EQ(pad.effect.u.periodic.custom_data, nullptr);
}

}  // namespace
}  // namespace gaitpad
