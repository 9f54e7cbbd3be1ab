// What a run comes to, for summary.json and for who reads it: replay's and a live session's are the
// same.
#pragma once
#include <nlohmann/json.hpp>

#include "session/simulation.h"

namespace gaitpad {

// The whole run's numbers and one character's. `damaged_lines`: of the trace, 0 for a live session.
nlohmann::ordered_json run_summary(const Simulation& simulation, const Walker& walker, int rate_hz,
                                   std::int64_t damaged_lines);

}  // namespace gaitpad
