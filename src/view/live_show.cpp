// A live session as a show.
#include <algorithm>
#include <utility>

#include "view/show.h"

namespace gaitpad {
namespace {

class LiveShow final : public Show {
 public:
  explicit LiveShow(std::unique_ptr<LiveSession> session)
      : Show(session->spec()), session_(std::move(session)) {
    bool is_new = false;
    frame_ = &session_->latest(is_new);
  }

  const Cast& cast() const noexcept override { return session_->cast(); }
  const SessionFrame& frame() const noexcept override { return *frame_; }

  void look(double) override {
    bool is_new = false;
    frame_ = &session_->latest(is_new);
    for (TickSample sample; session_->take_sample(sample);) {
      if (is_by_hand()) sample.step_us = 0.0f;  // a picture does not tell of the machine's speed
      history_.add(sample);
    }
  }

  void look_for_picture() override {
    due_ticks_ += pace_ * cast().rate_hz / kPictureRateHz;
    advance(static_cast<int>(due_ticks_));
    due_ticks_ -= static_cast<int>(due_ticks_);
    look(0.0);
  }

  double share(std::int64_t now_ns) const noexcept override {
    if (is_by_hand() || pace_ <= 0.0) return 1.0;
    const double passed_s = static_cast<double>(now_ns - frame_->time_ns) / 1e9;
    return std::clamp(passed_s * cast().rate_hz * pace_, 0.0, 1.0);
  }

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
  double due_ticks_ = 0.0;  // pictures: parts of a tick that are left
};

}  // namespace

Result<std::unique_ptr<Show>> open_live_show(const SessionSpec& options) {
  auto prepared = LiveSession::prepare(options);
  if (!prepared) return prepared.error();
  return open_live_show(*prepared);
}

Result<std::unique_ptr<Show>> open_live_show(
    const std::shared_ptr<LiveSession::Prepared>& prepared) {
  auto session = LiveSession::start(prepared);
  if (!session) return session.error();
  return std::unique_ptr<Show>(std::make_unique<LiveShow>(std::move(*session)));
}

}  // namespace gaitpad
