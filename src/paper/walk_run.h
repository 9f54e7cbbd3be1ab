// Walks for the figures and claims: a character, a style and a stick in, every tick out.
#pragma once
#include <functional>
#include <vector>

#include "gaitpad/control.h"
#include "gaitpad/walk.h"

namespace gaitpad {

inline constexpr int kPaperRate_hz = 240;
inline constexpr double kPaperStick = 0.8;  // the figures' walk: this far forward

struct StickAt {
  double time_s = 0.0;
  vec2 left{0.0};  // from then on; +x right, +y forward
};
struct WalkCase {
  const WalkModel* model = nullptr;
  StyleValues style;
  IkMode ik = IkMode::robust;
  std::vector<StickAt> stick = {{0.5, vec2(0.0, kPaperStick)}};
  double end_s = 10.0;
  bool keeps_joints = false;
};
struct WalkSample {
  WalkFrame frame;
  std::array<LegAngles, 2> angles_rad{};
  double phase = 0.0;          // of the data's stride, not wrapped within a stride
  vec3 hips_m{0.0};            // on the ground, without the data's oscillations
  double pelvis_yaw_rad = 0;   // beyond the heading; with keeps_joints
  std::vector<vec3> joints_m;  // of the skeleton, world; with keeps_joints
};
struct Walk {
  std::vector<WalkSample> samples;  // one a tick
};
using EachTick = std::function<void(const WalkState&, const Pose&)>;
Walk walked(const WalkCase& what, const EachTick& each = {});

// The three angles that figure 5 graphs, degrees: hip flexion, knee flexion, dorsiflexion are
// positive.
enum class LegJoint { hip, knee, ankle };
inline constexpr std::array<const char*, 3> kLegJointNames = {"hip", "knee", "ankle"};
double joint_deg(const LegAngles& angles_rad, LegJoint joint) noexcept;

struct Ticks {  // [begin, end)
  std::size_t begin = 0, end = 0;
  std::size_t count() const noexcept { return end - begin; }
};
// From that foot's strike to its next one, in order of time.
std::vector<Ticks> strides(const Walk& walk, Side side);
// The first one that begins after `time_s`; empty where there is none.
Ticks stride_after(const Walk& walk, Side side, double time_s);
// Whole flights of that foot (their ticks) that begin after `time_s`.
std::vector<Ticks> flights(const Walk& walk, Side side, double time_s);

double joint_deg(const Walk& walk, std::size_t tick, Side side, LegJoint joint) noexcept;
struct Range {
  double min = 0.0, max = 0.0;
  double size() const noexcept { return max - min; }
};
Range joint_range(const Walk& walk, const Ticks& ticks, Side side, LegJoint joint) noexcept;
// Root mean square of the difference of two walks with equal ticks.
double joint_rms(const Walk& a, const Walk& b, const Ticks& ticks, Side side,
                 LegJoint joint) noexcept;

}  // namespace gaitpad
