// libFuzzer target: a session of two characters that reads one line of the input every eight ticks.
// `@` and two bytes are a report of the pad with these counts; any other line is a command as in a
// C: line. A command that command_problem() refuses is counted and changes nothing, any other takes
// effect, and every pose is finite.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "files/stride_cache.h"
#include "gaitpad/clean_strides.h"
#include "session/script.h"
#include "tests/session/made_session.h"

namespace gaitpad {

// Replaces the function that names the cache's folder: without a cache the strides are solved once
// per run.
std::string stride_cache_folder() { return {}; }
Result<GaitCycle> cached_clean_strides(GaitCycle cycle, const std::string&) {
  return with_clean_strides(std::move(cycle));
}

}  // namespace gaitpad

namespace {

using namespace gaitpad;
constexpr int kCharacters = 2, kTicksALine = 8, kMostLines = 64;

bool is_finite(const Pose& pose) {
  bool is = std::isfinite(pose.root_m.x + pose.root_m.y + pose.root_m.z);
  for (int i = 0; i < pose.joint_count; ++i) {
    const quat& q = pose.local[i];
    is = is && std::abs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1.0) < 1e-6;
  }
  return is;
}

Report report_of(std::string_view line) {
  if (line.size() == 3 && line[0] == '@')
    return made_report(static_cast<std::uint8_t>(line[1]), static_cast<std::uint8_t>(line[2]));
  return made_command(line.substr(0, Report{}.bytes.size()));
}

void check_line(std::string_view line, Simulation& session) {
  static const std::vector<std::string> styles = {"even", "limp"};
  const Report report = report_of(line);
  const std::int64_t bad_before = session.counts().bad_commands;
  session.step({&report, 1});
  if (report.kind == ReportKind::command) {
    // Only the session can refuse to lock all joints of a limb.
    const bool is_refused = session.counts().bad_commands > bad_before;
    const bool may_lock = text_of(report).find("weight") != std::string_view::npos;
    if (command_problem(text_of(report), styles, kCharacters) ? !is_refused
                                                              : is_refused && !may_lock)
      std::abort();
  }
  for (int i = 1; i < kTicksALine; ++i) session.step({});
  for (const Walker& walker : session.walkers()) {
    if (!is_finite(walker.pose)) std::abort();
  }
}

const Simulation& standing_session() {
  static const Simulation session = made_simulation(made_config(kCharacters));
  return session;
}

}  // namespace

// The strides are solved before the first input, whose time is limited.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  standing_session();
  return 0;
}
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Simulation session = standing_session();
  std::string_view rest(reinterpret_cast<const char*>(data), size);
  for (int i = 0; i < kMostLines && !rest.empty(); ++i) check_line(take_line(rest), session);
  return 0;
}
