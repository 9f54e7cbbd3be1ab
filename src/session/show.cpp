#include "session/show.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "system/clock.h"

namespace gaitpad {
namespace {

// A live session, which runs on its own thread or, for pictures, tick by tick on demand.
class LiveShow final : public Show {
 public:
  explicit LiveShow(std::unique_ptr<LiveSession> session)
      : Show(session->spec()), session_(std::move(session)) {
    bool is_new = false;
    frame_ = &session_->latest(is_new);
  }

  const Cast& cast() const noexcept override { return session_->cast(); }
  const SessionFrame& frame() const noexcept override { return *frame_; }

  void update(double) override {
    frame_ = &session_->latest_due();
    for (TickSample sample; session_->take_sample(sample);) {
      if (is_by_hand()) sample.step_us = 0.0f;  // a picture must not depend on the machine's speed
      history_.add(sample);
    }
  }

  void update_for_picture() override {
    due_ticks_ += pace_ * cast().rate_hz / kPictureRateHz;
    advance(static_cast<int>(due_ticks_));
    due_ticks_ -= static_cast<int>(due_ticks_);
    update(0.0);
  }

  double share(std::int64_t now_ns) const noexcept override {
    if (is_by_hand() || pace_ <= 0.0) return 1.0;
    const double passed_s = static_cast<double>(now_ns - frame_->time_ns) / 1e9;
    return std::clamp(passed_s * cast().rate_hz * pace_, 0.0, 1.0);
  }

  void end_frame(FrameEnd end) override { session_->end_frame(end); }

  void set_pace(double pace) override {
    pace_ = pace;
    session_->set_pace(pace);
  }
  void step() override {
    if (is_by_hand()) {
      advance(1);
    } else {
      session_->step(1);
    }
  }
  void steer(const vec2& wanted) override { session_->steer(wanted); }
  void command(std::string_view text) override { session_->command(text); }
  void add_style(const Style& style) override { session_->add_style(style); }
  void rumble() override { session_->rumble(); }
  std::optional<Error> end_recording() override {
    options_.live.record.clear();
    return session_->end_recording();
  }
  bool has_ended() const noexcept override { return session_->has_ended(); }
  const LiveStatus* status() override {
    status_ = session_->status();
    return &status_;
  }

  std::string pad_name() const override {
    const PadFrame& pad = frame_->pad;
    return pad.is_present && pad.device != kNoDevice ? session_->pad_name(pad.device) : "";
  }
  std::vector<std::string> take_remarks() override { return session_->take_remarks(); }
  Result<RunSummary> stop() override { return session_->stop(); }

 private:
  bool is_by_hand() const noexcept {
    return options_.live.clock == SessionSpec::Live::Clock::by_hand;
  }
  void advance(int ticks) {
    if (ticks > 0) session_->advance(ticks);
  }

  std::unique_ptr<LiveSession> session_;
  const SessionFrame* frame_ = nullptr;
  LiveStatus status_;
  double due_ticks_ = 0.0;  // pictures: fraction of a tick that is left over
};

constexpr int kTicksAtOnce = 48;
// Time for computing ticks in each frame, so that drawing stays smooth.
constexpr std::int64_t kComputing_ns = 12'000'000;

// A trace on a time line, computed up to the tick that is shown.
class PlaybackShow final : public Show {
 public:
  PlaybackShow(const SessionSpec& options, std::unique_ptr<Playback> playback)
      : Show(options), playback_(std::move(playback)) {
    playback_->seek(0, 1);
    take_samples();
  }

  const Cast& cast() const noexcept override { return playback_->cast(); }
  const SessionFrame& frame() const noexcept override { return playback_->frame(); }

  void update(double passed_s) override {
    if (is_there_) go_on(passed_s * cast().rate_hz);
    const std::int64_t end_ns = now_ns() + kComputing_ns;
    do {
      is_there_ = playback_->seek(tick(), kTicksAtOnce);
      take_samples();  // taken after each part, so that no sample is lost
    } while (!is_there_ && now_ns() < end_ns);
  }

  void update_for_picture() override {
    if (!std::exchange(is_for_pictures_, true))
      position_ = -1.0;  // before the first tick, because the first picture also shows one step
    go_on(static_cast<double>(cast().rate_hz) / kPictureRateHz);
    do {
      is_there_ = playback_->seek(tick(), kTicksAtOnce);
      take_samples();
    } while (!is_there_);
  }

