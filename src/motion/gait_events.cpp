#include "motion/gait_events.h"

#include <algorithm>
#include <memory>

#include "base/numeric.h"
#include "base/text.h"
#include "gaitpad/limbs.h"
#include "motion/leg_pose.h"
#include "motion/sole.h"

namespace gaitpad {
namespace {

// --- Tracks of a motion's feet -------------------------------------------------------------------

constexpr double kFastest_legs_s = 14.0;  // faster than any sprinter's foot: a jump in the data
constexpr std::size_t kFlatPercent = 10;  // share of all frames in which a walker's foot is flat

bool is_jump(const vec3& a, const vec3& b, double most_m) {
  return !(glm::distance(a, b) <= most_m);
}

std::vector<SampleRange> unbroken_ranges(const FeetTracks& tracks) {
  const std::vector<vec3>& pelvis = tracks.pelvis_m;
  const double most_m = kFastest_legs_s * tracks.leg_m * tracks.sample_s;
  const int frames = static_cast<int>(pelvis.size());
  std::vector<SampleRange> ranges;
  int first = 0;
  for (int f = 1; f <= frames; ++f) {
    const bool breaks =
        f == frames || is_jump(pelvis[f], pelvis[f - 1], most_m) ||
        std::any_of(tracks.foot.begin(), tracks.foot.end(), [&](const FootTrack& foot) {
          return is_jump(foot.ankle_m[f], foot.ankle_m[f - 1], most_m);
        });
    if (!breaks) continue;
    if (f - first >= 2) ranges.push_back({first, f - 1});
    first = f;
  }
  return ranges;
}

vec3 median_of(const std::vector<vec3>& places) {
  vec3 middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const vec3& p : places) values.push_back(p[axis]);
    middle[axis] = median(std::move(values));
  }
  return middle;
}

// What a sole is guessed from beside a foot's tracks.
struct FootFrames {
  std::vector<vec3> toe_end_m;
  std::vector<quat> ankle;
};

// Heel and toe in the ankle's frame: the median over the frames in which ankle and toe are slowest
// and lowest. A mean would include the unrelated pose with which some clips begin.
struct Sole {
  vec3 heel_m, toe_m;
};
Sole sole_of(const FeetTracks& tracks, int side, const FootFrames& frames) {
  const FootTrack& foot = tracks.foot[side];
  const double leg_m = tracks.leg_m;
  std::vector<std::pair<double, int>> flat;
  for (const SampleRange& range : tracks.ranges) {
    for (int f = range.first; f <= range.last; ++f) {
      const int a = std::max(f - 1, range.first), b = std::min(f + 1, range.last);
      const double speed = (glm::distance(foot.ankle_m[a], foot.ankle_m[b]) +
                            glm::distance(foot.toe_joint_m[a], foot.toe_joint_m[b])) /
                           ((b - a) * tracks.sample_s);
      flat.emplace_back(speed + kFlatRate_per_s * (foot.ankle_m[f].y + foot.toe_joint_m[f].y), f);
    }
  }
  if (flat.empty()) return {};
  std::sort(flat.begin(), flat.end());
  flat.resize(std::max<std::size_t>(1, flat.size() * kFlatPercent / 100));
  std::vector<vec3> heels, toes;
  for (const auto& [score, f] : flat) {
    vec3 toe = foot.toe_joint_m[f] - foot.ankle_m[f];
    const vec3 end = frames.toe_end_m[f] - foot.ankle_m[f];
    if (is_short_foot(toe, leg_m) && !is_short_foot(end, leg_m)) toe = end;
    if (is_short_foot(toe, leg_m))
      toe = kOwnToe_legs * leg_m * heading_direction(tracks.heading_rad[f]) + vec3(0.0, toe.y, 0.0);
    const double low = std::min({toe.y, end.y, -kLeastAnkle_legs * leg_m});
    const quat into_ankle = glm::conjugate(frames.ankle[f]);
    heels.push_back(into_ankle * vec3(-kHeelShare * toe.x, low, -kHeelShare * toe.z));
    toes.push_back(into_ankle * toe);
  }
  return {median_of(heels), median_of(toes)};
}

// --- Swings, roughly -----------------------------------------------------------------------------

constexpr double kSmoothing_s = 0.04;  // half the width of the window over the ankle's track
// A shorter rest, and a swing that is shorter or longer in time or way, does not count.
constexpr double kShortestRest_s = 0.06;
constexpr double kShortestSwing_s = 0.15, kLongestSwing_s = 1.8;
constexpr double kShortestSwing_legs = 0.15, kLongestSwing_legs = 2.6;

