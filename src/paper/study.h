// What the figures are drawn from: a motion, its stride, the styles of figure 5.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "gaitpad/control.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/result.h"
#include "gaitpad/simulation.h"
#include "gaitpad/style.h"
#include "gaitpad/walk.h"

namespace gaitpad {

struct PaperSource {
  std::string motion;     // `procedural` or the file as it was named
  bool is_adult = false;  // the built-in curve of an adult: some claims have numbers for it alone
  Motion frames;          // the motion as it stands in the file
  GaitCycle cycle;        // its best stride
  std::vector<Style> styles;
};

// `motion_file` empty or `procedural`: the built-in one. Styles come from the folders of
// config_files.h; one that a figure needs and that is nowhere is an error.
Result<PaperSource> load_paper_source(const std::string& motion_file,
                                      const std::vector<std::string>& config_folders);

// By its name; there is one for each of figure5_styles().
const Style& style_of(const PaperSource& source, const std::string& name);

// Red, green and blue of figure 5 (a) and (b).
struct FigureStyles {
  std::string red, green, blue;
};
const FigureStyles& styles_of_5a();
const FigureStyles& styles_of_5b();

// Walks for the figures and claims: a character, a style and a stick in, every tick out.

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

// What the claims and figures of one motion share: its models and walks, each made once.

class Study {
 public:
  // Fails where no character can be made of the motion's skeleton.
  static Result<Study> of(PaperSource source);

  const PaperSource& source() const { return source_; }
  const WalkModel& model() const { return *model_; }
  // The same motion on other legs.
  Result<WalkModel> model_with_legs(double leg_ratio) const;
  // Straight on, kPaperStick forward, as long as `figure_stride()` needs.
  const Walk& walk(const std::string& style, IkMode mode);
  // The stride that the figures show: from the first strike of the right foot after kFigureStart_s.
  // The same ticks for all styles of a figure, since weights change no time.
  Ticks figure_stride(const Walk& walk) const;

 private:
  explicit Study(PaperSource source) : source_(std::move(source)) {}
  PaperSource source_;
  std::shared_ptr<const WalkModel> model_;
  std::map<std::pair<std::string, IkMode>, Walk> walks_;
};

inline constexpr double kFigureStart_s = 4.0, kFigureEnd_s = 9.0;

// How far planted points slide.

// The greatest distance, mm, of a heel or toe from where it stood when its plant began, of all
// plants that begin at or after `from`.
double planted_slide_mm(const Walk& walk, std::size_t from = 0);

// A gamepad of two 16-bit axes, for the claims that begin at the joystick.

// With the calibration of an unknown stick (inner zone 0.2, outer 0.95).
PadConfig paper_pad();
// Raw -1..1, +x right, +y forward.
Report paper_report(const vec2& raw);
Report paper_unplug();
// That pad, one character a style, on this motion.
SimulationConfig paper_session(const GaitCycle& cycle, const std::vector<Style>& styles, IkMode ik);

}  // namespace gaitpad
