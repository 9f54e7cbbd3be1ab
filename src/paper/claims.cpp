#include "paper/claims.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>

namespace gaitpad {
namespace {

constexpr double kSteady_s = 3.5, kLong_s = 250.0;
using Claims = std::vector<Claim>;

const Walk& even(Study& s, IkMode mode) { return s.walk(styles_of_5a().red, mode); }

Claims cycle_group(Study& s, IkMode mode) {
  Claims all = table_1_claims(even(s, mode), 0.0, mode);
  const Claims more = continuity_claims(even(s, mode), foot_build(s.model()), kSteady_s, mode);
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Claims weight_group(Study& s, IkMode mode) {
  const FigureStyles& names = styles_of_5a();
  const WeightWalks walks = {&even(s, mode), &s.walk(names.green, mode), &s.walk(names.blue, mode)};
  return weight_claims(walks, s.figure_stride(*walks.even), mode);
}

Claims monotone_group(Study& s, IkMode mode) {
  const Walk& red = even(s, mode);
  const Ticks stride = s.figure_stride(red);
  std::vector<double> rms_deg;
  for (const double weight : {0.9, 0.8, 0.5, 0.2}) {
    WalkCase what;
    what.model = &s.model();
    set_value(what.style, "legs.weight.hip", weight);
    what.ik = mode;
    what.end_s = kFigureEnd_s;
    rms_deg.push_back(joint_rms(red, walked(what), stride, kRightSide, LegJoint::hip));
  }
  return monotone_claims(rms_deg, mode);
}

Claims limp_group(Study& s, IkMode mode) {
  const FigureStyles& names = styles_of_5b();
  const LimpWalks walks = {&even(s, mode), &s.walk(names.red, mode), &s.walk(names.green, mode),
                           &s.walk(names.blue, mode)};
  Claims all = limp_claims(walks, mode);
  const Claims more = limp_weight_claims(walks, s.figure_stride(*walks.limp), mode);
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Claims endurance_group(Study& s, IkMode mode) {
  WalkCase what;
  what.model = &s.model();
  what.ik = mode;
  what.end_s = kLong_s;
  return endurance_claims(walked(what), mode);
}

// Measures claims that do not depend on the solver once, in robust mode, a session's default.
template <Claims (*group)(const Study&)>
Claims robust_only(Study& s, IkMode mode) {
  return mode == IkMode::robust ? group(s) : Claims{};
}
template <Claims (*group)(const Study&, IkMode)>
Claims in_mode(Study& s, IkMode mode) {
  return group(s, mode);
}
Claims flight_group(Study& s, IkMode mode) { return flight_claims(s.source(), mode); }
Claims jacobian_group(Study& s, IkMode mode) {
  return mode == IkMode::paper ? jacobian_claims(s.model(), mode) : Claims{};
}
Claims chain_group(Study&, IkMode mode) { return chain_claims(mode); }
Claims reach_group(Study& s, IkMode mode) { return reach_claims(s.model(), mode); }
Claims cost_group(Study& s, IkMode mode) {
  return mode == IkMode::robust ? cost_claims(s) : Claims{};
}

using Group = Claims (*)(Study&, IkMode);
// Beside each group stand the numbers of its claims.
constexpr Group kGroups[] = {
    &flight_group,                 // 1-5
    &robust_only<scaling_claims>,  // 6
    &cycle_group,                  // 7, 8
    &jacobian_group,               // 9
    &chain_group,                  // 10-12
    &weight_group,                 // 13-16
    &monotone_group,               // 17
    &limp_group,                   // 18-20
    &cost_group,                   // 21
    &in_mode<terrain_claims>,      // 22
    &reach_group,                  // 23
    &in_mode<turn_claims>,         // 24
    &robust_only<pad_claims>,      // 25
    &robust_only<fatigue_claims>,  // 26
    &in_mode<hip_claims>,          // 27
    &robust_only<body_claims>,     // 28
    &in_mode<sliding_claims>,      // 29
    &endurance_group,              // 30
};

int number_of(const Claim& claim) { return std::atoi(claim.name.c_str()); }

}  // namespace

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
  // The motion's file name comes from outside: invalid UTF-8 is replaced, non-ASCII is escaped.
  return all.dump(1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::vector<Claim> all_claims(Study& study, const std::function<void(double share)>& progress) {
  Claims all;
  double done = 0.0;
  for (const Group group : kGroups) {
    for (const IkMode mode : {IkMode::paper, IkMode::robust}) {
      if (progress) progress(done++ / (2.0 * std::size(kGroups)));
      for (Claim& claim : group(study, mode)) all.push_back(std::move(claim));
    }
  }
  std::ranges::stable_sort(all, {}, number_of);
  return all;
}

}  // namespace gaitpad
