#include "session/history.h"

namespace gaitpad {
namespace {

bool lands_right(const WalkerSample& before, const WalkerSample& now) noexcept {
  return now.stage == Stage::roll && now.swing == kRightSide &&
         !(before.stage == Stage::roll && before.swing == kRightSide);
}

}  // namespace

void History::add(const TickSample& sample) {
  const bool follows = size_ > 0 && sample.tick == (*this)[size_ - 1].tick + 1 &&
                       sample.walker_count == (*this)[size_ - 1].walker_count;
  if (!follows) size_ = 0;
  if (size_ == samples_.size()) {
    begin_ = (begin_ + 1) % samples_.size();
    --size_;
  }
  samples_[(begin_ + size_) % samples_.size()] = sample;
  ++size_;
}

History::Span History::newest_cycles(int walker, int cycles) const noexcept {
  const Span none{size_, size_};
  if (size_ == 0 || walker < 0 || walker >= (*this)[0].walker_count || cycles < 1) return none;
  const auto sample = [this, walker](std::size_t i) -> const WalkerSample& {
    return (*this)[i].walkers[static_cast<std::size_t>(walker)];
  };
  int landings = 0;
  std::size_t end = size_;
  for (std::size_t i = size_ - 1; i > 0; --i) {
    if (sample(i).stage == Stage::idle) landings = 0;
    if (!lands_right(sample(i - 1), sample(i))) continue;
    if (landings == 0) end = i;
    if (landings == cycles) return {i, end};
    ++landings;
  }
  return none;
}

}  // namespace gaitpad
