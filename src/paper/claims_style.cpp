// Assertions 26-28: fatigue, the hips' two parameters, the body above them.
#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "paper/claims.h"
#include "paper/planted.h"

namespace gaitpad {
namespace {

constexpr double kSteady_s = 4.0;

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

struct Pace {
  double step_m = 0.0, speed_m_s = 0.0;
};
Pace tired_pace(const WalkModel& model, double fatigue) {
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
  const Ticks stride = stride_after(walk, kRightSide, kSteady_s);
  Range yaw{1e9, -1e9}, height{1e9, -1e9};
  for (std::size_t k = stride.begin; k < stride.end; ++k) {
    const WalkSample& s = walk.samples[k];
    yaw = {std::min(yaw.min, s.pelvis_yaw_rad), std::max(yaw.max, s.pelvis_yaw_rad)};
    height = {std::min(height.min, s.frame.pelvis_m.y), std::max(height.max, s.frame.pelvis_m.y)};
  }
  return {yaw.size() / kDegree, 1e3 * height.size(), planted_slide_mm(walk)};
}

// Joints that are neither in a leg nor between the root and the pelvis.
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

// The first joint whose name says an arm's end of that side: hand, wrist or forearm.
int hand_of(const Skeleton& skeleton, Side side) {
  const std::string word = side == kLeftSide ? "left" : "right";
  for (const char* part : {"hand", "wrist", "forearm"}) {
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
      const std::string name = lower_case(skeleton.joints[j].name);
      const bool is_side = name.find(word) != std::string::npos || name.starts_with(word[0]);
      if (is_side && name.find(part) != std::string::npos) return static_cast<int>(j);
    }
  }
  return -1;
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

// How a hand's place before the pelvis goes with the other leg's hip flexion, the lesser of both.
double arm_and_leg(const WalkModel& model, double stick) {
  const Walk walk = straight(model, {}, IkMode::robust, stick, 10.0);
  const Ticks stride = stride_after(walk, kRightSide, 5.0);
  double least = 1.0;
  for (const Side side : {kLeftSide, kRightSide}) {
    const int hand = hand_of(model.cycle.skeleton, side);
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
  int back = 0;  // ticks at which the data's time runs backwards
};
Above above_the_hips(const WalkModel& model) {
  const std::vector<int> upper = upper_joints(model.cycle);
  Above found;
  Pose source;
  double before = 0.0;
  bool was_whole = false;
  straight(model, {}, IkMode::robust, kPaperStick, 7.0, [&](const WalkState& s, const Pose& pose) {
    const bool is_whole = presence(s) >= 1.0 && s.stage != Stage::idle;
    if (is_whole) {
      sample_local(model.cycle, s.phase, source);
      for (const int j : upper) {
        found.apart_deg = std::max(found.apart_deg, apart_deg(source.local[j], pose.local[j]));
      }
      const double move = s.phase - before;
      found.back += was_whole && !(move - std::floor(move + 0.5) > 0.0);
    }
    before = s.phase;
    was_whole = is_whole;
  });
  return found;
}

}  // namespace

std::vector<Claim> fatigue_claims(const Study& study) {
  ClaimList list("3.1", IkMode::robust);
  const Pace fresh = tired_pace(study.model(), 0.0), spent = tired_pace(study.model(), 1.0);
  double step = 0.0, speed = 0.0;
  int rises = 0;
  Pace before = fresh;
  for (const double f : {0.25, 0.5, 0.75, 1.0}) {
    const Pace now = tired_pace(study.model(), f);
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
  return list.take();
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
           heights +
               "; not proportional: the reach of the legs lowers the hips at every step, "
               "whatever the parameter");
  list.add("27 planted feet slide for all of them by, mm", slide, at_most(0.1));
  return list.take();
}

std::vector<Claim> body_claims(const Study& study) {
  ClaimList list("3.2", IkMode::robust);
  const Above above = above_the_hips(study.model());
  list.add("28 joints above the hips off the data at the warped time, deg", above.apart_deg,
           at_most(1e-6));
  list.add("28 ticks at which the warped time does not advance", above.back, equal_to(0));
  const std::string name = "28 hand against the opposite hip, correlation";
  const Skeleton& skeleton = study.model().cycle.skeleton;
  if (hand_of(skeleton, kLeftSide) < 0 || hand_of(skeleton, kRightSide) < 0) {
    list.add_untested(name, more_than(0.8), "no hands by name in this skeleton");
    return list.take();
  }
  double least = 1.0;
  std::string text;
  for (const double stick : {0.3, 0.6, 1.0}) {
    const double r = arm_and_leg(study.model(), stick);
    text += fmt::format("{}{}: {:.2f}", text.empty() ? "stick " : ", ", stick, r);
    least = std::min(least, r);
  }
  list.add(name, least, more_than(0.8), text);
  return list.take();
}

}  // namespace gaitpad
