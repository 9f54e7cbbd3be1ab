#include "bench/bench_work.h"

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <filesystem>
#include <random>

#include "base/lanes.h"
#include "drivers/system_users.h"
#include "files/stride_cache.h"
#include "gaitpad/config_files.h"
#include "gaitpad/crowd.h"
#include "gaitpad/replay.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/trace.h"
#include "session/workers.h"
#include "system/threads.h"
#include "walk/leg_solve.h"

namespace gaitpad {
namespace {

// --- The walk that is measured -------------------------------------------------------------------

// The part of the bundled trace in which the character walks and turns.
constexpr int kFirstTick = 480, kLastTick = 2880;
constexpr int kStickTicks = 8;  // a character gets a new stick after this number
                                // of ticks

std::string bundled_trace(const std::vector<std::string>& config_folders) {
  const std::string name = "traces/round.hid";
  for (const std::string& folder : config_folders) {
    const std::filesystem::path path = std::filesystem::path(folder) / name;
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) return path.string();
  }
  return name;
}

// The built-in motion's walkers, one for each style, driven by the bundled trace.
struct Session {
  SimulationConfig config;
  std::vector<std::vector<Report>> ticks;
  double dt_s() const { return 1.0 / config.rate_hz; }
};

Result<Session> bench_session(const std::vector<std::string>& config_folders,
                              const std::vector<std::string>& styles, IkMode ik) {
  SessionSpec spec;
  spec.config_folders = config_folders;
  spec.walk.styles = styles;
  spec.walk.ik = ik;
  auto trace = read_trace(bundled_trace(spec.config_folders));
  if (!trace) return trace.error();
  const int rate_hz = replay_rate_hz(*trace, std::nullopt);
  const auto count = assign_ticks(*trace, rate_hz);
  if (!count) return count.error();
  const auto files = load_pad_files(spec);
  if (!files) return files.error();
  auto pads = pad_configs(*files, trace->devices, trace->path);
  if (!pads) return pads.error();
  auto config = simulation_config(spec, rate_hz);
  if (!config) return config.error();
  config->pads = std::move(*pads);
  Session session{std::move(*config), {}};
  session.ticks.resize(kLastTick);
  for (const TraceEvent& event : trace->events) {
    if (event.tick < kLastTick) session.ticks[event.tick].push_back(report_of(*trace, event));
  }
  return session;
}

// The walkers at kFirstTick.
Result<Simulation> walking(const Session& session) {
  auto simulation = Simulation::create(session.config);
  if (!simulation) return simulation.error();
  for (int tick = 0; tick < kFirstTick; ++tick) simulation->step(session.ticks[tick]);
  return simulation;
}

// The sticks of the trace from kFirstTick on; a character may begin anywhere in them.
std::vector<Stick> sticks_of(const Session& session, Simulation simulation) {
  std::vector<Stick> sticks;
  for (int tick = kFirstTick; tick < kLastTick; ++tick) {
    simulation.step(session.ticks[tick]);
    sticks.push_back(simulation.stick());
  }
  return sticks;
}

// --- One leg: the solver alone, warm -------------------------------------------------------------

constexpr int kSnapshotTicks = 40;
constexpr PaperOptions kPaper = {.tolerance_m = 1e-5};

IkAngles all_angles(const LegAngles& angles) {
  IkAngles all{};
  std::copy(angles.begin(), angles.end(), all.begin());
  return all;
}

// The constraint rows of the foot in a tick whose solution is `frame`.
constexpr double kSideLever_m = 0.1;  // to the point whose height keeps a foot from rolling
std::array<IkRow, 6> foot_rows(const LegBuild& leg, const IkFrame& frame, bool is_on_toe) {
  const vec3 effector = is_on_toe ? leg.model.toe_m : leg.model.heel_m;
  const vec3 other = is_on_toe ? leg.model.heel_m : leg.model.toe_m;
  const vec3 side = frame.rotation * leg.side;
  const vec3 along = frame.rotation * glm::normalize(leg.model.toe_m - leg.model.heel_m);
  const vec3 across = glm::cross(along, side);
  const auto row = [&](const vec3& point, const vec3& direction) {
    return IkRow{point, direction, glm::dot(direction, frame.position_m + frame.rotation * point)};
  };
  return {row(effector, side),  row(effector, across),
          row(effector, along), row(other, side),
          row(other, across),   row(effector + kSideLever_m * leg.side, across)};
}

// Both legs of one tick, solved side by side by the walk's closed form, as a tick of one walk does.
// They start at the pose of the tick before and move to the walk's solution.
using RobustLegs = std::array<LegGoal<float>, 2>;
void add_legs(const Walker& before, const Walker& now, double, std::vector<RobustLegs>& legs) {
  RobustLegs& both = legs.emplace_back();
  const auto last_rad = leg_angles(*before.model, before.pose),
             solved_rad = leg_angles(*now.model, now.pose);
  const auto number = [](double x) { return static_cast<float>(x); };
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = now.model->leg[side];
    const IkFrame foot = end_frame(leg.chain, all_angles(solved_rad[side]));
    const vec3& p = foot.position_m;
    const quat& q = foot.rotation;
    LegGoal<float>& solve = both[side];
    solve.ankle_m = {number(p.x), number(p.y), number(p.z)};
    solve.foot = {number(q.w), number(q.x), number(q.y), number(q.z)};
    solve.thigh_m = number(leg.model.thigh_m);
    solve.shank_m = number(leg.model.shank_m);
    for (int j = 0; j < kLegDofs; ++j) solve.table_rad[j] = number(last_rad[side][j]);
  }
}

