#include "gaitpad/live.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "drivers/realtime.h"
#include "gaitpad/keyboard.h"
#include "session/live_loop.h"
#include "session/pad_forward.h"
#include "session/pose_stream.h"
#include "session/recorded_session.h"
#include "system/clock.h"
#include "system/threads.h"

namespace gaitpad {

// A session that is prepared but has not opened a device yet.
struct LiveSession::Prepared {
  SessionSpec spec;
  int rate_hz;
  Simulation simulation;
  Cast cast;
  Script script;
  PadFiles pad_files;
  RecordedSession recorded;
  std::unique_ptr<PoseStream> stream;  // null: poses are not sent
  std::vector<std::string> remarks;
};

struct LiveSession::Impl {
  explicit Impl(Prepared& prepared)
      : spec(std::move(prepared.spec)),
        rate_hz(prepared.rate_hz),
        simulation(std::move(prepared.simulation)),
        cast(std::move(prepared.cast)),
        script(std::move(prepared.script)),
        styles(simulation.styles()),
        recorded(std::move(prepared.recorded)),
        stream(std::move(prepared.stream)),
        remarks(std::move(prepared.remarks)) {}

  bool is_by_hand() const { return spec.live.clock == SessionSpec::Live::Clock::by_hand; }
  std::optional<Error> open_recording();
  void start_loop();
  void start_thread();
  void stop_loop();
  void remark_on_time(const LiveStatus& now);
  void remark_on_recording();
  std::optional<Error> finish_recording(std::int64_t ticks);

  const SessionSpec spec;
  const int rate_hz;
  Simulation simulation;
  Cast cast;
  Script script;
  std::vector<Style> styles;  // styles that commands may name; used by the viewing thread only
  // Style lists that the loop uses or has given back. They are freed here, never on the loop's
  // thread.
  std::deque<std::shared_ptr<const std::vector<Style>>> style_lists;
  RecordedSession recorded;
  std::unique_ptr<PoseStream> stream;       // null: poses are not sent
  std::unique_ptr<PadForward> forward;      // null: there is no virtual pad
  std::shared_ptr<KeyboardStick> keyboard;  // null: the keyboard is not a pad
  std::unique_ptr<PadStream> pads;
  std::unique_ptr<Recording> recording;
  std::unique_ptr<LiveLoop> loop;
  std::thread thread;
  std::string time_policy;  // scheduling of the thread when it started
  bool is_memory_locked = false;
  bool is_stopped = false;

