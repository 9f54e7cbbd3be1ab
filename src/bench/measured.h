// Runs works in turns and reports the time of a unit of each.
#pragma once
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bench/bench_work.h"
#include "system/cores.h"

namespace gaitpad {

// Times of a unit of a work.
struct BenchRow {
  const Work* work = nullptr;
  std::vector<double> ns;  // a unit's time in each round
  // The smallest value that at least this share of the rounds do not exceed.
  double quantile(double share) const;
  double median() const { return quantile(0.5); }
};

// The works run in turns, block by block, so that other load of the machine affects all of them.
// Before the first round each determines its number of passes. `show` gets 0 .. 1 after each round.
std::vector<BenchRow> measured(const std::vector<Work>& works, int rounds, const Cores& cores,
                               const std::function<void(double share)>& show);

// Median of the first row with this name, number of characters and lanes; 0 matches any. Nothing if
// no row matches.
double median_ns(const std::vector<BenchRow>& rows, std::string_view name, int characters,
                 int width);

std::string processor_name();

// A row with its spread, peer and bounds, as `gaitpad bench --json` prints it.
nlohmann::ordered_json json_of(const BenchRow& row, const std::vector<BenchRow>& rows);
// All rows, and the loading of a clip by a name of its own, too.
nlohmann::ordered_json list_of(const std::vector<BenchRow>& rows, const std::string& processor);

}  // namespace gaitpad
