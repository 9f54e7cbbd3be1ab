#include "gaitpad/session_frame.h"

namespace gaitpad {
namespace {

constexpr std::array<LegDof, 3> kShownJoints = {kHipX, kKneeX, kAnkleX};

void copy_walker(const Walker& walker, WalkerFrame& frame) noexcept {
  const WalkState& state = walker.state;
  copy_pose(walker.before, frame.before);
  copy_pose(walker.pose, frame.pose);
  frame.walk = walk_frame(walker);
  frame.params = walker.params;
  frame.style = walker.values;
  frame.style_index = walker.style;
  frame.overrides = walker.overrides;
  frame.angles_rad = leg_angles(*walker.model, walker.pose);
  frame.phase = shown_phase(state);
  frame.presence = presence(state);
  frame.ik_failures = walker.ik_failures;
}

void copy_pad(const Pads& pads, SessionFrame& frame) noexcept {
  frame.pad.device = pads.driving();
  frame.pad.state = pads.driving_state();
  frame.pad.reports = pads.driving_reports();
  frame.pad.untouched = pads.untouched();
  frame.presses = pads.presses();
  const PadConfig* config = pads.driving_pad();
  frame.pad.is_present = config != nullptr && config->is_present;
  frame.pad.calibration = config != nullptr ? config->calibration : Calibration{};
}

}  // namespace

Cast cast_of(const Simulation& simulation, const SimulationConfig& config) {
  Cast cast;
  cast.motion = config.cycle.name;
  cast.source = std::make_shared<const GaitCycle>(config.cycle);
  cast.rate_hz = config.rate_hz;
  cast.terrain = simulation.terrain();
  for (const Style& style : simulation.styles()) {
    cast.styles.push_back(style.name);
    cast.style_values.push_back(style);
  }
  for (std::size_t i = 0; i < simulation.walkers().size(); ++i) {
    const Walker& w = simulation.walkers()[i];
    cast.members.push_back({config.walkers[i].character.name, cast.styles[config.walkers[i].style],
                            w.model, w.limits});
  }
  const Followers& followers = simulation.followers();
  for (std::size_t i = 0; i < followers.shown().root_m.size(); ++i) {
    const int member = static_cast<int>(i);
    cast.crowd.push_back({followers.model(member), followers.style(member)});
  }
  return cast;
}

void copy_frame(const Simulation& simulation, SessionFrame& frame) noexcept {
  frame.ik = simulation.ik();
  frame.stick_means = simulation.stick_means();
  frame.counts = simulation.counts();
  frame.tick = frame.counts.ticks - 1;
  frame.stick = simulation.stick();
  copy_pad(simulation.pads(), frame);
  const std::vector<Walker>& walkers = simulation.walkers();
  frame.walker_count = static_cast<int>(walkers.size());
  for (std::size_t i = 0; i < walkers.size(); ++i) copy_walker(walkers[i], frame.walkers[i]);
  frame.crowd = simulation.followers().shown();
}

void copy_sample(const Simulation& simulation, TickSample& sample) noexcept {
  const std::vector<Walker>& walkers = simulation.walkers();
  sample.tick = simulation.counts().ticks - 1;
  sample.walker_count = static_cast<int>(walkers.size());
  sample.stick_x = static_cast<float>(simulation.stick().left.x);
  sample.stick_y = static_cast<float>(simulation.stick().left.y);
  for (std::size_t i = 0; i < walkers.size(); ++i) {
    const Walker& walker = walkers[i];
    const WalkFrame walk = walk_frame(walker);
    const std::array<LegAngles, 2> angles_rad = leg_angles(*walker.model, walker.pose);
    WalkerSample& s = sample.walkers[i];
    for (const Side side : {kLeftSide, kRightSide}) {
      for (std::size_t j = 0; j < kShownJoints.size(); ++j) {
        // In a sample flexion is positive at every joint; in the model hip and ankle flexion is
        // negative.
        const double angle_rad = angles_rad[side][kShownJoints[j]];
        s.joint_rad[side][j] =
            static_cast<float>(kShownJoints[j] == kKneeX ? angle_rad : -angle_rad);
      }
      s.ik_iterations[side] = static_cast<std::int16_t>(walk.ik_iterations[side]);
      s.ik_error_m[side] = static_cast<float>(walk.ik_error_m[side]);
      s.heel_above_m[side] = static_cast<float>(walk.heel_m[side].y - walk.heel_ground_m[side]);
    }
    s.heel_m = walk.heel_m;
    s.toe_m = walk.toe_m;
    s.stage = walk.stage;
    s.swing = walk.swing;
    s.heel_planted = walk.heel_planted;
    s.toe_planted = walk.toe_planted;
  }
}

}  // namespace gaitpad