// Running mean weighted by a raised cosine, shortened at the range's ends.
std::vector<vec3> smoothed(const std::vector<vec3>& p, const SampleRange& range,
                           double half_samples) {
  const int reach = static_cast<int>(half_samples);
  std::vector<double> cosine;
  for (int k = 0; k <= reach; ++k) {
    cosine.push_back(1.0 + sin_cos(kPi * k / (half_samples + 1.0)).cos);
  }
  std::vector<vec3> out;
  for (int f = range.first; f <= range.last; ++f) {
    const int n = std::min({reach, f - range.first, range.last - f});
    vec3 sum(0.0);
    double weight = 0.0;
    for (int k = -n; k <= n; ++k) {
      const double w = cosine[static_cast<std::size_t>(std::abs(k))];
      sum += p[f + k] * w;
      weight += w;
    }
    out.push_back(sum / weight);
  }
  return out;
}

// Horizontal speed of the ankle at each sample of the range.
std::vector<double> ankle_speeds(const FeetTracks& tracks, Side side, const SampleRange& range) {
  const std::vector<vec3> track =
      smoothed(tracks.foot[side].ankle_m, range, kSmoothing_s / tracks.sample_s);
  const int n = static_cast<int>(track.size());
  std::vector<double> speed(n);
  for (int i = 0; i < n; ++i) {
    const int a = std::max(i - 1, 0), b = std::min(i + 1, n - 1);
    speed[i] = horizontal_length(track[b] - track[a]) / ((b - a) * tracks.sample_s);
  }
  return speed;
}

// A foot's swing with the samples between which its two events are searched. The events may be
// evaluated for several limits.
struct SwingSearch : FootSwing {
  int first = 0, last = 0;  // consecutive samples in which the foot moves
  // Last sample of the swing before, first of the swing after; else the range's ends.
  int rest_first = 0, rest_last = 0;
  int fastest_heel = 0;        // sample at which the search for the strike begins
  int flat = 0;                // sample at which it ends
  double standing_heel_m = 0;  // height at `flat`
  int fastest_toe = 0;         // the search for the toe-off begins here, backwards
  int pushing = 0;             // sample at which the search ends: the toe is slowest while the heel
                               // rises
};

// Fractional index between two neighbours at which the speed crosses the limit.
double crossing(const std::vector<double>& speed, int a, int b, double limit) {
  const double rise = speed[b] - speed[a];
  return rise == 0.0 ? a : a + (b - a) * std::clamp((limit - speed[a]) / rise, 0.0, 1.0);
}

// The runs of samples of a range in which a foot moves.
std::vector<SwingSearch> moving_runs(const FeetTracks& tracks, Side side, int range,
                                     const std::vector<double>& speed, double limit) {
  const auto [first, last] = tracks.ranges[range];
  const double rest_samples = kShortestRest_s / tracks.sample_s;
  std::vector<SwingSearch> runs;
  for (int i = first; i <= last; ++i) {
    if (!(speed[i - first] > limit)) continue;
    if (runs.empty() || i - runs.back().last - 1 >= rest_samples) {
      SwingSearch run;
      run.side = side, run.range = range, run.first = i;
      run.rest_first = runs.empty() ? first : runs.back().last;
      if (!runs.empty()) runs.back().rest_last = i;
      runs.push_back(run);
    }
    runs.back().last = i;
  }
  if (!runs.empty()) runs.back().rest_last = last;
  for (SwingSearch& run : runs) {
    const int from = run.first - first, to = run.last - first;
    if (run.first > first) run.moves_from = first + crossing(speed, from - 1, from, limit);
    if (run.last < last) run.moves_to = first + crossing(speed, to, to + 1, limit);
  }
  return runs;
}

bool is_swing(const FeetTracks& tracks, const SwingSearch& run) {
  if (!run.moves_from || !run.moves_to) return true;  // the range cuts it
  const std::vector<vec3>& ankle = tracks.foot[run.side].ankle_m;
  const double time_s = (run.last - run.first + 1) * tracks.sample_s;
  const double legs = horizontal_length(ankle[run.last] - ankle[run.first]) / tracks.leg_m;
  return time_s >= kShortestSwing_s && time_s <= kLongestSwing_s && legs >= kShortestSwing_legs &&
         legs <= kLongestSwing_legs;
}