struct PaperLeg {
  IkChain chain;
  std::array<IkRow, 6> rows;
  std::size_t row_count = 0;
  IkAngles start{};
};
void add_legs(const Walker& before, const Walker& now, double, std::vector<PaperLeg>& legs) {
  constexpr double kLow_m = 1e-5;  // a heel this low has not risen
  const WalkFrame frame = walk_frame(now);
  const auto last_rad = leg_angles(*before.model, before.pose),
             solved_rad = leg_angles(*now.model, now.pose);
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegBuild& leg = now.model->leg[side];
    const bool stands = frame.toe_planted[side], rolls = !stands && frame.heel_planted[side];
    PaperLeg& solve = legs.emplace_back();
    solve.chain = leg.chain;
    for (int j = 0; j < kLegDofs; ++j) solve.chain.dof[j].weight = now.params.weight[side][j];
    solve.rows = foot_rows(leg, end_frame(leg.chain, all_angles(solved_rad[side])), stands);
    const bool is_low = frame.heel_m[side].y - frame.heel_ground_m[side] < kLow_m;
    solve.row_count = rolls || (stands && is_low) ? 5 : 3;
    solve.start = all_angles(last_rad[side]);
  }
}

// Solves the legs of these walkers, in one tick of each kSnapshotTicks.
template <class Legs>
std::vector<Legs> solves_of(const Session& session, Simulation simulation,
                            const std::vector<int>& walkers) {
  std::vector<Legs> legs;
  for (int tick = kFirstTick; tick + 1 < kLastTick; tick += kSnapshotTicks) {
    for (int k = 0; k + 1 < kSnapshotTicks; ++k) simulation.step(session.ticks[tick + k]);
    const std::vector<Walker> before = simulation.walkers();
    simulation.step(session.ticks[tick + kSnapshotTicks - 1]);
    for (const int w : walkers) add_legs(before[w], simulation.walkers()[w], session.dt_s(), legs);
  }
  return legs;
}

int solve(const RobustLegs& both) {
  LegGoal<float> goals[2] = {both[0], both[1]};
  Leg<float> legs[2];
  solve_both(goals, legs);
  benchmark::DoNotOptimize(legs);
  benchmark::DoNotOptimize(goals);
  return (legs[0].short_m == 0.0f) + (legs[1].short_m == 0.0f);
}
int solve(PaperLeg& leg) {
  IkAngles angles = leg.start;
  const IkResult result = solve_paper(leg.chain, {leg.rows.data(), leg.row_count}, kPaper, angles);
  benchmark::DoNotOptimize(angles);
  return result.iterations;
}

