#include "hid/sdl_numbers.h"

#include <algorithm>
#include <map>
#include <utility>

namespace gaitpad {

namespace {

enum Direction : std::size_t { kUp, kRight, kDown, kLeft };

struct InputField {
  const Field* field = nullptr;
  EvdevCode code;
  ControlSource source;
};

bool is_hat(const Field& f) { return f.usage == usage::kHatSwitch; }
bool is_dpad(const Field& f) { return f.usage >= usage::kDpadUp && f.usage <= usage::kDpadLeft; }

// Counts how often a usage has occurred in its report.
class Occurrences {
 public:
  ControlSource next(const Field& f) {
    ControlSource source;
    source.usage = f.usage;
    source.occurrence = ++count_[{f.report_id, f.usage}];
    return source;
  }

 private:
  std::map<std::pair<std::uint8_t, std::uint32_t>, std::uint32_t> count_;
};

SdlHat all_directions(const ControlSource& hat) {
  SdlHat sources;
  for (std::size_t i = 0; i < kHatDirections; ++i) {
    sources[i] = hat;
    sources[i]->directions = static_cast<std::uint8_t>(1u << i);
  }
  return sources;
}

std::vector<InputField> coded_fields(const ReportDescriptor& d, StatedBy who) {
  std::vector<InputField> coded;
  Occurrences occurrences;
  const auto codes = evdev_codes(d, who);
  for (std::size_t i = 0; i < d.fields.size(); ++i) {
    const Field& f = d.fields[i];
    if (f.kind != FieldKind::input || f.is_array) continue;
    const ControlSource source = occurrences.next(f);
    if (i < codes.size() && codes[i]) coded.push_back({&f, *codes[i], source});
  }
  std::stable_sort(coded.begin(), coded.end(), [](const InputField& a, const InputField& b) {
    return a.code.code < b.code.code;
  });
  return coded;
}

// One field of a hat: a whole one, a D-pad's direction, or one axis that counts -1, 0, 1.
void add_to_hat(const InputField& part, SdlHat& hat) {
  const auto half = [&part](AxisPart side) {
    ControlSource source = part.source;
    source.part = side;
    return source;
  };
  constexpr Direction kOfUsage[] = {kUp, kDown, kRight, kLeft};  // usages 0x90 .. 0x93
  if (is_hat(*part.field)) {
    hat = all_directions(part.source);
  } else if (is_dpad(*part.field)) {
    hat[kOfUsage[part.field->usage - usage::kDpadUp]] = part.source;
  } else if (part.code.code % 2 == 0) {
    hat[kLeft] = half(AxisPart::low);
    hat[kRight] = half(AxisPart::high);
  } else {
    hat[kUp] = half(AxisPart::low);
    hat[kDown] = half(AxisPart::high);
  }
}

bool makes_a_hat(const InputField& f) {
  if (f.code.code < evdev::kAbsHat0X || f.code.code > evdev::kAbsHat3Y) return false;
  const Field& field = *f.field;
  return is_hat(field) || is_dpad(field) || (field.logical_min == -1 && field.logical_max == 1);
}

}  // namespace

SdlNumbers sdl_numbers(const ReportDescriptor& d, StatedBy who) {
  SdlNumbers numbered;
  std::vector<ControlSource> low_keys;
  std::map<int, SdlHat> hats;
  for (const InputField& f : coded_fields(d, who)) {
    if (f.code.type == EvdevType::key) {
      if (f.code.code >= evdev::kKeyMax) continue;  // SDL stops before it
      (f.code.code >= evdev::kBtnJoystick ? numbered.buttons : low_keys).push_back(f.source);
    } else if (makes_a_hat(f)) {
      add_to_hat(f, hats[(f.code.code - evdev::kAbsHat0X) / 2]);
    } else if (f.code.code < evdev::kAbsMax) {
      numbered.axes.push_back(f.source);
    }
  }
  numbered.buttons.insert(numbered.buttons.end(), low_keys.begin(), low_keys.end());
  for (const auto& [number, hat] : hats) numbered.hats.push_back(hat);
  return numbered;
}

}  // namespace gaitpad
