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

// simulation_config() fills both from files (gaitpad/session_spec.h), or a program does.
struct WalkerConfig {
  Character character;                 // its build
  int style = 0;                       // index in SimulationConfig::styles
  std::optional<GaitCycle> own_cycle;  // the cycle on the character's own skeleton, if it has one
};
struct SimulationConfig {
  int rate_hz = 240;           // ticks a second, kLeastRateHz .. kMaxRateHz
  IkMode ik = IkMode::robust;  // until a command says otherwise, like `stick`
  StickMeans stick = StickMeans::steers;
  std::vector<PadConfig> pads;  // a report's device is the index here
  PadRules pad_rules = PadRules::version_2;
  // That commands may name, at least one; of equal names the first one counts.
  std::vector<Style> styles;
  GaitCycle cycle;        // its pace is the one in force
  Pace pace = Pace::own;  // that was chosen; with the built-in motion it changes nothing
  // 1 .. kMaxWalkers; they stand side by side, the first at the origin.
  std::vector<WalkerConfig> walkers;
  int crowd = 0;  // so many more walk behind the first, 0 .. kMaxFollowers
  // That move the crowd on, at most, 1 .. kMaxCrowdThreads; the poses are the same for any number.
  int crowd_threads = 1;
  bool shows_crowd = true;  // keeps the crowd's poses of two ticks for viewers
  std::shared_ptr<const Terrain> terrain = flat_terrain();  // never null
  std::vector<std::string> remarks;  // what a user should know of the files that it was read from
};

// `SimulationConfig: rate_hz is 0, outside [10, 10000]`. Calls the check of all that it holds.
std::optional<Error> check(const SimulationConfig& config);

// Configurations for devices that are not known yet: set_pad() fills them in.
std::vector<PadConfig> unknown_pads(std::size_t count);

// All that follows is what a simulation tells. Counted since the beginning.
struct SimulationCounts {
  std::int64_t ticks = 0;
  std::int64_t reports = 0;      // input reports, sound or not
  std::int64_t bad_reports = 0;  // too short, of an unknown id, of no device
  std::int64_t commands = 0;
  std::int64_t bad_commands = 0;  // malformed, with unknown names, out of bounds: changed nothing
};

// The zone of the terrain that a walker is in, and the style that it returns to when it leaves.
struct ZoneStyle {
  int index = -1;           // in Terrain::zones; -1: none
  bool gives_back = false;  // false: in no zone, or a command has chosen another style in it
  int own_style = 0;        // from before the zone
  StyleValues own_values;
};

struct Walker {
  std::shared_ptr<const WalkModel> model;  // shared with copies of the simulation
  GaitLimits limits;
  int style = 0;       // index in Simulation::styles()
  StyleValues values;  // of that style, with what commands have changed since
  ZoneStyle zone;
  StyleBlend blend;
  double tired = 0.0;    // 0 .. 1, by the fatigue model of its style
  StyleValues in_force;  // used by the last tick: `values` blended in, with fatigue
  GaitOverrides overrides;
  GaitParams params;  // of the last tick
  WalkState state;
  Pose before, pose;             // of the tick before the last and of the last
  vec3 start_m{0.0};             // where it stood at first, facing +z; world
  double walked_m = 0.0;         // on the ground, along the path of its hips; resets do not count
  std::int64_t ik_failures = 0;  // legs times ticks
};

// Copies only the joints that there are: a whole Pose has 10 KB.
void copy_pose(const Pose& from, Pose& to) noexcept;

// Copies are cheap, a few kilobytes a character: they share what does not change.
class Simulation {
 public:
  // Error: what check() refuses, a motion that does not fit a character, a zone whose style does
  // not exist.
  static Result<Simulation> create(const SimulationConfig& config);

  // Sets what is known of a device that was found while the simulation runs, before its first
  // report. Its entry in SimulationConfig::pads must be one of unknown_pads(). No heap: they are
  // swapped.
  void set_pad(std::uint16_t device, PadConfig&& config) noexcept { pads_.set_pad(device, config); }
  // Takes over a list of styles in which those so far keep their places, and hands the old one
  // back. No heap.
  void swap_styles(std::shared_ptr<const std::vector<Style>>& styles) noexcept {
    styles_.swap(styles);
  }
  // Runs one tick with the reports that belong to it, in order of arrival. No heap, lock or clock,
  // unless several threads move a crowd on.
  void step(std::span<const Report> reports) noexcept;
  // Takes in one report of the tick that the next step() runs. For recordings: a tick of one may
  // have millions of reports.
  void take_report(const Report& report) noexcept;

  const std::vector<Walker>& walkers() const { return walkers_; }
  const Followers& followers() const { return followers_; }  // the crowd
  const std::vector<Style>& styles() const { return *styles_; }
  // The ground: the configuration's terrain, enlarged if a foot would not fit its treads.
  const std::shared_ptr<const Terrain>& terrain() const { return terrain_; }
  double terrain_scale() const { return terrain_scale_; }
  const Stick& stick() const { return stick_; }  // of the last tick
  StickMeans stick_means() const { return stick_means_; }
  IkMode ik() const { return ik_; }  // of the walkers; `ik` commands change it
  const Pads& pads() const { return pads_; }
  // Whether a heel of the first character struck the ground in the last tick.
  bool heel_struck() const { return heel_struck_; }
  const SimulationCounts& counts() const { return counts_; }
  // Over the bits of every pose of every character in every tick so far, those of the crowd after
  // the walkers'.
  std::uint64_t pose_hash() const { return hash_.value(); }

 private:
  Simulation() = default;
  Result<std::vector<std::shared_ptr<const WalkModel>>> models_of(const SimulationConfig& config);
  std::optional<Error> find_zone_styles();
  bool obey(std::string_view text) noexcept;
  int style_index(std::string_view name) const noexcept;  // -1: there is none
  bool choose_style(std::span<Walker> walkers, std::string_view name) noexcept;
  void add_to_hash(const vec3& root_m, std::span<const quat> local) noexcept;

  double dt_s_ = 0.0;
  IkMode ik_ = IkMode::robust;
  Pads pads_;
  std::shared_ptr<const std::vector<Style>> styles_;
  std::shared_ptr<const std::vector<int>> zone_styles_;  // of each of the terrain's zones
  std::vector<Walker> walkers_;
  Followers followers_;
  std::shared_ptr<const Terrain> terrain_;
  double terrain_scale_ = 1.0;
  Stick stick_;
  StickMeans stick_means_ = StickMeans::steers;
  double camera_rad_ = 0.0;  // that a stick which points is seen along
  bool heel_struck_ = false;
  SimulationCounts counts_;
  WordHash hash_;
};

}  // namespace gaitpad
