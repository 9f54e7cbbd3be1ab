// For determinism_test.py: walks made-up sessions and prints the pose hash of every tick, so that
// two builds can be compared. Its only file is a motion that it writes into the given folder and
// reads back. The strides that the walks read are solved, not taken from a cache.
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <locale>
#include <stdexcept>

#include "base/lanes.h"
#include "gaitpad/bvh.h"
#include "gaitpad/clean_strides.h"
#include "gaitpad/hash.h"
#include "gaitpad/motion_file.h"
#include "strides/solver_input.h"
#include "tests/session/made_session.h"
#include "tests/walk/made_crowd.h"

namespace gaitpad {
namespace {

constexpr int kTicks = 2600;

int fail(const std::string& message) {
  fmt::print(stderr, "{}\n", message);
  return 1;
}

int walk(const char* name, const SimulationConfig& config) {
  auto simulation = Simulation::create(config);
  if (!simulation) return fail(simulation.error().message);
  for (int tick = 0; tick < kTicks; ++tick) {
    const std::vector<Report> reports = made_tick(tick);
    simulation->step(reports);
    fmt::print("{} tick {} {:016x}\n", name, tick, simulation->pose_hash());
  }
  return 0;
}

// The procedural walk through a BVH file: covers the reader, the search for legs and the periodic
// cycle.
Result<GaitCycle> cycle_through_file(const std::string& path) {
  const Motion motion = procedural_motion();
  std::ofstream out(path);
  BvhLayout layout;
  layout.frame_time_s = motion.frame_time_s;
  BvhWriter writer(out, motion.skeleton, layout);
  for (const MotionFrame& frame : motion.frames) {
    Pose pose;
    pose.root_m = frame.root_m;
    pose.joint_count = static_cast<int>(frame.local.size());
    std::copy(frame.local.begin(), frame.local.end(), pose.local.begin());
    writer.write(pose);
  }
  if (!writer.finish()) return Error{path + ": cannot be written"};
  auto read = load_motion(path);
  if (!read) return read.error();
  auto cycle = gait_cycle(*read);
  if (!cycle) return cycle;
  return with_clean_strides(std::move(*cycle));
}

// Walks 64 characters for a minute, at every lane width up to the widest of this build and
// processor.
void walk_crowd() {
  for (const int lanes : {4, 8, 16}) {
    use_lanes(lanes);
    MadeCrowd made(64);
    WordHash hash;
    for (int tick = 0; tick < 60 * kCrowdRate; ++tick) {
      made.step(tick);
      made.add_to(hash);
      if (tick % kCrowdRate == 0)
        fmt::print("crowd, {} lanes, tick {} {:016x}\n", lanes, tick, hash.value());
    }
  }
  use_lanes(widest_lanes());
}

void print_family(const char* name, const StrideFamily& family) {
  WordHash hash;
  for_each_number(family, [&hash](double number) { hash.add(number); });
  fmt::print("{} strides {:016x}\n", name, hash.value());
}

int run(int argc, char** argv) {
  if (argc != 2) return fail("usage: pose_hash_main FOLDER");
  ::setenv("GAITPAD_CACHE", "off", 1);
  try {
    // A host program may set a locale by this or by std::setlocale().
    std::locale::global(std::locale(""));
  } catch (const std::runtime_error&) {  // thrown if the environment's locale is not installed
  }
  if (std::getenv("GAITPAD_SAY_LOCALE") != nullptr) std::printf("locale: %.1f\n", 0.5);
  SimulationConfig config = made_config(4);
  print_family("procedural", *config.cycle.strides);
  if (walk("procedural robust", config) != 0) return 1;
  config.ik = IkMode::paper;
  if (walk("procedural paper", config) != 0) return 1;
  if (walk("terrain and body", made_uneven_config(3)) != 0) return 1;
  auto cycle = cycle_through_file(std::string(argv[1]) + "/procedural.bvh");
  if (!cycle) return fail(cycle.error().message);
  print_family("captured", *cycle->strides);
  config = made_config(2);
  config.cycle = std::move(*cycle);
  if (walk("captured robust", config) != 0) return 1;
  walk_crowd();
  return 0;
}

}  // namespace
}  // namespace gaitpad

int main(int argc, char** argv) { return gaitpad::run(argc, argv); }
