// What the claims and figures of one motion share: its models and walks, each made once.
#pragma once
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "paper/claim.h"
#include "paper/source.h"
#include "paper/walk_run.h"

namespace gaitpad {

class Study {
 public:
  // Fails where no character can be made of the motion's skeleton.
  static Result<Study> of(PaperSource source);

  const PaperSource& source() const { return source_; }
  const WalkModel& model() const { return *model_; }
  // The same motion on other legs.
  Result<WalkModel> model_with_legs(double leg_ratio) const;
  // Straight on, kPaperStick forward, as long as `figure_stride()` needs.
  const Walk& walk(const std::string& style, IkMode mode);
  // The stride that the figures show: from the first strike of the right foot after kFigureStart_s.
  // The same ticks for all styles of a figure, since weights change no time.
  Ticks figure_stride(const Walk& walk) const;

 private:
  explicit Study(PaperSource source) : source_(std::move(source)) {}
  PaperSource source_;
  std::shared_ptr<const WalkModel> model_;
  std::map<std::pair<std::string, IkMode>, Walk> walks_;
};

inline constexpr double kFigureStart_s = 4.0, kFigureEnd_s = 9.0;

}  // namespace gaitpad
