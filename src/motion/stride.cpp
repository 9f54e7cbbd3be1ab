#include "motion/stride.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "base/numeric.h"
#include "base/text.h"
#include "motion/gait_events.h"
#include "motion/leg_pose.h"

namespace gaitpad {
namespace {

// A stride lasts from one event of a foot (it begins or stops moving) to the next equal one, with
// every other event once in between. The best stride of a motion is most like its continuation.

// --- Events --------------------------------------------------------------------------------------

struct FootEvent {
  double frame;
  int kind;  // 2 * side, and 1 more if the foot lands
};

// All events of one range, in time order.
std::vector<FootEvent> foot_events(const std::vector<FootSwing>& swings, int range) {
  std::vector<FootEvent> events;
  for (const FootSwing& s : swings) {
    if (s.range != range) continue;
    if (s.moves_from) events.push_back({*s.moves_from, 2 * s.side});
    if (s.moves_to) events.push_back({*s.moves_to, 2 * s.side + 1});
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const FootEvent& a, const FootEvent& b) { return a.frame < b.frame; });
  return events;
}

// --- Strides and how well they close -------------------------------------------------------------

double heading_at(const FeetTracks& track, double frame) {
  const int f =
      std::clamp(static_cast<int>(frame), 0, static_cast<int>(track.heading_rad.size()) - 2);
  return mix(track.heading_rad[f], track.heading_rad[f + 1], frame - f);
}

// Mean distance of the legs' joints, relative to the pelvis and its heading, and of the pelvis'
// height, in leg lengths.
double pose_distance(const FeetTracks& track, double a, double b) {
  const quat back_a = rotation_y(-heading_at(track, a)), back_b = rotation_y(-heading_at(track, b));
  const vec3 pelvis_a = point_at(track.pelvis_m, a), pelvis_b = point_at(track.pelvis_m, b);
  double sum = std::abs(pelvis_a.y - pelvis_b.y);
  for (const FootTrack& leg : track.foot) {
    for (const auto* p : {&leg.knee_m, &leg.ankle_m, &leg.toe_joint_m}) {
      sum += glm::distance(back_a * (point_at(*p, a) - pelvis_a),
                           back_b * (point_at(*p, b) - pelvis_b));
    }
  }
  return sum / (7.0 * track.leg_m);
}

// Distance between a stride's first and last pose. It includes the poses 5 % of the stride before
// and after, so that velocities have to agree as well.
double seam(const FeetTracks& track, const SampleRange& range, double start, double period) {
  double sum = 0.0, weight = 0.0;
  for (const double off : {-0.05 * period, 0.0, 0.05 * period}) {
    if (start + off < range.first || start + period + off > range.last) continue;
    sum += pose_distance(track, start + off, start + period + off);
    weight += 1.0;
  }
  return weight > 0.0 ? sum / weight : 1.0;
}

constexpr double kShortestStride_legs = 0.2;  // least length: a shuffle's two steps
// A longer, slower or more sharply turning stride is not used.
constexpr double kLongestStride_s = 4.0;
constexpr double kSlowest_legs_s = 0.12;
constexpr double kSharpestTurn_rad = 60.0 * kDegree;

struct Candidate {
  StrideWindow window;
  double speed_legs_s = 0.0, seam_legs = 0.0;
  double score = 0.0;  // the smaller the score, the better the stride
};

// True if each of the four events happens once among these.
bool is_stride(const std::vector<FootEvent>& events, std::size_t from, std::size_t to) {
  std::array<int, 4> count{};
  for (std::size_t i = from; i < to; ++i) ++count[events[i].kind];
  return count == std::array{1, 1, 1, 1};
}

// The period within 4 % of the events' period with the smallest seam: the last pose fits the first
// one best. A change costs up to 0.02 leg lengths.
double best_period(const FeetTracks& track, const SampleRange& range, double start, double period) {
  double best = period, least = seam(track, range, start, period);
  for (int k = -16; k <= 16; ++k) {
    const double tried = period * (1.0 + 0.0025 * k);
    if (start + tried > range.last) continue;
    const double cost = seam(track, range, start, tried) + 0.02 * std::abs(k) / 16.0;
    if (cost < least) {
      least = cost;
      best = tried;
    }
  }
  return best;
}

std::optional<Candidate> candidate(const FeetTracks& track, const SampleRange& range, double start,
                                   double end, double frame_s) {
  Candidate c;
  StrideWindow& w = c.window;
  w = {start, best_period(track, range, start, end - start), 0.0, range.first, range.last};
  const double stop = w.start + w.period;
  w.turn_rad = heading_at(track, stop) - heading_at(track, w.start);
  const vec3 travel = point_at(track.pelvis_m, stop) - point_at(track.pelvis_m, w.start);
  const double legs = horizontal_length(travel) / track.leg_m;
  c.speed_legs_s = legs / (w.period * frame_s);
  c.seam_legs = seam(track, range, w.start, w.period);
  const bool is_walk = w.period * frame_s <= kLongestStride_s && legs >= kShortestStride_legs &&
                       c.speed_legs_s >= kSlowest_legs_s &&
                       std::abs(w.turn_rad) <= kSharpestTurn_rad;
  return is_walk ? std::optional<Candidate>(c) : std::nullopt;
}

// Adds the strides from each event to the next equal one.
void add_between_events(const FeetTracks& track, const SampleRange& range,
                        const std::vector<FootEvent>& events, double frame_s,
                        std::vector<Candidate>& found) {
  for (std::size_t i = 0; i < events.size(); ++i) {
    std::size_t k = i + 1;
    while (k < events.size() && events[k].kind != events[i].kind) ++k;
    if (k == events.size() || !is_stride(events, i, k)) continue;
    const auto c = candidate(track, range, events[i].frame, events[k].frame, frame_s);
    if (c) found.push_back(*c);
  }
}

// For clips of little more than one stride, which may contain no event twice: adds the strides from
// each frame to the most similar later one with each event once in between.
void add_by_pose(const FeetTracks& track, const SampleRange& range,
                 const std::vector<FootEvent>& events, double frame_s,
                 std::vector<Candidate>& found) {
  constexpr double kLike_legs = 0.05;
  constexpr double kShortest_s = 0.5;
  const auto first_from = [&](double frame) {
    const auto is_before = [](const FootEvent& event, double at) { return event.frame < at; };
    return std::lower_bound(events.begin(), events.end(), frame, is_before) - events.begin();
  };
  const int shortest = static_cast<int>(kShortest_s / frame_s) + 1;
  const int longest = static_cast<int>(kLongestStride_s / frame_s);
  for (int start = range.first; start + shortest <= range.last; ++start) {
    int best_end = -1;
    double least = kLike_legs;
    for (int end = start + shortest; end <= std::min(range.last, start + longest); ++end) {
      if (!is_stride(events, first_from(start), first_from(end))) continue;
      const double cost = seam(track, range, start, end - start);
      if (cost >= least) continue;
      least = cost;
      best_end = end;
    }
    if (best_end < 0) continue;
    if (const auto c = candidate(track, range, start, best_end, frame_s)) found.push_back(*c);
  }
}

std::vector<Candidate> candidates(const FeetTracks& feet) {
  std::vector<Candidate> found;
  for (const auto add : {&add_between_events, &add_by_pose}) {
    for (const double share : kMovingShares) {
      if (!found.empty()) break;
      const std::vector<FootSwing> swings = foot_swings(feet, share);
      for (std::size_t range = 0; range < feet.ranges.size(); ++range) {
        add(feet, feet.ranges[range], foot_events(swings, static_cast<int>(range)), feet.sample_s,
            found);
      }
    }
  }
  return found;
}

// Number of times that the leading foot, or the higher foot, changes in the range.
int steps_in_place(const FeetTracks& track, const SampleRange& range) {
  // A smaller movement is a shift of the weight.
  constexpr double kAhead_legs = 0.1, kAbove_legs = 0.03;
  int ahead = 0, above = 0, steps_ahead = 0, steps_above = 0;
  const auto count = [](double difference, double least, int& side, int& steps) {
    if (std::abs(difference) < least) return;
    const int now = difference > 0.0 ? 1 : -1;
    steps += side != 0 && now != side;
    side = now;
  };
  for (int f = range.first; f <= range.last; ++f) {
    const vec3 apart = track.foot[kLeftSide].ankle_m[f] - track.foot[kRightSide].ankle_m[f];
    const vec3 front = heading_direction(track.heading_rad[f]);
    count(glm::dot(apart, front), kAhead_legs * track.leg_m, ahead, steps_ahead);
    count(apart.y, kAbove_legs * track.leg_m, above, steps_above);
  }
  return std::max(steps_ahead, steps_above);
}

// The error sentence. Its numbers show whether the motion is too short for a stride.
std::string why_no_stride(const FeetTracks& track) {
  constexpr double kFastestWalk_legs_s = 3.6;  // leg lengths a second: 3 m/s for an adult
  // Way and duration of the range in which the hips move farthest.
  double moved_m = -1.0, time_s = 0.0;
  int steps = 0;
  for (const SampleRange& range : track.ranges) {
    double here_m = 0.0;
    for (int f = range.first; f <= range.last; ++f)
      here_m = std::max(here_m, horizontal_length(track.pelvis_m[f] - track.pelvis_m[range.first]));
    if (here_m > moved_m) {
      moved_m = here_m;
      time_s = (range.last - range.first + 1) * track.sample_s;
    }
    steps = std::max(steps, steps_in_place(track, range));
  }
  const std::string numbers =
      "the hips go " + fixed(std::max(moved_m, 0.0), 2) + " m in " + fixed(time_s, 2) + " s";
  if (steps >= 2 && moved_m < kSlowest_legs_s * track.leg_m * time_s) {
    return "walks on the spot: " + numbers + ", and a stride has to travel";
  }
  const bool runs = moved_m > kFastestWalk_legs_s * track.leg_m * time_s;
  return "holds no full walking stride of both feet: " + numbers + (runs ? ", it is a run" : "");
}

// Difference between the travel of the stride's halves, as a share of the stride.
double unsteadiness(const FeetTracks& track, const StrideWindow& w) {
  const vec3 start = point_at(track.pelvis_m, w.start);
  const vec3 middle = point_at(track.pelvis_m, w.start + 0.5 * w.period);
  const vec3 end = point_at(track.pelvis_m, w.start + w.period);
  const double first = horizontal_length(middle - start), second = horizontal_length(end - middle);
  return std::abs(second - first) / (first + second);
}

// Prefers a small seam, a straight and steady stride at the motion's usual speed, and frames beyond
// it for fading the seam.
void sort_best_first(const FeetTracks& track, std::vector<Candidate>& all) {
  std::vector<double> speed;
  for (const Candidate& c : all) speed.push_back(c.speed_legs_s);
  const double usual = median(speed);
  for (Candidate& c : all) {
    const StrideWindow& w = c.window;
    const double stop = w.start + w.period;
    const double room = std::max(w.start - w.first, w.last - stop) / w.period;
    c.score = c.seam_legs + 0.1 * std::abs(w.turn_rad) +
              0.1 * std::abs(c.speed_legs_s / usual - 1.0) + 0.1 * unsteadiness(track, w) +
              0.02 * (1.0 - std::min(room / 0.2, 1.0));
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score < b.score; });
}

