#include "session/simulation.h"

#include <fmt/format.h>

#include <charconv>
#include <utility>

#include "motion/cycle_retarget.h"

namespace gaitpad {
namespace {

constexpr double kSpacing_m = 1.2;  // between neighbours, to the right of the first

// Cuts the first word off `text`.
std::string_view next_word(std::string_view& text) noexcept {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  std::size_t size = 0;
  while (size < text.size() && !blank(text[size])) ++size;
  const std::string_view word = text.substr(0, size);
  text.remove_prefix(size);
  return word;
}

// The whole word as a number from 1 on, else 0.
int position(std::string_view word) noexcept {
  int value = 0;
  const auto end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, value);
  return result.ec == std::errc() && result.ptr == end && value > 0 ? value : 0;
}

// On a skeleton of its own the walk is retargeted already; its leg is still compared to the
// motion's.
Result<WalkModel> model_of(const SimulationConfig& config, const WalkerConfig& walker) {
  if (!walker.own_cycle) return walk_model(config.cycle, walker.character);
  Character build = walker.character;
  build.skeleton.clear();
  auto model = walk_model(*walker.own_cycle, build);
  if (model) model->source_leg_length_m = mean_leg_m(config.cycle);
  return model;
}

int landings(const Walker& walker) noexcept {
  return walker.state.frame.steps[kLeftSide] + walker.state.frame.steps[kRightSide];
}

}  // namespace

std::vector<PadConfig> unknown_pads(std::size_t count) {
  std::vector<PadConfig> pads(count);
  for (PadConfig& pad : pads) pad.is_usable = pad.is_present = false;
  return pads;
}

Result<Simulation> Simulation::create(const SimulationConfig& config) {
  if (config.walkers.empty() || config.walkers.size() > kMaxWalkers) {
    return Error{
        fmt::format("{} characters: 1 to {} can walk", config.walkers.size(), kMaxWalkers)};
  }
  Simulation s;
  s.dt_s_ = 1.0 / config.rate_hz;
  s.ik_ = config.ik;
  s.pads_ = Pads(config.pads, config.rate_hz);
  s.styles_ = config.styles;
  s.walkers_.reserve(config.walkers.size());
  for (const WalkerConfig& walker : config.walkers) {
    auto model = model_of(config, walker);
    if (!model) return model.error();
    Walker& w = s.walkers_.emplace_back();
    w.model = std::make_shared<const WalkModel>(std::move(*model));
    w.limits = gait_limits(w.model->leg_length_m);
    w.style = walker.style;
    w.values = s.styles_[walker.style];
    const double right_m = kSpacing_m * static_cast<double>(s.walkers_.size() - 1);
    w.state = standing(*w.model, -right_m * kLeft, w.pose);
    w.before = w.pose;
  }
  return s;
}

void Simulation::step(std::span<const Report> reports) noexcept {
  for (const Report& report : reports) take(report);
  stick_ = pads_.stick_of_tick();
  const int landings_before = landings(walkers_.front());
  for (Walker& w : walkers_) {
    w.before = w.pose;
    w.params = gait_params(stick_, w.values, w.limits);
    advance(*w.model, w.params, ik_, dt_s_, w.state, w.pose);
    for (const bool failed : w.state.frame.ik_failed) w.ik_failures += failed;
    add_to_hash(w.pose);
  }
  heel_struck_ = landings(walkers_.front()) != landings_before;
  ++counts_.ticks;
}

void Simulation::take(const Report& report) noexcept {
  switch (report.kind) {
    case ReportKind::command:
      ++counts_.commands;
      counts_.bad_commands += !obey(text_of(report));
      return;
    case ReportKind::added:
      pads_.add(report.device);
      return;
    case ReportKind::removed:
      pads_.remove(report.device);
      return;
    case ReportKind::input:
      ++counts_.reports;
      counts_.bad_reports += !pads_.take(report);
      return;
  }
}

// `style NAME` for every character, `style N NAME` for the n-th one; `mark` marks a place in a
// recording.
bool Simulation::obey(std::string_view command) noexcept {
  const std::string_view verb = next_word(command);
  if (verb == "mark") return true;
  if (verb != "style") return false;
  std::string_view name = next_word(command);
  std::size_t first = 0, last = walkers_.size();
  if (const std::string_view second = next_word(command); !second.empty()) {
    const int n = position(name);
    if (n == 0 || n > static_cast<int>(walkers_.size())) return false;
    first = static_cast<std::size_t>(n) - 1;
    last = first + 1;
    name = second;
  }
  if (!next_word(command).empty()) return false;
  for (std::size_t i = 0; i < styles_.size(); ++i) {
    if (styles_[i].name != name) continue;
    for (std::size_t w = first; w < last; ++w) {
      walkers_[w].style = static_cast<int>(i);
      walkers_[w].values = styles_[i];
    }
    return true;
  }
  return false;
}

void Simulation::add_to_hash(const Pose& pose) noexcept {
  for (const double x : {pose.root_m.x, pose.root_m.y, pose.root_m.z}) hash_.add(x);
  for (int j = 0; j < pose.joint_count; ++j) {
    const quat& q = pose.local[j];
    for (const double x : {q.w, q.x, q.y, q.z}) hash_.add(x);
  }
}

}  // namespace gaitpad
