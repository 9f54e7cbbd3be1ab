// Runs works in turns and reports the time of a unit of each.
#pragma once
#include <sched.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bench/bench_work.h"

namespace gaitpad {

// Pins this thread to one core, so that no migration is measured, and unpins it for work with
// several threads.
class Cores {
 public:
  Cores() {
    CPU_ZERO(&all_);
    CPU_ZERO(&one_);
    if (::sched_getaffinity(0, sizeof all_, &all_) != 0) return;
    for (int core = 0; core < CPU_SETSIZE; ++core)
      if (CPU_ISSET(core, &all_)) core_ = core;  // the last core: the first serves most interrupts
    if (core_ >= 0) CPU_SET(core_, &one_);
  }
  ~Cores() { use_all(); }
  Cores(const Cores&) = delete;
  Cores& operator=(const Cores&) = delete;
  void use_one() const { use(one_); }
  void use_all() const { use(all_); }
  // The core that threads are pinned to; -1: it is unknown, and nothing is pinned.
  int core() const { return core_; }

 private:
  void use(const cpu_set_t& cores) const {
    if (core_ >= 0) ::sched_setaffinity(0, sizeof cores, &cores);
  }
  cpu_set_t all_, one_;
  int core_ = -1;
};

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
// there is none.
double median_ns(const std::vector<BenchRow>& rows, std::string_view name, int characters,
                 int width);

std::string processor_name();

// A row with its spread, peer and bounds, as `gaitpad bench --json` prints it.
nlohmann::ordered_json json_of(const BenchRow& row, const std::vector<BenchRow>& rows);
// All rows, and two with names of their own: a leg's share of the tick's inverse kinematics, and
// the loading of a clip.
nlohmann::ordered_json list_of(const std::vector<BenchRow>& rows, const std::string& processor);

}  // namespace gaitpad
