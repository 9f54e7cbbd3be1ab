// Assertions 13-17: figure 5a. Numbers in the notes are those of the project's two prototypes of
// the paper's method: a planar leg (heel as effector, warm start) and a 3-D walk.
#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"

namespace gaitpad {
namespace {

constexpr const char* kSection = "4, figure 5a";
constexpr double kEndShare = 0.1;  // of a flight: so near to its ends the leg is nearly stretched
constexpr std::array<Side, 2> kSides = {kLeftSide, kRightSide};

double worst_of(const std::array<double, 2>& v) { return std::max(v[0], v[1]); }
double least_of(const std::array<double, 2>& v) { return std::min(v[0], v[1]); }
double farthest_from(double middle, const std::array<double, 2>& v) {
  return std::fabs(v[0] - middle) > std::fabs(v[1] - middle) ? v[0] : v[1];
}
std::string both_text(const std::array<double, 2>& v) {
  return fmt::format("left {:.3g}, right {:.3g}", v[0], v[1]);
}

template <class F>
std::array<double, 2> each_leg(F measure) {
  return {measure(kLeftSide), measure(kRightSide)};
}

std::array<double, 2> range_ratio(const Walk& even, const Walk& other, const Ticks& stride,
                                  LegJoint joint) {
  return each_leg([&](Side s) {
    return joint_range(other, stride, s, joint).size() / joint_range(even, stride, s, joint).size();
  });
}

double sum_of_others(const Walk& walk, const Ticks& stride, Side side) {
  return joint_range(walk, stride, side, LegJoint::knee).size() +
         joint_range(walk, stride, side, LegJoint::ankle).size();
}

double least_knee(const Walk& walk, const Ticks& stride) {
  return std::min(joint_range(walk, stride, kLeftSide, LegJoint::knee).min,
                  joint_range(walk, stride, kRightSide, LegJoint::knee).min);
}

// 13: a stiffened hip.
void stiff_hip_claims(const WeightWalks& w, const Ticks& stride, ClaimList& list) {
  const auto rms =
      each_leg([&](Side s) { return joint_rms(*w.even, *w.stiff_hip, stride, s, LegJoint::hip); });
  list.add("13 RMS change of the hip of stiff_hip against even, deg", least_of(rms), at_least(1.5),
           both_text(rms) + "; planar prototype 5.4, 3-D prototype 2.8 to 3.7");
  const auto hip = range_ratio(*w.even, *w.stiff_hip, stride, LegJoint::hip);
  list.add("13 hip range of stiff_hip over even", worst_of(hip), at_most(0.95),
           both_text(hip) +
               "; planar prototype 0.82 without joint limits, 0.94 with; 3-D prototype 0.994 to "
               "0.997 with the ends of a flight pinned to the plan (as robust does), 0.85 to 0.94 "
               "with the pitch left free");
  const auto others = each_leg([&](Side s) {
    return sum_of_others(*w.stiff_hip, stride, s) / sum_of_others(*w.even, stride, s);
  });
  list.add(
      "13 knee and ankle range of stiff_hip over even", least_of(others), more_than(1.0),
      both_text(others) +
          "; planar prototype 1.39 without joint limits, 1.26 with; 3-D prototype 0.90 to 0.96 "
          "pinned, 0.92 to 1.07 free");
  const auto knee = range_ratio(*w.even, *w.stiff_hip, stride, LegJoint::knee);
  list.add("13 knee range of stiff_hip over even", least_of(knee), more_than(1.0),
           both_text(knee) +
               "; the paper: \"extra movement in the knee joint compensates\"; planar prototype "
               "1.17 without joint limits, 0.98 with: then the ankle takes it");
  list.add("13 least knee angle of stiff_hip, deg", least_knee(*w.stiff_hip, stride), at_least(0.0),
           fmt::format("even {:.1f}; planar prototype -9.1 (heel) and -26.1 (toe) without joint "
                       "limits: the paper states none, and without them a stiff hip bends the knee "
                       "backwards",
                       least_knee(*w.even, stride)));
}

// 14: a knee stiffened a little.
void stiff_knee_claims(const WeightWalks& w, const Ticks& stride, ClaimList& list) {
  constexpr double kLeast = 0.2, kMost = 1.5;
  const auto extremes = each_leg([&](Side s) {
    const Range a = joint_range(*w.even, stride, s, LegJoint::hip),
                b = joint_range(*w.stiff_knee, stride, s, LegJoint::hip);
    return std::max(std::fabs(a.min - b.min), std::fabs(a.max - b.max));
  });
  list.add("14 hip's extremes of stiff_knee against even, deg", worst_of(extremes), at_most(3.0),
           both_text(extremes) + "; planar prototype 0.5, 3-D prototype 0.3");
  const auto rms =
      each_leg([&](Side s) { return joint_rms(*w.even, *w.stiff_knee, stride, s, LegJoint::hip); });
  list.add("14 RMS change of the hip of stiff_knee against even, deg",
           farthest_from(0.5 * (kLeast + kMost), rms), within(kLeast, kMost),
           both_text(rms) + "; planar prototype 0.53, 3-D prototype 0.5 to 0.8");
}

// Hip's change against even over the flights of a stride: at their ends, and the most between.
struct EndsAndMiddle {
  double ends_deg = 0.0, middle_deg = 0.0;
};
EndsAndMiddle ends_and_middle(const Walk& even, const Walk& other, const Ticks& stride) {
  EndsAndMiddle found;
  for (const Side side : kSides) {
    for (const Ticks& f : flights(even, side, 0.0)) {
      if (f.begin < stride.begin || f.end > stride.end) continue;
      for (std::size_t k = f.begin; k < f.end; ++k) {
        const double u = static_cast<double>(k - f.begin) / static_cast<double>(f.count());
        const double d = std::fabs(joint_deg(other, k, side, LegJoint::hip) -
                                   joint_deg(even, k, side, LegJoint::hip));
        const bool is_end = u < kEndShare || u > 1.0 - kEndShare;
        (is_end ? found.ends_deg : found.middle_deg) =
            std::max(is_end ? found.ends_deg : found.middle_deg, d);
      }
    }
  }
  return found;
}

// 15: ends of a stride close, its middle apart.
void end_claims(const WeightWalks& w, const Ticks& stride, ClaimList& list) {
  const EndsAndMiddle hip = ends_and_middle(*w.even, *w.stiff_hip, stride),
                      knee = ends_and_middle(*w.even, *w.stiff_knee, stride);
  list.add("15 hip of stiff_knee off even at the ends of flight, deg", knee.ends_deg,
           less_than(1.0), "the first and last tenth of the flights of the stride");
  list.add("15 the same over its most in mid-flight", knee.ends_deg / knee.middle_deg,
           less_than(1.0),
           fmt::format("mid-flight {:.2f} deg; planar prototype 0.53 against 0.77 deg",
                       knee.middle_deg));
  list.add("15 hip of stiff_hip off even at the ends over its most in mid-flight",
           hip.ends_deg / hip.middle_deg, less_than(1.0),
           fmt::format("ends {:.2f}, mid-flight {:.2f} deg; planar prototype 2.7 against 7.5 deg "
                       "with joint limits; without them its ends are its maximum, 7.9",
                       hip.ends_deg, hip.middle_deg));
  list.add("15 ends of stiff_hip over ends of stiff_knee", hip.ends_deg / knee.ends_deg,
           more_than(1.0), "the paper: green \"slightly more divergent\"");
}

double distance_mm(const vec3& a, const vec3& b) { return 1000.0 * glm::distance(a, b); }

// 16: where the feet go is not the weights' business.
void place_claims(const WeightWalks& w, const Ticks& stride, ClaimList& list) {
  double landing = 0.0, heel = 0.0, standing = 0.0, flying = 0.0;
  for (const Walk* other : {w.stiff_hip, w.stiff_knee}) {
    for (std::size_t k = stride.begin; k < stride.end; ++k) {
      const WalkFrame &a = w.even->samples[k].frame, &b = other->samples[k].frame;
      for (const Side side : kSides) {
        const bool lands = a.stage == Stage::roll && a.swing == side;
        const bool flies = a.stage == Stage::flight && a.swing == side;
        if (lands) landing = std::max(landing, distance_mm(a.heel_m[side], b.heel_m[side]));
        if (flies) heel = std::max(heel, distance_mm(a.heel_m[side], b.heel_m[side]));
        double& toe = a.toe_planted[side] ? standing : flying;
        toe = std::max(toe, distance_mm(a.toe_m[side], b.toe_m[side]));
      }
    }
  }
  list.add("16 landing places of the heels differ, mm", landing, at_most(1.0));
  list.add("16 planted toes differ, mm", standing, at_most(1.0));
  list.add("16 swinging heels differ, mm", heel, at_most(1.0),
           fmt::format("the flying toe, which table I prescribes no place for, by {:.0f} mm: that "
                       "is what the weights move; 3-D prototype 1 to 60 mm",
                       flying));
}

}  // namespace

std::vector<Claim> weight_claims(const WeightWalks& walks, const Ticks& stride, IkMode mode) {
  ClaimList list(kSection, mode);
  stiff_hip_claims(walks, stride, list);
  stiff_knee_claims(walks, stride, list);
  end_claims(walks, stride, list);
  place_claims(walks, stride, list);
  return list.take();
}

std::vector<Claim> monotone_claims(const std::vector<double>& rms_deg, IkMode mode) {
  ClaimList list(kSection, mode);
  int falls = 0;
  std::string text;
  for (std::size_t i = 0; i < rms_deg.size(); ++i) {
    falls += i > 0 && !(rms_deg[i] > rms_deg[i - 1]);
    text += fmt::format("{}{:.2f}", i > 0 ? " / " : "", rms_deg[i]);
  }
  list.add("17 hip weights at which its RMS change does not grow", falls, equal_to(0),
           "hip 0.9 / 0.8 / 0.5 / 0.2: " + text +
               " deg; planar prototype .14 / .32 / 1.30 / 5.4 (4.6 with joint limits), 3-D "
               "prototype .62 / .72 / 1.3 / 2.8");
  return list.take();
}

}  // namespace gaitpad
