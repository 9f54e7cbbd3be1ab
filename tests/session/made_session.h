// Made pads, reports and sessions for the tests of src/session, without files.
#pragma once
#include <string>
#include <vector>

#include "gaitpad/simulation.h"
#include "gaitpad/trace.h"
#include "tests/clean_cycle.h"
#include "tests/made_pad.h"
#include "tests/value_of.h"

namespace gaitpad {

// A report of made_pad() with X and Y at these values. 0x80 is the middle; Y grows backwards.
inline Report made_report(int x, int y, std::uint16_t device = 0) {
  Report report;
  report.device = device;
  report.size = 6;
  report.bytes = {static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 0x80, 0x80, 0x08, 0};
  return report;
}
inline Report made_plug(ReportKind kind, std::uint16_t device = 0) {
  Report report;
  report.device = device;
  report.kind = kind;
  return report;
}
inline Report made_command(std::string_view text) {
  Report report;
  report.kind = ReportKind::command;
  report.size = static_cast<std::uint16_t>(text.size());
  std::copy(text.begin(), text.end(), report.bytes.begin());
  return report;
}

// Appends a report to a trace.
inline void add_event(Trace& trace, std::int64_t time_us, const Report& report) {
  TraceEvent event;
  event.time_us = time_us;
  event.device = report.device;
  event.kind = report.kind;
  event.first_byte = static_cast<std::uint32_t>(trace.bytes.size());
  event.size = report.size;
  trace.bytes.insert(trace.bytes.end(), report.bytes.begin(), report.bytes.begin() + report.size);
  trace.events.push_back(event);
}

// The configuration of made_pad(), with the calibration of an unknown stick.
inline PadConfig made_pad_config() {
  PadConfig config;
  auto layout = pad_layout(made_pad(), {});
  if (layout) config.layout = std::make_shared<const PadLayout>(std::move(*layout));
  config.is_usable = config.layout && config.layout->is_pad;
  return config;
}

inline Style made_limp() {
  Style style;
  style.name = "limp";
  style.stride[kLeftSide] = {.length = 0.5, .speed = 1.3, .flight_height = 0.5};
  style.weight[kRightSide][kHipX] = 0.2;
  return style;
}

// A session of the procedural walk, the styles `even` and `limp`, and one made pad.
inline SimulationConfig made_config(int walkers) {
  SimulationConfig config;
  config.pads = {made_pad_config()};
  config.styles.resize(1);
  config.styles[0].name = "even";
  config.styles.push_back(made_limp());
  config.cycle = clean_cycle(procedural_gait());
  for (int i = 0; i < walkers; ++i) {
    WalkerConfig& walker = config.walkers.emplace_back();
    walker.character.leg_ratio = 1.0 + 0.1 * i;
    walker.style = i % 2;
  }
  return config;
}

inline Simulation made_simulation(const SimulationConfig& config) {
  return value_of(Simulation::create(config));
}

inline void step(Simulation& simulation, const std::vector<Report>& reports, int ticks = 1) {
  simulation.step(reports);
  for (int i = 1; i < ticks; ++i) simulation.step({});
}

// A simulation after `ticks` ticks in which the stick was held at x, y.
inline Simulation walked(const SimulationConfig& config, int x, int y, int ticks) {
  Simulation simulation = made_simulation(config);
  step(simulation, {made_report(x, y)}, ticks);
  return simulation;
}

// Covers all inputs of a pose except the legs on level ground: slopes, stairs, waves, zones,
// blends, fatigue, stiff arms, hands that carry or hold a rail, and the look.
inline SimulationConfig made_uneven_config(int walkers) {
  SimulationConfig config = made_config(walkers);
  Terrain terrain;
  for (const SectionShape& shape :
       {SectionShape(FlatSection{1.0}), SectionShape(SlopeSection{2.5, 0.15, 0.5}),
        SectionShape(StairsSection{0.17, 0.28, 4}), SectionShape(StairsSection{-0.17, 0.28, 4}),
        SectionShape(rough_section(6.0, 0.03, 2.0, 1.0, 7))}) {
    add_section(terrain, shape);
  }
  TerrainZone& zone = terrain.zones.emplace_back();
  zone.from_m = 2.0;
  zone.to_m = 4.0;
  zone.style = "limp";
  config.terrain = std::make_shared<const Terrain>(std::move(terrain));
  Style& busy = config.styles.emplace_back();
  busy.name = "busy";
  busy.blend_s = 0.7;
  busy.fatigue_per_100_m = 5.0;
  busy.body.arm_weight[kLeftSide][0] = 0.3;
  busy.body.spine_weight[0] = 0.4;
  busy.body.hand[kLeftSide].carry = 1.0;
  busy.body.hand[kRightSide].rail = 1.0;
  busy.body.head.look = 1.0;
  for (WalkerConfig& walker : config.walkers) walker.style = 2;
  return config;
}

// The reports of one tick of a varied session: standing, straight, curves, a style, changed values,
// unplugging, a reset.
inline std::vector<Report> made_tick(int tick) {
  constexpr int kPeriod = 3000;
  switch (tick % kPeriod) {
    case 240:
      return {made_report(0x80, 0x20)};
    case 700:
      return {made_report(0x30, 0x20), made_report(0x40, 0x18)};
    case 1000:
      return {made_command("style 1 limp")};
    case 1300:
      return {made_report(0xd0, 0x30), made_command("set 2 legs.weight.knee 0.8")};
    case 1500:
      return {made_command("gait 2 stride_left_m 0.3"), made_command("gait hip_bounce 1.5")};
    case 1700:
      return {made_report(0x80, 0x00), made_command("style even")};
    case 2100:
      return {made_plug(ReportKind::removed)};
    case 2300:
      return {made_plug(ReportKind::added), made_report(0x80, 0x80)};
    case 2301:
      return {made_report(0x80, 0x40), made_command("gait 1 speed_m_s 0.8")};
    case 2600:
      return {made_command("reset"), made_command("gait 1 no_such_key 1")};
    case 2800:
      return {made_report(0x80, 0x80)};
    default:
      return {};
  }
}

}  // namespace gaitpad
