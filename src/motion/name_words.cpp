#include "motion/name_words.h"

namespace gaitpad {
namespace {

char lower(char c) { return (c >= 'A' && c <= 'Z') ? static_cast<char>(c + 32) : c; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }

}  // namespace

std::vector<std::string> name_words(std::string_view name) {
  if (const auto colon = name.rfind(':'); colon != name.npos) name.remove_prefix(colon + 1);
  std::vector<std::string> out(1);
  for (std::size_t i = 0; i < name.size(); ++i) {
    const char c = name[i];
    if (!is_upper(c) && !is_lower(c)) {
      out.emplace_back();
      continue;
    }
    const bool starts_word =
        is_upper(c) && i > 0 &&
        (is_lower(name[i - 1]) || (i + 1 < name.size() && is_lower(name[i + 1])));
    if (starts_word) out.emplace_back();
    out.back() += lower(c);
  }
  std::erase_if(out, [](const std::string& w) { return w.empty(); });
  return out;
}

NamedSide named_side(std::string_view word) {
  if (word == "l" || word == "left" || word == "lft") return NamedSide::left;
  if (word == "r" || word == "right" || word == "rgt") return NamedSide::right;
  return NamedSide::none;
}

}  // namespace gaitpad
