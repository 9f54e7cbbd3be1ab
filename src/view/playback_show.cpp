// A trace on a time line as a show.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "drivers/posix.h"
#include "view/show.h"

namespace gaitpad {
namespace {

constexpr int kTicksAtOnce = 48;
constexpr std::int64_t kComputing_ns = 12'000'000;  // in a drawn frame: drawing stays fluid

class PlaybackShow final : public Show {
 public:
  PlaybackShow(const SessionSpec& options, std::unique_ptr<Playback> playback)
      : Show(options), playback_(std::move(playback)) {
    playback_->seek(0, 1);
    take_samples();
  }

  const Cast& cast() const noexcept override { return playback_->cast(); }
  const SessionFrame& frame() const noexcept override { return playback_->frame(); }

  void look(double passed_s) override {
    if (is_there_) go_on(passed_s * cast().rate_hz);
    const std::int64_t end_ns = now_ns() + kComputing_ns;
    do {
      is_there_ = playback_->seek(tick(), kTicksAtOnce);
      take_samples();  // by then: of what is computed at once none is left out
    } while (!is_there_ && now_ns() < end_ns);
  }

  void look_for_picture() override {
    if (!std::exchange(is_for_pictures_, true)) position_ = -1.0;  // the first one shows as many
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

  const UiTimeline* timeline() override {
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
  double position_ = 0.0;  // ticks, where it is to be
  bool is_there_ = true;
  bool is_for_pictures_ = false, are_remarks_taken_ = false;
  UiTimeline timeline_;
};

}  // namespace

Result<std::unique_ptr<Show>> open_playback_show(const SessionSpec& options) {
  auto playback = Playback::open(options);
  if (!playback) return playback.error();
  return std::unique_ptr<Show>(std::make_unique<PlaybackShow>(options, std::move(*playback)));
}

}  // namespace gaitpad
