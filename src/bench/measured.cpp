#include "bench/measured.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/lanes.h"

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

constexpr double kBlock_s = 0.02;  // length of a work's block in each round, of at least one pass
// Most time of a character in a larger crowd, relative to crowds of 1,000.
constexpr double kMostGrowth = 1.8;
constexpr int kGrowsFrom = 1000;
constexpr double kFrame_ns = 1e9 / 60.0;

// Keeps Google Benchmark's result: this thread's processor time, which other programs do not
// affect, or the elapsed time if there are several threads.
class TimedBlock : public benchmark::BenchmarkReporter {
 public:
  explicit TimedBlock(bool has_threads) : has_threads_(has_threads) {}
  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      pass_ns = has_threads_ ? run.GetAdjustedRealTime() : run.GetAdjustedCPUTime();
      passes = run.iterations;
    }
  }
  double pass_ns = 0.0;
  std::int64_t passes = 0;

 private:
  bool has_threads_;
};

// Runs `passes` passes of a work or, if 0, as many as take kBlock_s.
TimedBlock measured_block(const Work& work, std::int64_t passes) {
  benchmark::ClearRegisteredBenchmarks();
  auto* registered = benchmark::RegisterBenchmark("block", [&work](benchmark::State& state) {
    for (auto _ : state) work.pass();
  });
  if (work.is_on_all_cores) registered->UseRealTime();
  passes > 0 ? registered->Iterations(passes) : registered->MinTime(kBlock_s);
  TimedBlock block(work.is_on_all_cores);
  benchmark::RunSpecifiedBenchmarks(&block);
  return block;
}

}  // namespace

std::vector<BenchRow> measured(const std::vector<Work>& works, int rounds, const Cores& cores,
                               const std::function<void(double share)>& show) {
  std::vector<BenchRow> rows;
  std::vector<std::int64_t> passes;
  const auto block_of = [&](const Work& work, std::int64_t count) {
    work.is_on_all_cores ? cores.use_all() : cores.use_one();
    use_lanes(work.width > 0 ? work.width : widest_lanes());
    return measured_block(work, count);
  };
  for (const Work& work : works) {
    rows.push_back({&work, {}});
    passes.push_back(block_of(work, 0).passes);
  }
  for (int round = 0; round < rounds; ++round) {
    show(static_cast<double>(round) / rounds);
    for (std::size_t i = 0; i < works.size(); ++i) {
      const Work& work = works[i];
      if (round % work.every != 0) continue;
      const TimedBlock block = block_of(work, passes[i]);
      rows[i].ns.push_back(block.pass_ns / work.units);
    }
  }
  cores.use_all();
  return rows;
}

double BenchRow::quantile(double share) const {
  std::vector<double> sorted = ns;
  std::sort(sorted.begin(), sorted.end());
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto i = static_cast<std::size_t>(place);
  const double next = sorted[std::min(i + 1, sorted.size() - 1)];
  return sorted[i] + (next - sorted[i]) * (place - static_cast<double>(i));
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

double median_ns(const std::vector<BenchRow>& rows, std::string_view name, int characters,
                 int width) {
  for (const BenchRow& row : rows) {
    const Work& work = *row.work;
    if (work.name == name && (characters == 0 || work.characters == characters) &&
        (width == 0 || work.width == width))
      return row.median();
  }
  return std::nan("");
}

ordered_json json_of(const BenchRow& row, const std::vector<BenchRow>& rows) {
  const Work& work = *row.work;
  const double ns = row.median();
  ordered_json json = {{"name", work.name}, {"characters", work.characters}};
  if (work.width > 0) json["width"] = work.width;
  json["ns"] = ns;
  json["ns_low"] = row.quantile(0.25);
  json["ns_high"] = row.quantile(0.75);
  json["time_us"] = ns * work.characters / 1e3;
  json["clock"] = work.is_on_all_cores ? "elapsed" : "thread";
  bool is_met = true;
  const auto add_bound = [&](const char* key, double value, double most) {
    json[key] = most;
    is_met = is_met && value <= most;
  };
  if (!work.over.empty()) {
    const double ratio = ns / median_ns(rows, work.over, 0, 0);
    json["over"] = work.over;
    json["ratio"] = ratio;
    if (work.most_ratio > 0.0) add_bound("bound_ratio", ratio, work.most_ratio);
  }
  if (work.most_ns > 0.0) {
    add_bound("bound_ns", ns, work.most_ns);
    json["limit_us"] = work.most_ns * work.characters / 1e3;
    json["ratio_to_limit"] = ns / work.most_ns;
  }
  if (work.name == "crowd" && work.characters > kGrowsFrom &&
      !std::isnan(median_ns(rows, "crowd", kGrowsFrom, work.width))) {
    const double growth = ns / median_ns(rows, "crowd", kGrowsFrom, work.width);
    json["growth"] = growth;
    add_bound("bound_growth", growth, kMostGrowth);
  }
  if (work.width > 0) {
    const double alone_ns = median_ns(rows, "crowd_alone", 0, 0);
    if (!std::isnan(alone_ns)) json["ratio_alone"] = ns / alone_ns;
  }
  if (work.width > 0 || work.name == "character_even")
    json["at_60_hz"] = std::floor(kFrame_ns / ns);
  json.update(work.notes);
  if (json.contains("bound_ns") || json.contains("bound_ratio") || json.contains("bound_growth"))
    json["met"] = is_met;
  return json;
}

ordered_json list_of(const std::vector<BenchRow>& rows, const std::string& processor) {
  ordered_json list = ordered_json::array();
  for (const BenchRow& row : rows) {
    list.push_back(json_of(row, rows));
    ordered_json again = list.back();
    if (row.work->name == "load_clip") {
      again["name"] = "load";
      list.push_back(again);
    }
  }
  for (ordered_json& row : list) {
    row["processor"] = processor;
    row["lanes"] = widest_lanes();
  }
  return list;
}

}  // namespace gaitpad
