// Assertions 13-17: figure 5a. 18-20: figure 5b. 25: the joystick. 26-28: fatigue, hips, upper
// body. Some notes compare with two earlier prototypes of the paper's method: a planar leg (heel as
// effector, warm start) and a 3-D walk.

#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"
#include "paper/study.h"

namespace gaitpad {
namespace {

constexpr const char* kSection5a = "4, figure 5a";
// Last share of a flight: before its strike the leg is nearly stretched.
constexpr double kEndShare = 0.1;
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

// Claim 13: a stiffened hip.
void stiff_hip_claims(const WeightWalks& w, const Ticks& stride, ClaimList& list) {
  const auto rms =
      each_leg([&](Side s) { return joint_rms(*w.even, *w.stiff_hip, stride, s, LegJoint::hip); });
  list.add("13 RMS change of the hip of stiff_hip against even, deg", least_of(rms), at_least(1.5),
           both_text(rms) + "; planar prototype 5.4, 3-D prototype 2.8 to 3.7");
  const auto hip = range_ratio(*w.even, *w.stiff_hip, stride, LegJoint::hip);
  list.add("13 hip range of stiff_hip over even", worst_of(hip), at_most(0.90),
           both_text(hip) +
               "; planar prototype 0.82 without joint limits, 0.94 with; 3-D prototype 0.994 to "
               "0.997 with pelvis and foot pinned to the plan, 0.85 to 0.94 with the pitch left "
               "free (robust mode)");
  const auto others = each_leg([&](Side s) {
    return sum_of_others(*w.stiff_hip, stride, s) / sum_of_others(*w.even, stride, s);
  });
  list.add(
      "13 knee and ankle range of stiff_hip over even", least_of(others), at_least(0.99),
      both_text(others) +
          "; planar prototype 1.39 without joint limits, 1.26 with; 3-D prototype 0.90 to 0.96 "
          "pinned, 0.92 to 1.07 free");
  const auto knee =
      each_leg([&](Side s) { return joint_rms(*w.even, *w.stiff_hip, stride, s, LegJoint::knee); });
  list.add("13 RMS change of the knee of stiff_hip against even, deg", least_of(knee),
           at_least(1.5),
           both_text(knee) +
               "; the paper: \"extra movement in the knee joint compensates\"; range over even " +
               both_text(range_ratio(*w.even, *w.stiff_hip, stride, LegJoint::knee)) +
               ": the strike and the flying heel's path fix its extremes");
  list.add("13 least knee angle of stiff_hip, deg", least_knee(*w.stiff_hip, stride), at_least(0.0),
           fmt::format("even {:.1f}; planar prototype -9.1 (heel) and -26.1 (toe) without joint "
                       "limits: the paper states none, and without them a stiff hip bends the knee "
                       "backwards",
                       least_knee(*w.even, stride)));
}

// Claim 14: a slightly stiffened knee.
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

// Change of the hip against even in the flights of a stride: at their ends, where the leg is nearly
// stretched, and the largest change before.
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
        const bool is_end = u > 1.0 - kEndShare;
        (is_end ? found.ends_deg : found.middle_deg) =
            std::max(is_end ? found.ends_deg : found.middle_deg, d);
      }
    }
  }
  return found;
}

// Claim 15: walks agree where a leg is nearly stretched, and differ before that.
void end_claims(const WeightWalks& w, const Ticks& stride, ClaimList& list) {
  const EndsAndMiddle hip = ends_and_middle(*w.even, *w.stiff_hip, stride),
                      knee = ends_and_middle(*w.even, *w.stiff_knee, stride);
  list.add("15 hip of stiff_knee off even at the ends of flight, deg", knee.ends_deg,
           less_than(1.0),
           "the last tenth of the flights of the stride: the chain \"close to being completely "
           "extended\"");
  list.add(
      "15 the same over its most before", knee.ends_deg / knee.middle_deg, less_than(1.0),
      fmt::format("before {:.2f} deg; planar prototype 0.53 against 0.77 deg", knee.middle_deg));
  list.add("15 hip of stiff_hip off even at the ends over its most before",
           hip.ends_deg / hip.middle_deg, less_than(1.0),
           fmt::format("ends {:.2f}, before {:.2f} deg; planar prototype 2.7 against 7.5 deg "
                       "with joint limits; without them its ends are its maximum, 7.9",
                       hip.ends_deg, hip.middle_deg));
  list.add("15 ends of stiff_hip over ends of stiff_knee", hip.ends_deg / knee.ends_deg,
           more_than(1.0), "the paper: green \"slightly more divergent\"");
}

