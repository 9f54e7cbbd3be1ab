// A live session as a show.
#include <algorithm>
#include <utility>

#include "view/show.h"

namespace gaitpad {
namespace {

class LiveShow final : public Show {
 public:
  LiveShow(const ShowOptions& options, std::unique_ptr<LiveSession> session)
      : Show(options), session_(std::move(session)) {
    bool is_new = false;
    frame_ = &session_->latest(is_new);
  }

  const Cast& cast() const noexcept override { return session_->cast(); }
  const SessionFrame& frame() const noexcept override { return *frame_; }

  void look(double) override {
    bool is_new = false;
    frame_ = &session_->latest(is_new);
    for (TickSample sample; session_->take(sample);) {
      if (is_by_hand()) sample.step_us = 0.0f;  // a picture does not tell of the machine's speed
      history_.add(sample);
    }
  }

  void look_for_picture() override {
    due_ticks_ += pace_ * options_.live.rate_hz / kPictureRateHz;
    advance(static_cast<int>(due_ticks_));
    due_ticks_ -= static_cast<int>(due_ticks_);
    look(0.0);
  }

  double share(std::int64_t now_ns) const noexcept override {
    if (is_by_hand() || pace_ <= 0.0) return 1.0;
    const double passed_s = static_cast<double>(now_ns - frame_->time_ns) / 1e9;
    return std::clamp(passed_s * options_.live.rate_hz * pace_, 0.0, 1.0);
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
  Result<std::vector<nlohmann::ordered_json>> stop() override { return session_->stop(); }

 private:
  bool is_by_hand() const noexcept { return options_.live.clock == LiveOptions::Clock::by_hand; }
  void advance(int ticks) {
    if (ticks > 0) session_->advance(ticks);
  }

  std::unique_ptr<LiveSession> session_;
  const SessionFrame* frame_ = nullptr;
  LiveStatus status_;
  double due_ticks_ = 0.0;  // pictures: parts of a tick that are left
};

}  // namespace

Result<std::unique_ptr<Show>> open_live_show(const ShowOptions& options) {
  auto session = LiveSession::start(options.live);
  if (!session) return session.error();
  return std::unique_ptr<Show>(std::make_unique<LiveShow>(options, std::move(*session)));
}

}  // namespace gaitpad