std::vector<SwingSearch> swing_runs(const FeetTracks& tracks, double moving_share,
                                    double& limit_m_s) {
  std::vector<std::array<std::vector<double>, 2>> speeds;  // by range and side
  std::vector<double> all;
  for (const SampleRange& range : tracks.ranges) {
    speeds.emplace_back();
    for (const Side side : {kLeftSide, kRightSide}) {
      const auto& speed = speeds.back()[side] = ankle_speeds(tracks, side, range);
      all.insert(all.end(), speed.begin(), speed.end());
    }
  }
  limit_m_s = moving_share * percentile(std::move(all), 95);
  std::vector<SwingSearch> found;
  for (int range = 0; range < static_cast<int>(speeds.size()); ++range) {
    for (const Side side : {kLeftSide, kRightSide}) {
      for (const SwingSearch& run :
           moving_runs(tracks, side, range, speeds[range][side], limit_m_s)) {
        if (is_swing(tracks, run)) found.push_back(run);
      }
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const SwingSearch& a, const SwingSearch& b) { return a.first < b.first; });
  return found;
}

// --- The two events of a swing, exactly ----------------------------------------------------------

// Limits for an adult: height and speed of a heel that strikes, speed of a toe that leaves.
constexpr double kDown_m = 0.005, kStill_m_s = 0.3, kLeaving_m_s = 0.2;
constexpr double kSpeed_s = 0.012;  // half the time over which a speed is averaged
constexpr double kFlat_s = 0.025;   // half the time over which flatness is averaged
constexpr double kRest_s = 0.05;    // a heel that has struck stays still for this time
// Highest strike above the standing heel; higher up a heel only pauses.
constexpr double kMostSink_m = 0.06;
constexpr double kPush_s = 0.15;  // time for which a toe stands while the heel rises
// Least double support, s. With 0.02, 0.04, 0.06, 0.08 and 0.10 s the heels of 23 captured walks
// move 0.36, 0.42, 0.44, 0.57 and 0.72 m/s at their strikes (median). People have 0.1 s in a free
// walk and 0.04 s in the fastest.
constexpr double kLeastRoll_s = 0.06;
constexpr double kSlideStep = 0.05;  // growth of the limits in each attempt, relative

// Reads the tracks of a swing's foot within its range.
struct Reader {
  const FootTrack& foot;
  SampleRange range;
  double sample_s, scale;  // the leg's length over an adult's

  Reader(const FeetTracks& tracks, const FootSwing& swing)
      : foot(tracks.foot[swing.side]),
        range(tracks.ranges[swing.range]),
        sample_s(tracks.sample_s),
        scale(tracks.leg_m / kReferenceLeg_m) {}

  // Number of samples in that time, at least 1.
  int half(double time_s) const { return std::max(1, static_cast<int>(time_s / sample_s + 0.5)); }
  // The samples within a time of one sample.
  SampleRange around(int i, double time_s) const {
    const int n = half(time_s);
    return {std::max(i - n, range.first), std::min(i + n, range.last)};
  }
  double speed(const std::vector<vec3>& p, int i) const {
    const auto [a, b] = around(i, kSpeed_s);
    return glm::distance(p[a], p[b]) / (std::max(b - a, 1) * sample_s);
  }
  // The mean of a value of the samples around one.
  template <class Value>
  double averaged(int i, const Value& value) const {
    const auto [a, b] = around(i, kFlat_s);
    double sum = 0.0;
    for (int k = a; k <= b; ++k) sum += value(k);
    return sum / (b - a + 1);
  }
  // Score of speed and height; small when the foot is flat.
  double flatness(int i) const {
    return averaged(i, [this](int k) {
      return speed(foot.heel_m, k) + speed(foot.toe_m, k) +
             kFlatRate_per_s * (foot.heel_m[k].y + foot.toe_m[k].y);
    });
  }
  int fastest(const std::vector<vec3>& p, int first, int last) const {
    return lowest(first, last, [&](int i) { return -speed(p, i); });
  }
};

// Share of the way to the next sample at which a falling value crosses the limit; 0 if it does not.
double share_above(double above, double next, double limit) {
  return above > limit && above > next ? std::min((above - limit) / (above - next), 1.0) : 0.0;
}

void set_search(const FeetTracks& tracks, double limit_m_s, SwingSearch& s) {
  const Reader r(tracks, s);
  s.fastest_heel = r.fastest(r.foot.heel_m, s.first, s.last);
  s.flat =
      lowest(std::min(s.last + 1, s.rest_last), s.rest_last, [&](int i) { return r.flatness(i); });
  s.standing_heel_m = r.averaged(s.flat, [&](int k) { return r.foot.heel_m[k].y; });
  s.fastest_toe = r.fastest(r.foot.toe_m, s.first, s.last);
  int leaving = s.fastest_toe;
  while (leaving > s.rest_first && r.speed(r.foot.toe_m, leaving) > limit_m_s) --leaving;
  // The last of equally slow samples.
  const int most = std::min(leaving - s.rest_first, r.half(kPush_s));
  s.pushing = leaving - lowest(0, most, [&](int k) { return r.speed(r.foot.toe_m, leaving - k); });
}