// One pass solves all legs.
template <class Legs>
Work leg_work(const char* name, const char* label, std::vector<Legs> legs) {
  Work work;
  work.name = name;
  work.label = label;
  work.units = static_cast<double>(legs.size() * (std::is_same_v<Legs, RobustLegs> ? 2 : 1));
  int iterations = 0;
  for (Legs& one : legs) iterations += solve(one);
  work.notes["iterations_per_leg"] = iterations / work.units;
  work.pass = [legs = std::move(legs)]() mutable {
    for (Legs& one : legs) solve(one);
  };
  return work;
}

// --- Bare playback: the peer ---------------------------------------------------------------------

// The local rotation of every joint at a phase, one joint after another: Catmull-Rom through four
// samples, as sample_local() computes it with two joints side by side.
void play_back(const GaitCycle& cycle, double phase, Pose& pose) {
  const double place = (phase - std::floor(phase)) * kCycleSamples;
  const int i = std::min(static_cast<int>(place), kCycleSamples - 1);
  const double t = place - i;
  const std::array<double, 4> weight = {
      0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (3.0 * t - 5.0),
      0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (t - 1.0)};
  const std::size_t joints = cycle.standing_local.size();
  std::array<const quat*, 4> row;
  for (int k = 0; k < 4; ++k)
    row[k] = cycle.local.data() +
             static_cast<std::size_t>((i + k - 1 + kCycleSamples) % kCycleSamples) * joints;
  pose.joint_count = static_cast<int>(joints);
  for (std::size_t j = 0; j < joints; ++j) {
    quat sum = row[1][j] * weight[1];
    for (const int k : {0, 2, 3}) {
      const double sign = glm::dot(row[k][j], row[1][j]) < 0.0 ? -1.0 : 1.0;
      sum = sum + row[k][j] * (sign * weight[k]);
    }
    pose.local[j] = glm::normalize(sum);
  }
}

enum class PlaybackFrames { local, world };
Work playback_work(const Session& session, PlaybackFrames kind) {
  struct State {
    GaitCycle cycle;
    double phase = 0.0;
    Pose pose;
    JointFrames frames;
  };
  const auto s = std::make_shared<State>();
  s->cycle = session.config.cycle;
  const double step = session.dt_s() / s->cycle.duration_s;
  Work work;
  work.name = kind == PlaybackFrames::local ? "playback" : "playback_world";
  work.label = kind == PlaybackFrames::local ? "local rotations (the peer)"
                                             : "and world frames of all joints";
  work.notes["joints"] = s->cycle.standing_local.size();
  work.pass = [s, step, kind] {
    play_back(s->cycle, s->phase, s->pose);
    if (kind == PlaybackFrames::world) forward_kinematics(s->cycle.skeleton, s->pose, s->frames);
    s->phase += step;
    benchmark::DoNotOptimize(s->pose);
    benchmark::DoNotOptimize(s->frames);
  };
  return work;
}

// --- One character, and four ---------------------------------------------------------------------

// Characters that follow the trace's sticks, without a session.
struct LiveWalkers {
  struct One {
    std::shared_ptr<const WalkModel> model;
    StyleValues style;
    GaitLimits limits;
    std::size_t begin = 0;  // index of the character's first stick
    GaitParams params;
    WalkState state;
    Pose pose;
  };
  std::vector<One> all;
  std::vector<Stick> sticks;
  std::size_t tick = 0;
  double dt_s = 0.0;

  // `from`: indices of walkers in `simulation`; each begins at another part of the trace.
  LiveWalkers(double tick_s, const Simulation& simulation, const std::vector<int>& from,
              const std::vector<Stick>& led_by)
      : sticks(led_by), dt_s(tick_s) {
    for (const int i : from) {
      const Walker& w = simulation.walkers()[i];
      const std::size_t begin = all.size() * 149 % sticks.size();
      all.push_back({w.model, w.in_force, w.limits, begin, w.params, w.state, w.pose});
    }
  }
  void read_sticks() {
    if (tick++ % kStickTicks != 0) return;
    for (One& one : all)
      one.params = gait_params(sticks[(one.begin + tick) % sticks.size()], one.style, one.limits);
  }
  void advance_all() {
    read_sticks();
    for (One& one : all) advance(*one.model, one.params, IkMode::robust, dt_s, one.state, one.pose);
  }
};

