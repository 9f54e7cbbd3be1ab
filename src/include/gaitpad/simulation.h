// The whole chain for one tick: reports in, poses out. The live loop, the replay, the tests and the
// benchmark all call step(). Its result depends on the reports alone, never on a clock: the same
// reports in the same ticks give the same poses bit by bit.
//
//   auto simulation = Simulation::create(config);   // simulation_config() reads one from files
//   simulation->step(reports);                      // once every 1 / rate_hz seconds
//   const Pose& pose = simulation->walkers().front().pose;
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/control.h"
#include "gaitpad/followers.h"
#include "gaitpad/hash.h"
#include "gaitpad/pads.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "gaitpad/style.h"
#include "gaitpad/walk.h"

namespace gaitpad {

inline constexpr int kMaxWalkers = 16;

// A character. simulation_config() fills both structs from files (gaitpad/session_spec.h), or a
// program does.
struct WalkerConfig {
  Character character;                 // the character's build
  int style = 0;                       // index in SimulationConfig::styles
  std::optional<GaitCycle> own_cycle;  // the cycle on the character's own skeleton, if it has one
};
struct SimulationConfig {
  int rate_hz = 240;  // ticks a second, kLeastRateHz .. kMaxRateHz
  // Mode of the inverse kinematics at the beginning; commands change it, as they do `stick`.
  IkMode ik = IkMode::robust;
  StickMeans stick = StickMeans::steers;
  std::vector<PadConfig> pads;  // indexed by a report's device
  PadRules pad_rules = PadRules::version_2;
  // Styles that commands may name, at least one; of equal names the first one counts.
  std::vector<Style> styles;
  GaitCycle cycle;        // the motion; a walk uses cycle.pace, not the next member
  Pace pace = Pace::own;  // the pace that was chosen; it has no effect on the built-in motion
  // 1 .. kMaxWalkers characters; they stand side by side, the first at the origin.
  std::vector<WalkerConfig> walkers;
  int crowd = 0;  // number of characters that walk behind the first, 0 .. kMaxFollowers
  // Most threads that advance the crowd, 1 .. kMaxCrowdThreads; the poses are the same for any
  // number.
  int crowd_threads = 1;
  bool shows_crowd = true;  // keeps the crowd's poses of two ticks for viewers
  std::shared_ptr<const Terrain> terrain = flat_terrain();  // never null
  // Remarks for the user about the files that the configuration was read from.
  std::vector<std::string> remarks;
};

// Errors read `SimulationConfig: rate_hz is 0, outside [10, 10000]`. Calls the check of all
// members.
std::optional<Error> check(const SimulationConfig& config);

// Configurations for devices that are not known yet; set_pad() replaces them.
std::vector<PadConfig> unknown_pads(std::size_t count);

// Numbers since the beginning; the structs below are results of a simulation.
struct SimulationCounts {
  std::int64_t ticks = 0;
  std::int64_t reports = 0;      // input reports, sound or not
  std::int64_t bad_reports = 0;  // too short, with an unknown id or of no device
  std::int64_t commands = 0;
  // Malformed, with unknown names or out of bounds; they changed nothing.
  std::int64_t bad_commands = 0;
};

// The zone that a walker is in, and the style to which it returns when it leaves.
struct ZoneStyle {
  int index = -1;           // index in Terrain::zones; -1: none
  bool gives_back = false;  // false: in no zone, or a command has chosen another style inside it
  int own_style = 0;        // index of the style before the zone
  StyleValues own_values;
};

struct Walker {
  // The walker's model, shared with copies of the simulation.
  std::shared_ptr<const WalkModel> model;
  GaitLimits limits;
  int style = 0;       // index in Simulation::styles()
  StyleValues values;  // values of that style, with the changes by commands
  ZoneStyle zone;
  StyleBlend blend;
  double tired = 0.0;    // tiredness, 0 .. 1, by the fatigue model of its style
  StyleValues in_force;  // values in the last tick: `values` blended in, with fatigue
  GaitOverrides overrides;
  GaitParams params;  // parameters of the last tick
  WalkState state;
  Pose before, pose;             // poses after the last tick but one and after the last
  vec3 start_m{0.0};             // place at the beginning, facing +z; world
  double walked_m = 0.0;         // distance on the ground, along the path of the hips; resets do
                                 // not count
  std::int64_t ik_failures = 0;  // number of failures, one for each leg and tick
};

inline WalkFrame walk_frame(const Walker& walker) noexcept {
  return walk_frame(*walker.model, walker.state, walker.pose);
}

// Copies only as many joints as there are: a whole Pose has 10 KB.
void copy_pose(const Pose& from, Pose& to) noexcept;

// A simulation. Copies are cheap, a few kilobytes for each character, because they share what does
// not change.
class Simulation {
 public:
  // Error: what check() refuses, a motion that does not fit a character, a zone whose style does
  // not exist.
  static Result<Simulation> create(const SimulationConfig& config);

