// Walks the terrain course with every motion, leg ratio, stick and style and prints the worst
// values of each as CSV. Usage: terrain_sweep [--quick] [MOTION.bvh ...]; without a file the
// built-in motion.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "animation/terrain_file.h"
#include "animation/terrain_judge.h"
#include "motion/load.h"

using namespace gaitpad;

namespace {

Terrain course(const std::string& name) {
  auto terrain = load_terrain(fmt::format("{}/config/terrain/{}.toml", GAITPAD_SOURCE_DIR, name));
  if (!terrain) {
    fmt::print(stderr, "{}\n", terrain.error().message);
    std::exit(1);
  }
  return *terrain;
}

Style styled(const char* name) {
  Style s;
  s.name = name;
  if (s.name == "even") return s;
  auto loaded = load_style(fmt::format("{}/config/styles/{}.toml", GAITPAD_SOURCE_DIR, name));
  if (!loaded) {
    fmt::print(stderr, "{}\n", loaded.error().message);
    std::exit(1);
  }
  return *loaded;
}

// As a session does it: where a sole does not lie on the shortest tread, the ground grows.
double terrain_scale(const Terrain& terrain, const WalkModel& model) {
  double scale = 1.0;
  for (const LegBuild& leg : model.leg) {
    const vec3 sole = leg.tip_m - leg.model.heel_m;
    const double needed = glm::length(vec2(sole.x, sole.z)) + 0.02, tread = least_tread_m(terrain);
    if (needed > tread) scale = std::max({scale, model.leg_length_m / kReferenceLeg_m, needed / tread});
  }
  return scale;
}

TerrainWorst walk(const Terrain& ground, WalkModel& model, double stick_y, const Style& style, FILE* trace) {
  model.terrain = std::make_shared<const Terrain>(scaled(ground, terrain_scale(ground, model)));
  const double goal = length_m(*model.terrain) + 1.0;
  const GaitLimits limits = gait_limits(model.leg_length_m);
  Pose pose;
  WalkState state = standing(model, vec3(0.0), pose);
  TerrainJudge judge(model);
  Stick stick;
  stick.left = vec2(0.0, stick_y);
  const GaitParams go = gait_params(stick, style, limits),
                   stop = gait_params(Stick{}, style, limits);
  for (int k = 0, rest = 0; k < 240 * 240 && rest < 400; ++k) {
    if (pose.root_m.z > goal) ++rest;
    advance(model, rest ? stop : go, IkMode::robust, 1.0 / 240, state, pose);
    judge.see(state, pose);
    if (trace) {
      fmt::print(trace, "{} {} {} {:.5f} {:.5f} {:.5f} {:.5f}", k, int(state.stage),
                 int(state.swing), pose.root_m.y, pose.root_m.z, state.base_m,
                 state.frame.stride_m[state.swing]);
      for (Side side : {kLeftSide, kRightSide}) {
        const auto s = judge.sole(side);
        const LegBuild& leg = model.leg[side];
        const LegAngles& q = state.angles_rad[side];
        const IkFrame end = end_frame(leg.chain, [&] {
          IkAngles a{};
          std::copy(q.begin(), q.end(), a.begin());
          return a;
        }());
        const vec3 hip =
            s.heel - end.rotation * leg.model.heel_m - end.position_m;  // pelvis about upright
        const SinCos t = sin_cos(-q[kHipX]);
        for (double v :
             {hip.y, hip.z, hip.y - leg.model.thigh_m * t.cos, hip.z + leg.model.thigh_m * t.sin,
              s.heel.y, s.heel.z, s.toe.y, s.toe.z, s.ball.y, s.ball.z, s.tip.y, s.tip.z})
          fmt::print(trace, " {:.5f}", v);
        for (double a : q) fmt::print(trace, " {:.3f}", a / kDegree);
        if (getenv("DEBUG")) {
          fmt::print(trace, " # it {} err {:.1e} pitch {:.3f} yaw {:.3f} |",
                     state.frame.ik_iterations[side], state.frame.ik_error_m[side],
                     state.foot[side].pose.pitch_rad / kDegree,
                     state.foot[side].pose.yaw_rad / kDegree);
          for (double a : state.data_rad[side]) fmt::print(trace, " {:.3f}", a / kDegree);
        }
      }
      fmt::print(trace, "\n");
    }
  }
  return judge.worst;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> motions;
  std::vector<double> ratios = {0.6, 1.0, 1.6}, sticks = {0.4, 0.7, 1.0};
  std::vector<const char*> styles = {"even",      "limp_left",  "limp_left_hip", "limp_left_knee",
                                     "stiff_hip", "stiff_knee", "tired"};
  FILE* trace = nullptr;
  std::string terrain = "course";
  for (int i = 1; i < argc; ++i) {
    const std::string a = argv[i];
    if (a == "--even")
      styles = {"even"};
    else if (a == "--ratio")
      ratios = {std::atof(argv[++i])};
    else if (a == "--stick")
      sticks = {std::atof(argv[++i])};
    else if (a == "--style")
      styles = {argv[++i]};
    else if (a == "--terrain") terrain = argv[++i];
    else if (a == "--trace")
      trace = fopen(argv[++i], "w");
    else
      motions.push_back(a);
  }
  const Terrain ground = course(terrain);
  if (motions.empty()) motions = {"procedural"};
  fmt::print(
      "{:12} {:>4} {:>4} {:14} {:>6} {:>6} {:>6} {:>6} {:>6} {:>6} {:>5} {:>5} {:>3} {:>3} {:>6} "
      "ticks\n",
      "motion", "leg", "y", "style", "height", "slide", "sunk", "over", "jump", "pelvis", "kmin",
      "kmax", "ik", "n", "z");
  for (const std::string& file : motions) {
    auto cycle = [&]() -> Result<GaitCycle> {
      if (file == "procedural") return procedural_gait();
      auto motion = load_motion(file);
      if (!motion) return motion.error();
      return gait_cycle(*motion);
    }();
    if (!cycle) {
      fmt::print(stderr, "{}\n", cycle.error().message);
      return 1;
    }
    for (double ratio : ratios) {
      Character c;
      c.leg_ratio = ratio;
      auto model = walk_model(*cycle, c);
      for (double y : sticks) {
        for (const char* style : styles) {
          const TerrainWorst w = walk(ground, *model, y, styled(style), trace);
          fmt::print(
              "{:12} {:4} {:4} {:14} {:6.2f} {:6.3f} {:6.2f} {:6.1f} {:6.3f} {:6.2f} {:5.1f} "
              "{:5.1f} {:3} {:3} {:6.2f} h{} s{} {:.2f} j{} {} {:.2f}\n",
              std::filesystem::path(file).stem().string().substr(0, 12), ratio, y, style,
              w.height_mm, w.slide_mm, w.sunk_mm, w.overhang_mm, w.jump_deg, w.pelvis_mm,
              w.knee_min_deg, w.knee_max_deg, w.failures, w.landings, w.end_z_m, w.height_tick,
              w.sunk_tick, w.sunk_z_m, w.jump_tick, w.jump_joint, w.jump_z_m);
        }
      }
    }
  }
}
