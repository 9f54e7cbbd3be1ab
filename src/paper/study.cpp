#include "paper/study.h"

namespace gaitpad {

Result<Study> Study::of(PaperSource source) {
  auto model = walk_model(source.cycle, Character{});
  if (!model) return model.error();
  Study study(std::move(source));
  study.model_ = std::make_shared<const WalkModel>(std::move(*model));
  return study;
}

Result<WalkModel> Study::model_with_legs(double leg_ratio) const {
  Character character;
  character.leg_ratio = leg_ratio;
  return walk_model(source_.cycle, character);
}

const Walk& Study::walk(const std::string& style, IkMode mode) {
  const auto key = std::pair(style, mode);
  if (const auto found = walks_.find(key); found != walks_.end()) return found->second;
  WalkCase what;
  what.model = model_.get();
  what.style = style_of(source_, style);
  what.ik = mode;
  what.end_s = kFigureEnd_s;
  what.keeps_joints = true;
  return walks_.emplace(key, walked(what)).first->second;
}

Ticks Study::figure_stride(const Walk& walk) const {
  return stride_after(walk, kRightSide, kFigureStart_s);
}

}  // namespace gaitpad
