// A crowd whose members differ in build, terrain, style and stick.
#pragma once
#include <cmath>
#include <memory>
#include <vector>

#include "gaitpad/clean_strides.h"
#include "gaitpad/control.h"
#include "gaitpad/crowd.h"
#include "gaitpad/hash.h"
#include "tests/value_of.h"

namespace gaitpad {

constexpr int kCrowdRate = 60;
constexpr double kCrowdDt = 1.0 / kCrowdRate;

class MadeCrowd {
 public:
  explicit MadeCrowd(int members) {
    Terrain uneven;
    for (const SectionShape& shape :
         {SectionShape(SlopeSection{2.5, 0.15, 0.5}), SectionShape(StairsSection{0.17, 0.3, 6}),
          SectionShape(FlatSection{2.0}), SectionShape(StairsSection{-0.17, 0.3, 6})}) {
      add_section(uneven, shape);
    }
    const auto ground = std::make_shared<const Terrain>(std::move(uneven));
    const GaitCycle cycle = value_of(with_clean_strides(procedural_gait()));
    std::vector<std::shared_ptr<const WalkModel>> models;
    for (int build = 0; build < 8; ++build) {
      Character character;
      character.leg_ratio = 0.86 + 0.04 * build;
      WalkModel model = value_of(walk_model(cycle, character));
      if (build % 4 == 3) model.terrain = ground;
      models.push_back(std::make_shared<const WalkModel>(std::move(model)));
    }
    StyleValues limp, stiff, carries;
    limp.stride[kLeftSide] = {.length = 0.6, .speed = 1.3, .flight_height = 0.6};
    stiff.weight[kLeftSide][kKneeX] = stiff.weight[kRightSide][kKneeX] = 0.2;
    carries.body.hand[kLeftSide].carry = 1.0;
    carries.body.spine_weight[0] = 0.4;
    styles_ = {StyleValues{}, limp, stiff, carries, StyleValues{}};
    for (int i = 0; i < members; ++i)
      members_.push_back({models[i % 8], vec3(1.2 * (i % 8), 0.0, -1.2 * (i / 8))});
    crowd_ = Crowd(members_);
  }

  Crowd& crowd() { return crowd_; }
  const std::vector<CrowdMember>& members() const { return members_; }

  // Commands all members in this tick. Each begins, turns and rests at other times.
  void command(int tick) {
    for (int i = 0; i < crowd_.size(); ++i) {
      const int t = tick - 7 * i, leg = t / (2 * kCrowdRate);
      Stick stick;
      // Each fourth member goes straight on over its terrain.
      const bool straight_on = i % 8 % 4 == 3;
      if (t > 0 && (straight_on || leg % 5 != 4))
        stick.left = vec2(straight_on ? 0.0 : 0.25 * ((i + leg) % 5 - 2), 0.3 + 0.15 * (i % 5));
      if (i % 16 == 5 && leg % 5 == 2) stick.left.y = -0.6;
      crowd_.params()[i] =
          gait_params(stick, styles_[i % styles_.size()], gait_limits(crowd_.model(i)));
    }
  }
  void step(int tick) {
    command(tick);
    crowd_.advance(kCrowdDt);
  }
  void add_to(WordHash& hash) const {
    for (int i = 0; i < crowd_.size(); ++i) {
      for (int a = 0; a < 3; ++a) hash.add(crowd_.root_m(i)[a]);
      for (const quat& q : crowd_.local(i)) {
        hash.add(q.w), hash.add(q.x), hash.add(q.y), hash.add(q.z);
      }
    }
  }

 private:
  std::vector<CrowdMember> members_;
  std::vector<StyleValues> styles_;
  Crowd crowd_;
};

}  // namespace gaitpad