  mutable std::mutex mutex;              // guards the members below
  std::optional<PadStreamCounts> final;  // set when the session was stopped
  std::vector<std::string> remarks;
  LiveStatus remarked;           // status at the last remark about late ticks
  bool is_failure_said = false;  // the user was told that the recording has failed
};

std::optional<Error> LiveSession::Impl::open_recording() {
  if (spec.live.record.empty()) return std::nullopt;
  auto opened = Recording::start(
      {spec.live.record, rate_hz, {}, std::move(recorded)},
      [p = pads.get()](std::uint16_t i) -> const TraceDevice& { return p->device(i); });
  if (!opened) return opened.error();
  recording = std::move(*opened);
  return std::nullopt;
}

void LiveSession::Impl::start_loop() {
  // The option is recorded as a command, so that a replay does not need it.
  if (spec.walk.stick == StickMeans::points) pads->command("stick points");
  const LiveLoop::Options options = {rate_hz, spec.live.rumble, spec.live.frame_ticks,
                                     stream ? &stream->newest() : nullptr,
                                     forward ? &forward->mail() : nullptr};
  loop = std::make_unique<LiveLoop>(options, script, simulation, *pads, recording.get());
  if (stream) stream->start();
  if (forward) forward->start();
  if (is_by_hand()) {
    time_policy = "by hand";
    loop->begin();
  } else {
    start_thread();
  }
}

void LiveSession::Impl::start_thread() {
  std::promise<std::optional<std::string>> refused;
  auto refusal = refused.get_future();
  thread = std::thread([this, refused = std::move(refused)]() mutable {
    name_thread("gaitpad-loop");
    const auto priority = take_priority(RealtimeRank::loop);
    time_policy = gaitpad::time_policy();
    const auto memory = lock_memory();
    is_memory_locked = !memory;
    refused.set_value(realtime_remark(priority, memory));
    loop->run();
  });
  if (auto remark = refusal.get()) remarks.push_back(std::move(*remark));
}

void LiveSession::Impl::stop_loop() {
  is_stopped = true;
  if (thread.joinable()) {
    loop->stop();
    thread.join();
  }
  if (is_memory_locked) unlock_memory();
  if (stream) stream->stop();
  if (forward) forward->stop();
  const std::lock_guard lock(mutex);
  final = pads->counts();
}

void LiveSession::Impl::remark_on_time(const LiveStatus& now) {
  if (now.standstills > remarked.standstills) {
    remarks.push_back(fmt::format(
        "the program stood still; the session is {:.1f} s behind real time", now.skipped_s));
  }
  if (now.overloads > 0 && remarked.overloads == 0) {
    remarks.push_back(fmt::format(
        "a tick takes {:.0f} us and there are {} a second: the session runs slower than real time; "
        "fewer characters or a lower --rate help",
        now.tick_us_median, rate_hz));
  }
  remarked = now;
}

void LiveSession::Impl::remark_on_recording() {
  if (is_failure_said || recording == nullptr) return;
  if (const auto problem = recording->problem()) {
    remarks.push_back(problem->message + "; the session goes on without being recorded");
    is_failure_said = true;
  }
}

std::optional<Error> LiveSession::Impl::finish_recording(std::int64_t ticks) {
  auto said = recording->finish(ticks, now_ns());
  if (!said) return said.error();
  const std::lock_guard lock(mutex);
  remarks.insert(remarks.end(), said->begin(), said->end());
  return std::nullopt;
}

LiveSession::LiveSession() = default;
LiveSession::~LiveSession() {
  if (impl_ && impl_->loop && !impl_->is_stopped) static_cast<void>(stop());
}

Result<std::shared_ptr<LiveSession::Prepared>> LiveSession::prepare(const SessionSpec& spec) {
  if (auto problem = check(spec)) return *problem;
  const int rate_hz = spec.rate_hz.value_or(kDefaultRateHz);
  const InputFiles pad_inputs;
  auto files = load_pad_files(spec);
  if (!files) return files.error();
  const InputFiles walk_inputs;
  auto config = simulation_config(spec, rate_hz);
  if (!config) return config.error();
  RecordedSession recorded;
  if (!spec.live.record.empty())
    recorded = recorded_session(spec, config->pace, walk_inputs.read(), pad_inputs.read(),
                                files->overrides);
  config->pads = unknown_pads(kMaxPads);
  auto simulation = Simulation::create(*config);
  if (!simulation) return simulation.error();
  auto script = script_for(*simulation, spec.walk.script);
  if (!script) return script.error();
  Cast cast = cast_of(*simulation, *config);
  std::unique_ptr<PoseStream> stream;
  if (!spec.live.stream.empty()) {
    auto opened = PoseStream::open(spec.live.stream, spec.live.stream_fps, cast);
    if (!opened) return opened.error();
    stream = std::move(*opened);
  }
  return std::make_shared<Prepared>(Prepared{
      spec, rate_hz, std::move(*simulation), std::move(cast), std::move(*script), std::move(*files),
      std::move(recorded), std::move(stream), std::move(config->remarks)});
}

Result<std::unique_ptr<LiveSession>> LiveSession::start(const std::shared_ptr<Prepared>& prepared) {
  if (!prepared) return Error{"LiveSession::start: prepared is null"};
  std::unique_ptr<LiveSession> live(new LiveSession());
  live->impl_ = std::make_unique<Impl>(*prepared);
  Impl& impl = *live->impl_;
  if (impl.spec.live.keyboard) impl.keyboard = std::make_shared<KeyboardStick>();
  auto pads =
      PadStream::start({std::move(prepared->pad_files), impl.spec.pad.selector, impl.keyboard});
  if (!pads) return pads.error();
  impl.pads = std::move(*pads);
  if (impl.spec.live.forward) {
    auto forward = PadForward::open();
    if (!forward) return forward.error();
    impl.forward = std::move(*forward);
    impl.remarks.push_back("other programs see the pad calibrated as " + impl.forward->node());
  }
  if (auto problem = impl.open_recording()) return *problem;
  impl.start_loop();
  return live;
}

Result<std::unique_ptr<LiveSession>> LiveSession::start(const SessionSpec& spec) {
  auto prepared = prepare(spec);
  if (!prepared) return prepared.error();
  return start(*prepared);
}

const SessionSpec& LiveSession::spec() const noexcept { return impl_->spec; }
const Cast& LiveSession::cast() const noexcept { return impl_->cast; }

std::string LiveSession::pad_name(std::uint16_t device) const {
  if (!impl_->loop->is_known(device)) return {};
  return impl_->pads->device(device).info.name;
}

const SessionFrame& LiveSession::latest(bool& is_new) noexcept {
  return impl_->loop->latest(is_new);
}

bool LiveSession::take_report_time(ReportTime& time) noexcept {
  return impl_->loop->take_report_time(time);
}

const SessionFrame& LiveSession::latest_due() noexcept { return impl_->loop->latest_due(); }
void LiveSession::end_frame(FrameEnd end) noexcept { impl_->loop->end_frame(end); }

bool LiveSession::take_sample(TickSample& sample) noexcept {
  return impl_->loop->take_sample(sample);
}

void LiveSession::set_pace(double pace) noexcept { impl_->loop->set_pace(pace); }
void LiveSession::step(int ticks) noexcept { impl_->loop->step(ticks); }
void LiveSession::advance(int ticks) noexcept {
  if (impl_->is_by_hand() && !impl_->is_stopped) impl_->loop->advance(ticks);
}
void LiveSession::steer(const vec2& wanted) noexcept {
  if (impl_->keyboard) impl_->keyboard->steer(wanted);
}

void LiveSession::command(std::string_view text) {
  const Cast& cast = impl_->cast;
  if (auto problem = command_problem(text, cast.styles, static_cast<int>(cast.members.size()))) {
    const std::lock_guard lock(impl_->mutex);
    impl_->remarks.push_back(std::move(*problem));
  }
  impl_->pads->command(text);
}

void LiveSession::add_style(const Style& style) {
  Cast& cast = impl_->cast;
  std::vector<Style> styles = impl_->styles;
  const auto same = std::ranges::find(styles, style.name, &Style::name);
  const auto place = static_cast<std::size_t>(same - styles.begin());
  if (same == styles.end()) {
    styles.push_back(style);
    cast.styles.push_back(style.name);
    cast.style_values.emplace_back();
  }
  styles[place] = style;
  cast.style_values[place] = style;
  impl_->styles = styles;
  impl_->style_lists.push_back(std::make_shared<const std::vector<Style>>(std::move(styles)));
  impl_->loop->set_styles(impl_->style_lists.back());
}

void LiveSession::rumble() noexcept { impl_->loop->beat_once(); }

bool LiveSession::has_ended() const noexcept { return impl_->loop->has_ended(); }

LiveStatus LiveSession::status() const noexcept {
  LiveStatus status = impl_->loop->status();
  if (impl_->stream) status.streamed = impl_->stream->frames();
  // After an overload the loop runs at normal priority.
  status.time_policy = status.overloads > 0 ? "normal priority" : impl_->time_policy;
  const std::lock_guard lock(impl_->mutex);
  status.pads = impl_->final ? *impl_->final : impl_->pads->counts();
  if (impl_->recording != nullptr) status.recording_lost = impl_->recording->lost();
  return status;
}

std::vector<std::string> LiveSession::take_remarks() {
  const LiveStatus now = impl_->loop->status();
  std::vector<std::string> all = impl_->pads->take_remarks();
  const std::lock_guard lock(impl_->mutex);
  impl_->remark_on_time(now);
  impl_->remark_on_recording();
  std::move(impl_->remarks.begin(), impl_->remarks.end(), std::back_inserter(all));
  impl_->remarks.clear();
  return all;
}

Result<RunSummary> LiveSession::stop() {
  if (impl_->is_stopped) return Error{"the session was stopped before"};
  impl_->stop_loop();
  RunSummary run = run_summary(impl_->simulation, impl_->cast);
  if (impl_->recording == nullptr) return run;
  if (auto problem = impl_->finish_recording(run.ticks)) return *problem;
  run.recording_lost = impl_->recording->lost();  // if > 0, a replay does not give this pose_hash
  return run;
}

std::optional<Error> LiveSession::end_recording() {
  constexpr std::chrono::milliseconds kNap{1};
  if (impl_->recording == nullptr || impl_->is_stopped) return std::nullopt;
  impl_->loop->leave_recording();
  if (impl_->is_by_hand()) impl_->loop->advance(0);
  while (impl_->loop->recorded_ticks() < 0) std::this_thread::sleep_for(kNap);
  auto problem = impl_->finish_recording(impl_->loop->recorded_ticks());
  const std::lock_guard lock(impl_->mutex);
  impl_->recording.reset();
  return problem;
}

}  // namespace gaitpad
