// Assertion 24: straight on or turning.
#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"
#include "paper/planted.h"

namespace gaitpad {
namespace {

constexpr double kForward = 0.6, kHalf = 0.5;  // stick
constexpr std::array<double, 3> kSideways = {0.25, kHalf, 0.8};
constexpr double kTurning_s = 4.0;  // after the start the turn is steady

Walk turning(const WalkModel& model, IkMode mode, double x, double end_s) {
  WalkCase what;
  what.model = &model;
  what.ik = mode;
  what.stick = {{0.5, vec2(x, kForward)}};
  what.end_s = end_s;
  return walked(what);
}

// Sideways way of the hips in a stride, mm, the worst.
double straight_drift_mm(const Walk& walk) {
  double worst = 0.0;
  for (const Ticks& s : strides(walk, kRightSide)) {
    const vec3 move = walk.samples[s.end].hips_m - walk.samples[s.begin].hips_m;
    worst = std::max(worst, 1e3 * std::fabs(move.x));
  }
  return worst;
}

// The greatest distance of heels, toes and pelvis from the other walk's mirror image.
double mirror_gap_m(const Walk& a, const Walk& b) {
  double most = 0.0;
  const auto gap = [&most](const vec3& p, vec3 q) {
    q.x = -q.x;
    most = std::max(most, glm::distance(p, q));
  };
  for (std::size_t k = 0; k < std::min(a.samples.size(), b.samples.size()); ++k) {
    const WalkFrame &f = a.samples[k].frame, &g = b.samples[k].frame;
    gap(f.pelvis_m, g.pelvis_m);
    for (const Side side : {kLeftSide, kRightSide}) {
      gap(f.heel_m[side], g.heel_m[other(side)]);
      gap(f.toe_m[side], g.toe_m[other(side)]);
    }
  }
  return most;
}

struct Circle {
  double radius_error = kNoNumber;  // share of speed over turn rate
  double closes_m = kNoNumber;
};
Circle circle_of(const Walk& walk) {
  const auto begin = static_cast<std::size_t>(kTurning_s * kPaperRate_hz);
  const double from = walk.samples[begin].frame.heading_rad;
  vec3 sum(0.0);
  std::size_t end = begin;
  while (end < walk.samples.size() &&
         std::fabs(walk.samples[end].frame.heading_rad - from) < 2.0 * kPi) {
    sum += walk.samples[end++].hips_m;
  }
  if (end == walk.samples.size()) return {};
  const double n = static_cast<double>(end - begin);
  const vec3 centre = sum / n;
  double radius = 0.0, rate = 0.0, speed = 0.0;
  for (std::size_t k = begin; k < end; ++k) {
    radius += glm::distance(walk.samples[k].hips_m, centre) / n;
    rate += std::fabs(walk.samples[k].frame.turn_rate_rad_s) / n;
    speed += walk.samples[k].frame.speed_m_s / n;
  }
  const double gap = glm::distance(walk.samples[end].hips_m, walk.samples[begin].hips_m);
  return {std::fabs(radius * rate / speed - 1.0), gap};
}

void circle_claims(const Walk& walk, ClaimList& list) {
  const Circle circle = circle_of(walk);
  list.add("24 radius of a circle off speed over turn rate, %", 100.0 * circle.radius_error,
           at_most(2.0), "path of the hips");
  list.add("24 circle closes within, mm", 1e3 * circle.closes_m, at_most(50.0));
}

}  // namespace

std::vector<Claim> turn_claims(const Study& study, IkMode mode) {
  ClaimList list("3.3.1", mode);
  const WalkModel& model = study.model();
  list.add("24 sideways drift without sideways stick, mm a stride",
           straight_drift_mm(turning(model, mode, 0.0, 9.0)), at_most(0.1));
  int wrong = 0, falls = 0;
  double slide = 0.0, mirror = 0.0;
  std::string text;
  for (const double sign : {-1.0, 1.0}) {
    double before = 0.0;
    for (const double x : kSideways) {
      const Walk walk = turning(model, mode, sign * x, 6.0);
      const double heading = walk.samples.back().frame.heading_rad;
      wrong += !(heading * sign < 0.0);
      falls += !(std::fabs(heading) > before);
      before = std::fabs(heading);
      slide = std::max(slide, planted_slide_mm(walk));
      text +=
          fmt::format("{}{:+.2f}: {:+.0f}", text.empty() ? "" : ", ", sign * x, heading / kDegree);
      if (sign > 0.0 && x == kHalf) mirror = mirror_gap_m(walk, turning(model, mode, -x, 6.0));
    }
  }
  list.add("24 sideways sticks that turn the wrong way", wrong, equal_to(0),
           "heading after 6 s, deg: " + text);
  list.add("24 larger sideways sticks that turn less", falls, equal_to(0));
  list.add("24 planted feet slide in turns by, mm", slide, at_most(0.1));
  if (study.source().is_adult) {
    list.add("24 mirrored stick off the mirrored walk, m", mirror, at_most(1e-6),
             mode == IkMode::paper
                 ? "a solve ends within 0.01 mm of its goal, somewhere, and the next begins there"
                 : "");
  } else {
    list.add_untested("24 mirrored stick off the mirrored walk, m", at_most(1e-6),
                      "a captured walk is not symmetric");
  }
  circle_claims(turning(model, mode, kHalf, 20.0), list);
  return list.take();
}

}  // namespace gaitpad
