// Decodes the bytes of a report into the state of the pad. pad_layout() works out once, at set-up,
// which field of which report is which control; decode() then reads a report without heap or locks.
//
//   gaitpad::DeviceInfo device;
//   device.descriptor = ...;                            // the HID report descriptor
//   auto layout = gaitpad::pad_layout(device);          // Result<PadLayout>
//   gaitpad::PadState pad;
//   if (gaitpad::decode(*layout, report, pad)) ...      // pad.axis, pad.buttons
//
// How controls are found: fields of the first game-pad, joystick or multi-axis collection with X
// and Y are bound by their usages and neighbours; a [[pad]] entry of config/pads (pad_overrides.h)
// or a line of SDL's data base (DeviceInfo::mapping) adds what usages do not tell.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "gaitpad/descriptor.h"
#include "gaitpad/pad_overrides.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"

namespace gaitpad {

// ---- The layout: what pad_layout() builds. To decode reports one need not know it.

// A field of a report. `bit_offset` counts from the first bit after the report id.
struct FieldBits {
  std::uint32_t bit_offset = 0;
  std::uint8_t bit_size = 0;
  bool is_signed = false;
  std::int64_t min = 0, max = 0;
};
struct AxisOp {
  FieldBits bits;  // the field; `min` and `max` bound the part of its range that counts
  PadAxis axis = kLeftX;
  bool reversed = false;  // the axis falls while the field grows
  std::int8_t side = 0;   // part of a stick's axis: 0 the whole, else from 0 to this end (-1, 1)
};
struct ButtonOp {
  FieldBits bits;  // the field; `min` and `max` bound the part of its range that counts
  // Pressed if one of these bits of the value is set; 0: pressed by the range.
  std::uint32_t mask = 0;
  std::uint32_t button = 0;  // bit of PadState::buttons that the field presses
  bool reversed = false;     // pressed in the lower half of the range
};
struct HatOp {
  FieldBits bits;
  std::int64_t last = 0;                        // values from min to last are directions
  std::int64_t numerator = 1, denominator = 1;  // steps of 45 degrees for each count, as a fraction
  // 0: the hat is the whole D-pad. Else any of these directions (1 up, 2 right, 4 down, 8 left)
  // presses `button` (a bit of PadState::buttons) and adds `value` to `axis`.
  std::uint8_t directions = 0;
  std::uint32_t button = 0;
  float value = 0.0f;
  PadAxis axis = kLeftX;
};
struct ArrayOp {  // an array field: its value names a pressed button
  FieldBits bits;
  std::vector<std::uint32_t> button;  // bit of PadState::buttons for each value - min
};

// The layout of one report.
struct ReportLayout {
  std::uint8_t report_id = 0;
  bool numbered = false;  // the report begins with its id
  // Size in bytes, with the id: one of exact_sizes (of a replaced descriptor); if there are none,
  // min_size or more.
  std::uint16_t min_size = 0;
  std::vector<std::uint16_t> exact_sizes;
  std::uint32_t covered = 0;  // bits of PadState::buttons that this report carries
  std::uint32_t summed = 0;   // bits of the axes that are the sum of several fields
  std::vector<AxisOp> axes;
  std::vector<ButtonOp> buttons;
  std::vector<HatOp> hats;
  std::vector<ArrayOp> arrays;
};

// A button field without a control; `gaitpad decode` prints it as button_N.
struct UnnamedButton {
  std::uint8_t report_id = 0;
  FieldBits bits;
  std::uint16_t number = 0;  // the button's number on HID's button page
};

struct PadLayout {
  bool is_pad = false;          // it is a pad by its descriptor (pad_application) or by its pad
                                // file
  bool streams = false;         // the pad reports at rest as well, so silence means a broken link
  std::string override_origin;  // FILE:LINE of the [[pad]] entry that was used; empty: none
  ReportDescriptor descriptor;
  std::vector<ReportLayout> reports;  // layouts of replaced reports come first
  std::vector<UnnamedButton> unnamed;
};

// Works out the layout of a device. Error if its descriptor, or the one that an override replaces
// it by, is damaged: `My pad: report descriptor: byte 12: ...`.
Result<PadLayout> pad_layout(const DeviceInfo& device, const PadOverrides& overrides = {});

// Indices (in ReportDescriptor::fields) of the input fields of the pad: those of the collection
// that pad_application() finds, and the consumer and system keys beside it. Empty: no pad.
std::vector<std::size_t> pad_fields(const ReportDescriptor& descriptor);

// ---- Decoding

// True if reports of this layout contain the left stick.
bool tells_stick(const ReportLayout& layout) noexcept;
// The layout of this report. Null if the report is too short, has an unknown id or is no input
// report.
const ReportLayout* layout_of(const PadLayout& layout, const Report& report) noexcept;
// Updates the controls that the report contains; the others keep their state. False, and `state` is
// unchanged, if the report is too short, has an unknown id or is no input report.
bool decode(const PadLayout& layout, const Report& report, PadState& state) noexcept;

}  // namespace gaitpad
