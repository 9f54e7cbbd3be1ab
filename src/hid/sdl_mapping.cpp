#include "hid/sdl_mapping.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/toml_file.h"
#include "hid/sdl_numbers.h"
#include "hid/trace.h"
#include "hid/trace_lines.h"

namespace gaitpad {

namespace {

constexpr std::int64_t kMaxNumber = 1000;

enum class SourceKind { axis, button, hat };
// `a2`, `+a2`, `-a2`, `a2~`, `b3`, `h0.8`
struct NumberedSource {
  SourceKind kind = SourceKind::axis;
  std::size_t number = 0;
  std::uint8_t directions = 0;
  AxisPart part = AxisPart::whole;
  bool reversed = false;
};

bool take(std::string_view& text, char c) {
  if (!text.starts_with(c)) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<NumberedSource> numbered_source(std::string_view text) {
  NumberedSource source;
  if (take(text, '+')) {
    source.part = AxisPart::high;
  } else if (take(text, '-')) {
    source.part = AxisPart::low;
  }
  if (text.ends_with('~')) {
    source.reversed = true;
    text.remove_suffix(1);
  }
  if (take(text, 'b')) {
    source.kind = SourceKind::button;
  } else if (take(text, 'h')) {
    source.kind = SourceKind::hat;
    const std::size_t point = text.find('.');
    if (point == std::string_view::npos) return std::nullopt;
    const auto directions = decimal(text.substr(point + 1), 15);
    if (!directions || *directions == 0) return std::nullopt;
    source.directions = static_cast<std::uint8_t>(*directions);
    text = text.substr(0, point);
  } else if (!take(text, 'a')) {
    return std::nullopt;
  }
  const auto number = decimal(text, kMaxNumber);
  if (!number) return std::nullopt;
  source.number = static_cast<std::size_t>(*number);
  return source;
}

// Where one number is several fields (a D-pad of four buttons), more than one.
ControlSources sources_of(const SdlNumbers& numbered, const NumberedSource& wanted) {
  ControlSources sources;
  if (wanted.kind == SourceKind::hat) {
    if (wanted.number >= numbered.hats.size()) return sources;
    for (std::size_t i = 0; i < kHatDirections; ++i) {
      const auto& direction = numbered.hats[wanted.number][i];
      if (((wanted.directions >> i) & 1u) != 0 && direction) sources.push_back(*direction);
    }
    return sources;
  }
  const bool is_axis = wanted.kind == SourceKind::axis;
  const auto& list = is_axis ? numbered.axes : numbered.buttons;
  if (wanted.number >= list.size()) return sources;
  sources.push_back(list[wanted.number]);
  if (is_axis) {
    sources.back().part = wanted.part;
    sources.back().reversed = wanted.reversed;
  }
  return sources;
}

constexpr std::array<std::string_view, kAxisCount> kSdlAxes = {
    "leftx", "lefty", "rightx", "righty", "lefttrigger", "righttrigger"};

// The control that a key names; null for what is none (`platform`, `hint`, `crc` ...).
std::optional<ControlSources>* control_of(std::string_view key, ControlMap& map) {
  for (std::size_t i = 0; i < kSdlAxes.size(); ++i) {
    if (key == kSdlAxes[i]) return &map.axes[i];
  }
  for (std::size_t i = 0; i < kButtonNames.size(); ++i) {
    if (key == kButtonNames[i]) return &map.buttons[i];
  }
  return nullptr;
}

std::optional<Error> add_pair(std::string_view pair, const SdlNumbers& numbered, ControlMap& map) {
  const std::size_t colon = pair.find(':');
  if (colon == std::string_view::npos) {
    return Error{fmt::format("SDL mapping: {} is no pair control:source", in_quotes(pair))};
  }
  std::string_view key = pair.substr(0, colon), text = pair.substr(colon + 1);
  StickSide side = StickSide::both;
  if (take(key, '+')) {
    side = StickSide::positive;
  } else if (take(key, '-')) {
    side = StickSide::negative;
  }
  std::optional<ControlSources>* control = control_of(key, map);
  if (!control || text.empty()) return std::nullopt;
  const auto wanted = numbered_source(text);
  if (!wanted) return Error{"SDL mapping: unknown source " + in_quotes(text)};
  for (ControlSource source : sources_of(numbered, *wanted)) {
    source.side = side;
    if (!*control) control->emplace();
    if ((*control)->size() >= kMaxSdlSources) {
      return Error{
          fmt::format("SDL mapping: more than {} sources for {}", kMaxSdlSources, in_quotes(key))};
    }
    (*control)->push_back(source);
  }
  return std::nullopt;
}

std::string_view next_part(std::string_view& rest) {
  const std::string_view part = rest.substr(0, rest.find(','));
  rest.remove_prefix(std::min(rest.size(), part.size() + 1));
  return part;
}

bool is_guid(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdefABCDEF";
  return text.size() == 32 && text.find_first_not_of(kDigits) == std::string_view::npos;
}

}  // namespace

bool is_one_line(std::string_view mapping) {
  return std::none_of(mapping.begin(), mapping.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

Result<ControlMap> sdl_controls(std::string_view mapping, const ReportDescriptor& descriptor,
                                std::string_view driver) {
  if (mapping.size() > kMaxTraceTextBytes) {
    return Error{fmt::format("SDL mapping: {} bytes, at most {} are read", mapping.size(),
                             kMaxTraceTextBytes)};
  }
  std::string_view rest = mapping;
  const std::string_view guid = next_part(rest);
  if (!is_guid(guid)) {
    return Error{
        fmt::format("SDL mapping: {} is no GUID of 32 hexadecimal digits", in_quotes(guid))};
  }
  next_part(rest);  // the name
  const SdlNumbers numbered = sdl_numbers(descriptor, stated_by(driver));
  ControlMap map;
  while (!rest.empty()) {
    const std::string_view pair = next_part(rest);
    if (pair.empty()) continue;
    if (auto error = add_pair(pair, numbered, map)) return *error;
  }
  return map;
}

}  // namespace gaitpad
