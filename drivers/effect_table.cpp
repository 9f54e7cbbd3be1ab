#include "drivers/effect_table.h"

#include <errno.h>

namespace gaitpad {

void EffectTable::set_target(EffectTarget* target) noexcept {
  target_ = target;
  for (auto& entry : entries_) {
    if (!entry) continue;
    entry->id_on_target = -1;
    // A pad that refuses an effect stays without it.
    if (target_ != nullptr) static_cast<void>(upload_to_target(*entry));
  }
  if (target_ != nullptr && gain_) static_cast<void>(target_->send(FF_GAIN, *gain_));
}

int EffectTable::upload_to_target(Entry& entry) noexcept {
  ff_effect effect = entry.effect;
  effect.id = static_cast<std::int16_t>(entry.id_on_target);
  const int problem = target_->upload(effect);
  if (problem == 0) entry.id_on_target = effect.id;
  return problem;
}

int EffectTable::upload(const ff_effect& effect) noexcept {
  if (effect.id < 0 || effect.id >= FF_GAIN) return EINVAL;
  auto& entry = entries_[static_cast<std::size_t>(effect.id)];
  Entry next = entry.value_or(Entry{});
  next.effect = effect;
  if (effect.type == FF_PERIODIC) {  // a wave's samples are in the memory of another program
    next.effect.u.periodic.custom_len = 0;
    next.effect.u.periodic.custom_data = nullptr;
  }
  const int problem = target_ != nullptr ? upload_to_target(next) : 0;
  if (problem == 0) entry = next;
  return problem;
}

int EffectTable::erase(int id) noexcept {
  if (id < 0 || id >= FF_GAIN || !entries_[static_cast<std::size_t>(id)]) return EINVAL;
  auto& entry = entries_[static_cast<std::size_t>(id)];
  const int id_on_target = entry->id_on_target;
  entry.reset();
  return target_ != nullptr && id_on_target >= 0 ? target_->erase(id_on_target) : 0;
}

void EffectTable::send(std::uint16_t code, std::int32_t value) noexcept {
  if (code == FF_GAIN) gain_ = value;
  if (target_ == nullptr) return;
  if (code >= FF_GAIN) {
    static_cast<void>(target_->send(code, value));
  } else if (const auto& entry = entries_[code]; entry && entry->id_on_target >= 0) {
    static_cast<void>(target_->send(static_cast<std::uint16_t>(entry->id_on_target), value));
  }
}

}  // namespace gaitpad