// --- Clips that are one loop ---------------------------------------------------------------------

constexpr double kLoop_legs = 0.12;  // mean distance of first and last pose in a looping clip

// Spreads the difference of the last and the first pose over the clip, so that they differ only in
// place and heading.
void close_loop(Motion& motion, double turn_rad) {
  const int last = static_cast<int>(motion.frames.size()) - 1;
  const std::vector<quat> from = motion.frames.front().local, to = motion.frames.back().local;
  const double rise = motion.frames.back().root_m.y - motion.frames.front().root_m.y;
  for (std::size_t j = 0; j < from.size(); ++j) {
    const quat aim = j == 0 ? rotation_y(turn_rad) * from[j] : from[j];
    const vec3 gap = rotation_vector(glm::conjugate(to[j]) * aim);
    for (int f = 0; f <= last; ++f) {
      quat& q = motion.frames[f].local[j];
      q = q * from_rotation_vector(gap * (double(f) / last - 0.5));
    }
  }
  for (int f = 0; f <= last; ++f) motion.frames[f].root_m.y -= rise * (double(f) / last - 0.5);
}

}  // namespace

vec3 point_at(const std::vector<vec3>& track, double frame) {
  const int f = std::clamp(static_cast<int>(frame), 0, static_cast<int>(track.size()) - 2);
  return glm::mix(track[f], track[f + 1], frame - f);
}

