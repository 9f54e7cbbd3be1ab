#include "stick/guide.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace gaitpad {
namespace {

// Longer silence tells no more, and costs no time.
constexpr std::int64_t kLongestHoldNs = 5000 * kMillisecondNs;

// Of the larger part of a push to the smaller: 30 degrees off.
constexpr double kClearRatio = 1.7;

constexpr int kPushes = 4;
constexpr GuideStep kFirstPush = GuideStep::forward;
const std::array<vec2, kPushes> kAsked = {vec2(0.0, 1.0), vec2(1.0, 0.0), vec2(0.0, -1.0),
                                          vec2(-1.0, 0.0)};

bool is_push(GuideStep step) noexcept {
  return step >= GuideStep::forward && step <= GuideStep::left;
}
std::size_t push_of(GuideStep step) noexcept {
  return static_cast<std::size_t>(step) - static_cast<std::size_t>(kFirstPush);
}

// The raw axis along which it goes; none: not clear.
std::optional<RawDirection> direction_of(const vec2& push) noexcept {
  const double x = std::fabs(push.x), y = std::fabs(push.y);
  if (x > 0.0 && x >= kClearRatio * y)
    return push.x > 0.0 ? RawDirection::plus_x : RawDirection::minus_x;
  if (y > 0.0 && y >= kClearRatio * x)
    return push.y > 0.0 ? RawDirection::plus_y : RawDirection::minus_y;
  return std::nullopt;
}

RawDirection opposite(RawDirection direction) noexcept {
  switch (direction) {
    case RawDirection::plus_x:
      return RawDirection::minus_x;
    case RawDirection::minus_x:
      return RawDirection::plus_x;
    case RawDirection::plus_y:
      return RawDirection::minus_y;
    case RawDirection::minus_y:
      return RawDirection::plus_y;
  }
  return direction;
}

// Whether two pushes that were asked for, number `a` and `b` of kAsked, can be of one stick.
bool fits(const vec2& push_a, std::size_t a, const vec2& push_b, std::size_t b) noexcept {
  const auto one = direction_of(push_a), other = direction_of(push_b);
  if (!one || !other) return true;
  if ((a + b) % 2 == 1) return is_along_x(*one) != is_along_x(*other);
  return a == b ? *one == *other : *one == opposite(*other);
}

template <typename Sample>
void join(std::vector<std::vector<Sample>>& tracks, const std::vector<std::vector<Sample>>& more,
          bool continues) {
  auto next = more.begin();
  if (continues && !tracks.empty() && next != more.end()) {
    tracks.back().insert(tracks.back().end(), next->begin(), next->end());
    ++next;
  }
  tracks.insert(tracks.end(), next, more.end());
}

void join(PadTracks& tracks, const PadTracks& more, bool continues) {
  for (std::size_t side = 0; side < 2; ++side) {
    join(tracks.stick[side], more.stick[side], continues);
    join(tracks.trigger[side], more.trigger[side], continues);
  }
}

}  // namespace

const char* name_of(GuideStep step) noexcept {
  switch (step) {
    case GuideStep::rest:
      return "rest";
    case GuideStep::turn:
      return "turning";
    case GuideStep::forward:
      return "push forward";
    case GuideStep::right:
      return "push right";
    case GuideStep::back:
      return "push back";
    case GuideStep::left:
      return "push left";
    case GuideStep::triggers:
      return "triggers";
    case GuideStep::done:
      return "done";
  }
  return "";
}

CalibrationGuide::CalibrationGuide(const PadLayout& layout) : tracker_(layout) {
  for (int side = 0; side < 2; ++side) {
    if (has_stick(layout, side)) sticks_.emplace_back().side = side;
    if (has_trigger(layout, side)) triggers_.emplace_back().side = side;
  }
  if (!sticks_.empty()) {
    steps_ = {GuideStep::rest,  GuideStep::turn, GuideStep::forward,
              GuideStep::right, GuideStep::back, GuideStep::left};
    if (!triggers_.empty()) steps_.push_back(GuideStep::triggers);
  }
  steps_.push_back(GuideStep::done);
}

