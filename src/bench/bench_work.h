// The works that `gaitpad bench` measures, each of a known size. measured.h runs them in turns.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

// The stages of a tick, and the seconds spent in each since they were set to 0.
inline constexpr std::array<const char*, 4> kStages = {"clock and plan", "sampling", "ik", "pose"};
using StageTimes = std::array<double, kStages.size()>;

struct Work {
  std::string name, label;  // in the list, and in the table
  int characters = 1;
  int width = 0;                 // of a crowd: number of walks side by side
  double units = 1.0;            // characters or legs per pass
  std::string over;              // name of its peer; empty: none
  double most_ns = 0.0;          // limit of a unit's time; 0: none
  double most_ratio = 0.0;       // limit of that time / the peer's; 0: none
  bool is_on_all_cores = false;  // measures elapsed time instead of the thread's
  int every = 1;                 // runs in every n-th round
  std::function<void()> pass;
  std::shared_ptr<StageTimes> stages;                               // if the work splits its time
  nlohmann::ordered_json notes = nlohmann::ordered_json::object();  // further keys of its row
};

// A leg's inverse kinematics, one character and four, bare playback, crowds of 1 to
// `most_characters` and their members alone, loading and replays. Error: the bundled trace or a
// style cannot be read.
Result<std::vector<Work>> bench_work(int most_characters,
                                     const std::vector<std::string>& config_folders);

}  // namespace gaitpad