std::optional<double> strike_of(const FeetTracks& tracks, const SwingSearch& s, double slide) {
  if (!s.moves_to) return std::nullopt;
  const Reader r(tracks, s);
  const std::vector<vec3>& heel = r.foot.heel_m;
  const double down_m = slide * r.scale * kDown_m, still_m_s = slide * r.scale * kStill_m_s;
  const auto rests = [&](int i) {
    const int end = std::min(i + r.half(kRest_s), s.flat);
    for (int k = i; k <= end; ++k) {
      if (r.speed(heel, k) > still_m_s) return false;
    }
    return heel[i].y - s.standing_heel_m <= r.scale * kMostSink_m;
  };
  int rest = s.fastest_heel + 1;
  while (rest < s.flat && !rests(rest)) ++rest;
  // A heel is down near the lowest height of this rest, not of the whole stance: some feet sink
  // into the floor later.
  double low_m = heel[rest].y;
  for (int k = rest; k <= std::min(rest + r.half(kRest_s), s.flat); ++k) {
    low_m = std::min(low_m, heel[k].y);
  }
  while (rest < s.flat && heel[rest].y > low_m + down_m) ++rest;
  return rest - 1 +
         std::max(share_above(heel[rest - 1].y, heel[rest].y, low_m + down_m),
                  share_above(r.speed(heel, rest - 1), r.speed(heel, rest), still_m_s));
}

std::optional<double> toe_off_of(const FeetTracks& tracks, const SwingSearch& s, double slide) {
  if (!s.moves_from) return std::nullopt;
  const Reader r(tracks, s);
  const double most_m_s = slide * r.scale * kLeaving_m_s;
  int i = s.fastest_toe - 1;
  while (i > s.pushing && r.speed(r.foot.toe_m, i) > most_m_s) --i;
  if (i <= r.range.first) return std::nullopt;  // the toe left before the range begins
  return i + 1 - share_above(r.speed(r.foot.toe_m, i + 1), r.speed(r.foot.toe_m, i), most_m_s);
}

// The next swing in the same range if it is the other foot's, otherwise -1.
int other_foots_next_swing(const std::vector<SwingSearch>& swings, std::size_t i) {
  for (std::size_t k = i + 1; k < swings.size(); ++k) {
    if (swings[k].range != swings[i].range) continue;
    return swings[k].side == swings[i].side ? -1 : static_cast<int>(k);
  }
  return -1;
}

}  // namespace

FeetTracks feet_tracks(const Motion& motion) {
  FeetTracks tracks;
  tracks.sample_s = motion.frame_time_s;
  tracks.leg_m = leg_length_m(motion);
  std::array<FootFrames, 2> frames;
  const auto world = std::make_unique<JointFrames>();
  for (const MotionFrame& frame : motion.frames) {
    forward_kinematics(motion, frame, *world);
    const auto& at = world->position_m;
    tracks.pelvis_m.push_back(at[motion.pelvis]);
    double heading = hips_heading(at[motion.legs[kLeftSide].hip] - at[motion.legs[kRightSide].hip]);
    if (!tracks.heading_rad.empty())
      heading = tracks.heading_rad.back() + wrapped(heading - tracks.heading_rad.back());
    tracks.heading_rad.push_back(heading);
    for (int side = 0; side < 2; ++side) {
      const LegJoints& j = motion.legs[side];
      FootTrack& foot = tracks.foot[side];
      foot.knee_m.push_back(at[j.knee]);
      foot.ankle_m.push_back(at[j.ankle]);
      foot.toe_joint_m.push_back(at[j.toe]);
      frames[side].toe_end_m.push_back(at[j.toe_end]);
      frames[side].ankle.push_back(world->rotation[j.ankle]);
    }
  }
  tracks.ranges = unbroken_ranges(tracks);
  for (int side = 0; side < 2; ++side) {
    const Sole sole = sole_of(tracks, side, frames[side]);
    FootTrack& foot = tracks.foot[side];
    for (std::size_t f = 0; f < foot.ankle_m.size(); ++f) {
      foot.heel_m.push_back(foot.ankle_m[f] + frames[side].ankle[f] * sole.heel_m);
      foot.toe_m.push_back(foot.ankle_m[f] + frames[side].ankle[f] * sole.toe_m);
    }
  }
  return tracks;
}

