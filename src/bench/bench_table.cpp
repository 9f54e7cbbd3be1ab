#include "bench/bench_table.h"

#include <fmt/format.h>

#include <utility>

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

constexpr int kMostStateBytes = 1024;  // upper bound for the memory of a character's state

std::string time_text(double ns) {
  if (ns < 1e4) return fmt::format("{:.0f} ns", ns);
  return ns < 1e6 ? fmt::format("{:.1f} us", ns / 1e3) : fmt::format("{:.1f} ms", ns / 1e6);
}

const char* heading_of(const std::string& name) {
  if (name.starts_with("leg")) return "one leg, the solve alone";
  if (name.starts_with("playback")) return "bare playback of the skeleton";
  if (name.ends_with("60_hz")) return "a character, at 60 Hz";
  if (name.starts_with("char") || name == "step") return "a character, at the trace's 240 Hz";
  if (name == "crowd_alone") return "members of the crowd below, each walking alone";
  if (name.starts_with("replay")) return "a replay of 20 s, the program running already";
  if (name == "crowd") return "a character in a crowd, ticks of 1/60 s";
  if (name == "crowd_all_cores") return "the same on all cores";
  if (name == "crowd_memory") return "a character's state and pose, moved and not computed";
  return "loading";
}

std::string bounds_text(const ordered_json& row) {
  std::string text;
  const auto add = [&](const char* bound, const char* value, const std::string& limit) {
    if (!row.contains(bound)) return;
    const bool is_met = row[value].get<double>() <= row[bound].get<double>();
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", limit, is_met ? "met" : "MISSED");
  };
  if (row.contains("bound_ns")) add("bound_ns", "ns", time_text(row["bound_ns"]));
  if (row.contains("bound_ratio"))
    add("bound_ratio", "ratio", fmt::format("{} x", row["bound_ratio"].get<double>()));
  if (row.contains("bound_growth"))
    add("bound_growth", "growth",
        fmt::format("{:.2f} of 1,000's, {} x", row["growth"].get<double>(),
                    row["bound_growth"].get<double>()));
  return text;
}

}  // namespace

std::string lanes_text(int lanes) {
  const char* set = lanes >= 16 ? "AVX-512" : lanes >= 8 ? "AVX2" : "128 bits";
  return fmt::format("{} lanes ({})", lanes, set);
}

std::vector<std::string> bench_lines(const std::vector<BenchRow>& rows, const ordered_json& list,
                                     int core, int rounds) {
  const ordered_json& first = list.front();
  std::vector<std::string> lines;
  lines.push_back(fmt::format("{}, {}{}; medians over {} rounds, quartiles, times the peer, bound",
                              first["processor"].get<std::string>(), lanes_text(first["lanes"]),
                              core >= 0 ? fmt::format(", core {}", core) : "", rounds));
  std::string heading;
  for (const BenchRow& row : rows) {
    const ordered_json json = json_of(row, rows);
    const std::string next = heading_of(row.work->name);
    if (next != heading) lines.push_back(next);
    heading = next;
    const std::string& label = row.work->label;
    const std::string spread =
        fmt::format("{} - {}", time_text(json["ns_low"]), time_text(json["ns_high"]));
    std::string line = fmt::format("  {:34} {:>9}  {:>19}", label, time_text(json["ns"]), spread);
    line += json.contains("ratio") ? fmt::format("  {:6.2f} x", json["ratio"].get<double>())
                                   : std::string(10, ' ');
    if (json.contains("ratio_alone"))
      line += fmt::format("  {:5.2f} x alone", json["ratio_alone"].get<double>());
    if (json.contains("at_60_hz"))
      line += fmt::format("  {:6.0f} at 60 Hz", json["at_60_hz"].get<double>());
    const std::string bounds = bounds_text(json);
    if (!bounds.empty()) line += "  " + bounds;
    if (json.contains("iterations_per_leg"))
      line += fmt::format("  {:.2f} iterations a leg", json["iterations_per_leg"].get<double>());
    if (json.contains("bytes")) line += fmt::format("  {:.0f} bytes", json["bytes"].get<double>());
    line.erase(line.find_last_not_of(' ') + 1);
    lines.push_back(std::move(line));
  }
  for (const ordered_json& row : list) {
    if (row["name"] != "character_even") continue;
    const double state = row["state_bytes"];
    lines.push_back(
        fmt::format("a character's state {:.0f} bytes (bound {}, {}), parameters {}, pose {}; "
                    "a build's model {:.0f} KB, shared",
                    state, kMostStateBytes, state <= kMostStateBytes ? "met" : "MISSED",
                    row["params_bytes"].get<int>(), row["pose_bytes"].get<int>(),
                    row["model_bytes"].get<double>() / 1e3));
  }
  return lines;
}

}  // namespace gaitpad
