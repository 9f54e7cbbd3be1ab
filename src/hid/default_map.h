// Which control a field is, from its usage and its neighbours, for pads that no file describes.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "gaitpad/descriptor.h"
#include "gaitpad/pad_map.h"
#include "gaitpad/report.h"

namespace gaitpad {

enum class ControlKind : std::uint8_t { axis, button, hat, dpad };

// One field of a descriptor bound to one control of the pad.
struct Binding {
  ControlKind kind = ControlKind::axis;
  int control = 0;        // PadAxis or PadButton; unused for a hat
  std::size_t field = 0;  // index in ReportDescriptor::fields
  std::uint32_t mask = 0;
  bool reversed = false;
  AxisPart part = AxisPart::whole;  // these as in ControlSource
  StickSide side = StickSide::both;
  std::uint8_t directions = 0;
};

// Indices of the fields that belong to the pad: of the first application collection 1:4, 1:5 or 1:8
// with X and Y, and the consumer and system keys beside it. Empty where there is no such
// collection.
std::vector<std::size_t> pad_fields(const ReportDescriptor& descriptor);

ButtonOrder likely_button_order(const ReportDescriptor& descriptor,
                                const std::vector<std::size_t>& fields);

std::vector<Binding> default_bindings(const ReportDescriptor& descriptor,
                                      std::optional<ButtonOrder> order);
// The number in that order, counted from 1, of a button; kButtonCount for none.
PadButton button_of(ButtonOrder order, std::uint32_t number) noexcept;

}  // namespace gaitpad
