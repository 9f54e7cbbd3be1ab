#include "session/summary.h"

#include <fmt/format.h>

#include "session/walk_export.h"

namespace gaitpad {

nlohmann::ordered_json run_summary(const Simulation& simulation, const Walker& walker, int rate_hz,
                                   std::int64_t damaged_lines) {
  const SimulationCounts& counts = simulation.counts();
  nlohmann::ordered_json s;
  s["ticks"] = counts.ticks;
  s["rate_hz"] = rate_hz;
  s["pose_hash"] = fmt::format("{:016x}", simulation.pose_hash());
  s.update(walker_summary(walker));
  s["terrain"] = simulation.terrain()->name;
  s["terrain_scale"] = simulation.terrain_scale();
  s["style"] = simulation.styles()[walker.style].name;
  s["fatigue"] = walker.in_force.fatigue;
  s["ik_failures"] = walker.ik_failures;
  s["reports"] = counts.reports;
  s["bad_reports"] = counts.bad_reports;
  s["bad_commands"] = counts.bad_commands;
  s["damaged_lines"] = damaged_lines;
  return s;
}

}  // namespace gaitpad