Work character_work(const char* name, const char* label,
                    const std::shared_ptr<LiveWalkers>& walkers) {
  Work work;
  work.name = name;
  work.label = label;
  work.characters = static_cast<int>(walkers->all.size());
  work.units = work.characters;
  work.pass = [walkers] { walkers->advance_all(); };
  return work;
}

// --- Ground that is asked for --------------------------------------------------------------------

// Waves of 0.2 m without an end, and how often they were asked for.
struct Waves {
  mutable long long asked = 0;
};
Ground ask_waves(const void* game, double x_m, double z_m) noexcept {
  ++static_cast<const Waves*>(game)->asked;
  return {0.1 * (gaitpad::sin_cos(0.8 * x_m).sin + gaitpad::sin_cos(0.8 * z_m).sin)};
}

// The walker on the waves, from standing.
Work asked_work(const std::shared_ptr<LiveWalkers>& walkers) {
  const auto waves = std::make_shared<Waves>();
  LiveWalkers::One& one = walkers->all.front();
  auto model = std::make_shared<WalkModel>(*one.model);
  model->terrain = std::make_shared<Terrain>(
      Terrain{.name = "waves", .sections = {}, .zones = {}, .asked = {&ask_waves, waves.get()}});
  one.model = model;
  one.state = standing(*model, vec3(0.0), one.pose);
  constexpr int kCounted = 2400;
  for (int tick = 0; tick < kCounted; ++tick) walkers->advance_all();
  Work work = character_work("character_asked", "1, even, on waves that are asked for", walkers);
  work.notes["asked_per_tick"] = static_cast<double>(waves->asked) / kCounted;
  work.pass = [walkers, waves] { walkers->advance_all(); };
  return work;
}

// One question to a height field of 200 m, along a walk.
Work query_work() {
  const auto grid = std::make_shared<GroundGrid>(
      GroundGrid{.x_m = -100.0, .z_m = -100.0, .spacing_m = 0.5, .columns = 400, .rows = 400});
  for (int i = 0; i < grid->columns * grid->rows; ++i)
    grid->height_m.push_back(static_cast<float>(0.05 * gaitpad::sin_cos(0.1 * i).sin));
  const auto terrain = std::make_shared<Terrain>();
  terrain->asked = asked_ground(*grid);
  Work work;
  work.name = "ground_query";
  work.label = "a height field of 400 x 400";
  constexpr int kQueries = 1000;
  work.units = kQueries;
  work.pass = [grid, terrain] {
    for (int i = 0; i < kQueries; ++i)
      benchmark::DoNotOptimize(ground_at(*terrain, 0.01 * i, 0.02 * i));
  };
  return work;
}

// The whole of Simulation::step(), with reports, styles and the pose's hash.
Work step_work(const Session& session, const Simulation& simulation, const char* label) {
  struct State {
    Session session;
    Simulation simulation;
    int tick = kFirstTick;
  };
  const auto s = std::make_shared<State>(State{session, simulation});
  Work work;
  work.name = "step";
  work.label = label;
  work.characters = static_cast<int>(simulation.walkers().size());
  work.units = work.characters;
  work.pass = [s] {
    s->simulation.step(s->session.ticks[s->tick]);
    if (++s->tick == kLastTick) s->tick = kFirstTick;
  };
  double iterations = 0.0;
  Simulation counted = simulation;
  for (int tick = kFirstTick; tick < kLastTick; ++tick) {
    counted.step(session.ticks[tick]);
    for (const Walker& w : counted.walkers())
      for (const float n : w.state.walk.told.iterations) iterations += n;
  }
  work.notes["iterations_per_leg"] = iterations / (2.0 * work.units * (kLastTick - kFirstTick));
  return work;
}

// --- Crowds --------------------------------------------------------------------------------------

constexpr double kCrowdDt_s = 1.0 / 60.0;
// Ticks before a crowd is measured, the same for all sizes: a walk that starts costs three times
// as much as one that walks on.
constexpr int kWarmTicks = 60;
constexpr int kLastStart = 20;  // standing members start at one of the first
                                // kLastStart ticks
constexpr int kLarge = 10000;   // a crowd of this size has fewer rounds
constexpr int kBuilds = 16;
constexpr unsigned kSeed = 14;
const std::vector<std::string> kCrowdStyles = {"even",      "stiff_hip",     "stiff_knee",
                                               "limp_left", "limp_left_hip", "limp_left_knee",
                                               "muscular",  "heavy_slack"};