  double share(std::int64_t) const noexcept override {
    if (is_for_pictures_ || pace_ <= 0.0 || !is_there_) return 1.0;
    return std::clamp(position_ - std::floor(position_), 0.0, 1.0);
  }

  void set_pace(double pace) override { pace_ = pace; }
  void step() override { seek(tick() + 1); }

  const Timeline* timeline() override {
    timeline_.tick = is_there_ ? playback_->frame().tick : tick();
    timeline_.ticks = playback_->ticks();
    timeline_.marks = playback_->marks();
    timeline_.pace = pace_;
    timeline_.is_computing = !is_there_;
    return &timeline_;
  }
  void seek(std::int64_t tick) override {
    position_ = static_cast<double>(std::clamp<std::int64_t>(tick, 0, playback_->ticks() - 1));
    is_there_ = false;
  }
  void set_looping(bool is_looping) override { timeline_.is_looping = is_looping; }

  std::string pad_name() const override {
    const std::uint16_t device = playback_->frame().pad.device;
    const auto& devices = playback_->devices();
    return device < devices.size() ? devices[device].info.name : "";
  }
  std::vector<std::string> take_remarks() override {
    if (std::exchange(are_remarks_taken_, true)) return {};
    return playback_->remarks();
  }
  Result<RunSummary> stop() override { return playback_->summary(); }

 private:
  std::int64_t tick() const noexcept { return static_cast<std::int64_t>(std::max(position_, 0.0)); }

  void go_on(double ticks) {
    const auto last = static_cast<double>(playback_->ticks() - 1);
    position_ += ticks * pace_;
    if (position_ >= last) position_ = timeline_.is_looping && pace_ > 0.0 ? 0.0 : last;
  }
  void take_samples() {
    for (TickSample sample; playback_->take_sample(sample);) history_.add(sample);
  }

  std::unique_ptr<Playback> playback_;
  double position_ = 0.0;  // place of the playback, in ticks
  bool is_there_ = true;
  bool is_for_pictures_ = false, are_remarks_taken_ = false;
  Timeline timeline_;
};

// The last state of an ended show.
class StillShow final : public Show {
 public:
  explicit StillShow(Show& show)
      : Show(show.options()),
        cast_(show.cast()),
        frame_(std::make_unique<SessionFrame>(show.frame())),
        pad_name_(show.pad_name()) {
    history_ = show.history();
    pace_ = 0.0;
    options_.live.record.clear();
    if (const LiveStatus* status = show.status()) status_ = *status;
  }

  const Cast& cast() const noexcept override { return cast_; }
  const SessionFrame& frame() const noexcept override { return *frame_; }
  void update(double) override {}
  void update_for_picture() override {}
  double share(std::int64_t) const noexcept override { return 1.0; }
  void set_pace(double) override {}
  void step() override {}
  const LiveStatus* status() override { return &status_; }
  std::string pad_name() const override { return pad_name_; }
  std::vector<std::string> take_remarks() override { return {}; }
  Result<RunSummary> stop() override { return RunSummary(); }

 private:
  Cast cast_;
  std::unique_ptr<SessionFrame> frame_;
  LiveStatus status_;
  std::string pad_name_;
};

}  // namespace

std::unique_ptr<Show> still_show(Show& show) { return std::make_unique<StillShow>(show); }

Result<Show::Start> Show::prepare(const SessionSpec& spec) {
  if (spec.replay.trace.empty()) {
    auto prepared = LiveSession::prepare(spec);
    if (!prepared) return prepared.error();
    return Start([prepared = *prepared]() -> Result<std::unique_ptr<Show>> {
      auto session = LiveSession::start(prepared);
      if (!session) return session.error();
      return std::unique_ptr<Show>(std::make_unique<LiveShow>(std::move(*session)));
    });
  }
  auto playback = Playback::open(spec);
  if (!playback) return playback.error();
  const auto show = std::make_shared<std::unique_ptr<Show>>(
      std::make_unique<PlaybackShow>(spec, std::move(*playback)));
  return Start([show]() -> Result<std::unique_ptr<Show>> { return std::move(*show); });
}

Result<std::unique_ptr<Show>> Show::open(const SessionSpec& spec) {
  const auto start = prepare(spec);
  if (!start) return start.error();
  return (*start)();
}

void Show::add_config_folder(const std::string& folder) {
  std::vector<std::string>& folders = options_.config_folders;
  if (std::ranges::count(folders, folder) == 0) folders.push_back(folder);
}

}  // namespace gaitpad
