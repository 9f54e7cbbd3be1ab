// A pad's event node, calibrated: the sticks' and triggers' axes carry the calibrated position,
// every other code what the pad sends. Plain data in and out; pads/stand_in.h sends it.
#pragma once
#include <cstdint>
#include <vector>

#include "drivers/virtual_pad.h"
#include "gaitpad/decode.h"
#include "hid/evdev_layout.h"

namespace gaitpad {

class CalibratedCopy {
 public:
  // `pad`: the layout by which the node's reports are decoded. An axis that is half a control, or
  // one of several whose sum is a control, is passed on unchanged.
  CalibratedCopy(const EvdevLayout& node, const PadLayout& pad);

  // The node's axes and keys under their codes. A stick's full deflection is kFullStick, whatever
  // the pad counts: rest is exactly 0, and no step of the calibrated position is lost. A trigger
  // keeps the pad's range.
  std::vector<VirtualPadAxis> axes() const;
  std::vector<std::uint16_t> keys() const;

  // The events of all changes since the last call, without the SYN_REPORT at the end.
  std::vector<VirtualPadEvent> events(const EvdevState& raw, const VirtualPadState& calibrated);
  // The events that release everything, for a pad that was unplugged.
  std::vector<VirtualPadEvent> rest();

 private:
  struct Axis {
    VirtualPadAxis shown;
    int control = -1;       // a PadAxis; -1: the axis is passed on unchanged
    bool reversed = false;  // the control's value falls while the axis grows
  };
  std::vector<VirtualPadEvent> change_to(const EvdevState& next);

  std::vector<Axis> axes_;
  std::vector<std::uint16_t> keys_;
  EvdevState sent_;
};

}  // namespace gaitpad
