// The thirty assertions of the paper's text, each measured as a number and compared with its bound.
// Most bounds were derived from the paper's figures and from two prototypes of its method; if the
// walk itself has a stricter bound, that one is used. A claim that does not hold as worded in the
// paper is reported as failed.
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/walk.h"
#include "paper/study.h"

namespace gaitpad {

inline constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

struct Bound {
  enum class Kind { at_most, less, at_least, more, within, equal } kind = Kind::at_most;
  double limit = 0.0;
  double low = 0.0;  // lower limit, for the kind `within`: low <= value <= limit
};
inline constexpr Bound at_most(double v) { return {Bound::Kind::at_most, v}; }
inline constexpr Bound less_than(double v) { return {Bound::Kind::less, v}; }
inline constexpr Bound at_least(double v) { return {Bound::Kind::at_least, v}; }
inline constexpr Bound more_than(double v) { return {Bound::Kind::more, v}; }
inline constexpr Bound within(double low, double high) { return {Bound::Kind::within, high, low}; }
inline constexpr Bound equal_to(double v) { return {Bound::Kind::equal, v}; }

bool holds(const Bound& bound, double value) noexcept;  // False if the value is not finite.
std::string text_of(const Bound& bound);                // The bound in words: "<= 0.95".

struct Claim {
  std::string name;     // the claim's name; it begins with its number among the thirty
  std::string section;  // section of the paper
  IkMode mode = IkMode::robust;
  std::optional<double> value;
  std::string bound;
  std::optional<bool> pass;  // none: this motion cannot test the claim; `note` gives the reason
  std::string note;
};

// Collects the claims of one section of the paper and one mode.
class ClaimList {
 public:
  ClaimList(std::string section, IkMode mode) : section_(std::move(section)), mode_(mode) {}
  Claim& add(std::string name, double value, const Bound& bound, std::string note = {});
  Claim& add_untested(std::string name, const Bound& bound, std::string why);
  std::vector<Claim> take_claims() { return std::move(claims_); }

 private:
  std::string section_;
  IkMode mode_;
  std::vector<Claim> claims_;
};

const char* name_of(IkMode mode) noexcept;
// {"motion", "claims": [...]}, the file claims.json.
std::string claims_json(const std::string& motion, const std::vector<Claim>& claims);

// All groups, ordered by number; those that depend on the solver in both modes. Calls `progress`
// repeatedly with the share of groups that are done.
std::vector<Claim> all_claims(Study& study, const std::function<void(double share)>& progress = {});

// Each function below measures one group of assertions from its arguments only, so that a test can
// pass a broken walk. The numbers beside the functions are those of the assertions.

// claims_motion.cpp: the motion data and other legs, section 3.2.
std::vector<Claim> flight_claims(const PaperSource& source, IkMode mode);  // 1-5
std::vector<Claim> scaling_claims(const Study& study);                     // 6
std::vector<Claim> sliding_claims(const Study& study, IkMode mode);        // 29

// claims_cycle.cpp: the two-stage cycle, turns and uneven ground, section 3.3.1.
std::vector<Claim> table_1_claims(const Walk& walk, double after_s, IkMode mode);  // 7
struct FootBuild {  // sizes of the walking character's feet
  std::array<double, 2> toe_rest_m{};
};
FootBuild foot_build(const WalkModel& model);
std::vector<Claim> continuity_claims(const Walk& walk, const FootBuild& build, double after_s,
                                     IkMode mode);                        // 8
std::vector<Claim> endurance_claims(const Walk& long_walk, IkMode mode);  // 30
std::vector<Claim> terrain_claims(const Study& study, IkMode mode);       // 22
std::vector<Claim> turn_claims(const Study& study, IkMode mode);          // 24

// claims_solver.cpp: the solver, figure 4 and its cost, section 3.3.2.
std::vector<Claim> jacobian_claims(const WalkModel& model, IkMode mode);  // 9
std::vector<Claim> chain_claims(IkMode mode);                             // 10-12
std::vector<Claim> cost_claims(Study& study);                             // 21
std::vector<Claim> reach_claims(const WalkModel& model, IkMode mode);     // 23

// claims_style.cpp: effects of weights, injuries, fatigue, hips and joystick, sections 3.1 and 4.
struct WeightWalks {
  const Walk *even = nullptr, *stiff_hip = nullptr, *stiff_knee = nullptr;
};
std::vector<Claim> weight_claims(const WeightWalks& walks, const Ticks& stride,
                                 IkMode mode);  // 13-16
// RMS changes of the hip for decreasing weights (0.9, 0.8, 0.5, 0.2), in degrees.
std::vector<Claim> monotone_claims(const std::vector<double>& rms_deg, IkMode mode);  // 17
struct LimpWalks {
  const Walk *even = nullptr, *limp = nullptr, *limp_hip = nullptr, *limp_knee = nullptr;
};
std::vector<Claim> limp_claims(const LimpWalks& walks, IkMode mode);  // 18, 19
std::vector<Claim> limp_weight_claims(const LimpWalks& walks, const Ticks& stride,
                                      IkMode mode);              // 20
std::vector<Claim> pad_claims(const Study& study);               // 25
std::vector<Claim> fatigue_claims(const Study& study);           // 26
std::vector<Claim> hip_claims(const Study& study, IkMode mode);  // 27
std::vector<Claim> body_claims(const Study& study);              // 28

}  // namespace gaitpad
