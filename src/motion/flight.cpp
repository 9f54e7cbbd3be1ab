#include "gaitpad/flight.h"

#include <algorithm>

#include "base/numeric.h"
#include "gaitpad/motion.h"
#include "motion/gait_events.h"
#include "motion/stride.h"

namespace gaitpad {
namespace {

constexpr double kBand = 0.10;      // share of the range of heights: the paper's 10 %
constexpr double kHeelOff_s = 0.6;  // longest time before the lift at which the heel may rise

int nearest(double frame) { return static_cast<int>(frame + 0.5); }

bool can_walk(const Motion& motion) { return !check(motion) && has_legs(motion); }

// The frame in which the heel begins to rise: searched backwards from the lift to `stop`, the
// ankle's first minimum within the band; if there is none, its lowest frame. Heights are not
// smoothed, because a standing ankle's minima are less than a millimetre deep.
int heel_off_frame(const std::vector<vec3>& ankle, int lift, int stop, double reach) {
  const auto [low, high] = std::minmax_element(
      ankle.begin(), ankle.end(), [](const vec3& a, const vec3& b) { return a.y < b.y; });
  const double limit_m = low->y + kBand * (high->y - low->y);
  int lowest = lift;
  for (int f = lift - 1; f >= stop && lift - f <= reach; --f) {
    const double y = ankle[f].y;
    if (y < ankle[lowest].y) lowest = f;
    const bool is_low = f > 0 && y <= ankle[f - 1].y && y < ankle[f + 1].y;
    if (is_low && y <= limit_m) return f;
  }
  return lowest;
}

// The swings of a foot that have both a toe-off and a strike.
std::vector<Swing> whole_swings(const FeetTracks& feet, Side side) {
  const std::vector<vec3>& ankle = feet.foot[side].ankle_m;
  std::vector<Swing> found;
  for (const double share : kMovingShares) {
    if (!found.empty()) break;
    int stop = 0;
    for (const FootSwing& swing : foot_swings(feet, share)) {
      if (swing.side != side) continue;
      stop = std::max(stop, feet.ranges[swing.range].first);
      if (swing.toe_off && swing.strike && *swing.toe_off < *swing.strike) {
        Swing s;
        s.lift = nearest(*swing.toe_off);
        s.land = nearest(*swing.strike);
        s.peak = s.lift;
        for (int f = s.lift; f <= s.land; ++f) {
          if (ankle[f].y > ankle[s.peak].y) s.peak = f;
        }
        s.heel_off = heel_off_frame(ankle, s.lift, stop, kHeelOff_s / feet.sample_s);
        found.push_back(s);
      }
      if (swing.strike) stop = nearest(*swing.strike);
    }
  }
  return found;
}

// Swings and the tracks that they index. If the clip is a loop that holds no whole swing, the
// tracks hold it twice.
struct Found {
  FeetTracks feet;
  std::vector<Swing> swings;
};
Found found_in(const Motion& motion, Side side) {
  Found found{feet_tracks(motion), {}};
  found.swings = whole_swings(found.feet, side);
  if (!found.swings.empty()) return found;
  const Motion twice = looped_twice(motion);
  if (twice.frames.empty()) return found;
  found.feet = feet_tracks(twice);
  found.swings = whole_swings(found.feet, side);
  const int frames = static_cast<int>(motion.frames.size());
  std::erase_if(found.swings, [&](const Swing& s) { return s.lift >= frames; });
  return found;
}

}  // namespace

std::vector<Swing> swings(const Motion& motion, Side side) {
  return can_walk(motion) ? found_in(motion, side).swings : std::vector<Swing>();
}

std::optional<Swing> robust_flight(const Motion& motion, Side side) {
  if (!can_walk(motion)) return std::nullopt;
  const Found found = found_in(motion, side);
  const std::vector<vec3>& ankle = found.feet.foot[side].ankle_m;
  std::vector<double> times, lengths;
  for (const Swing& s : found.swings) {
    times.push_back(s.land - s.lift);
    lengths.push_back(horizontal_length(ankle[s.land] - ankle[s.lift]));
  }
  const double usual_time = median(times), usual_length = median(lengths);
  if (found.swings.empty()) return std::nullopt;
  return found.swings[lowest(0, static_cast<int>(found.swings.size()) - 1, [&](int i) {
    const Swing& s = found.swings[i];
    // The clip begins within the stance before this swing, so its heel-off is not known.
    const bool begins_before = s.heel_off < 1 || s.heel_off == s.lift;
    return std::abs(times[i] / usual_time - 1.0) + std::abs(lengths[i] / usual_length - 1.0) +
           (begins_before ? 1.0 : 0.0);
  })];
}

std::optional<Swing> paper_flight(const std::vector<double>& heights) {
  if (heights.size() < 3) return std::nullopt;
  const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
  const double band = kBand * (*high - *low);
  std::array<int, 3> target{};
  int found = 0, direction = 0;  // sign of the last gradient that was not 0
  for (std::size_t f = 1; f < heights.size() && found < 3; ++f) {
    const double gradient = heights[f] - heights[f - 1];
    if (gradient == 0.0) continue;
    const int now = gradient > 0.0 ? 1 : -1;
    const double turn_m = heights[f - 1];
    const bool is_target = found == 1 ? direction > 0 && now < 0 && turn_m >= *high - band
                                      : direction < 0 && now > 0 && turn_m <= *low + band;
    if (is_target) target[found++] = static_cast<int>(f) - 1;
    direction = now;
  }
  if (found < 3) return std::nullopt;
  return Swing{.heel_off = target[0], .lift = target[0], .peak = target[1], .land = target[2]};
}

std::optional<Swing> paper_flight(const Motion& motion, Side side) {
  if (!can_walk(motion)) return std::nullopt;
  const std::array<int, 1> joints = {motion.legs[side].ankle};
  const auto tracks = joint_tracks_m(motion, joints);
  std::vector<double> heights;
  for (const vec3& p : tracks[0]) heights.push_back(p.y);
  return paper_flight(heights);
}

}  // namespace gaitpad