double distance_mm(const vec3& a, const vec3& b) { return 1000.0 * glm::distance(a, b); }

// Claim 16: weights do not change the paths of the feet.
void place_claims(const WeightWalks& w, const Ticks& stride, ClaimList& list) {
  double landing = 0.0, heel = 0.0, lifting = 0.0, standing = 0.0, flying = 0.0;
  for (const Walk* other : {w.stiff_hip, w.stiff_knee}) {
    for (std::size_t k = stride.begin; k < stride.end; ++k) {
      const WalkFrame &a = w.even->samples[k].frame, &b = other->samples[k].frame;
      for (const Side side : kSides) {
        const bool lands = a.stage == Stage::roll && a.swing == side;
        if (lands) landing = std::max(landing, distance_mm(a.heel_m[side], b.heel_m[side]));
        double& toe = a.toe_planted[side] ? standing : flying;
        toe = std::max(toe, distance_mm(a.toe_m[side], b.toe_m[side]));
      }
    }
    for (const Side side : kSides) {
      for (const Ticks& f : flights(*w.even, side, 0.0)) {
        if (f.begin < stride.begin || f.end > stride.end) continue;
        for (std::size_t k = f.begin; k < f.end; ++k) {
          double& off = 2 * (k - f.begin) < f.count() ? lifting : heel;
          off = std::max(off, distance_mm(w.even->samples[k].frame.heel_m[side],
                                          other->samples[k].frame.heel_m[side]));
        }
      }
    }
  }
  list.add("16 landing places of the heels differ, mm", landing, at_most(1.0));
  list.add("16 planted toes differ, mm", standing, at_most(1.0));
  list.add("16 heels differ in the second half of a flight, mm", heel, at_most(1.0),
           fmt::format("in the first half, where the foot still turns about its toe, by {:.0f} mm, "
                       "and the flying toe, which table I prescribes no place for, by {:.0f} mm: "
                       "that is what the weights move; 3-D prototype 1 to 60 mm",
                       lifting, flying));
}

constexpr const char* kSection5b = "4, figure 5b";
constexpr double kSteady_s = 3.5;  // time after the start from which the walk is
                                   // steady
// The middle of a flight, in shares of its duration.
constexpr double kMidFrom = 0.25, kMidTo = 0.75;

double forward_m(const WalkFrame& frame, const vec3& v) {
  return glm::dot(v, heading_direction(frame.heading_rad));
}

struct FlightFigures {
  double ticks = 0.0, peak_m = 0.0;
  double reach_m = 0.0;      // distance that the heel covers in the flight
  double clearance_m = 0.0;  // smallest height of the toe in mid-flight
  double step_m = 0.0;       // distance from the standing heel to the landing heel
};

// Means over the steady flights of a foot.
FlightFigures flight_figures(const Walk& walk, Side side) {
  FlightFigures sum;
  int count = 0;
  for (const Ticks& f : flights(walk, side, kSteady_s)) {
    double peak = 0.0, clearance = 1e9;
    for (std::size_t k = f.begin; k < f.end; ++k) {
      const WalkFrame& frame = walk.samples[k].frame;
      const double u = static_cast<double>(k - f.begin) / static_cast<double>(f.count());
      peak = std::max(peak, frame.heel_m[side].y);
      if (u > kMidFrom && u < kMidTo) clearance = std::min(clearance, frame.toe_m[side].y);
    }
    const WalkFrame &lift = walk.samples[f.begin].frame, &land = walk.samples[f.end].frame;
    std::size_t stood = f.begin;  // the last tick at which the other heel stood
    while (stood > 0 && !walk.samples[stood].frame.heel_planted[other(side)]) --stood;
    sum.step_m +=
        forward_m(land, land.heel_m[side] - walk.samples[stood].frame.heel_m[other(side)]);
    sum.reach_m += forward_m(land, land.heel_m[side] - lift.heel_m[side]);
    sum.ticks += static_cast<double>(f.count());
    sum.peak_m += peak;
    sum.clearance_m += clearance;
    ++count;
  }
  const double n = count;
  return {sum.ticks / n, sum.peak_m / n, sum.reach_m / n, sum.clearance_m / n, sum.step_m / n};
}

