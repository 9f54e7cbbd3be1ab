// Recordings with expectations: found in folders, replayed, judged, renewed.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"

namespace gaitpad {

struct CheckOptions {
  std::vector<std::string> config_folders;
  bool updates = false;             // writes the expectations that are not met or are missing
  bool with_curves = false;         // of the joint that differs first
  std::optional<double> max_hours;  // as SessionSpec::Replay's
  bool user_styles = false;         // as SessionSpec::Replay's
};

// A recording and what stands beside it.
struct CheckedTrace {
  std::string path;  // without extension, as it was given or found
  std::string recording() const { return path + ".hid"; }
  std::string expectation() const { return path + ".expect.toml"; }
  std::string poses() const { return path + ".expect.poses"; }
};

struct FoundTraces {
  std::vector<CheckedTrace> traces;  // ordered by path, each once
  std::vector<std::string> without;  // further recordings in the folders, without an expectation
};
// Files are taken as they are: a recording or its expectation. Folders are searched, hidden ones
// and links left out; recordings without an expectation count only if `updates` is set. Error: a
// path does not exist.
Result<FoundTraces> found_traces(const std::vector<std::string>& paths, bool updates);

// Both courses of a joint over all ticks that are kept: its rotation vector in degrees, in the
// frame of its parent; of a root its place in metres.
struct JointCurves {
  std::string joint;
  bool is_angle = true;
  int rate_hz = 0;
  std::size_t first_tick = 0;  // that differs
  std::array<std::vector<double>, 3> before, after;
  std::vector<double> distance;  // degrees or metres between them
};
struct CheckResult {
  bool is_met = false;  // with CheckOptions::updates: whether the files say so now
  std::string verdict;  // one sentence
  std::vector<std::string> details;
  double seconds = 0.0;
  std::optional<JointCurves> curves;
};
CheckResult checked(const CheckedTrace& trace, const CheckOptions& options);

// All of them on so many threads. `take` gets the results in the order of the traces, each as soon
// as those before it are known, from one thread at a time.
void check_all(const std::vector<CheckedTrace>& traces, const CheckOptions& options, int threads,
               const std::function<void(std::size_t, CheckResult&&)>& take);

}  // namespace gaitpad
