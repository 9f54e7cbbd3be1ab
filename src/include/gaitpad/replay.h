// A trace through the whole system, without a window: files and a summary come out.
#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gaitpad/result.h"
#include "gaitpad/setup.h"

namespace gaitpad {

struct ReplayOptions {
  SessionOptions session;
  std::string trace;
  std::string out;             // folder for the files; empty: none
  std::optional<int> rate_hz;  // an error where the trace says another
  std::optional<int> fps;      // of the poses written; the rate where absent
  bool gltf = false;           // pose.glb beside pose.bvh
  Damage damage = Damage::refuse;
};

struct ReplayResult {
  std::vector<nlohmann::ordered_json> summaries;  // one a character, as in summary.json
  std::vector<double> distance_m;                 // one a character: on the ground, along the path
  std::vector<std::string> remarks;               // what a user should know though it is no failure
};

// Errors leave the folder as it was.
Result<ReplayResult> replay(const ReplayOptions& options);

}  // namespace gaitpad
