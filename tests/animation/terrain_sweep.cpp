// Walks the terrain course with every motion, leg ratio, stick and style and prints the worst
// values of each as CSV. Usage: terrain_sweep [--quick] [MOTION.bvh ...]; without a file the
// built-in motion.
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>

#include "animation/terrain_judge.h"
#include "motion/load.h"

using namespace gaitpad;

namespace {

Terrain course() {
  Terrain t;
  const auto add = [&t](const SectionShape& s) {
    if (auto e = add_section(t, s)) {
      fmt::print(stderr, "{}\n", e->message);
      std::exit(1);
    }
  };
  const std::string kind = getenv("COURSE") ? getenv("COURSE") : "course";
  add(FlatSection{1.5});
  if (kind == "up") {
    add(SlopeSection{4.0, 0.15, 0.5});
    add(FlatSection{1});
    return t;
  }
  if (kind == "stairs") {
    add(StairsSection{0.17, 0.28, 6});
    add(FlatSection{1});
    return t;
  }
  if (kind == "down") {
    add(StairsSection{-0.17, 0.28, 6});
    add(FlatSection{1});
    return t;
  }
  if (kind == "rough") {
    add(rough_section(5.0, 0.03, 2.0, 1.5, 1));
    add(FlatSection{1});
    return t;
  }
  if (kind == "flat") {
    add(FlatSection{5});
    return t;
  }
  add(SlopeSection{3.0, 0.15, 0.5});
  add(FlatSection{1.0});
  add(StairsSection{0.17, 0.28, 5});
  add(FlatSection{1.0});
  add(StairsSection{-0.17, 0.28, 5});
  add(FlatSection{1.0});
  add(SlopeSection{3.0, -0.15, 0.5});
  add(FlatSection{0.5});
  add(rough_section(4.0, 0.03, 2.0, 1.5, 1));
  add(FlatSection{1.5});
  return t;
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

double sole_m(const WalkModel& m) {
  double longest = 0;
  for (const LegBuild& leg : m.leg) {
    const vec3 v = leg.tip_m - leg.model.heel_m;
    longest = std::max(longest, std::abs(v.z) + 2.0 * std::abs(leg.side.z) * leg.half_width_m);
  }
  return longest;
}

TerrainWorst walk(WalkModel& model, double ratio, double stick_y, const Style& style, FILE* trace) {
  static const Terrain kCourse = course();
  const bool scale = sole_m(model) > least_tread_m(kCourse);
  model.terrain = std::make_shared<const Terrain>(scale ? scaled(kCourse, ratio) : kCourse);
  const double goal = length_m(*model.terrain) + 1.0;
  const GaitLimits limits = gait_limits(model.leg_length_m);
  Pose pose;
  WalkState state = standing(model, vec3(0.0), pose);
  TerrainJudge judge(model);
  Stick stick;
  stick.left = vec2(0.0, stick_y);
  const GaitParams go = gait_params(stick, style, limits),
                   stop = gait_params(Stick{}, style, limits);
  for (int k = 0, rest = 0; k < 240 * 120 && rest < 400; ++k) {
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
    else if (a == "--trace")
      trace = fopen(argv[++i], "w");
    else
      motions.push_back(a);
  }
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
          const TerrainWorst w = walk(*model, ratio, y, styled(style), trace);
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