// Number of bytes that are allocated on the heap.
double heap_bytes() {
  const auto info = ::mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

// Shared by all crowds. Members share the models of some builds.
struct CrowdCast {
  std::vector<std::shared_ptr<const WalkModel>> models;
  std::vector<GaitLimits> limits;
  std::vector<StyleValues> styles;
  std::vector<Stick> sticks;
  int stick_step = 1;  // number of the trace's sticks that a crowd's tick advances by
  double model_bytes = 0.0;
};

Result<CrowdCast> crowd_cast(const Session& session, const std::vector<Stick>& sticks) {
  CrowdCast cast;
  cast.sticks = sticks;
  cast.stick_step = std::max(1, static_cast<int>(kCrowdDt_s / session.dt_s() + 0.5));
  for (const WalkerConfig& walker : session.config.walkers)
    cast.styles.push_back(session.config.styles[walker.style]);
  std::mt19937 random(kSeed);
  const auto between = [&random](double low, double high) {
    return low + (high - low) * (random() / 4294967295.0);
  };
  const double before = heap_bytes();
  for (int i = 0; i < kBuilds; ++i) {
    Character build;
    build.scale = between(0.75, 1.15);
    build.leg_ratio = between(0.85, 1.15);
    auto model = walk_model(session.config.cycle, build);
    if (!model) return model.error();
    cast.models.push_back(std::make_shared<const WalkModel>(std::move(*model)));
    cast.limits.push_back(gait_limits(*cast.models.back()));
  }
  cast.model_bytes = (heap_bytes() - before) / kBuilds;
  return cast;
}

// A crowd of mixed builds and styles; each member follows another part of the trace, in another
// stage.
class LedCrowd {
 public:
  LedCrowd(std::shared_ptr<const CrowdCast> cast, int size) : cast_(std::move(cast)) {
    std::mt19937 random(kSeed);
    std::vector<CrowdMember> members;
    const int row = static_cast<int>(std::ceil(std::sqrt(size)));
    for (int i = 0; i < size; ++i) {
      const auto one_of = [&random](std::size_t n) { return static_cast<int>(random() % n); };
      const Part part = {one_of(cast_->models.size()), one_of(cast_->styles.size()),
                         one_of(cast_->sticks.size()), one_of(kLastStart)};
      parts_.push_back(part);
      members.push_back({cast_->models[part.model], vec3(1.5 * (i % row), 0.0, 1.5 * (i / row))});
    }
    const double before = heap_bytes();
    crowd_ = Crowd(members);
    bytes_each_ = (heap_bytes() - before) / size;
    for (int i = 0; i < size; ++i) ask(i, Stick{});
    crowd_.group_by_style();
  }
  double bytes_each() const { return bytes_each_; }

  // Advances the members one by one, each as if it walked alone.
  void advance_each() {
    lead();
    for (int i = 0; i < crowd_.size(); ++i) {
      const Part& part = parts_[i];
      advance(*cast_->models[part.model], crowd_.params()[i], IkMode::robust, kCrowdDt_s,
              alone_[i].first, alone_[i].second);
    }
  }
  // Copies the members' states, from which advance_each() then continues.
  void leave() {
    for (int i = 0; i < crowd_.size(); ++i) {
      alone_.emplace_back(crowd_.state(i), Pose());
      crowd_.copy_pose(i, alone_.back().second);
    }
  }

  // Advances all members; with workers, on all of their threads.
  void advance_all(Workers* workers) {
    lead();
    if (workers) {
      workers->for_each(crowd_.blocks(), [this](int b) { crowd_.advance_block(b, kCrowdDt_s); });
    } else {
      crowd_.advance(kCrowdDt_s);
    }
  }

 private:
  struct Part {
    int model, style, stick, start;
  };
  // Gives the members the sticks of this tick.
  void lead() {
    for (int i = tick_ % kStickTicks; i < crowd_.size(); i += kStickTicks) {
      const Part& part = parts_[i];
      if (tick_ < part.start) continue;
      const std::size_t at =
          static_cast<std::size_t>(part.stick + tick_ * cast_->stick_step) % cast_->sticks.size();
      ask(i, cast_->sticks[at]);
    }
    ++tick_;
  }
  void ask(int member, const Stick& stick) {
    const Part& part = parts_[member];
    crowd_.params()[member] =
        gait_params(stick, cast_->styles[part.style], cast_->limits[part.model]);
  }

  std::shared_ptr<const CrowdCast> cast_;
  std::vector<Part> parts_;
  Crowd crowd_;
  std::vector<std::pair<WalkState, Pose>> alone_;
  double bytes_each_ = 0.0;
  int tick_ = 0;
};

enum class CrowdCores { one, all };
Work crowd_work(std::shared_ptr<const CrowdCast> cast, int size, int lanes, CrowdCores cores,
                const std::shared_ptr<Workers>& workers) {
  use_lanes(lanes);
  const auto crowd = std::make_shared<LedCrowd>(std::move(cast), size);
  for (int tick = 0; tick < kWarmTicks; ++tick) crowd->advance_all(workers.get());
  Work work;
  work.name = "crowd";
  work.label = lanes == 1 ? fmt::format("{:6}   one after another", size)
                          : fmt::format("{:6}   {} lanes", size, lanes);
  work.characters = size;
  work.units = size;
  work.width = lanes;
  work.over = "playback";
  work.every = size >= kLarge ? 3 : 1;
  // With a sanitizer, mallinfo2() counts nothing.
  if (crowd->bytes_each() > 0.0) work.notes["bytes"] = crowd->bytes_each();
  if (cores == CrowdCores::all) {
    work.name = "crowd_all_cores";
    work.is_on_all_cores = true;
    work.label += fmt::format(", {} threads", workers->threads());
    work.notes["threads"] = workers->threads();
    work.pass = [crowd, workers] { crowd->advance_all(workers.get()); };
    return work;
  }
  if (size == 1000) {
    work.most_ratio = lanes >= 16 ? 0.6 : lanes >= 8 ? 0.9 : lanes >= 4 ? 1.5 : 0.0;
  }
  work.pass = [crowd] { crowd->advance_all(nullptr); };
  return work;
}

// The peer of a crowd: the same number of members with the same builds, styles, sticks and rate,
// one after another. Crowds of different sizes have the same first members.
Work alone_work(std::shared_ptr<const CrowdCast> cast, int size) {
  const auto crowd = std::make_shared<LedCrowd>(std::move(cast), size);
  for (int tick = 0; tick < kWarmTicks; ++tick) crowd->advance_all(nullptr);
  crowd->leave();
  Work work;
  work.name = "crowd_alone";
  work.label = fmt::format("{:6}   mixed builds and styles, 60 Hz", size);
  work.characters = size;
  work.units = size;
  work.over = "playback";
  work.pass = [crowd] { crowd->advance_each(); };
  return work;
}

// The memory limit: reads and writes a crowd's states and poses once, reads its parameters, and
// computes nothing.
Work memory_work(const CrowdCast& cast, int size) {
  struct Memory {
    std::vector<std::array<double, sizeof(WalkState) / sizeof(double)>> states;
    std::vector<quat> poses;
    std::vector<GaitParams> params;
  };
  const std::size_t count = static_cast<std::size_t>(size),
                    joints = cast.models.front()->cycle.standing_local.size();
  const auto memory = std::make_shared<Memory>();
  memory->states.resize(count);
  memory->poses.resize(count * joints, kIdentity);
  memory->params.resize(count);
  Work work;
  work.name = "crowd_memory";
  work.label = fmt::format("{:6}   its memory alone", size);
  work.characters = size;
  work.units = size;
  work.over = "playback";
  work.every = size >= kLarge ? 3 : 1;
  work.notes["bytes"] = sizeof(WalkState) + joints * sizeof(quat) + sizeof(GaitParams);
  work.pass = [memory, joints] {
    double sum = 0.0;
    for (std::size_t i = 0; i < memory->states.size(); ++i) {
      for (double& number : memory->states[i]) number += 1.0;
      for (quat& q : std::span(memory->poses).subspan(i * joints, joints)) q = -q;
      for (const LegWeights& weights : memory->params[i].weight) sum += weights[0];
    }
    benchmark::DoNotOptimize(sum);
  };
  return work;
}

// --- Loading -------------------------------------------------------------------------------------

// A folder that is deleted with the last work that uses it.
std::shared_ptr<const std::filesystem::path> cache_folder(std::string_view what) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path path =
      fs::temp_directory_path(ignored) / fmt::format("gaitpad_bench_{}_{}", what, own_process_id());
  return {new fs::path(path), [](const fs::path* p) {
            std::error_code unused;
            fs::remove_all(*p, unused);
            delete p;
          }};
}

