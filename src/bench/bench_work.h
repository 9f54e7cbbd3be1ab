// The works that `gaitpad bench` measures, each of a known size. measured.h runs them in turns.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

struct Work {
  std::string name, label;  // the name in the list, and the words in the table
  int characters = 1;
  int width = 0;                 // number of walks that a crowd computes side by side
  double units = 1.0;            // number of characters or legs that one pass computes
  std::string over;              // name of the work that it is compared with; empty: none
  double most_ns = 0.0;          // most time that a unit may take; 0: no limit
  double most_ratio = 0.0;       // most time of a unit relative to the peer's; 0: no limit
  bool is_on_all_cores = false;  // the elapsed time is measured instead of the thread's
  int every = 1;                 // runs in every n-th round
  std::function<void()> pass;
  // Further keys of the work's row.
  nlohmann::ordered_json notes = nlohmann::ordered_json::object();
};

// A leg's inverse kinematics, one character and four, bare playback, crowds of 1 to
// `most_characters` and their members alone, loading and replays. Error: the bundled trace or a
// style cannot be read.
Result<std::vector<Work>> bench_work(int most_characters,
                                     const std::vector<std::string>& config_folders);

}  // namespace gaitpad
