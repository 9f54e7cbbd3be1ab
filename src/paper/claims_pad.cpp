// Assertion 25: the joystick, from a gamepad's reports to the walk.
#include <fmt/format.h>

#include <algorithm>

#include "paper/claims.h"
#include "paper/made_pad.h"

namespace gaitpad {
namespace {

constexpr int kSecond = kPaperRate_hz;

Stick stick_for(const vec2& raw) {
  Pads pads({paper_pad()}, kPaperRate_hz);
  pads.take_report(paper_report(raw));
  return pads.finish_tick();
}

// Of a grid inside the inner zone.
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

// The greatest second difference of a leg angle over the ticks, degrees; the stick goes to `raw` at
// the first.
double second_difference(Simulation& simulation, const vec2& raw, int ticks) {
  const WalkState& state = simulation.walkers()[0].state;
  std::array<LegAngles, 2> last = state.angles_rad, before_last = last;
  simulation.step({});
  before_last = last, last = state.angles_rad;
  double most = 0.0;
  for (int k = 0; k < ticks; ++k) {
    simulation.step(k == 0 ? std::vector<Report>{paper_report(raw)} : std::vector<Report>{});
    for (const Side side : {kLeftSide, kRightSide}) {
      for (int j = 0; j < kLegDofs; ++j) {
        const double d = state.angles_rad[side][j] - 2.0 * last[side][j] + before_last[side][j];
        most = std::max(most, std::fabs(d) / kDegree);
      }
    }
    before_last = last, last = state.angles_rad;
  }
  return most;
}

}  // namespace

std::vector<Claim> pad_claims(const Study& study) {
  ClaimList list("3.1", IkMode::robust);
  const std::vector<Style> styles = {style_of(study.source(), "even")};
  auto simulation = Simulation::create(paper_session(study.source().cycle, styles, IkMode::robust));
  if (!simulation) {
    list.add_untested("25 gamepad", equal_to(0), simulation.error().message);
    return list.take();
  }
  const GaitLimits& limits = simulation->walkers()[0].limits;
  const WalkFrame& frame = simulation->walkers()[0].state.frame;
  list.add("25 sticks inside the dead zone that are not exactly neutral", not_neutral(),
           equal_to(0));
  list.add("25 deflections at which more stick walks slower", speed_falls(limits), equal_to(0));
  run(*simulation, 6 * kSecond, {paper_report(vec2(0.0, 1.0))});
  list.add("25 step at full stick over the greatest",
           frame.stride_m[kRightSide] / limits.max_step_m, within(0.995, 1.005));
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
  while (frame.stage != Stage::idle && ticks < 10 * kSecond) {
    simulation->step({});
    ++ticks;
  }
  list.add("25 from unplugging to standing on both feet, s", static_cast<double>(ticks) / kSecond,
           at_most(3.0), "the step that runs, and one that brings the feet together");
  return list.take();
}

}  // namespace gaitpad
