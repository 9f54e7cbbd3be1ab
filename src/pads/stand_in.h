// A virtual pad in place of a real one, for every other program: gaitpad alone reads the real pad,
// through its event node, and the virtual pad has its sticks and triggers calibrated. Effects of
// force feedback go back to the real pad. `gaitpad forward` is this and a loop around it.
#pragma once
#include <poll.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/effect_table.h"
#include "drivers/event_node.h"
#include "drivers/virtual_pad.h"
#include "gaitpad/pad_configuration.h"
#include "gaitpad/pads.h"
#include "pads/calibrated_copy.h"
#include "system/descriptors.h"

namespace gaitpad {

class StandIn {
 public:
  enum class Look {
    own,       // the name, ids and codes of the real pad
    xbox_360,  // those of an Xbox 360 pad, whatever the real one is
  };
  struct Options {
    Look look = Look::own;
    PadFiles files;
    // Tests replace these functions.
    std::function<Result<std::unique_ptr<EventNode>>(const DeviceListing&)> open = &EventNode::open;
    std::function<Result<std::unique_ptr<VirtualPad>>(const VirtualPadShape&)> create =
        &VirtualPad::create;
  };
  explicit StandIn(Options options) : options_(std::move(options)) {}

  // Takes this pad. If the new virtual pad would look like the present one, that one stays, so that
  // no program notices; else it is made anew. Error: the real pad cannot be opened or is another
  // program's, or no virtual pad can be made.
  std::optional<Error> plug(const DeviceListing& listing);
  bool has_pad() const noexcept { return node_ != nullptr; }
  // Node of the virtual pad; empty: not made.
  std::string node() const { return pad_ ? pad_->node() : ""; }

  // The descriptors to poll. When one of them is ready, call serve().
  std::vector<pollfd> poll_fds() const;
  // Passes on all events that have come. When the real pad is gone, the virtual one comes to rest,
  // and keeps the effects that programs have uploaded.
  void serve() noexcept;
  std::vector<std::string> take_remarks() { return std::exchange(remarks_, {}); }

 private:
  void send() noexcept;
  void settle() noexcept;
  void unplug() noexcept;

  const Options options_;
  std::unique_ptr<EventNode> node_;  // node of the real pad; null: no pad is there
  PadConfig config_;
  PadState state_;
  JumpFilter filter_;
  Timer settling_;                      // is set only if the calibration filters jumps
  std::optional<CalibratedCopy> copy_;  // the virtual pad's content with Look::own
  VirtualPadState sent_;                // the last state that was sent with Look::xbox_360
  std::unique_ptr<VirtualPad> pad_;     // null: no pad has come yet
  VirtualPadShape shape_;
  EffectTable effects_;
  std::vector<std::string> remarks_;
};

}  // namespace gaitpad
