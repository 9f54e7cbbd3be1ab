#include "paper/study.h"

#include <algorithm>
#include <cassert>

#include "files/stride_cache.h"
#include "gaitpad/config_files.h"
#include "gaitpad/motion_file.h"

namespace gaitpad {
namespace {

void keep_joints(const WalkModel& model, const WalkState& state, const Pose& pose,
                 JointFrames& frames, WalkSample& sample) {
  forward_kinematics(model.cycle.skeleton, pose, frames);
  sample.joints_m.assign(frames.position_m.begin(), frames.position_m.begin() + pose.joint_count);
  const quat pelvis =
      frames.rotation[model.cycle.pelvis] * glm::inverse(model.cycle.pelvis_standing);
  sample.pelvis_yaw_rad = wrapped(heading_of(pelvis * kForward) - state.root.heading_rad);
}

vec2 stick_at(const std::vector<StickAt>& stick, double time_s) {
  vec2 now(0.0);
  for (const StickAt& s : stick) {
    if (s.time_s <= time_s) now = s.left;
  }
  return now;
}

bool is_landing(const Walk& walk, std::size_t tick, Side side) {
  if (tick == 0) return false;
  const WalkFrame &before = walk.samples[tick - 1].frame, &now = walk.samples[tick].frame;
  return now.stage == Stage::roll && now.swing == side && before.stage == Stage::flight;
}

double slide_of(const Walk& walk, std::size_t from, std::array<bool, 2> WalkFrame::*planted,
                std::array<vec3, 2> WalkFrame::*place, Side side) {
  double most = 0.0;
  bool stood = true;  // true at first, so that a plant that began before `from` is ignored
  vec3 anchor(0.0);
  bool counts = false;
  for (std::size_t k = from; k < walk.samples.size(); ++k) {
    const WalkFrame& f = walk.samples[k].frame;
    const bool stands = (f.*planted)[side];
    if (stands && (!stood || k == 0)) {
      anchor = (f.*place)[side];
      counts = true;
    }
    if (stands && counts) most = std::max(most, glm::distance((f.*place)[side], anchor));
    stood = stands;
  }
  return 1e3 * most;
}

constexpr double kFull = 32767.0;

DeviceInfo device() {
  DeviceInfo info;
  info.bus = BusType::virtual_bus;
  info.vendor = 0x1209;
  info.product = 0x0001;
  info.name = "figures";
  // A descriptor of a game pad with X and Y, 16 bits each, -32767..32767.
  info.descriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x09, 0x30, 0x09, 0x31, 0x16, 0x01,
                     0x80, 0x26, 0xff, 0x7f, 0x75, 0x10, 0x95, 0x02, 0x81, 0x02, 0xc0};
  return info;
}

}  // namespace

const FigureStyles& styles_of_5a() {
  static const FigureStyles kStyles = {"even", "stiff_hip", "stiff_knee"};
  return kStyles;
}

const FigureStyles& styles_of_5b() {
  static const FigureStyles kStyles = {"limp_left", "limp_left_hip", "limp_left_knee"};
  return kStyles;
}

const Style& style_of(const PaperSource& source, const std::string& name) {
  const auto found = std::ranges::find(source.styles, name, &Style::name);
  assert(found != source.styles.end());
  return *found;
}

Result<PaperSource> load_paper_source(const std::string& motion_file, std::optional<Pace> pace,
                                      const std::vector<std::string>& config_folders) {
  PaperSource source;
  source.is_adult = motion_file.empty() || motion_file == "procedural";
  source.motion = source.is_adult ? "procedural" : motion_file;
  if (source.is_adult) {
    source.frames = procedural_motion();
    source.cycle = procedural_gait();
  } else {
    const auto path = motion_path(config_folders, motion_file);
    if (!path) return path.error();
    auto motion = load_motion_source(*path);
    if (!motion) return motion.error();
    auto cycle = gait_cycle(*motion);
    if (!cycle) return cycle.error();
    cycle->pace = pace.value_or(cycle->pace);
    source.frames = std::move(*motion);
    source.cycle = std::move(*cycle);
  }
  auto clean = cached_clean_strides(std::move(source.cycle), stride_cache_folder());
  if (!clean) return clean.error();
  source.cycle = std::move(*clean);
  for (const FigureStyles& figure : {styles_of_5a(), styles_of_5b()}) {
    for (const std::string& name : {figure.red, figure.green, figure.blue}) {
      auto path = config_file(config_folders, "styles", name);
      if (!path) return path.error();
      auto style = load_style(*path);
      if (!style) return style.error();
      style->name = name;
      source.styles.push_back(std::move(*style));
    }
  }
  return source;
}

Walk walked(const WalkCase& what, const EachTick& each) {
  const WalkModel& model = *what.model;
  const GaitLimits limits = gait_limits(model);
  Pose pose;
  JointFrames frames;
  WalkState state = standing(model, vec3(0.0), pose);
  Walk walk;
  const int ticks = static_cast<int>(what.end_s * kPaperRate_hz);
  walk.samples.resize(static_cast<std::size_t>(std::max(ticks, 0)));
  for (int tick = 0; tick < ticks; ++tick) {
    Stick stick;
    stick.left = stick_at(what.stick, static_cast<double>(tick) / kPaperRate_hz);
    advance(model, gait_params(stick, what.style, limits), what.ik, 1.0 / kPaperRate_hz, state,
            pose);
    WalkSample& sample = walk.samples[static_cast<std::size_t>(tick)];
    sample.frame = walk_frame(model, state, pose);
    sample.angles_rad = leg_angles(model, pose);
    sample.phase = shown_phase(state);
    sample.hips_m = state.root.place_m;
    if (what.keeps_joints) keep_joints(model, state, pose, frames, sample);
    if (each) each(state, pose);
  }
  return walk;
}

