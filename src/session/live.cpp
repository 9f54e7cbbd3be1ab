#include "gaitpad/live.h"

#include <fmt/format.h>
#include <pthread.h>

#include <algorithm>
#include <future>
#include <mutex>
#include <thread>
#include <utility>

#include "drivers/posix.h"
#include "pads/realtime.h"
#include "session/live_loop.h"
#include "session/recording.h"
#include "session/walk_export.h"

namespace gaitpad {

void add_status(const LiveStatus& status, nlohmann::ordered_json& summary) {
  summary["time_s"] = status.time_s;
  summary["time_policy"] = status.time_policy;
  summary["overruns"] = status.overruns;
  summary["standstills"] = status.standstills;
  summary["overloads"] = status.overloads;
  summary["skipped_s"] = status.skipped_s;
  summary["late_us_median"] = status.late_us_median;
  summary["late_us_max"] = status.late_us_max;
  summary["tick_us_median"] = status.tick_us_median;
  summary["tick_us_max"] = status.tick_us_max;
  summary["wait_us_median"] = status.wait_us_median;
  summary["wait_us_max"] = status.wait_us_max;
  summary["lost"] = status.pads.lost;
  summary["plugged"] = status.pads.plugged;
  summary["unplugged"] = status.pads.unplugged;
  summary["recording_lost"] = status.recording_lost;
}

struct LiveSession::Impl {
  Impl(const LiveOptions& live_options, Simulation made, Cast of_it)
      : options(live_options), simulation(std::move(made)), cast(std::move(of_it)) {}

  bool is_by_hand() const { return options.clock == LiveOptions::Clock::by_hand; }
  std::optional<Error> open_recording();
  void start_loop();
  void start_thread();
  void stop_loop();
  void remark_on_time(const LiveStatus& now);
  void remark_on_recording();
  Result<std::vector<nlohmann::ordered_json>> summaries();

  LiveOptions options;
  Simulation simulation;
  Cast cast;
  Script script;
  std::shared_ptr<KeyboardStick> keyboard;  // may be null
  std::unique_ptr<PadStream> pads;
  std::unique_ptr<Recording> recording;
  std::unique_ptr<LiveLoop> loop;
  std::thread thread;
  std::string time_policy;  // of the thread, as it began
  bool is_memory_locked = false;
  bool is_stopped = false;

  mutable std::mutex mutex;              // of what follows
  std::optional<PadStreamCounts> final;  // once it was stopped
  std::vector<std::string> remarks;
  LiveStatus remarked;           // what has been said of the loop's time
  bool is_failure_said = false;  // the recording's
};

std::optional<Error> LiveSession::Impl::open_recording() {
  if (options.record.empty()) return std::nullopt;
  auto opened = Recording::start(
      {options.record, options.rate_hz, {}},
      [p = pads.get()](std::uint16_t i) -> const TraceDevice& { return p->device(i); });
  if (!opened) return opened.error();
  recording = std::move(*opened);
  return std::nullopt;
}

void LiveSession::Impl::start_loop() {
  loop = std::make_unique<LiveLoop>(LiveLoop::Options{options.rate_hz, options.rumble}, script,
                                    simulation, *pads, recording.get());
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
    ::pthread_setname_np(::pthread_self(), "gaitpad-loop");
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
  const std::lock_guard lock(mutex);
  final = pads->counts();
}

void LiveSession::Impl::remark_on_time(const LiveStatus& now) {
  if (now.standstills > remarked.standstills) {
    remarks.push_back(
        fmt::format("the program stood still; the session goes on {:.1f} s later than the time",
                    now.skipped_s));
  }
  if (now.overloads > 0 && remarked.overloads == 0) {
    remarks.push_back(fmt::format(
        "a tick takes {:.0f} us and there are {} a second: the session is slower than the time; "
        "fewer characters or a lower --rate help",
        now.tick_us_median, options.rate_hz));
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

Result<std::vector<nlohmann::ordered_json>> LiveSession::Impl::summaries() {
  std::int64_t lost = 0;
  if (recording != nullptr) {
    auto said = recording->finish(simulation.counts().ticks, now_ns());
    if (!said) return said.error();
    lost = recording->lost();
    const std::lock_guard lock(mutex);
    remarks.insert(remarks.end(), said->begin(), said->end());
  }
  std::vector<nlohmann::ordered_json> all;
  for (const Walker& walker : simulation.walkers()) {
    all.push_back(run_summary(simulation, walker, options.rate_hz, 0));
    if (lost > 0) all.back()["recording_lost"] = lost;  // it does not replay to this pose_hash
  }
  return all;
}

LiveSession::LiveSession() = default;
LiveSession::~LiveSession() {
  if (impl_ && impl_->loop && !impl_->is_stopped) static_cast<void>(stop());
}

Result<std::unique_ptr<LiveSession>> LiveSession::start(const LiveOptions& options) {
  if (options.rate_hz < 1 || options.rate_hz > kMaxRateHz) {
    return Error{fmt::format("a rate of {} Hz is not within 1 .. {}", options.rate_hz, kMaxRateHz)};
  }
  const SessionOptions& session = options.session;
  auto config = simulation_config(session, {}, "", options.rate_hz);
  if (!config) return config.error();
  config->pads = unknown_pads(kMaxPads);
  auto simulation = Simulation::create(*config);
  if (!simulation) return simulation.error();
  auto script = script_for(*simulation, session.script);
  if (!script) return script.error();
  auto files = load_pad_files(session.config_folders, session.map, session.calibration);
  if (!files) return files.error();

  std::unique_ptr<LiveSession> live(new LiveSession());
  Cast cast = cast_of(*simulation, *config);
  live->impl_ = std::make_unique<Impl>(options, std::move(*simulation), std::move(cast));
  Impl& impl = *live->impl_;
  impl.script = std::move(*script);
  if (options.keyboard) impl.keyboard = std::make_shared<KeyboardStick>();
  auto pads = PadStream::start({std::move(*files), options.wish, impl.keyboard});
  if (!pads) return pads.error();
  impl.pads = std::move(*pads);
  if (auto problem = impl.open_recording()) return *problem;
  impl.start_loop();
  return live;
}

const Cast& LiveSession::cast() const noexcept { return impl_->cast; }

std::string LiveSession::pad_name(std::uint16_t device) const {
  if (!impl_->loop->is_known(device)) return {};
  return impl_->pads->device(device).info.name;
}

const SessionFrame& LiveSession::latest(bool& is_new) noexcept {
  return impl_->loop->latest(is_new);
}

bool LiveSession::take(TickSample& sample) noexcept { return impl_->loop->take(sample); }

void LiveSession::set_pace(double pace) noexcept { impl_->loop->set_pace(pace); }
void LiveSession::step(int ticks) noexcept { impl_->loop->step(ticks); }
void LiveSession::advance(int ticks) noexcept {
  if (impl_->is_by_hand() && !impl_->is_stopped) impl_->loop->advance(ticks);
}
void LiveSession::steer(const vec2& wanted) noexcept {
  if (impl_->keyboard) impl_->keyboard->steer(wanted);
}

void LiveSession::command(std::string_view text) { impl_->pads->command(text); }

bool LiveSession::has_ended() const noexcept { return impl_->loop->has_ended(); }

LiveStatus LiveSession::status() const noexcept {
  LiveStatus status = impl_->loop->status();
  // After an overload the loop has given it up.
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

Result<std::vector<nlohmann::ordered_json>> LiveSession::stop() {
  if (impl_->is_stopped) return Error{"the session was stopped before"};
  impl_->stop_loop();
  return impl_->summaries();
}

}  // namespace gaitpad