std::optional<Error> load(Result<GaitCycle> cycle, const std::string& cache) {
  if (cycle) cycle = cached_clean_strides(std::move(*cycle), cache);
  if (!cycle) return cycle.error();
  const auto model = walk_model(*cycle, Character{});
  if (!model) return model.error();
  return std::nullopt;
}

// The work from a motion in memory to a character: the built-in motion; the same as a captured
// clip, whose halves are not assumed to be mirrored; the clip with its strides in a cache. Strides
// are solved on several cores.
Result<std::vector<Work>> load_work() {
  const auto clip = std::make_shared<const Motion>(procedural_motion());
  const auto cache = cache_folder("strides");
  if (auto problem = load(gait_cycle(*clip), cache->string())) return *problem;
  std::vector<Work> list(3);
  list[0].name = "load_built_in";
  list[0].label = "the built-in motion";
  list[0].most_ns = 10e6;
  list[0].pass = [] { load(procedural_gait(), ""); };
  list[1].name = "load_clip";
  list[1].label = "a clip";
  list[1].most_ns = 150e6;
  list[1].pass = [clip] { load(gait_cycle(*clip), ""); };
  list[2].name = "load_cached";
  list[2].label = "with its strides in the cache";
  list[2].pass = [clip, cache] { load(gait_cycle(*clip), cache->string()); };
  for (Work& work : list) {
    work.is_on_all_cores = true;
    work.every = 3;
  }
  return list;
}

