// What `gaitpad bench` measures: pieces of work of known size. measured.h lets them take turns.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

// The stages of a tick, and the seconds that went into each since somebody set them to 0.
inline constexpr std::array<const char*, 4> kStages = {"clock and plan", "sampling", "ik", "pose"};
using StageTimes = std::array<double, kStages.size()>;

struct Work {
  std::string name, label;  // in the list and in the table
  int characters = 1;
  int width = 0;                 // of a crowd: how many walks are side by side
  double units = 1.0;            // what one pass does: characters or legs
  std::string over;              // the name of its peer; empty: none
  double most_ns = 0.0;          // bounds on a unit's time, 0: none
  double most_ratio = 0.0;       // and on that time over the peer's
  bool is_on_all_cores = false;  // measured by elapsed time; else by the thread's processor time
  int every = 1;                 // it takes part in each so many-th round
  std::function<void()> pass;
  std::shared_ptr<StageTimes> stages;  // of the work that splits its time
  nlohmann::ordered_json notes = nlohmann::ordered_json::object();  // further keys of its row
};

// A leg's inverse kinematics, one character and four, bare playback, crowds of 1 to
// `most_characters` and their members alone, loading and replays. Error where the bundled trace or
// a style cannot be read.
Result<std::vector<Work>> bench_work(int most_characters,
                                     const std::vector<std::string>& config_folders);

}  // namespace gaitpad
