// The checks of one pad that findings() puts together.
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "tools/gaitpad/doctor_findings.h"

namespace gaitpad {

// What findings are made from and into.
struct Diagnosis {
  const Machine& machine;
  const RulesFile& shipped;
  std::vector<Finding> list;

  void add(Finding::State state, std::string node, const PadHardware& pad, std::string cause,
           std::string fix = "") {
    list.push_back({state, std::move(node), pad.name, std::move(cause), std::move(fix)});
  }
};

inline RuleSubject subject_of(const PadHardware& pad) {
  return {static_cast<std::uint16_t>(pad.bus), pad.vendor, pad.product};
}
// Of the nodes that one pad makes, the one with its sticks.
inline bool is_pad_event(const SystemNode& node) {
  return !node.is_motion_sensor && !node.is_touchpad;
}

// `state`: what a finding of these is, a problem or, where the pad works otherwise, a note.
// True where the node can be used.
bool check_access(const std::string& node, const PadHardware& pad, Finding::State state,
                  Diagnosis& diagnosis);
void check_events(const PadHardware& pad, Finding::State state, Diagnosis& diagnosis);

void check_binding(const UsbInterface& interface, const PadHardware& pad, Finding::State state,
                   Diagnosis& diagnosis);
void check_missing_nodes(const PadHardware& pad, Finding::State state, Diagnosis& diagnosis);
void check_model(const PadHardware& pad, Diagnosis& diagnosis);

}  // namespace gaitpad
