#include "base/suggestion.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/text.h"

namespace gaitpad {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t above = row[j];
      row[j] = std::min({above + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

}  // namespace

std::string suggestion(std::string_view unknown, std::span<const std::string> known) {
  // A similar name differs by at most two letters.
  std::size_t nearest = std::min<std::size_t>(3, unknown.size());
  const std::string* best = nullptr;
  if (unknown.size() > kMaxQuotedBytes) return {};
  for (const std::string& key : known) {
    const std::size_t distance = edit_distance(unknown, key);
    if (distance < nearest) nearest = distance, best = &key;
  }
  return best ? "; did you mean " + in_quotes(*best) + "?" : std::string();
}

}  // namespace gaitpad
