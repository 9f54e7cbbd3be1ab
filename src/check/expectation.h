// The expected results of a recording: NAME.expect.toml beside NAME.hid (config/README.md,
// Expectations). Options of the replay, the hash of the poses, counts, and numbers with tolerances.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/summary.h"

namespace gaitpad {

// A measure of a run or of one of its characters.
struct Measure {
  std::string_view name;
  // Tolerance in a new expectation: the larger of this and 1 % of the value. 0: a count, which must
  // be equal.
  double within = 0.0;
};
enum RunMeasure { kTicks, kReports, kBadReports, kBadCommands, kDamagedLines, kRunMeasures };
inline constexpr std::array<Measure, kRunMeasures> kOfRun = {
    {{"ticks"}, {"reports"}, {"bad_reports"}, {"bad_commands"}, {"damaged_lines"}}};
enum CharacterMeasure {
  kStepsLeft,
  kStepsRight,
  kIkFailures,
  kDistance,  // distance on the ground, along the path of the hips
  kSpeed,     // kDistance over the time in which the character was not idle
  kHeading,   // heading at the end, positive to the left
  kEndX,      // x of the pelvis at the end
  kEndZ,
  kStepLeft,  // mean length of the left foot's steps
  kStepRight,
  kHipLeft,  // range of the left hip's flexion
  kHipRight,
  kKneeLeft,
  kKneeRight,
  kAnkleLeft,
  kAnkleRight,
  kSlip,  // largest distance of a planted heel or toe from where it was planted
  kCharacterMeasures
};
inline constexpr std::array<Measure, kCharacterMeasures> kOfCharacter = {{{"steps_left"},
                                                                          {"steps_right"},
                                                                          {"ik_failures"},
                                                                          {"distance_m", 0.05},
                                                                          {"speed_m_s", 0.02},
                                                                          {"heading_rad", 0.02},
                                                                          {"end_x_m", 0.05},
                                                                          {"end_z_m", 0.05},
                                                                          {"step_left_m", 0.01},
                                                                          {"step_right_m", 0.01},
                                                                          {"hip_left_deg", 1.0},
                                                                          {"hip_right_deg", 1.0},
                                                                          {"knee_left_deg", 1.0},
                                                                          {"knee_right_deg", 1.0},
                                                                          {"ankle_left_deg", 1.0},
                                                                          {"ankle_right_deg", 1.0},
                                                                          {"slip_m", 0.0005}}};

// The measures of a run.
struct Measured {
  std::uint64_t pose_hash = 0;
  std::array<double, kRunMeasures> run{};
  std::vector<std::array<double, kCharacterMeasures>> characters;
};

// The larger of two slips. One that is not a number stays: later ones must not hide it.
double worse_slip_m(double before_m, double slip_m) noexcept;

// Watches a run tick by tick.
class RunMeter {
 public:
  void look(const Simulation& simulation);  // Call it after each tick.
  Measured finish(const Simulation& simulation, const RunSummary& summary) const;

 private:
  struct Foot {
    std::array<bool, 2> is_planted{};  // the foot's heel and toe
    std::array<vec3, 2> planted_m{};
    int steps = 0;
    double sum_m = 0.0;
    // Smallest and largest angle of hip, knee and ankle.
    std::array<double, 3> least_rad{}, most_rad{};
  };
  struct Character {
    std::array<Foot, 2> feet;
    std::int64_t walking_ticks = 0;
    double slip_m = 0.0;
  };
  void look(const WalkerSample& sample, const Walker& walker, Character& character) const;

  std::int64_t ticks_ = 0;
  TickSample sample_;
  std::vector<Character> characters_;
};

struct Expected {
  int measure = 0;  // number of the measure in kOfRun or kOfCharacter
  double value = 0.0, within = 0.0;
};
// A file that the replay depends on.
struct ExpectedFile {
  // `config/` and the path in a folder of configuration, or a path relative to the expectation.
  std::string name;
  std::uint64_t hash = 0;
  bool operator==(const ExpectedFile&) const = default;
};
struct Expectation {
  std::string heading;  // the comment at the file's beginning, which a renewal keeps
  // The options of the walk, with the paths in the file, which are relative to the file.
  SessionSpec::Walk walk;
  SessionSpec::Pad pad;
  std::optional<int> rate_hz;
  bool is_lenient = false;
  bool keeps_poses = true;  // a pose file is kept beside it, to locate a difference

  std::optional<std::uint64_t> pose_hash;
  std::vector<Expected> run;
  std::vector<std::vector<Expected>> characters;  // the expected measures of each character
  std::vector<ExpectedFile> files;                // the files of the replay when the expectation
                                                  // was written
  bool is_empty() const { return !pose_hash && run.empty() && characters.empty(); }
};

// Errors: `round.expect.toml:3: unknown key "pose_hsh"; ...`. `name` is the file's name in them.
Result<Expectation> parsed_expectation(std::string_view text, const std::string& name);
std::string expectation_text(const Expectation& expectation);

// The session that replays `trace` with the options of the expectation in `folder`.
SessionSpec session_of(const Expectation& expectation, const std::string& folder,
                       const std::string& trace);

// An expectation with the same options and tolerances and the values of a run. It has the measures
// that `expectation` had, or all of them if it had none.
Expectation renewed(const Expectation& expectation, const Measured& measured);

// A sentence for each file that has changed since the expectation was written. Empty if it lists no
// files.
std::vector<std::string> changed_files(const Expectation& expectation,
                                       const std::vector<ExpectedFile>& now);
// A sentence for each measure out of tolerance: `speed_m_s is 1.31, expected 1.2 within 0.02`.
std::vector<std::string> unmet_numbers(const Expectation& expectation, const Measured& measured);
// A sentence for each change by the renewal.
std::vector<std::string> changes(const Expectation& before, const Expectation& after);

std::string hash_text(std::uint64_t hash);

}  // namespace gaitpad
