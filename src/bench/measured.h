// Lets pieces of work take turns and tells what a unit of each took.
#pragma once
#include <sched.h>

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "bench/bench_work.h"

namespace gaitpad {

// Keeps this thread on one core, so that moves between cores do not count, and gives it all of
// them for work that has several threads.
class Cores {
 public:
  Cores() {
    CPU_ZERO(&all_);
    CPU_ZERO(&one_);
    if (::sched_getaffinity(0, sizeof all_, &all_) != 0) return;
    for (int core = 0; core < CPU_SETSIZE; ++core)
      if (CPU_ISSET(core, &all_)) core_ = core;  // the last: the first serves most interrupts
    if (core_ >= 0) CPU_SET(core_, &one_);
  }
  ~Cores() { use_all(); }
  Cores(const Cores&) = delete;
  Cores& operator=(const Cores&) = delete;
  void use_one() const { use(one_); }
  void use_all() const { use(all_); }
  int core() const { return core_; }  // -1: not known, then nothing is pinned

 private:
  void use(const cpu_set_t& cores) const {
    if (core_ >= 0) ::sched_setaffinity(0, sizeof cores, &cores);
  }
  cpu_set_t all_, one_;
  int core_ = -1;
};

// What a unit of a work, or one of its stages, took.
struct BenchRow {
  const Work* work = nullptr;
  int stage = -1;                       // in kStages; -1: the whole
  std::vector<double> ns;               // in each round
  double quantile(double share) const;  // the value that this share of the rounds does not exceed
  double median() const { return quantile(0.5); }
};

// All works take turns, block by block, so that what the machine does besides falls on all of them.
// Before the first round each finds its number of passes. `show`: told after each round, 0 .. 1.
std::vector<BenchRow> measured(const std::vector<Work>& works, int rounds, const Cores& cores,
                               const std::function<void(double share)>& show);

// The median of the first row with this name, and this many characters and lanes; 0 stands for any.
// Nothing if there is none.
double median_of(const std::vector<BenchRow>& rows, std::string_view name, int characters,
                 int width);

std::string processor_name();

// A row with its spread, its peer and its bounds, as `gaitpad bench --json` prints it.
nlohmann::ordered_json json_of(const BenchRow& row, const std::vector<BenchRow>& rows);
// The rows as a list, and two under names of their own: a leg's share of the tick's inverse
// kinematics, and loading a clip.
nlohmann::ordered_json list_of(const std::vector<BenchRow>& rows, const std::string& processor);

}  // namespace gaitpad
