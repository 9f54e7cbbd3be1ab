#include "session/playback.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <span>
#include <string_view>
#include <utility>

#include "drivers/pads/recorded_packets.h"
#include "session/script.h"

namespace gaitpad {
namespace {

// A device is plugged in from the start unless its first event is `added`. Error: none of the
// devices is a pad, so that there is no stick.
std::optional<Error> settle_pads(const Trace& trace, std::vector<PadConfig>& pads) {
  std::vector<bool> is_seen(pads.size(), false);
  for (const TraceEvent& event : trace.events) {
    if (event.device >= pads.size() || is_seen[event.device]) continue;
    is_seen[event.device] = true;
    pads[event.device].is_present = event.kind != ReportKind::added;
  }
  if (std::ranges::any_of(pads, &PadConfig::is_usable)) return std::nullopt;
  return Error{trace.path + ": none of its devices is a pad with a stick"};
}

std::optional<Error> length_problem(const Trace& trace, std::int64_t ticks, int rate_hz,
                                    std::optional<double> asked_hours) {
  using Replay = SessionSpec::Replay;
  const double max_hours =
      asked_hours.value_or(trace.skipped_lines > 0 ? Replay::kMaxDamagedHours : Replay::kMaxHours);
  const double hours = static_cast<double>(ticks) / rate_hz / 3600.0;
  if (hours <= max_hours) return std::nullopt;
  return Error{fmt::format("{}: lasts {:.4g} hours, longer than {:g}; --max-hours raises the limit",
                           trace.path, hours, max_hours)};
}

// Adds the files that the list does not name yet.
void add_files(std::span<const InputFile> files, std::vector<const InputFile*>& list) {
  for (const InputFile& file : files) {
    if (std::ranges::count(list, file.path, &InputFile::path) == 0) list.push_back(&file);
  }
}

}  // namespace

Result<PreparedTrace> prepared_trace(const SessionSpec& spec) {
  SetUps own;
  return prepared_trace(spec, own);
}

Result<PreparedTrace> prepared_trace(const SessionSpec& asked, SetUps& set_ups) {
  if (auto problem = check(asked)) return *problem;
  auto trace = read_trace(asked.replay.trace, asked.replay.damage);
  if (!trace) return trace.error();
  auto recorded = with_recorded(asked, *trace);
  if (!recorded) return recorded.error();
  SessionSpec& spec = *recorded;
  const InputFiles inputs(spec.recording, held_files(*trace));
  accept_packets(*trace);
  const int rate = replay_rate_hz(*trace, spec.rate_hz);
  auto ticks = assign_ticks(*trace, rate);
  if (!ticks) return ticks.error();
  if (auto problem = length_problem(*trace, *ticks, rate, spec.replay.max_hours)) return *problem;
  const auto pad_set_up = set_ups.pads(spec);
  if (!pad_set_up) return pad_set_up.error();
  const PadFiles& pad_files = (*pad_set_up)->files;
  auto pads = pad_configs(pad_files, trace->devices, trace->path);
  if (!pads) return pads.error();
  const std::size_t pad_reads = inputs.read().size();
  spec.walk.pace = replay_pace(*trace, spec.walk.pace);
  const auto walk_set_up = set_ups.walk(asked, spec, *trace, rate);
  if (!walk_set_up) return walk_set_up.error();
  const WalkSetUp& walk = **walk_set_up;
  SimulationConfig config = walk.config;
  config.pads = std::move(*pads);
  config.pad_rules = trace->version < 2 ? PadRules::version_1 : PadRules::version_2;
  if (auto problem = settle_pads(*trace, config.pads)) return *problem;
  const std::vector<std::string> left_out = left_out_styles(spec, *trace, config);
  config.remarks.insert(config.remarks.end(), left_out.begin(), left_out.end());
  if (!walk.start) {  // a zone's style may be missing
    const std::string cause = left_out.empty() ? "" : "; " + left_out.front();
    return Error{walk.start.error().message + cause};
  }
  if (auto problem = check(config)) return *problem;
  Simulation start = *walk.start;
  start.set_pads(Pads(config.pads, rate, config.pad_rules));
  auto changes = style_changes(*trace, start.styles());
  if (!changes) return changes.error();
  auto script = script_for(start, spec.walk.script);
  if (!script) return script.error();
  add_script(*script, rate, *trace);
  // The same order with and without a shared set-up: an expectation stores it.
  const std::span<const InputFile> reads = inputs.read();
  std::vector<const InputFile*> read;
  add_files((*pad_set_up)->read, read);
  add_files(reads.first(pad_reads), read);
  add_files(walk.read, read);
  add_files(reads, read);
  auto used = used_files(read, *trace, config, pad_files.overrides);
  return PreparedTrace{std::move(*trace),   *ticks,         std::move(config), std::move(start),
                       std::move(*changes), std::move(used)};
}

void TraceRun::step(const PreparedTrace& prepared) noexcept {
  const Trace& trace = prepared.trace;
  const std::int64_t tick = ticks();
  for (const auto& changes = prepared.style_changes;
       next_change_ < changes.size() && changes[next_change_].tick == tick; ++next_change_) {
    auto styles = changes[next_change_].styles;
    simulation_.swap_styles(styles);
  }
  Report report;
  for (; next_event_ < trace.events.size() && trace.events[next_event_].tick == tick;
       ++next_event_) {
    copy_report(trace, trace.events[next_event_], report);
    simulation_.take_report(report);
  }
  simulation_.step({});
}

namespace {

constexpr std::size_t kMaxSnapshots = 1024, kLeastSnapshots = 4;
constexpr std::size_t kMostCrowdBytes = std::size_t{256} << 20;  // most memory of all snapshots

// Returns fewer snapshots for a large crowd, whose states need more memory.
std::size_t most_snapshots(const Simulation& simulation) {
  const std::size_t bytes = std::max<std::size_t>(simulation.followers().bytes(), 1);
  return std::clamp(kMostCrowdBytes / bytes, kLeastSnapshots, kMaxSnapshots);
}

std::optional<std::string> mark_of(const Trace& trace, const TraceEvent& event) {
  switch (event.kind) {
    case ReportKind::command: {
      const char* text = reinterpret_cast<const char*>(trace.bytes.data()) + event.first_byte;
      const std::string_view command(text, event.size);
      // A mark without a name fills a long pause of a recording.
      if (command == "mark") return std::nullopt;
      return std::string(command);
    }
    case ReportKind::added:
      return "plugged in";
    case ReportKind::removed:
      return "unplugged";
    case ReportKind::input:
      return std::nullopt;
  }
  return std::nullopt;
}

std::vector<PlaybackMark> marks_of(const PreparedTrace& prepared) {
  std::vector<PlaybackMark> marks;
  for (const TraceEvent& event : prepared.trace.events) {
    if (event.tick >= prepared.ticks || marks.size() == Playback::kMaxMarks) break;
    if (auto text = mark_of(prepared.trace, event)) marks.push_back({event.tick, std::move(*text)});
  }
  return marks;
}

// Tick at which the samples for a jump to `ticks` begin.
std::int64_t history_of(std::int64_t ticks) {
  return std::max<std::int64_t>(0, ticks - Playback::kHistoryTicks);
}

// Saved states at even distances; the first one is before tick 0. If there are too many, every
// other one is dropped.
class Snapshots {
 public:
  Snapshots(TraceRun start, int spacing_ticks)
      : most_(most_snapshots(start.simulation())), spacing_ticks_(spacing_ticks) {
    runs_.push_back(std::move(start));
  }
  // Saves the state if it is due.
  void keep_if_due(const TraceRun& run) {
    if (run.ticks() < runs_.back().ticks() + spacing_ticks_) return;
    if (runs_.size() == most_) thin_out();
    if (run.ticks() % spacing_ticks_ == 0) runs_.push_back(run);
  }
  // The latest snapshot at or before `ticks`.
  const TraceRun& before(std::int64_t ticks) const {
    const auto next = std::ranges::upper_bound(runs_, ticks, {}, &TraceRun::ticks);
    return *std::prev(next);
  }

