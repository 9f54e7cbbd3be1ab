#include "session/undo.h"

#include <fmt/format.h>

#include <algorithm>

#include "gaitpad/control.h"
#include "gaitpad/style.h"
#include "session/script.h"

namespace gaitpad {
namespace {

using Verb = Command::Verb;

constexpr std::int64_t kOneDrag = 120;  // ticks between two commands of one drag, at most

void give_back_gait(int walker, GaitKey key, const GaitOverrides& before,
                    std::vector<std::string>& out) {
  const auto k = static_cast<std::size_t>(key);
  const std::string_view name = info_of(key).name;
  out.push_back(before.is_set[k] ? fmt::format("gait {} {} {}", walker, name, before.value[k])
                                 : fmt::format("gait {} {} stick", walker, name));
}

// Restores the style and the values that were changed in it.
void give_back_style(int walker, const WalkerFrame& before, const Cast& cast,
                     std::vector<std::string>& out) {
  const auto style = static_cast<std::size_t>(before.style_index);
  if (before.style_index < 0 || style >= cast.styles.size()) return;
  out.push_back(fmt::format("style {} {}", walker, cast.styles[style]));
  if (style >= cast.style_values.size()) return;
  for (const StyleKey& key : style_keys()) {
    const auto own = value_of(cast.style_values[style], key.name);
    const auto now = value_of(before.style, key.name);
    if (own && now && *own != *now)
      out.push_back(fmt::format("set {} {} {}", walker, key.name, *now));
  }
}

void give_back(const Command& command, int walker, const WalkerFrame& before, const Cast& cast,
               std::vector<std::string>& out) {
  switch (command.verb) {
    case Verb::style:
      return give_back_style(walker, before, cast, out);
    case Verb::set:
      if (const auto now = value_of(before.style, command.name))
        out.push_back(fmt::format("set {} {} {}", walker, command.name, *now));
      return;
    case Verb::gait:
    case Verb::release:
      if (const auto key = gait_key(command.name))
        give_back_gait(walker, *key, before.overrides, out);
      return;
    case Verb::stick:
      for (int k = 0; k < kGaitKeys; ++k) {
        if (before.overrides.is_set[static_cast<std::size_t>(k)])
          give_back_gait(walker, static_cast<GaitKey>(k), before.overrides, out);
      }
      return;
    case Verb::mark:
    case Verb::steers:
    case Verb::points:
    case Verb::restart:
    case Verb::ik:
      return;
  }
}

// A key that is equal for all commands of one drag.
std::string what_of(std::string_view command) {
  const auto parsed = parsed_command(command);
  if (!parsed || (parsed->verb != Verb::set && parsed->verb != Verb::gait)) return {};
  return fmt::format("{} {} {}", static_cast<int>(parsed->verb), parsed->walker, parsed->name);
}

}  // namespace

std::vector<std::string> opposite_of(std::string_view text, const SessionFrame& frame,
                                     const Cast& cast) {
  std::vector<std::string> back;
  const auto command = parsed_command(text);
  if (!command) return back;
  if (command->verb == Verb::ik)
    return {fmt::format("ik {}", kIkNames[static_cast<std::size_t>(frame.ik)])};
  for (int walker = 1; walker <= frame.walker_count; ++walker) {
    if (command->walker != 0 && command->walker != walker) continue;
    give_back(*command, walker, frame.walkers[static_cast<std::size_t>(walker - 1)], cast, back);
  }
  return back;
}

void UndoList::add(const std::string& command, const SessionFrame& frame, const Cast& cast) {
  std::vector<std::string> back = opposite_of(command, frame, cast);
  if (back.empty()) return;
  changes_.resize(done_);
  const std::string what = what_of(command);
  if (!changes_.empty() && !what.empty() && changes_.back().what == what &&
      frame.tick - changes_.back().tick <= kOneDrag) {
    changes_.back().again = {command};
    changes_.back().tick = frame.tick;
    return;
  }
  if (changes_.size() == kMost) changes_.erase(changes_.begin());
  changes_.push_back({std::move(back), {command}, what, frame.tick});
  done_ = changes_.size();
}

std::vector<std::string> UndoList::undo() {
  if (done_ == 0) return {};
  changes_[done_ - 1].what.clear();  // the next drag is a separate change
  return changes_[--done_].back;
}

std::vector<std::string> UndoList::redo() {
  if (done_ == changes_.size()) return {};
  return changes_[done_++].again;
}

void UndoList::clear() {
  changes_.clear();
  done_ = 0;
}

}  // namespace gaitpad
