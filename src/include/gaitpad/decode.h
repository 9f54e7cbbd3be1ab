// From a report's bytes to the pad's state. The layout is built once, at set-up; decoding a report
// is a walk over its bindings, without heap, locks or surprises.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gaitpad/descriptor.h"
#include "gaitpad/pad_map.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

// A field of a report in the form that the loop reads.
struct FieldBits {
  std::uint32_t bit_offset = 0;
  std::uint8_t bit_size = 0;
  bool is_signed = false;
  std::int64_t min = 0, max = 0;
};
struct AxisOp {
  FieldBits bits;  // min, max: of the part that counts
  PadAxis axis = kLeftX;
  bool reversed = false;  // towards HID's direction: y of a stick grows towards the thumb's owner
  std::int8_t side = 0;   // of a stick's axis: 0 the whole of it, else from 0 to this
};
struct ButtonOp {
  FieldBits bits;  // min, max: of the part that counts
  std::uint32_t mask = 0;
  std::uint32_t button = 0;  // a bit of PadState::buttons
  bool reversed = false;     // pressed at the low end
};
struct HatOp {
  FieldBits bits;
  std::int64_t last = 0;                        // values from min to last are directions
  std::int64_t numerator = 1, denominator = 1;  // of the step in 45 degrees
  std::uint8_t directions = 0;  // 0: all of them, as the D-pad; else one of these does as follows
  std::uint32_t button = 0;     // presses this
  float value = 0.0f;           // adds this to `axis`
  PadAxis axis = kLeftX;
};
struct ArrayOp {  // a slot of an array whose value names a button
  FieldBits bits;
  std::vector<std::uint32_t> button;  // by value - min
};

struct ReportLayout {
  std::uint8_t report_id = 0;  // 0: reports are not numbered
  bool numbered = false;
  std::uint16_t min_size = 0;              // with the id
  std::vector<std::uint16_t> exact_sizes;  // of a replaced descriptor; empty: min_size counts
  std::uint32_t covered = 0;               // buttons that this report tells of
  std::uint32_t summed = 0;                // axes (bits) that several fields make up
  std::vector<AxisOp> axes;
  std::vector<ButtonOp> buttons;
  std::vector<HatOp> hats;
  std::vector<ArrayOp> arrays;
};

// A pressed button that no control is bound to.
struct UnnamedButton {
  std::uint8_t report_id = 0;
  FieldBits bits;
  std::uint16_t number = 0;
};

struct PadLayout {
  bool is_pad = false;
  bool streams = false;         // at rest too: silence means a broken link
  std::string override_origin;  // FILE:LINE of the [[pad]] that was used, empty for none
  ReportDescriptor descriptor;
  std::vector<ReportLayout> reports;  // replaced ones first
  std::vector<UnnamedButton> unnamed;
};

// Error where the device's descriptor is damaged or the override's replacement is.
Result<PadLayout> pad_layout(const DeviceInfo& device, const PadOverrides& overrides);

// How this report is read; null where it is too short, has an unknown id or is no input.
const ReportLayout* layout_of(const PadLayout& layout, const Report& report) noexcept;
// Updates what the report tells of and leaves the rest. False for a report that is too short, has
// an unknown id or is no input; `state` is then as before.
bool decode(const PadLayout& layout, const Report& report, PadState& state) noexcept;

}  // namespace gaitpad