 private:
  void thin_out() {
    spacing_ticks_ *= 2;
    std::erase_if(runs_, [this](const TraceRun& r) { return r.ticks() % spacing_ticks_ != 0; });
  }
  std::size_t most_;
  std::vector<TraceRun> runs_;
  std::int64_t spacing_ticks_;
};

}  // namespace

struct Playback::Impl {
  Impl(PreparedTrace prepared_trace, TraceRun start)
      : prepared(std::move(prepared_trace)),
        cast(cast_of(start.simulation(), prepared.config)),
        marks(marks_of(prepared)),
        run(std::move(start)),
        snapshots(run, prepared.config.rate_hz) {
    remarks = prepared.config.remarks;
    if (!prepared.style_changes.empty()) name_later_styles(*prepared.style_changes.back().styles);
    if (auto remark = damage_remark(prepared.trace)) remarks.push_back(std::move(*remark));
    copy_frame(run.simulation(), frame);
  }

  bool can_run_to(std::int64_t ticks) const;
  void jump(std::int64_t ticks);
  void step();

  void name_later_styles(const std::vector<Style>& styles);

  const PreparedTrace prepared;
  Cast cast;
  const std::vector<PlaybackMark> marks;
  std::vector<std::string> remarks;

  TraceRun run;
  Snapshots snapshots;
  std::int64_t first_sample = 0;  // samples of earlier ticks are not needed
  std::deque<TickSample> samples;
  SessionFrame frame;
};

void Playback::Impl::name_later_styles(const std::vector<Style>& styles) {
  for (std::size_t i = cast.styles.size(); i < styles.size(); ++i) {
    cast.styles.push_back(styles[i].name);
    cast.style_values.push_back(styles[i]);
  }
}

// True if the run can continue to `ticks`. False also if its samples begin too late: they were
// begun for a later place.
bool Playback::Impl::can_run_to(std::int64_t ticks) const {
  const std::int64_t ahead = ticks - run.ticks();
  return ahead >= 0 && ahead <= kHistoryTicks && first_sample <= history_of(ticks);
}

void Playback::Impl::jump(std::int64_t ticks) {
  first_sample = history_of(ticks);
  samples.clear();
  const TraceRun& nearest = snapshots.before(first_sample);
  const bool is_on_the_way = run.ticks() <= first_sample && run.ticks() >= nearest.ticks();
  if (!is_on_the_way) run = nearest;
}

void Playback::Impl::step() {
  run.step(prepared);
  snapshots.keep_if_due(run);
  if (run.ticks() <= first_sample) return;
  if (samples.size() == kHistoryTicks) samples.pop_front();
  copy_sample(run.simulation(), samples.emplace_back());
}

Playback::Playback() = default;
Playback::~Playback() = default;

Result<std::unique_ptr<Playback>> Playback::open(const SessionSpec& spec) {
  auto prepared = prepared_trace(spec);
  if (!prepared) return prepared.error();
  TraceRun start = TraceRun::begin(*prepared);
  std::unique_ptr<Playback> playback(new Playback());
  playback->impl_ = std::make_unique<Impl>(std::move(*prepared), std::move(start));
  return playback;
}

const Cast& Playback::cast() const noexcept { return impl_->cast; }
std::int64_t Playback::ticks() const noexcept { return impl_->prepared.ticks; }
const std::vector<PlaybackMark>& Playback::marks() const noexcept { return impl_->marks; }
const std::vector<std::string>& Playback::remarks() const noexcept { return impl_->remarks; }
const std::vector<TraceDevice>& Playback::devices() const noexcept {
  return impl_->prepared.trace.devices;
}

bool Playback::seek(std::int64_t tick, int budget) {
  Impl& impl = *impl_;
  if (ticks() == 0) return true;
  const std::int64_t wanted = std::clamp<std::int64_t>(tick, 0, ticks() - 1) + 1;
  if (!impl.can_run_to(wanted)) impl.jump(wanted);
  for (; budget > 0 && impl.run.ticks() < wanted; --budget) impl.step();
  copy_frame(impl.run.simulation(), impl.frame);
  return impl.run.ticks() == wanted;
}

const SessionFrame& Playback::frame() const noexcept { return impl_->frame; }

bool Playback::take_sample(TickSample& sample) {
  if (impl_->samples.empty()) return false;
  sample = impl_->samples.front();
  impl_->samples.pop_front();
  return true;
}

RunSummary Playback::summary() const {
  RunSummary run = run_summary(impl_->run.simulation(), impl_->cast);
  run.damaged_lines = impl_->prepared.trace.skipped_lines;
  return run;
}

std::uint64_t Playback::pose_hash() const noexcept { return impl_->run.simulation().pose_hash(); }

}  // namespace gaitpad
