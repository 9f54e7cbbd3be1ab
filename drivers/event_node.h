// A pad's event node, for callers that need more than its reports: its events for themselves alone,
// the codes behind a report, and its effects of force feedback.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "drivers/effect_table.h"
#include "gaitpad/driver.h"
#include "hid/evdev_layout.h"

namespace gaitpad {

class EventNode : public Device, public EffectTarget {
 public:
  // Errors as of the evdev driver, or that gaitpad was built without libevdev.
  static Result<std::unique_ptr<EventNode>> open(const DeviceListing& listing);

  // From now on no other program gets its events, and it has no effects but the caller's. 0, or
  // errno: EBUSY if another program has done so.
  virtual int grab() noexcept = 0;
  // The values that the newest report was made of.
  virtual const EvdevState& state() const noexcept = 0;
  virtual const EvdevLayout& layout() const noexcept = 0;
  // The node's codes of EV_FF: the kinds of effects, the gain. Empty: none, or the node may be read
  // only.
  virtual std::vector<std::uint16_t> effect_codes() const = 0;
};

}  // namespace gaitpad
