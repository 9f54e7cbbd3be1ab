// Walks a terrain with every motion, leg ratio, stick and style and prints the worst values of each
// walk. Exit status 1 where one misses its bound.
// Usage: terrain_sweep [--terrain NAME] [--ratio R] [--stick Y] [--style NAME] [MOTION ...]
// Without them: the course; legs 0.6, 1, 1.6; sticks 0.4, 0.7, 1; all styles; the built-in motion.
// A stick below 0 walks it backwards from its end.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "gaitpad/config_files.h"
#include "gaitpad/motion_file.h"
#include "tests/clean_cycle.h"
#include "tests/folders.h"
#include "tests/walk/terrain_judge.h"

namespace gaitpad {
namespace {

constexpr double kLongest_s = 360.0, kRate = 240.0;
// A captured walk that is faster on the adult's leg only has to keep the limits.
constexpr double kPlainSpeed_m_s = 1.3;

template <class T>
T value_or_exit(Result<T> result) {
  if (result) return std::move(*result);
  fmt::print(stderr, "{}\n", result.error().message);
  std::exit(1);
}

std::string config(const char* kind, const std::string& name) {
  return fmt::format("{}/config/{}/{}.toml", kSourceFolder, kind, name);
}

std::vector<std::string> shipped_styles() {
  std::vector<std::string> names;
  const std::string folder = kSourceFolder + "/config/styles";
  for (const auto& file : std::filesystem::directory_iterator(folder))
    names.push_back(file.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

Result<GaitCycle> cycle_of(const std::string& motion) {
  if (motion == "procedural") return procedural_gait();
  auto loaded = load_motion(motion);
  if (!loaded) return loaded.error();
  return gait_cycle(*loaded);
}

// Walks from one end of the terrain to a stop beyond the other end.
TerrainWorst walk(const WalkModel& model, double stick_y, const Style& style) {
  const double far_m = length_m(*model.terrain) + 1.0;
  const bool backward = stick_y < 0.0;
  const GaitLimits limits = gait_limits(model);
  Stick stick;
  stick.left = vec2(0.0, stick_y);
  const GaitParams go = gait_params(stick, style, limits),
                   stop = gait_params(Stick{}, style, limits);
  Pose pose;
  WalkState state = standing(model, vec3(0.0, 0.0, backward ? far_m : 0.0), pose);
  TerrainJudge judge(model);
  int rest = 0;
  for (int k = 0; k < kLongest_s * kRate && rest < 400; ++k) {
    if (backward ? pose.root_m.z < -1.0 : pose.root_m.z > far_m) ++rest;
    advance(model, rest > 0 ? stop : go, IkMode::robust, 1.0 / kRate, state, pose);
    judge.see(state, pose);
  }
  judge.worst.failures += rest < 400;  // the walk did not reach the end
  return judge.worst;
}

// The bound on second differences: 1 degree, 5 for captured walks at a high speed.
double most_jump_deg(const WalkModel& model, const std::string& motion, double stick_y) {
  const double size = model.leg_length_m / kReferenceLeg_m;
  const double speed = std::abs(stick_y) * gait_limits(model).max_speed_m_s;
  return motion != "procedural" && speed > kPlainSpeed_m_s * std::sqrt(size) ? 5.0 : 1.0;
}

bool is_sound(const TerrainWorst& w, double most_jump) {
  return w.height_mm < 5.0 && w.slide_mm < 1.0 && w.sunk_mm < 5.0 && w.overhang_mm <= 0.0 &&
         w.failures == 0 && w.jump_deg <= most_jump;
}

int run(int argc, char** argv) {
  std::vector<std::string> motions;
  std::vector<double> ratios = {0.6, 1.0, 1.6}, sticks = {0.4, 0.7, 1.0};
  std::vector<std::string> styles = shipped_styles();
  std::string terrain = "course";
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (!option.starts_with("--")) {
      motions.push_back(option);
      continue;
    }
    const std::string value = i + 1 < argc ? argv[++i] : "";
    if (option == "--terrain") {
      terrain = value;
    } else if (option == "--ratio") {
      ratios = {std::atof(value.c_str())};
    } else if (option == "--stick") {
      sticks = {std::atof(value.c_str())};
    } else if (option == "--style") {
      styles = {value};
    } else {
      fmt::print(stderr, "terrain_sweep: unknown option {}\n", option);
      return 2;
    }
  }
  if (motions.empty()) motions = {"procedural"};
  const Terrain ground = value_or_exit(load_terrain(config("terrain", terrain)));
  fmt::print(
      "{:12} {:>4} {:>4} {:14} {:>7} {:>7} {:>7} {:>8} {:>7} {:>7} {:>5} {:>5} {:>3} {:>6} {:>6}\n",
      "motion", "leg", "y", "style", "high_mm", "slid_mm", "sunk_mm", "edge_mm", "d2_deg",
      "hips_mm", "kmin", "kmax", "bad", "steps", "z_m");
  int missed = 0;
  for (const std::string& motion : motions) {
    const GaitCycle cycle = value_or_exit(cycle_of(motion));
    for (const double ratio : ratios) {
      Character character;
      character.leg_ratio = ratio;
      WalkModel model = value_or_exit(walk_model(clean_cycle(cycle), character));
      model.terrain = std::make_shared<const Terrain>(scaled(ground, terrain_scale(ground, model)));
      for (const double y : sticks) {
        for (const std::string& style : styles) {
          const TerrainWorst w = walk(model, y, value_or_exit(load_style(config("styles", style))));
          const bool sound = is_sound(w, most_jump_deg(model, motion, y));
          missed += !sound;
          fmt::print(
              "{:12} {:4} {:4} {:14} {:7.2f} {:7.3f} {:7.2f} {:8.1f} {:7.3f} {:7.2f} {:5.1f} "
              "{:5.1f} {:3} {:6} {:6.2f}{}\n",
              std::filesystem::path(motion).stem().string().substr(0, 12), ratio, y, style,
              w.height_mm, w.slide_mm, w.sunk_mm, w.overhang_mm, w.jump_deg, w.pelvis_mm,
              w.knee_min_deg, w.knee_max_deg, w.failures, w.landings, w.end_z_m,
              sound
                  ? ""
                  : fmt::format("  MISSED: d2 at {:.2f}, sunk at {:.2f}", w.jump_z_m, w.sunk_z_m));
        }
      }
    }
  }
  fmt::print("{} missed\n", missed);
  return missed == 0 ? 0 : 1;
}

}  // namespace
}  // namespace gaitpad

int main(int argc, char** argv) { return gaitpad::run(argc, argv); }
