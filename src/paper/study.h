// The input of figures and claims: a motion with its stride, the styles of figure 5, walks with
// every tick recorded, and a gamepad.
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
  std::string motion;     // `procedural`, or the path of the file as given
  bool is_adult = false;  // it is the built-in adult's walk, for which some claims state numbers
  Motion frames;          // the motion as it is in the file
  GaitCycle cycle;        // the motion's best stride
  std::vector<Style> styles;
};

// `motion_file`: empty or `procedural` is the built-in motion, which has the adult's pace. Without
// `pace` the motion's pace is used. Styles come from the configuration folders; a missing style of
// a figure is an error.
Result<PaperSource> load_paper_source(const std::string& motion_file, std::optional<Pace> pace,
                                      const std::vector<std::string>& config_folders);

// The style of this name, one of styles_of_5a() and styles_of_5b().
const Style& style_of(const PaperSource& source, const std::string& name);

// The styles of the red, green and blue character in figures 5 (a) and (b).
struct FigureStyles {
  std::string red, green, blue;
};
const FigureStyles& styles_of_5a();
const FigureStyles& styles_of_5b();

// A walk: computed from a character, a style and a stick; every tick is recorded.

inline constexpr int kPaperRate_hz = 240;
inline constexpr double kPaperStick = 0.8;  // forward deflection in the walk of the figures

struct StickAt {
  double time_s = 0.0;
  vec2 left{0.0};  // deflection from that time on; +x right, +y forward
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
  double phase = 0.0;          // phase of the data's stride, not wrapped
  vec3 hips_m{0.0};            // place of the hips on the ground, without the data's oscillations
  double pelvis_yaw_rad = 0;   // yaw relative to the heading; only with keeps_joints
  std::vector<vec3> joints_m;  // joints of the skeleton in the world; only with keeps_joints
};
struct Walk {
  std::vector<WalkSample> samples;  // one sample for each tick
};
using EachTick = std::function<void(const WalkState&, const Pose&)>;
Walk walked(const WalkCase& what, const EachTick& each = {});

// The three angles of figure 5 in degrees; hip flexion, knee flexion and dorsiflexion are positive.
enum class LegJoint { hip, knee, ankle };
inline constexpr std::array<const char*, 3> kLegJointNames = {"hip", "knee", "ankle"};
double joint_deg(const LegAngles& angles_rad, LegJoint joint) noexcept;

struct Ticks {  // the ticks [begin, end)
  std::size_t begin = 0, end = 0;
  std::size_t count() const noexcept { return end - begin; }
};
// The strides of a foot; each lasts from one strike to the next.
std::vector<Ticks> strides(const Walk& walk, Side side);
// The first stride that begins after `time_s`; empty if there is none.
Ticks stride_after(const Walk& walk, Side side, double time_s);
// The ticks of each complete flight of the foot that begins after `time_s`.
std::vector<Ticks> flights(const Walk& walk, Side side, double time_s);

double joint_deg(const Walk& walk, std::size_t tick, Side side, LegJoint joint) noexcept;
struct Range {
  double min = 0.0, max = 0.0;
  double size() const noexcept { return max - min; }
};
Range joint_range(const Walk& walk, const Ticks& ticks, Side side, LegJoint joint) noexcept;
// Root mean square of the difference between two walks, tick by tick.
double joint_rms(const Walk& a, const Walk& b, const Ticks& ticks, Side side,
                 LegJoint joint) noexcept;

// Shared by the claims and figures of one motion: its model and its walks, each computed once.

class Study {
 public:
  // Fails if no character can be made from the motion's skeleton.
  static Result<Study> of(PaperSource source);

  const PaperSource& source() const { return source_; }
  const WalkModel& model() const { return *model_; }
  // The motion on longer or shorter legs.
  Result<WalkModel> model_with_legs(double leg_ratio) const;
  // A straight walk, kPaperStick forward, long enough for figure_stride().
  const Walk& walk(const std::string& style, IkMode mode);
  // The stride in the figures: from the right foot's first strike after kFigureStart_s. All styles
  // of a figure have the same ticks, because weights do not change the timing.
  Ticks figure_stride(const Walk& walk) const;

 private:
  explicit Study(PaperSource source) : source_(std::move(source)) {}
  PaperSource source_;
  std::shared_ptr<const WalkModel> model_;
  std::map<std::pair<std::string, IkMode>, Walk> walks_;
};

inline constexpr double kFigureStart_s = 4.0, kFigureEnd_s = 9.0;

// Largest distance in mm of a planted heel or toe from the place where its plant began, over all
// plants that begin at or after `from`.
double planted_slide_mm(const Walk& walk, std::size_t from = 0);

// A gamepad with two 16-bit axes, for the claims about the joystick.

// The pad's configuration: the calibration of an unknown stick (inner zone 0.2, outer zone 0.95).
PadConfig paper_pad();
// A report of that pad. `raw` is -1..1, +x right, +y forward.
Report paper_report(const vec2& raw);
Report paper_unplug();
// A session with that pad and one character for each style, on this motion.
SimulationConfig paper_session(const GaitCycle& cycle, const std::vector<Style>& styles, IkMode ik);

}  // namespace gaitpad