double least_hips_speed(const Walk& walk) {
  double slowest = 1e9;
  for (std::size_t k = 1; k < walk.samples.size(); ++k) {
    if (static_cast<double>(k) < kSteady_s * kPaperRate_hz) continue;
    const WalkSample &a = walk.samples[k - 1], &b = walk.samples[k];
    slowest = std::min(slowest, forward_m(b.frame, b.hips_m - a.hips_m) * kPaperRate_hz);
  }
  return slowest;
}

constexpr double kSteadyHips_s = 4.0;

Walk straight(const WalkModel& model, const StyleValues& style, IkMode mode, double stick,
              double end_s, const EachTick& each = {}) {
  WalkCase what;
  what.model = &model;
  what.style = style;
  what.ik = mode;
  what.stick = {{0.5, vec2(0.0, stick)}};
  what.end_s = end_s;
  what.keeps_joints = true;
  return walked(what, each);
}

struct TiredGait {
  double step_m = 0.0, speed_m_s = 0.0;
};
TiredGait tired_pace(const WalkModel& model, double fatigue) {
  StyleValues style;
  style.fatigue = fatigue;
  const WalkFrame f = straight(model, style, IkMode::robust, 1.0, 7.0).samples.back().frame;
  return {f.stride_m[kRightSide], f.speed_m_s};
}

struct HipTravel {
  double yaw_deg = 0.0, height_mm = 0.0, slide_mm = 0.0;
};
HipTravel hip_travel(const WalkModel& model, const StyleValues& style, IkMode mode) {
  const Walk walk = straight(model, style, mode, kPaperStick, 8.0);
  const Ticks stride = stride_after(walk, kRightSide, kSteadyHips_s);
  Range yaw{1e9, -1e9}, height{1e9, -1e9};
  for (std::size_t k = stride.begin; k < stride.end; ++k) {
    const WalkSample& s = walk.samples[k];
    yaw = {std::min(yaw.min, s.pelvis_yaw_rad), std::max(yaw.max, s.pelvis_yaw_rad)};
    height = {std::min(height.min, s.frame.pelvis_m.y), std::max(height.max, s.frame.pelvis_m.y)};
  }
  return {yaw.size() / kDegree, 1e3 * height.size(), planted_slide_mm(walk)};
}

// Joints that are neither in a leg nor between root and pelvis.
std::vector<int> upper_joints(const GaitCycle& cycle) {
  const auto& joints = cycle.skeleton.joints;
  std::vector<bool> is_lower(joints.size(), false);
  for (int j = cycle.pelvis; j >= 0; j = joints[static_cast<std::size_t>(j)].parent) {
    is_lower[static_cast<std::size_t>(j)] = true;
  }
  std::vector<int> upper;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int parent = joints[j].parent;
    const bool is_hip = static_cast<int>(j) == cycle.leg[0].joints.hip ||
                        static_cast<int>(j) == cycle.leg[1].joints.hip;
    const bool in_leg = parent >= 0 && parent != cycle.pelvis &&
                        is_lower[static_cast<std::size_t>(parent)] && parent > cycle.pelvis;
    if (is_hip || in_leg) is_lower[j] = true;
    if (!is_lower[j] && !joints[j].is_end_site) upper.push_back(static_cast<int>(j));
  }
  return upper;
}

double apart_deg(const quat& a, const quat& b) {
  return 2.0 * glm::length(rotation_vector(glm::inverse(a) * b)) * 0.5 / kDegree;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  const double n = static_cast<double>(a.size());
  double ma = 0.0, mb = 0.0, saa = 0.0, sbb = 0.0, sab = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) ma += a[i] / n, mb += b[i] / n;
  for (std::size_t i = 0; i < a.size(); ++i) {
    saa += (a[i] - ma) * (a[i] - ma);
    sbb += (b[i] - mb) * (b[i] - mb);
    sab += (a[i] - ma) * (b[i] - mb);
  }
  return sab / std::sqrt(saa * sbb);
}