void CalibrationGuide::take(const Report& report) {
  if (report.kind == ReportKind::removed) unplugged();
  if (report.kind != ReportKind::input || step() == GuideStep::done || is_full()) return;
  advance(report.time_ns);
  if (step() == GuideStep::done || !tracker_.take(report)) return;
  if (running_reports_ == 0) continues_ = !is_cut_;
  is_cut_ = false;
  ++running_reports_;
  ++reports_;
  if (!std::exchange(is_placed_, true)) time_ns_ = report.time_ns;
  if (step() != GuideStep::turn) return;
  for (Stick& stick : sticks_) stick.turn.take(from_rest(stick), stick.release.rim());
  if (is_complete()) finish_step();
}

void CalibrationGuide::tick(std::int64_t now_ns) {
  if (!is_full()) advance(now_ns);
}

void CalibrationGuide::unplugged() noexcept {
  tracker_.cut();
  is_cut_ = true;
  is_placed_ = false;
  for (Stick& stick : sticks_) {
    stick.release.lose();
    stick.turn.lose();
    stick.push.lose();
  }
  for (Trigger& trigger : triggers_) {
    trigger.push.lose();
    trigger.level = StillWatch();
  }
}

// The controls have stood where they are from the last moment to this one.
void CalibrationGuide::advance(std::int64_t now_ns) {
  if (!is_placed_ || now_ns <= time_ns_ || step() == GuideStep::done) return;
  // Both are stamps of a clock, but a recording's may be any.
  const std::uint64_t passed_ns =
      static_cast<std::uint64_t>(now_ns) - static_cast<std::uint64_t>(time_ns_);
  const auto duration_ns =
      static_cast<std::int64_t>(std::min(passed_ns, static_cast<std::uint64_t>(kLongestHoldNs)));
  time_ns_ = now_ns;
  for (Stick& stick : sticks_) hold(stick, duration_ns);
  for (Trigger& trigger : triggers_) hold(trigger, duration_ns);
  if (is_complete()) finish_step();
}

void CalibrationGuide::hold(Stick& stick, std::int64_t duration_ns) {
  if (step() == GuideStep::rest) stick.release.hold(raw(stick), duration_ns);
  stick.push.hold(from_rest(stick), stick.release.rim(), duration_ns);
  const std::optional<vec2> push = stick.push.take_push();
  if (push && is_push(step())) take_push(stick, *push);
}

void CalibrationGuide::hold(Trigger& trigger, std::int64_t duration_ns) {
  const double value = tracker_.state().axis[kLeftTrigger + trigger.side];
  trigger.level.hold(vec2(value, 0.0), duration_ns);
  if (trigger.level.still_ns() > 0) {
    const double level = trigger.level.mean().x;
    trigger.released = std::min(trigger.released.value_or(level), level);
  }
  trigger.push.hold(vec2(value - trigger.released.value_or(0.0), 0.0), kHalfWay, duration_ns);
  if (trigger.push.take_push() && step() == GuideStep::triggers) trigger.is_done = true;
}

void CalibrationGuide::take_push(Stick& stick, const vec2& push) {
  const std::size_t number = push_of(step());
  if (stick.pushed[number]) return;  // the other stick is still at it
  if (!direction_of(push)) {
    stick.advice = "that was between two directions, hold it straighter";
    return;
  }
  for (std::size_t other = 0; other < number; ++other) {
    if (!stick.pushed[other] || fits(*stick.pushed[other], other, push, number)) continue;
    const auto before = static_cast<GuideStep>(static_cast<std::size_t>(kFirstPush) + other);
    stick.advice = std::string("that contradicts \"") + name_of(before) +
                   "\": once more, or back to that step";
    return;
  }
  stick.advice.clear();
  stick.pushed[number] = push;
}

