#include "gaitpad/simulation.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/ranges.h"
#include "base/text.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/style.h"
#include "session/script.h"

namespace gaitpad {
namespace {

// Distance of neighbours; each stands to the right of the one before.
constexpr double kSpacing_m = 1.2;

// A character with its own skeleton has the retargeted cycle; only the motion's leg length is still
// taken from the motion itself.
Result<WalkModel> model_of(const SimulationConfig& config, const WalkerConfig& walker) {
  if (!walker.own_cycle) return walk_model(config.cycle, walker.character);
  Character build = walker.character;
  build.skeleton.clear();
  auto model = walk_model(*walker.own_cycle, build);
  if (model) model->source_leg_length_m = mean_leg_m(config.cycle);
  return model;
}

// The style of a walker: commands choose it, zones replace it, changes are blended, fatigue is
// added. Only commands are input; the rest follows from the state, so that a replay computes the
// same.

void change_style(Walker& w, int style, const StyleValues& values) noexcept {
  w.blend = begun_blend(w.in_force, w.values, values);
  w.style = style;
  w.values = values;
}

// The zone at this place; the last one if zones overlap; -1 if there is none.
int zone_at(const Terrain& terrain, const vec3& place_m) noexcept {
  for (int i = static_cast<int>(terrain.zones.size()) - 1; i >= 0; --i) {
    const TerrainZone& zone = terrain.zones[static_cast<std::size_t>(i)];
    if (place_m.z >= zone.from_m && place_m.z <= zone.to_m && place_m.x >= zone.right_m &&
        place_m.x <= zone.left_m)
      return i;
  }
  return -1;
}

// Chooses a style by a command. It takes effect at once, inside a zone as well: the style from
// before the zone is not restored, and the zone's style returns only when the walker enters it
// again.
void choose_style(Walker& w, int style, std::span<const Style> styles) noexcept {
  w.zone.gives_back = false;
  change_style(w, style, styles[static_cast<std::size_t>(style)]);
}

// Applies the zone under the hips: entering a zone sets its style; leaving it restores the previous
// style with the values that commands had changed. `zone_styles[i]`: style index of zone i.
void follow_zones(Walker& w, const Terrain& terrain, std::span<const int> zone_styles,
                  std::span<const Style> styles) noexcept {
  if (terrain.zones.empty()) return;
  const int zone = zone_at(terrain, w.state.root.place_m);
  if (zone == w.zone.index) return;
  // When a walker goes from one zone directly into another, keep the style from before both.
  const bool has_own = w.zone.gives_back;
  const ZoneStyle before = w.zone;
  w.zone.index = zone;
  w.zone.gives_back = zone >= 0;
  if (zone < 0) {
    if (has_own) change_style(w, before.own_style, before.own_values);
    return;
  }
  if (!has_own) {
    w.zone.own_style = w.style;
    w.zone.own_values = w.values;
  }
  const int style = zone_styles[static_cast<std::size_t>(zone)];
  change_style(w, style, styles[static_cast<std::size_t>(style)]);
}

// Advances blend and fatigue by one tick; returns the values for this tick.
const StyleValues& advance_style(Walker& w, double dt_s) noexcept {
  w.in_force = advance(w.blend, with_fatigue(w.values, w.tired), dt_s);
  return w.in_force;
}

// Restores the start: the style that was chosen last, rested, in no zone.
void restart_style(Walker& w, std::span<const Style> styles) noexcept {
  if (w.zone.gives_back) w.style = w.zone.own_style;
  w.values = w.in_force = styles[static_cast<std::size_t>(w.style)];
  w.zone = {};
  w.blend = {};
  w.tired = 0.0;
}

// --- commands

// Sets the value for all walkers or for none: it must be valid for each of them.
bool set_values(std::span<Walker> walkers, std::string_view key, double value) noexcept {
  for (const Walker& w : walkers) {
    StyleValues changed = w.values;
    if (!set_value(changed, key, value)) return false;
  }
  for (Walker& w : walkers) set_value(w.values, key, value);
  return true;
}

bool set_gait(std::span<Walker> walkers, std::string_view name, double value) noexcept {
  const auto key = gait_key(name);
  if (!key || value < info_of(*key).min || value > info_of(*key).max) return false;
  for (Walker& w : walkers) {
    w.overrides.value[static_cast<std::size_t>(*key)] = value;
    w.overrides.is_set[static_cast<std::size_t>(*key)] = true;
  }
  return true;
}

bool give_back(std::span<Walker> walkers, std::string_view name) noexcept {
  const auto key = gait_key(name);
  if (!key) return false;
  for (Walker& w : walkers) w.overrides.is_set[static_cast<std::size_t>(*key)] = false;
  return true;
}

// Keeps the chosen style and the counts since the session's start.
void restart(std::span<const Style> styles, Walker& w) noexcept {
  const std::array<int, 2> steps = walk_steps(w.state).steps;
  restart_style(w, styles);
  w.overrides = {};
  w.state = standing(*w.model, w.start_m, w.pose);
  for (const Side side : {kLeftSide, kRightSide})
    w.state.walk.told.steps[side] = static_cast<float>(steps[side]);
}

int landings(const Walker& walker) noexcept {
  const Told<float>& told = walker.state.walk.told;
  return static_cast<int>(told.steps[kLeftSide] + told.steps[kRightSide] - told.struck);
}

}  // namespace

void copy_pose(const Pose& from, Pose& to) noexcept {
  to.root_m = from.root_m;
  to.joint_count = from.joint_count;
  std::copy_n(from.local.begin(), from.joint_count, to.local.begin());
}

std::vector<PadConfig> unknown_pads(std::size_t count) {
  std::vector<PadConfig> pads(count);
  for (PadConfig& pad : pads) pad.is_usable = pad.is_present = false;
  return pads;
}

std::optional<Error> check(const SimulationConfig& config) {
  if (config.rate_hz < kLeastRateHz || config.rate_hz > kMaxRateHz) {
    return Error{fmt::format("SimulationConfig: rate_hz is {}, outside [{}, {}]", config.rate_hz,
                             kLeastRateHz, kMaxRateHz)};
  }
  if (config.walkers.empty() || config.walkers.size() > kMaxWalkers) {
    return Error{
        fmt::format("{} characters: 1 to {} can walk", config.walkers.size(), kMaxWalkers)};
  }
  if (config.crowd < 0 || config.crowd > kMaxFollowers) {
    return Error{
        fmt::format("a crowd of {}: 0 to {} can walk behind", config.crowd, kMaxFollowers)};
  }
  const std::string what = "SimulationConfig: ";
  if (auto problem =
          range_problem(what + "crowd_threads", config.crowd_threads, 1.0, kMaxCrowdThreads))
    return problem;
  if (auto problem = choice_problem(what + "ik", config.ik, IkMode::robust)) return problem;
  if (auto problem = choice_problem(what + "stick", config.stick, StickMeans::points))
    return problem;
  if (auto problem = choice_problem(what + "pad_rules", config.pad_rules, PadRules::version_2))
    return problem;
  if (auto problem = choice_problem(what + "pace", config.pace, Pace::adult)) return problem;
  if (config.pads.size() >= kNoDevice)
    return Error{
        fmt::format("{}pads: there are {}, at most {}", what, config.pads.size(), kNoDevice - 1)};
  if (!config.terrain) return Error{"SimulationConfig: terrain is null, see flat_terrain()"};
  if (auto problem = check(*config.terrain)) return problem;
  if (config.styles.empty()) return Error{"SimulationConfig: styles is empty, one is needed"};
  for (const Style& style : config.styles) {
    if (auto problem = check(static_cast<const StyleValues&>(style)))
      return Error{fmt::format("style {}: {}", in_quotes(style.name), problem->message)};
  }
  for (std::size_t i = 0; i < config.pads.size(); ++i) {
    if (auto problem = check(config.pads[i]))
      return Error{fmt::format("SimulationConfig: pads[{}]: {}", i, problem->message)};
  }
  for (std::size_t i = 0; i < config.walkers.size(); ++i) {
    const int style = config.walkers[i].style, styles = static_cast<int>(config.styles.size());
    if (style < 0 || style >= styles) {
      return Error{fmt::format("SimulationConfig: walkers[{}].style is {}, outside [0, {}]", i,
                               style, styles - 1)};
    }
  }
  return std::nullopt;
}

Result<Simulation> Simulation::create(const SimulationConfig& config) {
  if (auto problem = check(config)) return *problem;
  Simulation s;
  s.dt_s_ = 1.0 / config.rate_hz;
  s.ik_ = config.ik;
  s.stick_means_ = config.stick;
  s.pads_ = Pads(config.pads, config.rate_hz, config.pad_rules);
  s.styles_ = std::make_shared<const std::vector<Style>>(config.styles);
  s.walkers_.reserve(config.walkers.size());
  auto models = s.models_of(config);
  if (!models) return models.error();
  if (auto problem = s.find_zone_styles()) return *problem;
  for (std::size_t i = 0; i < config.walkers.size(); ++i) {
    const WalkerConfig& walker = config.walkers[i];
    Walker& w = s.walkers_.emplace_back();
    w.model = (*models)[i];
    w.limits = gait_limits(*w.model);
    w.style = walker.style;
    restart_style(w, s.styles());
    const double right_m = kSpacing_m * static_cast<double>(s.walkers_.size() - 1);
    w.start_m = -right_m * kLeft;
    w.start_m.y = ground_at(*s.terrain_, w.start_m.x, w.start_m.z).height_m;
    w.state = standing(*w.model, w.start_m, w.pose);
    w.before = w.pose;
  }
  if (config.crowd > 0) {
    Followers::Options crowd{
        .count = config.crowd, .ik = config.ik, .threads = config.crowd_threads};
    crowd.shown = config.shows_crowd ? kMaxShownFollowers : 0;
    crowd.first_m = s.walkers_.front().start_m;
    crowd.middle_m = 0.5 * (s.walkers_.front().start_m + s.walkers_.back().start_m);
    models->erase(models->begin(),
                  models->begin() + static_cast<std::ptrdiff_t>(s.walkers_.size()));
    auto followers = Followers::create(crowd, *models, s.styles());
    if (!followers) return followers.error();
    s.followers_ = std::move(*followers);
  }
  return s;
}

// Models of the walkers, then of the crowd's builds. All share one ground, large enough for the
// largest foot.
Result<std::vector<std::shared_ptr<const WalkModel>>> Simulation::models_of(
    const SimulationConfig& config) {
  std::vector<std::shared_ptr<WalkModel>> models;
  const auto add = [&](Result<WalkModel> model) -> std::optional<Error> {
    if (!model) return model.error();
    terrain_scale_ = std::max(terrain_scale_, gaitpad::terrain_scale(*config.terrain, *model));
    models.push_back(std::make_shared<WalkModel>(std::move(*model)));
    return std::nullopt;
  };
  for (const WalkerConfig& walker : config.walkers) {
    if (auto problem = add(model_of(config, walker))) return *problem;
  }
  for (int i = 0; i < std::min(config.crowd, kFollowerBuilds); ++i) {
    const Character build = follower_build(config.walkers.front().character, i);
    if (auto problem = add(walk_model(config.cycle, build))) return *problem;
  }
  const bool grows = terrain_scale_ > 1.0;
  terrain_ = grows ? std::make_shared<const Terrain>(scaled(*config.terrain, terrain_scale_))
                   : config.terrain;
  for (const auto& model : models) model->terrain = terrain_;
  return std::vector<std::shared_ptr<const WalkModel>>(models.begin(), models.end());
}

std::optional<Error> Simulation::find_zone_styles() {
  std::vector<int> found;
  for (const TerrainZone& zone : terrain_->zones) {
    found.push_back(style_index(zone.style));
    if (found.back() < 0)
      return Error{fmt::format("{}: there is no style {}", zone.where, in_quotes(zone.style))};
  }
  zone_styles_ = std::make_shared<const std::vector<int>>(std::move(found));
  return std::nullopt;
}

void Simulation::step(std::span<const Report> reports) noexcept {
  for (const Report& report : reports) take_report(report);
  stick_ = pads_.finish_tick();
  const int landings_before = landings(walkers_.front());
  for (Walker& w : walkers_) {
    copy_pose(w.pose, w.before);
    follow_zones(w, *terrain_, *zone_styles_, styles());
    const Stick stick = stick_means_ == StickMeans::points
                            ? pointed_stick(stick_, w.state.root.heading_rad, camera_rad_, w.limits)
                            : stick_;
    w.params = gait_params(stick, advance_style(w, dt_s_), w.overrides, w.limits);
    const vec3 before_m = w.state.root.place_m;
    advance(*w.model, w.params, ik_, dt_s_, w.state, w.pose);
    const vec3 way_m = w.state.root.place_m - before_m;
    const double walked_m = glm::length(vec2(way_m.x, way_m.z));
    w.walked_m += walked_m;
    w.tired = tired(w.tired, w.values, walked_m, walk_steps(w.state).stage == Stage::idle, dt_s_);
    for (const float failed : w.state.walk.told.failed) w.ik_failures += failed != 0.0f;
    add_to_hash(w.pose.root_m, {w.pose.local.data(), static_cast<std::size_t>(w.pose.joint_count)});
  }
  if (followers_.size() > 0) {
    const Walker& first = walkers_.front();
    followers_.advance(first.params, first.state.root, walk_frame(first).speed_m_s, dt_s_);
  }
  const Crowd& crowd = followers_.crowd();
  for (int i = 0; i < crowd.size(); ++i) add_to_hash(crowd.root_m(i), crowd.local(i));
  heel_struck_ = landings(walkers_.front()) != landings_before;
  ++counts_.ticks;
}

void Simulation::take_report(const Report& report) noexcept {
  switch (report.kind) {
    case ReportKind::command:
      ++counts_.commands;
      counts_.bad_commands += !obey(text_of(report));
      return;
    case ReportKind::added:
      pads_.add_pad(report.device);
      return;
    case ReportKind::removed:
      pads_.remove_pad(report.device);
      return;
    case ReportKind::input:
      ++counts_.reports;
      counts_.bad_reports += !pads_.take_report(report);
      return;
  }
}

bool Simulation::obey(std::string_view text) noexcept {
  using Verb = Command::Verb;
  const auto command = parsed_command(text);
  if (!command || command->walker > static_cast<int>(walkers_.size())) return false;
  std::span<Walker> walkers = walkers_;
  if (command->walker > 0) walkers = walkers.subspan(command->walker - 1, 1);
  switch (command->verb) {
    case Verb::mark:
      return true;
    case Verb::ik:
      ik_ = command->name == kIkNames[0] ? IkMode::paper : IkMode::robust;
      return true;
    case Verb::style:
      return choose_style(walkers, command->name);
    case Verb::set:
      return set_values(walkers, command->name, command->value);
    case Verb::gait:
      return set_gait(walkers, command->name, command->value);
    case Verb::release:
      return give_back(walkers, command->name);
    case Verb::stick:
      for (Walker& w : walkers) w.overrides = {};
      return true;
    case Verb::steers:
      stick_means_ = StickMeans::steers;
      return true;
    case Verb::points:
      stick_means_ = StickMeans::points;
      camera_rad_ = command->value * kPi / 180.0;
      return true;
    case Verb::restart:
      for (Walker& w : walkers) restart(styles(), w);
      if (command->walker <= 1) followers_.restart();  // walker 1 leads the followers
      return true;
  }
  return false;
}

int Simulation::style_index(std::string_view name) const noexcept {
  for (std::size_t i = 0; i < styles().size(); ++i) {
    if (styles()[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

bool Simulation::choose_style(std::span<Walker> walkers, std::string_view name) noexcept {
  const int index = style_index(name);
  if (index < 0) return false;
  for (Walker& w : walkers) gaitpad::choose_style(w, index, styles());
  return true;
}

void Simulation::add_to_hash(const vec3& root_m, std::span<const quat> local) noexcept {
  WordHash hash = hash_;  // in a register
  hash.add(root_m.x);
  hash.add(root_m.y);
  hash.add(root_m.z);
  for (const quat& q : local) {
    hash.add(q.w);
    hash.add(q.x);
    hash.add(q.y);
    hash.add(q.z);
  }
  hash_ = hash;
}

}  // namespace gaitpad