double joint_deg(const LegAngles& angles_rad, LegJoint joint) noexcept {
  switch (joint) {
    case LegJoint::hip:
      return -angles_rad[kHipX] / kDegree;
    case LegJoint::knee:
      return angles_rad[kKneeX] / kDegree;
    case LegJoint::ankle:
      break;
  }
  return -angles_rad[kAnkleX] / kDegree;
}

std::vector<Ticks> strides(const Walk& walk, Side side) {
  std::vector<Ticks> found;
  std::size_t begin = 0;
  for (std::size_t k = 1; k < walk.samples.size(); ++k) {
    if (!is_landing(walk, k, side)) continue;
    if (begin > 0) found.push_back({begin, k});
    begin = k;
  }
  return found;
}

Ticks stride_after(const Walk& walk, Side side, double time_s) {
  for (const Ticks& stride : strides(walk, side)) {
    if (static_cast<double>(stride.begin) >= time_s * kPaperRate_hz) return stride;
  }
  return {};
}

std::vector<Ticks> flights(const Walk& walk, Side side, double time_s) {
  std::vector<Ticks> found;
  Ticks now;
  for (std::size_t k = 0; k < walk.samples.size(); ++k) {
    const WalkFrame& frame = walk.samples[k].frame;
    const bool flies = frame.stage == Stage::flight && frame.swing == side;
    if (flies && now.end != k) now.begin = k;
    if (flies) now.end = k + 1;
    const bool is_over = !flies && now.end == k && k > 0;
    if (is_over && static_cast<double>(now.begin) >= time_s * kPaperRate_hz) found.push_back(now);
  }
  return found;
}

double joint_deg(const Walk& walk, std::size_t tick, Side side, LegJoint joint) noexcept {
  return joint_deg(walk.samples[tick].angles_rad[side], joint);
}

Range joint_range(const Walk& walk, const Ticks& ticks, Side side, LegJoint joint) noexcept {
  Range range{1e9, -1e9};
  for (std::size_t k = ticks.begin; k < ticks.end; ++k) {
    const double angle = joint_deg(walk, k, side, joint);
    range.min = std::min(range.min, angle);
    range.max = std::max(range.max, angle);
  }
  return range;
}

double joint_rms(const Walk& a, const Walk& b, const Ticks& ticks, Side side,
                 LegJoint joint) noexcept {
  double squares = 0.0;
  for (std::size_t k = ticks.begin; k < ticks.end; ++k) {
    const double d = joint_deg(b, k, side, joint) - joint_deg(a, k, side, joint);
    squares += d * d;
  }
  return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(ticks.count(), 1)));
}

Result<Study> Study::of(PaperSource source) {
  auto model = walk_model(source.cycle, Character{});
  if (!model) return model.error();
  Study study(std::move(source));
  study.model_ = std::make_shared<const WalkModel>(std::move(*model));
  return study;
}

Result<WalkModel> Study::model_with_legs(double leg_ratio) const {
  Character character;
  character.leg_ratio = leg_ratio;
  return walk_model(source_.cycle, character);
}

const Walk& Study::walk(const std::string& style, IkMode mode) {
  const auto key = std::pair(style, mode);
  if (const auto found = walks_.find(key); found != walks_.end()) return found->second;
  WalkCase what;
  what.model = model_.get();
  what.style = style_of(source_, style);
  what.ik = mode;
  what.end_s = kFigureEnd_s;
  what.keeps_joints = true;
  return walks_.emplace(key, walked(what)).first->second;
}

Ticks Study::figure_stride(const Walk& walk) const {
  return stride_after(walk, kRightSide, kFigureStart_s);
}

double planted_slide_mm(const Walk& walk, std::size_t from) {
  double most = 0.0;
  for (const Side side : {kLeftSide, kRightSide}) {
    most = std::max({most, slide_of(walk, from, &WalkFrame::heel_planted, &WalkFrame::heel_m, side),
                     slide_of(walk, from, &WalkFrame::toe_planted, &WalkFrame::toe_m, side)});
  }
  return most;
}

PadConfig paper_pad() {
  PadConfig config;
  auto layout = pad_layout(device(), {});
  if (layout) config.layout = std::make_shared<const PadLayout>(std::move(*layout));
  config.is_usable = config.layout && config.layout->is_pad;
  return config;
}

Report paper_report(const vec2& raw) {
  Report report;
  report.device = 0;
  report.size = 4;
  const std::array<double, 2> axes = {raw.x, -raw.y};  // HID's Y axis points backwards
  for (std::size_t i = 0; i < 2; ++i) {
    const int count = static_cast<int>(std::floor(std::clamp(axes[i], -1.0, 1.0) * kFull + 0.5));
    report.bytes[2 * i] = static_cast<std::uint8_t>(count & 0xff);
    report.bytes[2 * i + 1] = static_cast<std::uint8_t>((count >> 8) & 0xff);
  }
  return report;
}

Report paper_unplug() {
  Report report;
  report.device = 0;
  report.kind = ReportKind::removed;
  return report;
}

SimulationConfig paper_session(const GaitCycle& cycle, const std::vector<Style>& styles,
                               IkMode ik) {
  SimulationConfig config;
  config.rate_hz = kPaperRate_hz;
  config.ik = ik;
  config.pads = {paper_pad()};
  config.styles = styles;
  config.cycle = cycle;
  for (std::size_t i = 0; i < styles.size(); ++i) {
    config.walkers.emplace_back().style = static_cast<int>(i);
  }
  return config;
}

}  // namespace gaitpad
