// libFuzzer target: commands, a line each, as C: lines and keys give them to two characters, and
// the same bytes as a script. After them the poses of a tick are finite; a command that
// command_problem() has nothing against is obeyed, unless it would lock all joints of a limb.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "gaitpad/gait_cycle.h"
#include "session/script.h"

namespace {

using namespace gaitpad;

Simulation made_simulation() {
  SimulationConfig config;
  config.cycle = procedural_gait();
  config.styles.resize(2);
  config.styles[0].name = "even";
  config.styles[1].name = "limp";
  config.styles[1].stride[kLeftSide] = {.length = 0.5, .speed = 1.3, .flight_height = 0.5};
  config.walkers.resize(2);
  auto simulation = Simulation::create(config);
  if (!simulation) std::abort();
  return *simulation;
}

bool is_finite(const Pose& pose) {
  const auto finite = [](double v) { return v - v == 0.0; };
  if (!finite(pose.root_m.x + pose.root_m.y + pose.root_m.z)) return false;
  return std::all_of(pose.local.begin(), pose.local.begin() + pose.joint_count,
                     [&](const quat& q) { return finite(q.w + q.x + q.y + q.z); });
}

Report made_command(std::string_view text) {
  Report report;
  report.kind = ReportKind::command;
  report.size = static_cast<std::uint16_t>(std::min(text.size(), kMaxReportBytes));
  std::copy_n(text.begin(), report.size, report.bytes.begin());
  return report;
}

void read_script(std::string_view text) {
  const auto script = parsed_script(text, "fuzz.toml");
  if (!script) {
    if (script.error().message.find('\n') != std::string::npos) std::abort();
    return;
  }
  for (const ScriptEvent& event : script->events) {
    if (tick_of(event, 240) < 0 || !parsed_command(event.command)) std::abort();
    if (text_of(report_of(event)) != event.command) std::abort();
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Simulation start = made_simulation();
  static const std::vector<std::string> styles = {"even", "limp"};
  constexpr int kMostCommands = 64;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  read_script(text);
  Simulation simulation = start;
  std::string_view rest = text;
  for (int i = 0; i < kMostCommands && !rest.empty(); ++i) {
    const std::string_view line = take_line(rest).substr(0, kMaxReportBytes);
    const auto before = simulation.counts();
    simulation.take_report(made_command(line));
    const auto& after = simulation.counts();
    const bool is_obeyed = after.bad_commands == before.bad_commands;
    const auto problem = command_problem(line, styles, 2);
    if (after.commands != before.commands + 1 || (problem && is_obeyed)) std::abort();
    if (problem && problem->find('\n') != std::string::npos) std::abort();
  }
  if (simulation.counts().commands == simulation.counts().bad_commands) return 0;
  simulation.step({});
  for (const Walker& walker : simulation.walkers()) {
    if (!is_finite(walker.pose)) std::abort();
  }
  return 0;
}
