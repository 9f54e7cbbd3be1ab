// The last state of a show that has ended.
#include <utility>

#include "view/show.h"

namespace gaitpad {
namespace {

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
  void look(double) override {}
  void look_for_picture() override {}
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

}  // namespace gaitpad