vec2 CalibrationGuide::raw(const Stick& stick) const noexcept {
  const auto& axis = tracker_.state().axis;
  const auto x = static_cast<std::size_t>(2 * stick.side);
  return {axis[x], axis[x + 1]};
}

vec2 CalibrationGuide::from_rest(const Stick& stick) const noexcept {
  return raw(stick) - stick.release.rest().value_or(vec2(0.0));
}

bool CalibrationGuide::is_complete() const noexcept {
  switch (step()) {
    case GuideStep::rest:
      return std::ranges::all_of(sticks_,
                                 [](const Stick& stick) { return stick.release.is_complete(); });
    case GuideStep::turn:
      return std::ranges::all_of(sticks_,
                                 [](const Stick& stick) { return stick.turn.is_complete(); });
    case GuideStep::triggers:
      return std::ranges::all_of(triggers_, &Trigger::is_done);
    case GuideStep::done:
      return false;
    default:
      break;
  }
  const std::size_t number = push_of(step());
  return std::ranges::all_of(
      sticks_, [number](const Stick& stick) { return stick.pushed[number].has_value(); });
}

void CalibrationGuide::finish_step() {
  pieces_.push_back({step(), continues_, running_reports_, tracker_.take_tracks()});
  running_reports_ = 0;
  ++index_;
  for (Stick& stick : sticks_) stick.push.restart();
  for (Trigger& trigger : triggers_) trigger.push.restart();
}

// Forgets what was seen in the running step.
void CalibrationGuide::drop_step() noexcept {
  tracker_.take_tracks();
  reports_ -= std::exchange(running_reports_, 0);
  is_cut_ = true;
  for (Stick& stick : sticks_) {
    if (step() == GuideStep::rest) stick.release.restart();
    if (step() == GuideStep::turn) stick.turn.restart();
    if (is_push(step())) stick.pushed[push_of(step())].reset();
    stick.push.restart();
    stick.advice.clear();
  }
  for (Trigger& trigger : triggers_) {
    trigger.push.restart();
    if (step() == GuideStep::triggers) trigger.is_done = false;
  }
}

void CalibrationGuide::skip() {
  if (step() == GuideStep::done) return;
  for (Stick& stick : sticks_) stick.advice.clear();
  finish_step();
}

void CalibrationGuide::repeat() { drop_step(); }

void CalibrationGuide::back() {
  drop_step();
  if (index_ == 0) return;
  --index_;
  reports_ -= pieces_.back().reports;
  pieces_.pop_back();
  drop_step();
}

PadTracks CalibrationGuide::tracks() const {
  PadTracks tracks;
  for (const Piece& piece : pieces_) join(tracks, piece.tracks, piece.continues);
  join(tracks, tracker_.tracks(), continues_);
  return tracks;
}

StickFrame CalibrationGuide::frame(int side) const {
  std::vector<vec2> pushes, asked;
  for (const Stick& stick : sticks_) {
    for (std::size_t i = 0; stick.side == side && i < kPushes; ++i) {
      if (!stick.pushed[i]) continue;
      pushes.push_back(*stick.pushed[i]);
      asked.push_back(kAsked[i]);
    }
  }
  return frame_of_pushes(pushes, asked).value_or(StickFrame{});
}

std::optional<StickFrame> frame_of_pushes(std::span<const vec2> pushes,
                                          std::span<const vec2> asked) {
  std::optional<RawDirection> right, forward;
  for (std::size_t i = 0; i < std::min(pushes.size(), asked.size()); ++i) {
    const std::optional<RawDirection> went = direction_of(pushes[i]), wish = direction_of(asked[i]);
    if (!went || !wish) continue;
    const RawDirection told = is_negative(*wish) ? opposite(*went) : *went;
    std::optional<RawDirection>& known = is_along_x(*wish) ? right : forward;
    if (known && *known != told) return std::nullopt;
    known = told;
  }
  if (!right || !forward || is_along_x(*right) == is_along_x(*forward)) return std::nullopt;
  return StickFrame{*right, *forward};
}

}  // namespace gaitpad
