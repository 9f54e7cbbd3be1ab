// What the guide says: instructions and progress.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stick/guide.h"

namespace gaitpad {
namespace {

const char* control_name(int side, bool is_stick) noexcept {
  if (is_stick) return side == 0 ? "left stick" : "right stick";
  return side == 0 ? "left trigger" : "right trigger";
}

const char* push_text(PushWatch::State state) noexcept {
  switch (state) {
    case PushWatch::State::waiting:
      return "waiting for it";
    case PushWatch::State::out:
      return "hold it";
    case PushWatch::State::held:
      return "now let go";
  }
  return "";
}
double push_share(PushWatch::State state) noexcept {
  switch (state) {
    case PushWatch::State::waiting:
      return 0.0;
    case PushWatch::State::out:
      return 0.3;
    case PushWatch::State::held:
      return 0.7;
  }
  return 0.0;
}

const char* direction_words(GuideStep step) noexcept {
  switch (step) {
    case GuideStep::forward:
      return "FORWARD, away from you";
    case GuideStep::right:
      return "to the RIGHT";
    case GuideStep::back:
      return "BACK, towards you";
    default:
      return "to the LEFT";
  }
}

// How the axes lie under the thumb is learned by the pushes, in later steps.
std::string side_name(const vec2& raw) {
  static constexpr const char* kNames[] = {"right", "front right", "front", "front left",
                                           "left",  "back left",   "back",  "back right"};
  const long eighth = std::lround(atan2(raw.y, raw.x) / (kPi / 4.0));
  return std::string(kNames[(eighth + 8) % 8]) + " by its axes";
}

}  // namespace

std::string CalibrationGuide::instruction() const {
  if (is_full() && step() != GuideStep::done)
    return "This took so long that no more is kept: skip to the end, or repeat the step.";
  const auto which = [](const auto& controls, bool is_stick) -> std::string {
    if (controls.size() != 1) return is_stick ? "each stick" : "each trigger";
    return std::string("the ") + control_name(controls.front().side, is_stick);
  };
  const std::string sticks = which(sticks_, true);
  switch (step()) {
    case GuideStep::rest:
      return fmt::format(
          "Push {} to its rim, let it snap back and wait a second; {} times, to different sides. "
          "Then leave it alone.",
          sticks, kWantedReleases);
    case GuideStep::turn:
      return fmt::format(
          "Turn {} in full circles, pressed outwards along its rim, slowly, until "
          "every direction is seen.",
          sticks);
    case GuideStep::triggers:
      return fmt::format("Press {} fully, hold it a moment, let go.", which(triggers_, false));
    case GuideStep::done:
      return "Done.";
    default:
      return fmt::format("Push {} {}, hold it a moment, let go.", sticks, direction_words(step()));
  }
}

std::vector<GuideProgress> CalibrationGuide::progress() const {
  std::vector<GuideProgress> all;
  if (step() == GuideStep::done) return all;
  if (step() == GuideStep::triggers) {
    for (const Trigger& trigger : triggers_) all.push_back(trigger_progress(trigger));
    return all;
  }
  for (const Stick& stick : sticks_) {
    if (step() == GuideStep::rest) {
      all.push_back(rest_progress(stick));
    } else {
      all.push_back(step() == GuideStep::turn ? turn_progress(stick) : push_progress(stick));
    }
    all.back().control = control_name(stick.side, true);
    all.back().raw = raw(stick);
  }
  return all;
}

GuideProgress CalibrationGuide::rest_progress(const Stick& stick) const {
  const ReleaseWatch& release = stick.release;
  const int count = std::min(release.count(), kWantedReleases);
  const int sides = std::min(release.sides(), kWantedSides);
  const double alone_s = static_cast<double>(release.rested_ns()) / 1e9;
  const double wanted_s = static_cast<double>(kWantedRestNs) / 1e9;
  GuideProgress progress;
  progress.done = 0.9 * (count + sides) / (kWantedReleases + kWantedSides);
  progress.text = fmt::format("{} of {} releases", count, kWantedReleases);
  if (release.is_complete()) {
    progress.done = 1.0;
  } else if (release.is_held()) {
    progress.text += "; it is held, let go";
  } else if (release.is_away()) {
    progress.text += "; let go and wait";
  } else if (count == kWantedReleases && sides < kWantedSides) {
    progress.text += fmt::format("; only from {} of {} sides", sides, kWantedSides);
  } else if (count == kWantedReleases) {
    progress.text += fmt::format("; leave it alone: {:.1f} of {:.1f} s", alone_s, wanted_s);
  }
  return progress;
}

GuideProgress CalibrationGuide::turn_progress(const Stick& stick) const {
  const TurnWatch& turn = stick.turn;
  const double turns = std::min(turn.turns(), kWantedTurns);
  GuideProgress progress;
  progress.done = 0.75 * turn.filled() / kTurnBins + 0.25 * turns / kWantedTurns;
  if (turn.is_complete()) progress.done = 1.0;
  // Rounded down: what is shown as two turns is two turns.
  progress.text = fmt::format("{} of {} directions, {:.1f} of {:.0f} turns", turn.filled(),
                              kTurnBins, std::floor(turns * 10.0) / 10.0, kWantedTurns);
  const std::optional<vec2> missing = turn.missing();
  if (missing && turn.filled() > 0) progress.text += "; not yet: " + side_name(*missing);
  if (missing && turns == kWantedTurns) progress.text += " (Enter goes on without)";
  return progress;
}

GuideProgress CalibrationGuide::push_progress(const Stick& stick) const {
  const auto number =
      static_cast<std::size_t>(step()) - static_cast<std::size_t>(GuideStep::forward);
  if (stick.pushed[number]) return {{}, 1.0, "seen", {}};
  const PushWatch::State state = stick.push.state();
  const bool is_advised = state == PushWatch::State::waiting && !stick.advice.empty();
  return {{}, push_share(state), is_advised ? stick.advice : push_text(state), {}};
}

GuideProgress CalibrationGuide::trigger_progress(const Trigger& trigger) const {
  GuideProgress progress;
  progress.control = control_name(trigger.side, false);
  const PushWatch::State state = trigger.push.state();
  progress.done = trigger.is_done ? 1.0 : push_share(state);
  progress.text = trigger.is_done ? "seen" : push_text(state);
  progress.raw = vec2(tracker_.state().axis[kLeftTrigger + trigger.side], 0.0);
  return progress;
}

}  // namespace gaitpad