// --- Replays -------------------------------------------------------------------------------------

// The bundled trace, from reading it to its summary, and with all files of --out, in a program that
// has replayed it before, as `replay` and `check` do with several recordings. The bounds are for
// the whole program, but its start is not measured.
Result<std::vector<Work>> replay_work(const std::vector<std::string>& config_folders) {
  SessionSpec spec;
  spec.config_folders = config_folders;
  spec.replay.trace = bundled_trace(spec.config_folders);
  const auto folder = cache_folder("replay");
  const auto replayer = std::make_shared<Replayer>();
  std::vector<Work> list(2);
  list[0].name = "replay";
  list[0].label = "without files";
  list[0].most_ns = 9e6;
  list[1].name = "replay_files";
  list[1].label = "with files";
  list[1].most_ns = 20e6;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (i == 1) spec.replay.out = folder->string();
    if (const auto result = replayer->replay(spec); !result) return result.error();
    list[i].pass = [spec, folder, replayer] { static_cast<void>(replayer->replay(spec)); };
    list[i].every = 3;
  }
  return list;
}

}  // namespace

Result<std::vector<Work>> bench_work(int most_characters,
                                     const std::vector<std::string>& config_folders) {
  const std::vector<std::string> styled = {"even", "stiff_hip", "stiff_knee", "limp_left"};
  const auto one = bench_session(config_folders, {"even"}, IkMode::robust);
  if (!one) return one.error();
  const auto paper = bench_session(config_folders, {"even"}, IkMode::paper);
  if (!paper) return paper.error();
  const auto four = bench_session(config_folders, styled, IkMode::robust);
  if (!four) return four.error();
  const auto even_four =
      bench_session(config_folders, {"even", "even", "even", "even"}, IkMode::robust);
  if (!even_four) return even_four.error();
  const auto cast_session = bench_session(config_folders, kCrowdStyles, IkMode::robust);
  if (!cast_session) return cast_session.error();
  const auto one_walks = walking(*one), paper_walks = walking(*paper), four_walk = walking(*four),
             even_walk = walking(*even_four);
  for (const auto* simulation : {&one_walks, &paper_walks, &four_walk, &even_walk})
    if (!*simulation) return simulation->error();
  const std::vector<Stick> sticks = sticks_of(*one, *one_walks);

  std::vector<Work> list;
  list.push_back(leg_work("leg_paper", "paper", solves_of<PaperLeg>(*paper, *paper_walks, {0})));
  list.push_back(leg_work("leg_robust_even", "robust, even weights",
                          solves_of<RobustLegs>(*one, *one_walks, {0})));
  list.back().most_ns = 90.0;
  list.push_back(leg_work("leg_robust_weighted", "robust, stiff hip or knee",
                          solves_of<RobustLegs>(*four, *four_walk, {1, 2})));

  list.push_back(playback_work(*one, PlaybackFrames::local));
  list.push_back(playback_work(*one, PlaybackFrames::world));

  const auto live = [&](const Session& session, const Simulation& simulation,
                        const std::vector<int>& from) {
    return std::make_shared<LiveWalkers>(session.dt_s(), simulation, from, sticks);
  };
  Work& even =
      list.emplace_back(character_work("character_even", "1, even", live(*one, *one_walks, {0})));
  even.over = "playback";
  even.most_ratio = 2.2;
  list.push_back(
      character_work("characters_even", "4, even", live(*even_four, *even_walk, {0, 1, 2, 3})));
  list.back().over = "playback";
  list.push_back(character_work("characters_styled", "4: even, stiff hip, stiff knee, limp",
                                live(*four, *four_walk, {0, 1, 2, 3})));
  list.back().over = "characters_even";
  list.back().most_ratio = 1.15;
  list.push_back(step_work(*one, *one_walks, "1, even, with the session"));
  list.push_back(step_work(*four, *four_walk, "4: the same, with the session"));
  list.back().most_ns = 5000.0;
  for (Work& work : list)
    if (work.name == "step") work.over = "playback";
  // From standing, for the tick's length is a constant of a walk.
  const auto at_60_hz =
      std::make_shared<LiveWalkers>(kCrowdDt_s, *one_walks, std::vector<int>{0}, sticks);
  LiveWalkers::One& slow = at_60_hz->all.front();
  slow.state = standing(*slow.model, vec3(0.0), slow.pose);
  list.push_back(character_work("character_even_60_hz", "1, even", at_60_hz));
  list.back().over = "playback";

  list.push_back(asked_work(live(*one, *one_walks, {0})));
  list.back().over = "playback";
  list.push_back(query_work());

  auto found = crowd_cast(*cast_session, sticks);
  if (!found) return found.error();
  const auto cast = std::make_shared<const CrowdCast>(std::move(*found));
  for (Work& work : list) {
    if (work.name != "character_even") continue;
    work.notes["state_bytes"] = sizeof(WalkState);
    work.notes["params_bytes"] = sizeof(GaitParams);
    work.notes["pose_bytes"] =
        sizeof(vec3) + one->config.cycle.standing_local.size() * sizeof(quat);
    work.notes["model_bytes"] = cast->model_bytes;
  }
  list.push_back(alone_work(cast, std::min(most_characters, 64)));
  std::vector<int> sizes;
  for (const int size : {1, 8, 64, 1000, 10000, 100000})
    if (size < most_characters) sizes.push_back(size);
  sizes.push_back(most_characters);
  const int widest = widest_lanes();
  const auto workers = std::make_shared<Workers>(machine_threads());
  for (int lanes = widest; lanes >= 1; lanes = lanes > 4 ? lanes / 2 : lanes - 3)
    for (const int size : sizes)
      if (size <= 1000 || lanes == widest)
        list.push_back(crowd_work(cast, size, lanes, CrowdCores::one, workers));
  for (const int size : {1000, 10000})
    if (workers->threads() > 1 && size <= most_characters)
      list.push_back(crowd_work(cast, size, widest, CrowdCores::all, workers));
  use_lanes(widest);
  for (const int size : sizes)
    if (size >= 64) list.push_back(memory_work(*cast, size));

  auto loads = load_work();
  if (!loads) return loads.error();
  for (Work& work : *loads) list.push_back(std::move(work));
  auto replays = replay_work(config_folders);
  if (!replays) return replays.error();
  for (Work& work : *replays) list.push_back(std::move(work));
  return list;
}

}  // namespace gaitpad
