// Recordings with expectations: finds them in folders, replays, judges and renews them.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"

namespace gaitpad {

struct CheckOptions {
  std::vector<std::string> config_folders;
  bool updates = false;             // writes expectations that failed or are missing
  bool with_curves = false;         // finds the curves of the first joint that differs
  std::optional<double> max_hours;  // limit on a recording's length, as in SessionSpec::Replay
  bool user_styles = false;         // the user's own styles may be named, as in SessionSpec::Replay
};

// A recording and the files beside it.
struct CheckedTrace {
  std::string path;  // the recording's path without its extension, as given or found
  std::string recording() const { return path + ".hid"; }
  std::string expectation() const { return path + ".expect.toml"; }
  std::string poses() const { return path + ".expect.poses"; }
};

struct FoundTraces {
  std::vector<CheckedTrace> traces;  // recordings with an expectation, ordered by path, each once
  std::vector<std::string> without;  // other recordings of the folders, without an expectation
};
// A file is a recording or its expectation. Folders are searched, without hidden folders and links;
// recordings without an expectation count only if `updates` is set. Error: a path does not exist.
Result<FoundTraces> found_traces(const std::vector<std::string>& paths, bool updates);

// A run's part of the recordings: every `total`-th, from number `index`, counted from 1.
struct Shard {
  int index = 1, total = 1;
};
// Parses `2/8`. Nothing if it is not I/N with 1 <= I <= N.
std::optional<Shard> parse_shard(std::string_view text);
std::vector<CheckedTrace> part_of(const std::vector<CheckedTrace>& traces, const Shard& shard);

// The path of a trace's picture in `folder`. Keeps the recording's own folders, but stays inside
// `folder`: `../walks/round` becomes `walks/round.png`.
std::string picture_path(const std::string& folder, const CheckedTrace& trace);

// Two curves of a joint over all kept ticks: its rotation vector in degrees in its parent's frame,
// or the root's place in metres.
struct JointCurves {
  std::string joint;
  bool is_angle = true;
  int rate_hz = 0;
  std::size_t first_tick = 0;  // number of the first tick that differs
  std::array<std::vector<double>, 3> before, after;
  std::vector<double> distance;  // distance of both curves at each tick, degrees or metres
};
struct CheckResult {
  bool is_met = false;  // the recording meets its expectation, or the renewed one after an update
  std::string verdict;  // one sentence: what was met, or what was not
  std::vector<std::string> details;
  double seconds = 0.0;
  std::optional<JointCurves> curves;
};

// Checks all of them on `threads` threads; a thread loads what successive recordings share once.
// `take` gets each result in the order of the traces, when the earlier ones are done; it is called
// by one thread at a time.
void check_all(const std::vector<CheckedTrace>& traces, const CheckOptions& options, int threads,
               const std::function<void(std::size_t, CheckResult&&)>& take);

}  // namespace gaitpad