  // Sets the configuration of a device that was found while the simulation runs, before its first
  // report. Its entry in SimulationConfig::pads must be one of unknown_pads(). No heap: they are
  // swapped.
  void set_pad(std::uint16_t device, PadConfig&& config) noexcept { pads_.set_pad(device, config); }
  // Replaces all pads before the first tick.
  void set_pads(Pads pads) noexcept { pads_ = std::move(pads); }
  // Replaces the list of styles by one in which the present styles keep their places, and hands the
  // old list back. No heap.
  void swap_styles(std::shared_ptr<const std::vector<Style>>& styles) noexcept {
    styles_.swap(styles);
  }
  // Runs one tick with its reports, in order of arrival. No heap, lock or clock, unless several
  // threads advance a crowd.
  void step(std::span<const Report> reports) noexcept;
  // Takes one report of the tick that the next step() runs. For recordings, in which a tick may
  // have millions of reports.
  void take_report(const Report& report) noexcept;

  const std::vector<Walker>& walkers() const { return walkers_; }
  const Followers& followers() const { return followers_; }  // The crowd.
  const std::vector<Style>& styles() const { return *styles_; }
  // The ground: the configuration's terrain, enlarged if a foot would not fit its treads.
  const std::shared_ptr<const Terrain>& terrain() const { return terrain_; }
  double terrain_scale() const { return terrain_scale_; }
  const Stick& stick() const { return stick_; }  // The sticks in the last tick.
  StickMeans stick_means() const { return stick_means_; }
  // The mode of the walkers' inverse kinematics; `ik` commands change it.
  IkMode ik() const { return ik_; }
  const Pads& pads() const { return pads_; }
  // True if a heel of the first character struck the ground in the last tick.
  bool heel_struck() const { return heel_struck_; }
  const SimulationCounts& counts() const { return counts_; }
  // Hash of the bits of every pose of every character in every tick so far; the crowd's poses come
  // after the walkers'.
  std::uint64_t pose_hash() const { return hash_.value(); }

 private:
  Simulation() = default;
  Result<std::vector<std::shared_ptr<const WalkModel>>> models_of(const SimulationConfig& config);
  std::optional<Error> find_zone_styles();
  bool obey(std::string_view text) noexcept;
  // Index of the style; -1: there is none with this name.
  int style_index(std::string_view name) const noexcept;
  bool choose_style(std::span<Walker> walkers, std::string_view name) noexcept;
  void add_to_hash(const vec3& root_m, std::span<const quat> local) noexcept;

  double dt_s_ = 0.0;
  IkMode ik_ = IkMode::robust;
  Pads pads_;
  std::shared_ptr<const std::vector<Style>> styles_;
  std::shared_ptr<const std::vector<int>> zone_styles_;  // index of each zone's style
  std::vector<Walker> walkers_;
  Followers followers_;
  std::shared_ptr<const Terrain> terrain_;
  double terrain_scale_ = 1.0;
  Stick stick_;
  StickMeans stick_means_ = StickMeans::steers;
  double camera_rad_ = 0.0;  // heading of the camera, to which a pointing stick is relative
  bool heel_struck_ = false;
  SimulationCounts counts_;
  WordHash hash_;
};

}  // namespace gaitpad
