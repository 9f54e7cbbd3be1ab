// What other tools' texts say about a pad's axes, in their own numbers; for calibration_import.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"

namespace gaitpad {

// jscal's broken line: full at `min` and `max`, nothing from `low` to `high`.
struct JscalAxis {
  bool is_corrected = false;  // type 1; else the rest means nothing
  bool reversed = false;      // it falls where the counts grow
  double min = 0.0, low = 0.0, high = 0.0, max = 0.0;
};
struct JscalText {
  int line = 0;  // of the correction; 0: there is none
  std::vector<JscalAxis> axes;
  std::vector<std::uint16_t> codes;  // of `jscal -u`: each axis' code; empty: none
};

// Of one axis, as far as it is told.
struct AbsInfo {
  std::optional<std::int32_t> min, max, flat;
  int line = 0;
};
using AbsInfos = std::map<std::uint16_t, AbsInfo>;  // by ABS code

struct MappingLine {
  int line = 0;
  std::string text;
};

struct ImportText {
  JscalText jscal;
  AbsInfos axes;
  std::vector<MappingLine> mappings;
  std::optional<std::uint32_t> ids;  // vendor << 16 | product of evemu's `I:` line
  std::uint16_t version = 0;
};

// Error where a line that it knows is damaged, where a thing is told twice, where the text holds
// more than one kind or none, and for more than 1 MiB.
Result<ImportText> import_text(std::string_view text, const std::string& source);

}  // namespace gaitpad
