// Replays a recording through the whole system, without a window, and returns files and a summary.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/session_spec.h"
#include "gaitpad/summary.h"

namespace gaitpad {

struct ReplayResult {
  RunSummary summary;
  std::vector<std::string> remarks;  // remarks for the user that are no failures
};

// Called repeatedly while a replay runs, with the number of ticks that are done. The time of a
// replay is proportional to that number, however long the gaps between its reports are. False: the
// replay ends at once, and replay() returns an error.
using ReplayProgress = std::function<bool(std::int64_t done, std::int64_t ticks)>;

// Replays `spec.replay.trace` from its first tick to its last and writes the files that
// `spec.replay` asks for. They appear in the folder together and complete: an error leaves the
// folder as it was.
Result<ReplayResult> replay(const SessionSpec& spec, const ReplayProgress& progress = {});

class SetUps;
// Replays several recordings, each as replay() does. Pad files, styles, motion, models and strides
// are kept for the next recording, so that recordings of the same session load them once. Files on
// the disk that change meanwhile are not read again. One thread uses it at a time.
class Replayer {
 public:
  Replayer();
  ~Replayer();
  Result<ReplayResult> replay(const SessionSpec& spec, const ReplayProgress& progress = {});

 private:
  std::unique_ptr<SetUps> set_ups_;
};

}  // namespace gaitpad