Result<std::vector<StrideWindow>> best_strides(const Motion& motion) {
  if (motion.frames.size() < 6) return Error{"has fewer than 6 frames"};
  const FeetTracks track = feet_tracks(motion);
  if (!(track.leg_m > 0.0)) return Error{"has no legs to walk on"};
  std::vector<Candidate> all = candidates(track);
  if (all.empty()) return Error{why_no_stride(track)};
  sort_best_first(track, all);
  std::vector<StrideWindow> windows;
  for (const Candidate& c : all) windows.push_back(c.window);
  return windows;
}

Motion looped_twice(const Motion& motion) {
  Motion twice = motion;
  twice.frames.clear();
  const int frames = static_cast<int>(motion.frames.size());
  if (frames < 6) return twice;
  const FeetTracks track = feet_tracks(motion);
  if (!(pose_distance(track, 0.0, frames - 1.0) <= kLoop_legs)) return twice;
  const double turn = wrapped(track.heading_rad.back() - track.heading_rad.front());
  twice.frames = motion.frames;
  close_loop(twice, turn);
  const quat onward = rotation_y(turn);
  // Join the loops by the pelvis, because the root may stand still.
  const std::vector<vec3> pelvis = feet_tracks(twice).pelvis_m;
  for (int f = 1; f < frames; ++f) {
    MotionFrame frame = twice.frames[f];
    frame.root_m = pelvis.back() + onward * (frame.root_m - pelvis.front());
    frame.local[0] = onward * frame.local[0];
    twice.frames.push_back(std::move(frame));
  }
  return twice;
}

}  // namespace gaitpad