std::vector<FootSwing> foot_swings(const FeetTracks& tracks, double moving_share) {
  double limit_m_s = 0.0;
  std::vector<SwingSearch> all = swing_runs(tracks, moving_share, limit_m_s);
  for (SwingSearch& swing : all) {
    set_search(tracks, limit_m_s, swing);
    swing.toe_off = toe_off_of(tracks, swing, 1.0);
    swing.strike = strike_of(tracks, swing, 1.0);
  }
  // A heel must strike before the other toe leaves. Widen the limits for feet that slide.
  for (std::size_t i = 0; i < all.size(); ++i) {
    const int other = other_foots_next_swing(all, i);
    if (other < 0 || !all[i].strike || !all[other].toe_off) continue;
    for (double slide = 1.0 + kSlideStep; slide <= kMostSlide; slide += kSlideStep) {
      if ((*all[other].toe_off - *all[i].strike) * tracks.sample_s >= kLeastRoll_s) break;
      all[i].strike = strike_of(tracks, all[i], slide);
      all[other].toe_off = toe_off_of(tracks, all[other], slide);
    }
  }
  return {all.begin(), all.end()};
}

namespace {

// --- A closed stride -----------------------------------------------------------------------------

// A run has both feet in the air at this speed; a shorter or slower flight is an error of events.
constexpr double kLeastFlight_s = 0.03, kSlowestRun_legs_s = 2.1;

// Three copies of the stride in a row, so that the middle one is not cut off.
FeetTracks in_a_row(const FeetTracks& stride, const vec3& travel_m) {
  FeetTracks row = stride;
  for (FootTrack& foot : row.foot) {
    for (std::vector<vec3>* points : {&foot.ankle_m, &foot.heel_m, &foot.toe_m}) {
      const std::vector<vec3> once = *points;
      for (const double copy : {1.0, 2.0}) {
        for (const vec3& p : once) points->push_back(p + travel_m * copy);
      }
    }
  }
  row.ranges = {{0, static_cast<int>(row.foot[0].ankle_m.size()) - 1}};
  return row;
}

// The longest swing of a foot that ends in the middle copy.
const FootSwing* middle_swing(const std::vector<FootSwing>& swings, Side side, double samples) {
  const FootSwing* best = nullptr;
  for (const FootSwing& s : swings) {
    if (s.side != side || !s.toe_off || !s.strike || *s.toe_off >= *s.strike) continue;
    if (*s.strike < samples || *s.strike >= 2.0 * samples) continue;
    if (!best || *s.strike - *s.toe_off > *best->strike - *best->toe_off) best = &s;
  }
  return best;
}

}  // namespace

Result<StrideEvents> stride_events(const FeetTracks& stride, const vec3& travel_m) {
  const FeetTracks row = in_a_row(stride, travel_m);
  const auto samples = static_cast<double>(stride.foot[0].ankle_m.size());
  std::string problem;
  for (const double share : kMovingShares) {
    const std::vector<FootSwing> swings = foot_swings(row, share);
    StrideEvents events;
    problem.clear();
    for (const Side side : {kLeftSide, kRightSide}) {
      const FootSwing* swing = middle_swing(swings, side, samples);
      if (!swing) {
        problem = std::string("the ") + kSideNames[side] + " foot does not swing";
        break;
      }
      events.toe_off[side] = fraction(*swing->toe_off / samples);
      events.strike[side] = fraction(*swing->strike / samples);
    }
    if (!problem.empty()) continue;
    std::array<double, 2> roll_s;  // duration from a strike to the other foot's toe-off
    for (const Side side : {kLeftSide, kRightSide}) {
      const double roll = events.toe_off[other(side)] - events.strike[side];
      roll_s[side] = (fraction(roll + 0.5) - 0.5) * samples * stride.sample_s;
    }
    const double flight_s = -std::max(roll_s[0], roll_s[1]);
    const double legs_s = glm::length(travel_m) / (samples * stride.sample_s) / stride.leg_m;
    if (flight_s > kLeastFlight_s && legs_s > kSlowestRun_legs_s)
      return Error{"holds no walk: both feet are in the air for " + fixed(flight_s, 2) +
                   " s before a strike, it is a run"};
    for (const Side side : {kLeftSide, kRightSide}) {
      if (roll_s[side] > 0.0) continue;
      return Error{std::string("holds no walk whose events are in order: the ") +
                   kSideNames[other(side)] + " toe leaves " + fixed(-roll_s[side], 2) +
                   " s before the " + kSideNames[side] + " heel strikes"};
    }
    return events;
  }
  return Error{"holds no walk: " + problem};
}

}  // namespace gaitpad