// Correlation of a hand's forward position relative to the pelvis with the other leg's hip flexion;
// the smaller value of both sides.
double arm_and_leg(const WalkModel& model, double stick) {
  const Walk walk = straight(model, {}, IkMode::robust, stick, 10.0);
  const Ticks stride = stride_after(walk, kRightSide, 5.0);
  double least = 1.0;
  for (const Side side : {kLeftSide, kRightSide}) {
    const int hand = model.body.joints.arm[side].wrist;
    std::vector<double> swing, hip;
    for (std::size_t k = stride.begin; k < stride.end; ++k) {
      const WalkSample& s = walk.samples[k];
      swing.push_back((s.joints_m[static_cast<std::size_t>(hand)] - s.frame.pelvis_m).z);
      hip.push_back(joint_deg(walk, k, other(side), LegJoint::hip));
    }
    least = std::min(least, correlation(swing, hip));
  }
  return least;
}

struct Above {
  double apart_deg = 0.0;
  int back = 0;  // number of ticks in which the data's time runs backwards
};
// Measures the joints above the hips; in robust mode without shoulders and elbows, because the
// speed sets the swing of the arms.
Above above_the_hips(const WalkModel& model, IkMode mode) {
  std::vector<int> upper = upper_joints(model.cycle);
  if (mode == IkMode::robust) {
    std::erase_if(upper, [&](int joint) {
      return std::ranges::any_of(model.body.joints.arm, [&](const ArmChain& arm) {
        return joint == arm.shoulder || joint == arm.elbow;
      });
    });
  }
  Above found;
  Pose source;
  double before = 0.0;
  bool was_whole = false;
  straight(model, {}, mode, kPaperStick, 7.0, [&](const WalkState& s, const Pose& pose) {
    const bool is_whole = presence(s) >= 1.0 && walk_steps(s).stage != Stage::idle;
    if (is_whole) {
      sample_local(model.cycle, shown_phase(s), source);
      for (const int j : upper) {
        found.apart_deg = std::max(found.apart_deg, apart_deg(source.local[j], pose.local[j]));
      }
      const double move = shown_phase(s) - before;
      found.back += was_whole && !(move - std::floor(move + 0.5) > 0.0);
    }
    before = shown_phase(s);
    was_whole = is_whole;
  });
  return found;
}

constexpr int kSecond = kPaperRate_hz;

Stick stick_for(const vec2& raw) {
  Pads pads({paper_pad()}, kPaperRate_hz);
  pads.take_report(paper_report(raw));
  return pads.finish_tick();
}

// Counts grid positions inside the inner zone that are not neutral.
int not_neutral() {
  int count = 0;
  const double inner = StickCalibration{}.inner;
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j) {
      const vec2 raw = vec2(i, j) * (inner / 20.0);
      if (glm::length(raw) > 0.995 * inner) continue;
      const Stick stick = stick_for(raw);
      count += stick.left.x != 0.0 || stick.left.y != 0.0;
    }
  }
  return count;
}

int speed_falls(const GaitLimits& limits) {
  int falls = 0;
  double before = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const GaitParams params = gait_params(stick_for(vec2(0.0, i / 400.0)), {}, limits);
    const StrideParams& s = params.stride[kRightSide];
    const double speed = params.walking ? s.length_m / s.time_s : 0.0;
    falls += speed < before;
    before = speed;
  }
  return falls;
}

void run(Simulation& simulation, int ticks, const std::vector<Report>& first) {
  for (int k = 0; k < ticks; ++k) simulation.step(k == 0 ? first : std::vector<Report>{});
}

// Largest second difference of a leg angle over the ticks, degrees; the stick moves to `raw` at the
// first tick.
double second_difference(Simulation& simulation, const vec2& raw, int ticks) {
  const Walker& walker = simulation.walkers()[0];
  const auto angles_rad = [&] { return leg_angles(*walker.model, walker.pose); };
  std::array<LegAngles, 2> last = angles_rad(), before_last = last;
  simulation.step({});
  before_last = last, last = angles_rad();
  double most = 0.0;
  for (int k = 0; k < ticks; ++k) {
    simulation.step(k == 0 ? std::vector<Report>{paper_report(raw)} : std::vector<Report>{});
    const std::array<LegAngles, 2> now = angles_rad();
    for (const Side side : {kLeftSide, kRightSide}) {
      for (int j = 0; j < kLegDofs; ++j) {
        const double d = now[side][j] - 2.0 * last[side][j] + before_last[side][j];
        most = std::max(most, std::fabs(d) / kDegree);
      }
    }
    before_last = last, last = now;
  }
  return most;
}

}  // namespace

