#include "paper/claim.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace gaitpad {

bool holds(const Bound& bound, double value) noexcept {
  if (!std::isfinite(value)) return false;
  switch (bound.kind) {
    case Bound::Kind::at_most:
      return value <= bound.limit;
    case Bound::Kind::less:
      return value < bound.limit;
    case Bound::Kind::at_least:
      return value >= bound.limit;
    case Bound::Kind::more:
      return value > bound.limit;
    case Bound::Kind::within:
      return value >= bound.low && value <= bound.limit;
    case Bound::Kind::equal:
      return value == bound.limit;
  }
  return false;
}

std::string text_of(const Bound& bound) {
  switch (bound.kind) {
    case Bound::Kind::at_most:
      return fmt::format("<= {:g}", bound.limit);
    case Bound::Kind::less:
      return fmt::format("< {:g}", bound.limit);
    case Bound::Kind::at_least:
      return fmt::format(">= {:g}", bound.limit);
    case Bound::Kind::more:
      return fmt::format("> {:g}", bound.limit);
    case Bound::Kind::within:
      return fmt::format("{:g} .. {:g}", bound.low, bound.limit);
    case Bound::Kind::equal:
      return fmt::format("== {:g}", bound.limit);
  }
  return {};
}

Claim& ClaimList::add(std::string name, double value, const Bound& bound, std::string note) {
  Claim claim{std::move(name),     section_,       mode_, value, text_of(bound),
              holds(bound, value), std::move(note)};
  if (!std::isfinite(value)) {
    claim.value.reset();
    claim.note = claim.note.empty() ? "no number came out" : "no number came out; " + claim.note;
  }
  return claims_.emplace_back(std::move(claim));
}

Claim& ClaimList::add_untested(std::string name, const Bound& bound, std::string why) {
  return claims_.emplace_back(Claim{std::move(name), section_, mode_, std::nullopt, text_of(bound),
                                    std::nullopt, std::move(why)});
}

const char* name_of(IkMode mode) noexcept { return mode == IkMode::paper ? "paper" : "robust"; }

std::string claims_json(const std::string& motion, const std::vector<Claim>& claims) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Claim& c : claims) {
    nlohmann::ordered_json row = {
        {"name", c.name}, {"section", c.section}, {"mode", name_of(c.mode)}};
    row["value"] = c.value ? nlohmann::ordered_json(*c.value) : nullptr;
    row["bound"] = c.bound;
    row["pass"] = c.pass ? nlohmann::ordered_json(*c.pass) : nullptr;
    if (!c.note.empty()) row["note"] = c.note;
    list.push_back(std::move(row));
  }
  const nlohmann::ordered_json all = {{"motion", motion}, {"claims", std::move(list)}};
  // A file's name is a stranger's bytes: what is no UTF-8 is replaced.
  return all.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string claims_table(const std::vector<Claim>& claims) {
  std::string text;
  std::size_t widest = 0;
  for (const Claim& c : claims) widest = std::max(widest, c.name.size());
  for (const Claim& c : claims) {
    const char* verdict = !c.pass ? "-" : *c.pass ? "pass" : "FAIL";
    const std::string value = c.value ? fmt::format("{:.4g}", *c.value) : "-";
    text += fmt::format("{:<{}}  {:<6}  {:>10}  {:<14}  {}\n", c.name, widest, name_of(c.mode),
                        value, c.bound, verdict);
  }
  return text;
}

}  // namespace gaitpad
