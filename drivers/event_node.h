// A pad's event node, for callers that need more than its reports: exclusive use of its events, the
// codes behind a report, and its effects of force feedback.
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
  // Errors are those of the evdev driver, or that gaitpad was built without libevdev.
  static Result<std::unique_ptr<EventNode>> open(const DeviceListing& listing);

  // From now on no other program gets the node's events, and only the caller can use its effects.
  // Returns 0 or errno: EBUSY if another program has grabbed it.
  virtual int grab() noexcept = 0;
  // The values from which the newest report was made.
  virtual const EvdevState& state() const noexcept = 0;
  virtual const EvdevLayout& layout() const noexcept = 0;
  // The node's codes of EV_FF: the kinds of effects, and the gain. Empty: there are none, or the
  // node is open for reading only.
  virtual std::vector<std::uint16_t> effect_codes() const = 0;
};

}  // namespace gaitpad