std::vector<Claim> weight_claims(const WeightWalks& walks, const Ticks& stride, IkMode mode) {
  ClaimList list(kSection5a, mode);
  stiff_hip_claims(walks, stride, list);
  stiff_knee_claims(walks, stride, list);
  end_claims(walks, stride, list);
  place_claims(walks, stride, list);
  return list.take_claims();
}

std::vector<Claim> monotone_claims(const std::vector<double>& rms_deg, IkMode mode) {
  ClaimList list(kSection5a, mode);
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
  return list.take_claims();
}

std::vector<Claim> limp_claims(const LimpWalks& walks, IkMode mode) {
  ClaimList list(kSection5b, mode);
  const FlightFigures even = flight_figures(*walks.even, kLeftSide),
                      even_right = flight_figures(*walks.even, kRightSide),
                      left = flight_figures(*walks.limp, kLeftSide),
                      right = flight_figures(*walks.limp, kRightSide);
  list.add("18 left heel's peak of the limp over even's", left.peak_m / even.peak_m,
           within(0.44, 0.56),
           fmt::format("{:.0f} against {:.0f} mm; the right one {:.0f} mm", 1e3 * left.peak_m,
                       1e3 * even.peak_m, 1e3 * right.peak_m));
  list.add("18 left step of the limp over its right step", left.step_m / right.step_m,
           within(0.49, 0.51), fmt::format("{:.3f} and {:.3f} m", left.step_m, right.step_m));
  list.add("18 ticks of the left flight off even's / 1.3", std::fabs(left.ticks - even.ticks / 1.3),
           at_most(1.0), fmt::format("{:.1f} against {:.1f} at 240 Hz", left.ticks, even.ticks));
  list.add("18 right step of the limp over even's", right.step_m / even_right.step_m,
           within(0.98, 1.02));
  list.add("18 right heel's peak of the limp over even's", right.peak_m / even_right.peak_m,
           within(0.90, 1.10),
           "beside a lame foot the hips are lower where the right heel leaves the floor, which is "
           "where its flight begins");
  list.add("19 left toe's clearance in mid-flight over the right one's",
           left.clearance_m / right.clearance_m, less_than(1.0),
           fmt::format("{:.0f} and {:.0f} mm{}", 1e3 * left.clearance_m, 1e3 * right.clearance_m,
                       mode == IkMode::paper ? "; in paper mode a flying toe has no goal" : ""));
  list.add("19 left heel's peak over the right one's", left.peak_m / right.peak_m, less_than(1.0),
           "the paper: \"the left-hand side trail barely skims the ground\"");
  list.add("19 right step over the left one", right.step_m / left.step_m, more_than(1.01));
  list.add(
      "19 ground that the right foot covers in a flight over the left's",
      right.reach_m / left.reach_m, more_than(1.01),
      "the paper: the right trail \"travels further per stride\"; in a straight walk both feet "
      "cover left + right step in every cycle, only the heel's lift-off place may differ");
  list.add("19 least forward speed of the limping hips, m/s", least_hips_speed(*walks.limp),
           more_than(0.0));
  return list.take_claims();
}

