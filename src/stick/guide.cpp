#include "stick/guide.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/numeric.h"

namespace gaitpad {

// ---- Watching one control

namespace {

constexpr std::int64_t kBucketNs = 100 * kMillisecondNs;
// Limit on the raw distance of two means over 0.1 s: 3 sigma of a very noisy stick.
constexpr double kStillWithin = 0.04;
// A shorter movement is a spike: wrong reports, at most three, between right ones.
constexpr std::int64_t kSpikeNs = 40 * kMillisecondNs;

constexpr std::int64_t kStillNs = 500 * kMillisecondNs;
constexpr std::int64_t kNearNs = 1500 * kMillisecondNs;
constexpr double kAway = 0.3;  // distance from the rest at which a stick is pushed
// Distance from the middle at which a stick is pushed, while its rest is not known.
constexpr double kAwayUnknown = 0.5;
// Greatest distance of a rest from the middle; farther out a stick is held.
constexpr double kFarthestRest = 0.45;
constexpr std::size_t kMaxRests = 64;  // places of further releases are ignored
// A rest this far from the middle is rare, so more releases are asked for.
constexpr double kAside = 0.1;

constexpr double kRimOfReach = 0.6;  // share of the stick's farthest distance
// Below this share a direction counts as not seen, because a corner was cut; the sides of a square
// gate have 0.71 of its corners.
constexpr double kLeastOfMedianRadius = 0.6;
// Limits of the travel between two reports along the rim: less is noise, more is a spike.
constexpr double kLeastTravel = 15.0 * kDegree, kMostTravel = 90.0 * kDegree;

constexpr double kUnpressed = 0.1;  // raw; a turn that stays this far inside of a push was not
                                    // pressed to the rim

constexpr std::int64_t kHeldNs = 250 * kMillisecondNs;
constexpr double kReleasedOfRim = 0.6;  // share of the rim's distance; nearer it is released

// 0 right, 1 front, 2 left, 3 back.
std::size_t quarter_of(const vec2& v) noexcept {
  if (std::fabs(v.x) >= std::fabs(v.y)) return v.x >= 0.0 ? 0 : 2;
  return v.y >= 0.0 ? 1 : 3;
}

}  // namespace

void StillWatch::hold(const vec2& raw, std::int64_t duration_ns) noexcept {
  while (duration_ns > 0) {
    const std::int64_t part_ns = std::min(duration_ns, kBucketNs - sum_ns_);
    sum_ += raw * static_cast<double>(part_ns);
    sum_ns_ += part_ns;
    duration_ns -= part_ns;
    if (sum_ns_ < kBucketNs) return;
    const vec2 mean = sum_ / static_cast<double>(kBucketNs);
    sum_ = vec2(0.0);
    sum_ns_ = 0;
    if (!(glm::distance(mean, mean_) <= kStillWithin)) still_ns_ = 0;
    const auto buckets = static_cast<double>(still_ns_ / kBucketNs);
    mean_ = (mean_ * buckets + mean) / (buckets + 1.0);
    still_ns_ += kBucketNs;
  }
}

void ReleaseWatch::hold(const vec2& raw, std::int64_t duration_ns) {
  still_.hold(raw, duration_ns);
  const vec2 from_rest = raw - rest_.value_or(vec2(0.0));
  if (glm::length(from_rest) > (rest_ ? kAway : kAwayUnknown)) {
    away_ns_ += duration_ns;
    away_ = from_rest;
    if (away_ns_ > kSpikeNs) {
      if (!is_away_) still_ = StillWatch();  // forget where it stood before this push
      reach_ = std::max(reach_, glm::length(from_rest));
      is_away_ = true;
      near_ns_ = 0;
      near_sum_ = vec2(0.0);
    }
  } else {
    away_ns_ = 0;
    near_ns_ += duration_ns;
    near_sum_ += raw * static_cast<double>(duration_ns);
  }
  if (is_back()) add_release();
  if (count() >= wanted() && sides() >= kWantedSides && near_ns_ >= kWantedRestNs)
    is_complete_ = true;
}

bool ReleaseWatch::is_aside() const noexcept { return rest_ && glm::length(*rest_) >= kAside; }

int ReleaseWatch::wanted() const noexcept {
  return is_aside() ? kWantedReleasesAside : kWantedReleases;
}

bool ReleaseWatch::is_held() const noexcept {
  return is_away_ && still_.still_ns() >= kStillNs && !is_back();
}

bool ReleaseWatch::is_back() const noexcept {
  if (near_ns_ >= kNearNs && away_ns_ == 0) return true;
  if (still_.still_ns() < kStillNs || !(glm::length(still_.mean()) < kFarthestRest)) return false;
  // One rest may be a stick that was held; from two rests on the place is known.
  return rests_.size() < 2 || glm::distance(still_.mean(), *rest_) < kAway;
}

void ReleaseWatch::add_release() {
  const bool is_still = still_.still_ns() >= kStillNs;
  const vec2 place = is_still ? still_.mean() : near_sum_ / static_cast<double>(near_ns_);
  if (!is_away_) {
    if (rests_.empty()) rest_ = place;
    return;
  }
  is_away_ = false;
  away_ns_ = 0;
  sides_[quarter_of(away_)] = true;
  if (rests_.size() < kMaxRests) rests_.push_back(place);
  rest_ = median_of(rests_);
}

void ReleaseWatch::restart() {
  rests_.clear();
  sides_ = {};
  is_complete_ = false;
  lose();
}

void ReleaseWatch::lose() noexcept {
  still_ = StillWatch();
  away_ns_ = near_ns_ = 0;
  near_sum_ = vec2(0.0);
  is_away_ = false;
}

double ReleaseWatch::rim() const noexcept {
  return reach_ > 0.0 ? std::min(kHalfWay, kRimOfReach * reach_) : kHalfWay;
}

int ReleaseWatch::sides() const noexcept {
  return static_cast<int>(std::ranges::count(sides_, true));
}

void TurnWatch::add_position(const vec2& from_rest, double rim) noexcept {
  rim_ = rim;
  const double radius = glm::length(from_rest);
  if (!(radius > rim)) return;  // also true for not-a-number
  const double angle_rad = atan2(from_rest.y, from_rest.x);
  const int bin = static_cast<int>(std::lround(angle_rad / (2.0 * kPi) * kTurnBins));
  double& greatest = radius_[static_cast<std::size_t>((bin + kTurnBins) % kTurnBins)];
  greatest = std::max(greatest, radius);
  const double moved_rad = anchor_rad_ ? std::fabs(wrapped(angle_rad - *anchor_rad_)) : 0.0;
  if (anchor_rad_ && moved_rad < kLeastTravel) return;
  if (moved_rad < kMostTravel) travelled_rad_ += moved_rad;
  anchor_rad_ = angle_rad;
}

double TurnWatch::least_radius() const noexcept {
  std::array<double, kTurnBins> sorted = radius_;
  const auto end = std::remove(sorted.begin(), sorted.end(), 0.0);
  return std::max(rim_, kLeastOfMedianRadius * median({sorted.begin(), end}));
}

double TurnWatch::radius_towards(const vec2& to) const noexcept {
  const auto bin = std::lround(atan2(to.y, to.x) / (2.0 * kPi) * kTurnBins) + kTurnBins;
  double greatest = 0.0;
  for (const long k : {bin - 1, bin, bin + 1})
    greatest = std::max(greatest, radius_[static_cast<std::size_t>(k % kTurnBins)]);
  return greatest;
}

int TurnWatch::filled() const noexcept {
  const double least = least_radius();
  return static_cast<int>(
      std::ranges::count_if(radius_, [least](double radius) { return radius > least; }));
}

std::optional<vec2> TurnWatch::missing() const noexcept {
  const double least = least_radius();
  int longest = 0, end = 0, run = 0;  // the longest run of empty bins, `end` included
  for (int i = 0; i < 2 * kTurnBins; ++i) {
    run = radius_[static_cast<std::size_t>(i % kTurnBins)] > least ? 0 : run + 1;
    if (run > kTurnBins) run = kTurnBins;
    if (run <= longest) continue;
    longest = run;
    end = i;
  }
  if (longest == 0) return std::nullopt;
  const SinCos middle = sin_cos((end - (longest - 1) / 2.0) * 2.0 * kPi / kTurnBins);
  return vec2(middle.cos, middle.sin);
}

void PushWatch::hold(const vec2& from_rest, double rim, std::int64_t duration_ns) noexcept {
  const double radius = glm::length(from_rest);
  const Zone zone = radius > rim                    ? Zone::out
                    : radius < kReleasedOfRim * rim ? Zone::in
                                                    : Zone::between;
  zone_ns_ = zone == zone_ ? zone_ns_ + duration_ns : duration_ns;
  zone_ = zone;
  if (zone == Zone::out && is_armed_) {
    out_ns_ += duration_ns;
    sum_ += from_rest * static_cast<double>(duration_ns);
  }
  if (zone != Zone::in || zone_ns_ < kSpikeNs) return;
  if (out_ns_ >= kHeldNs) push_ = sum_ / static_cast<double>(out_ns_);
  if (out_ns_ > kSpikeNs) was_short_ = out_ns_ < kHeldNs;
  out_ns_ = 0;
  sum_ = vec2(0.0);
  is_armed_ = true;
}

void PushWatch::restart() noexcept {
  is_armed_ = zone_ == Zone::in || zone_ == Zone::unknown;
  was_short_ = false;
  out_ns_ = 0;
  sum_ = vec2(0.0);
  push_.reset();
}

PushWatch::State PushWatch::state() const noexcept {
  if (out_ns_ >= kHeldNs) return State::held;
  return out_ns_ > kSpikeNs ? State::out : State::waiting;
}

std::optional<vec2> PushWatch::take_push() noexcept {
  const std::optional<vec2> push = push_;
  push_.reset();
  return push;
}

// ---- The guide

namespace {

// Longest silence that counts: no step waits for longer, and StillWatch takes it in parts of 0.1 s.
constexpr std::int64_t kLongestHoldNs = 5000 * kMillisecondNs;

// Least ratio of a push's larger to its smaller component: at most 30 degrees off an axis.
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

// The raw axis along which a push goes; none: not clear.
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

// Whether two pushes, made when kAsked[a] and kAsked[b] were asked for, can come from one stick.
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

void CalibrationGuide::take_report(const Report& report) {
  if (report.kind == ReportKind::removed) unplugged();
  if (report.kind != ReportKind::input || step() == GuideStep::done || is_full()) return;
  advance(report.time_ns);
  if (step() == GuideStep::done || !tracker_.add_report(report)) return;
  if (running_reports_ == 0) continues_ = !is_cut_;
  is_cut_ = false;
  ++running_reports_;
  ++reports_;
  if (!std::exchange(has_position_, true)) time_ns_ = report.time_ns;
  if (step() != GuideStep::turn) return;
  for (Stick& stick : sticks_) stick.turn.add_position(from_rest(stick), stick.release.rim());
  if (is_complete()) finish_step();
}

void CalibrationGuide::tick(std::int64_t now_ns) {
  if (!is_full()) advance(now_ns);
}

void CalibrationGuide::unplugged() noexcept {
  tracker_.cut();
  is_cut_ = true;
  has_position_ = false;
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

// Counts the time since the last call as time in which no control moved.
void CalibrationGuide::advance(std::int64_t now_ns) {
  if (!has_position_ || now_ns <= time_ns_ || step() == GuideStep::done) return;
  // The stamps of a damaged recording may be any numbers.
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
  if (stick.pushed[number]) return;  // this push was seen; the other stick is not done yet
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
  finished_steps_.push_back({step(), continues_, running_reports_, tracker_.take_tracks()});
  running_reports_ = 0;
  ++index_;
  for (Stick& stick : sticks_) stick.push.restart();
  for (Trigger& trigger : triggers_) trigger.push.restart();
  if (finished_steps_.back().step == GuideStep::left) turn_again();
}

// Goes back to the turn, once, for sticks whose pushes went farther than it. The pushes stay.
void CalibrationGuide::turn_again() {
  bool is_any = false;
  for (Stick& stick : sticks_) {
    const auto is_short = [&](const std::optional<vec2>& push) {
      const double turned = push ? stick.turn.radius_towards(*push) : 0.0;
      return turned > 0.0 && turned < glm::length(*push) - kUnpressed;
    };
    if (stick.turns_again || std::ranges::none_of(stick.pushed, is_short)) continue;
    stick.turns_again = is_any = true;
    stick.turn.restart();
  }
  if (is_any)
    index_ = static_cast<std::size_t>(std::ranges::find(steps_, GuideStep::turn) - steps_.begin());
}

// Forgets what the running step has seen.
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
  reports_ -= finished_steps_.back().reports;
  finished_steps_.pop_back();
  drop_step();
}

PadTracks CalibrationGuide::tracks() const {
  PadTracks tracks;
  for (const StepTracks& finished : finished_steps_)
    join(tracks, finished.tracks, finished.continues);
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
    const std::optional<RawDirection> went = direction_of(pushes[i]),
                                      meant = direction_of(asked[i]);
    if (!went || !meant) continue;
    const RawDirection told = is_negative(*meant) ? opposite(*went) : *went;
    std::optional<RawDirection>& known = is_along_x(*meant) ? right : forward;
    if (known && *known != told) return std::nullopt;
    known = told;
  }
  if (!right || !forward || is_along_x(*right) == is_along_x(*forward)) return std::nullopt;
  return StickFrame{*right, *forward};
}

// ---- What the guide says: instructions and progress

namespace {

const char* control_name(int side, bool is_stick) noexcept {
  if (is_stick) return side == 0 ? "left stick" : "right stick";
  return side == 0 ? "left trigger" : "right trigger";
}

const char* push_text(const PushWatch& push) noexcept {
  switch (push.state()) {
    case PushWatch::State::waiting:
      return push.was_short() ? "that was short: hold it a little longer" : "waiting for it";
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

// The name of a side in the directions of the raw axes: their orientation under the thumb is
// learned later, by the pushes.
std::string side_name(const vec2& raw) {
  static constexpr const char* kNames[] = {"right", "front right", "front", "front left",
                                           "left",  "back left",   "back",  "back right"};
  const long eighth = std::lround(atan2(raw.y, raw.x) / (kPi / 4.0));
  return std::string(kNames[(eighth + 8) % 8]) + " by its axes";
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

std::string CalibrationGuide::instruction() const {
  if (is_full() && step() != GuideStep::done)
    return "This took so long that no more is kept: skip to the end, or repeat the step.";
  const auto which = [](const auto& controls, bool is_stick) -> std::string {
    if (controls.size() != 1) return is_stick ? "each stick" : "each trigger";
    return std::string("the ") + control_name(controls.front().side, is_stick);
  };
  const std::string sticks = which(sticks_, true);
  switch (step()) {
    case GuideStep::rest: {
      int releases = kWantedReleases;
      for (const Stick& stick : sticks_) releases = std::max(releases, stick.release.wanted());
      return fmt::format(
          "Push {} to its rim, let it snap back and wait a second; {} times, to different sides. "
          "Then leave it alone.",
          sticks, releases);
    }
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
  const int wanted = release.wanted(), count = std::min(release.count(), wanted);
  const int sides = std::min(release.sides(), kWantedSides);
  const double alone_s = static_cast<double>(release.rested_ns()) / 1e9;
  const double wanted_s = static_cast<double>(kWantedRestNs) / 1e9;
  GuideProgress progress;
  progress.done = 0.9 * (count + sides) / (wanted + kWantedSides);
  progress.text = fmt::format("{} of {} releases", count, wanted);
  if (release.is_complete()) {
    progress.done = 1.0;
  } else if (release.is_held()) {
    progress.text += "; it is held, let go";
  } else if (release.is_away()) {
    progress.text += "; let go and wait";
  } else if (release.is_aside() && count >= 2 && count < wanted) {
    progress.text += fmt::format("; it rests {:.2f} off its middle: take your thumb right off",
                                 glm::length(*release.rest()));
  } else if (count == wanted && sides < kWantedSides) {
    progress.text += fmt::format("; only from {} of {} sides", sides, kWantedSides);
  } else if (count == wanted) {
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
  if (stick.turns_again && !turn.is_complete())
    progress.text = "it was not pressed to its rim, once more: ";
  // Rounded down, so that "2.0 turns" are two whole turns.
  progress.text += fmt::format("{} of {} directions, {:.1f} of {:.0f} turns", turn.filled(),
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
  if (is_advised) return {{}, push_share(state), stick.advice, {}};
  return {{}, push_share(state), push_text(stick.push), {}};
}

GuideProgress CalibrationGuide::trigger_progress(const Trigger& trigger) const {
  GuideProgress progress;
  progress.control = control_name(trigger.side, false);
  const PushWatch::State state = trigger.push.state();
  progress.done = trigger.is_done ? 1.0 : push_share(state);
  progress.text = trigger.is_done ? "seen" : push_text(trigger.push);
  progress.raw = vec2(tracker_.state().axis[kLeftTrigger + trigger.side], 0.0);
  return progress;
}

}  // namespace gaitpad