std::vector<Claim> limp_weight_claims(const LimpWalks& walks, const Ticks& stride, IkMode mode) {
  ClaimList list(kSection5b, mode);
  const auto range = [&](const Walk* w, LegJoint j) {
    return joint_range(*w, stride, kLeftSide, j).size();
  };
  const double hip = range(walks.limp_hip, LegJoint::hip), red = range(walks.limp, LegJoint::hip);
  list.add("20 left hip's range of limp_left_hip over limp_left", hip / red, less_than(1.0),
           fmt::format("{:.2f} against {:.2f} deg; 3-D prototype: only 0.2 to 0.4 deg less, since "
                       "the sound leg holds the pelvis",
                       hip, red));
  list.add("20 left knee's range of limp_left_knee over limp_left",
           range(walks.limp_knee, LegJoint::knee) / range(walks.limp, LegJoint::knee),
           less_than(1.0));
  double most = 0.0;
  for (const Walk* other : {walks.limp_hip, walks.limp_knee}) {
    for (std::size_t k = stride.begin; k < stride.end; ++k) {
      for (int j = 0; j < kLegDofs; ++j) {
        const double d = other->samples[k].angles_rad[kRightSide][j] -
                         walks.limp->samples[k].angles_rad[kRightSide][j];
        most = std::max(most, std::fabs(d) / kDegree);
      }
    }
  }
  list.add("20 right leg's angles change by, deg", most, at_most(1.0),
           "3-D prototype 0.06 (built-in and walk01) to 0.6 (m21)");
  return list.take_claims();
}

std::vector<Claim> fatigue_claims(const Study& study) {
  ClaimList list("3.1", IkMode::robust);
  const TiredGait fresh = tired_pace(study.model(), 0.0), spent = tired_pace(study.model(), 1.0);
  double step = 0.0, speed = 0.0;
  int rises = 0;
  TiredGait before = fresh;
  for (const double f : {0.25, 0.5, 0.75, 1.0}) {
    const TiredGait now = tired_pace(study.model(), f);
    step =
        std::max(step, std::fabs(now.step_m - mix(fresh.step_m, spent.step_m, f)) / fresh.step_m);
    speed = std::max(speed, std::fabs(now.speed_m_s - mix(fresh.speed_m_s, spent.speed_m_s, f)) /
                                fresh.speed_m_s);
    rises += !(now.step_m < before.step_m && now.speed_m_s < before.speed_m_s);
    before = now;
  }
  list.add("26 greatest step off a linear function of fatigue, %", 100.0 * step, at_most(0.1),
           fmt::format("walked, fresh {:.3f} m, spent {:.3f} m", fresh.step_m, spent.step_m));
  list.add("26 greatest speed off a linear function of fatigue, %", 100.0 * speed, at_most(1.0),
           fmt::format("walked, {:.3f} and {:.3f} m/s; stages last whole ticks", fresh.speed_m_s,
                       spent.speed_m_s));
  list.add("26 more fatigue that does not slow", rises, equal_to(0));
  StyleValues none;
  none.fatigue = 0.0;
  const Walk a = straight(study.model(), none, IkMode::robust, 1.0, 4.0),
             b = straight(study.model(), {}, IkMode::robust, 1.0, 4.0);
  double apart = 0.0;
  for (std::size_t k = 0; k < a.samples.size(); ++k) {
    apart = std::max(apart, glm::distance(a.samples[k].hips_m, b.samples[k].hips_m));
  }
  list.add("26 walk with fatigue 0 off the normal one, m", apart, equal_to(0));
  return list.take_claims();
}

std::vector<Claim> hip_claims(const Study& study, IkMode mode) {
  ClaimList list("3.1", mode);
  std::array<HipTravel, 4> sway, bounce;
  for (std::size_t i = 0; i < 4; ++i) {
    StyleValues style;
    style.hip_sway = static_cast<double>(i);
    sway[i] = hip_travel(study.model(), style, mode);
    style.hip_sway = 1.0;
    style.hip_bounce = static_cast<double>(i);
    bounce[i] = hip_travel(study.model(), style, mode);
  }
  const std::string yaws =
      fmt::format("0 / 1 / 2 / 3: {:.2f} / {:.2f} / {:.2f} / {:.2f} deg", sway[0].yaw_deg,
                  sway[1].yaw_deg, sway[2].yaw_deg, sway[3].yaw_deg);
  list.add("27 hips' turn with sway 0, deg", sway[0].yaw_deg, at_most(0.01), yaws);
  list.add("27 hips' turn with sway 2 over that with 1", sway[2].yaw_deg / sway[1].yaw_deg,
           within(1.95, 2.05), yaws);
  const std::string heights =
      fmt::format("0 / 1 / 2 / 3: {:.0f} / {:.0f} / {:.0f} / {:.0f} mm", bounce[0].height_mm,
                  bounce[1].height_mm, bounce[2].height_mm, bounce[3].height_mm);
  int falls = 0;
  double slide = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    falls += i > 0 && !(bounce[i].height_mm > bounce[i - 1].height_mm);
    slide = std::max({slide, sway[i].slide_mm, bounce[i].slide_mm});
  }
  list.add("27 more bounce that does not raise the hips' travel", falls, equal_to(0), heights);
  list.add("27 hips' travel with bounce 2 over that with 1",
           bounce[2].height_mm / bounce[1].height_mm, within(1.9, 2.1),
           heights + "; at 0 and 3 the reach of the legs bounds it");
  list.add("27 planted feet slide for all of them by, mm", slide, at_most(0.1));
  return list.take_claims();
}

std::vector<Claim> body_claims(const Study& study) {
  ClaimList list("3.2", IkMode::robust);
  const Above above = above_the_hips(study.model(), IkMode::robust),
              all = above_the_hips(study.model(), IkMode::paper);
  list.add("28 joints above the hips off the data at the warped time, deg",
           std::max(above.apart_deg, all.apart_deg), at_most(1e-6),
           "in robust mode shoulders and elbows apart, which swing as far as the pace asks");
  list.add("28 ticks at which the warped time does not advance", above.back, equal_to(0));
  const std::string name = "28 hand against the opposite hip, correlation";
  const auto& arms = study.model().body.joints.arm;
  if (!arms[kLeftSide].is_found() || !arms[kRightSide].is_found()) {
    list.add_untested(name, more_than(0.8), "no arms were found in this skeleton");
    return list.take_claims();
  }
  double least = 1.0;
  std::string text;
  for (const double stick : {0.3, 0.6, 1.0}) {
    const double r = arm_and_leg(study.model(), stick);
    text += fmt::format("{}{}: {:.2f}", text.empty() ? "stick " : ", ", stick, r);
    least = std::min(least, r);
  }
  list.add(name, least, more_than(0.8), text);
  return list.take_claims();
}

std::vector<Claim> pad_claims(const Study& study) {
  ClaimList list("3.1", IkMode::robust);
  const std::vector<Style> styles = {style_of(study.source(), "even")};
  auto simulation = Simulation::create(paper_session(study.source().cycle, styles, IkMode::robust));
  if (!simulation) {
    list.add_untested("25 gamepad", equal_to(0), simulation.error().message);
    return list.take_claims();
  }
  const Walker& walker = simulation->walkers()[0];
  const GaitLimits& limits = walker.limits;
  list.add("25 sticks inside the dead zone that are not exactly neutral", not_neutral(),
           equal_to(0));
  list.add("25 deflections at which more stick walks slower", speed_falls(limits), equal_to(0));
  run(*simulation, 6 * kSecond, {paper_report(vec2(0.0, 1.0))});
  const WalkFrame frame = walk_frame(walker);
  list.add("25 step at full stick over the greatest",
           frame.stride_m[kRightSide] / limits.max_step_m / limits.step_share[kRightSide],
           within(0.995, 1.005));
  list.add("25 speed at full stick over the greatest", frame.speed_m_s / limits.max_speed_m_s,
           within(0.99, 1.01), "stages last whole ticks");
  run(*simulation, 4 * kSecond, {paper_report(vec2(0.0, 0.5))});
  list.add("25 leg angles' second difference when the stick jumps, deg/tick^2",
           second_difference(*simulation, vec2(0.0, 1.0), 3 * kSecond), at_most(1.0),
           "0.5 to full stick in mid-step");
  run(*simulation, 2 * kSecond, {});
  simulation->step(std::vector<Report>{paper_unplug()});
  const bool is_neutral = glm::length(simulation->stick().left) == 0.0;
  list.add("25 stick on the tick of the unplugging", is_neutral ? 0.0 : 1.0, equal_to(0));
  int ticks = 0;
  while (walk_steps(walker.state).stage != Stage::idle && ticks < 10 * kSecond) {
    simulation->step({});
    ++ticks;
  }
  list.add("25 from unplugging to standing on both feet, s", static_cast<double>(ticks) / kSecond,
           at_most(3.0), "the step that runs, and one that brings the feet together");
  return list.take_claims();
}

}  // namespace gaitpad
