// Judges simulated sticks, healthy and faulty, with known truth. Prints tables in Markdown: the
// verdicts of each kind, the calibrated stick's output untouched and at full deflection, and the
// errors of the numbers.
//   stick_verdicts [STICKS OF EACH KIND] [KIND]    default: 40, all; with KIND a line a stick
// Every fourth stick is on a random pad: 8 to 16 bits, 25 to 8,000 Hz if the fault is visible at
// that rate, jitter, losses, changes only. Exit status 1: a stick got a wrong verdict.
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <map>
#include <string>

#include "gaitpad/gait_cycle.h"
#include "gaitpad/simulation.h"
#include "stick/made_hand.h"
#include "stick/made_stick.h"
#include "stick/pad_analysis.h"
#include "tests/clean_cycle.h"
#include "tests/hid/made_pads.h"

namespace gaitpad {
namespace {

// ---- The kinds

// The requirement on a kind of stick: a verdict, or a behaviour of the calibrated stick.
enum class Must {
  be_good,
  pass,
  not_replace,
  be_unknown,
  be_replace,
  stand_still,
  not_good,
  be_named,
  be_full
};
constexpr const char* kMustNames[] = {"good",     "good or worn", "never replace",
                                      "unknown",  "replace",      "replace or 0 steps",
                                      "not good", "named",        "full >= 0.96"};

struct Kind {
  const char* name;
  Must must;
  void (*make)(Draw&, MadeStick&);
  double least_hz = 25.0;  // lowest report rate at which the fault and the whole rim are visible
};

// The stick of the tables: 12 bits, 250 reports a second.
MadeStick usual_stick(Draw& draw) {
  MadeStick stick;
  stick.centre = 0.02 * draw.direction();
  stick.sigma = vec2(0.003);
  stick.hysteresis = 0.02;
  stick.reach_x = 0.94;
  stick.bits = 12;
  return stick;
}

const Kind kKinds[] = {
    {"healthy, 250 Hz", Must::be_good, [](Draw&, MadeStick&) {}},
    {"healthy, 8 to 16 bits, 25 to 8,000 Hz, jitter, losses", Must::not_replace,
     [](Draw& draw, MadeStick& s) {
       s.rate_hz = draw.one_of(std::array{25.0, 30.0, 66.0, 125.0, 1000.0, 8000.0});
       s.bits = static_cast<int>(draw.one_of(std::array{8.0, 10.0, 12.0, 16.0}));
       s.jitter_ms = draw.within(0.0, 0.2) * 1000.0 / s.rate_hz;
       s.drop_chance = draw.chance(0.5) ? 0.0 : draw.within(0.0, 0.05);
       s.reports_changes_only = draw.chance(0.4);
       s.gate = std::array{Gate::circle, Gate::square,
                           Gate::ellipse}[static_cast<std::size_t>(draw.within(0.0, 2.99))];
       s.reach_x = draw.within(0.88, 1.0);
       s.reach_y = draw.within(0.88, 1.0);
     }},
    {"healthy, 20 Hz and below", Must::be_unknown,
     [](Draw& draw, MadeStick& s) { s.rate_hz = draw.within(8.0, 20.0); }},
    {"worn: noise to 0.03, hysteresis to 0.15, off its middle by up to 0.2", Must::pass,
     [](Draw& draw, MadeStick& s) {
       s.centre = draw.within(0.0, 0.2) * draw.direction();
       s.sigma = vec2(draw.within(0.003, 0.03));
       s.hysteresis = draw.within(0.02, 0.15);
     },
     66.0},
    {"creeps home by up to 0.03 in 0.3 s", Must::pass,
     [](Draw& draw, MadeStick& s) { s.creep = draw.within(0.005, 0.03); }, 66.0},
    {"drifts by 0.003 to 0.02 a second", Must::be_replace,
     [](Draw& draw, MadeStick& s) {
       s.drift_per_s = draw.direction();
       s.drift_per_s *= draw.within(0.003, 0.02);
     }},
    {"wanders by 0.1, time constant 1 to 3 s", Must::stand_still,
     [](Draw& draw, MadeStick& s) { s.roam = 0.1, s.roam_s = draw.within(1.0, 3.0); }},
    {"wanders by 0.04 to 0.15, time constant 1 to 5 s", Must::stand_still,
     [](Draw& draw, MadeStick& s) {
       s.roam = draw.within(0.04, 0.15), s.roam_s = draw.within(1.0, 5.0);
     }},
    {"wanders by 0.01 to 0.03, time constant 1 to 5 s", Must::stand_still,
     [](Draw& draw, MadeStick& s) {
       s.roam = draw.within(0.01, 0.03), s.roam_s = draw.within(1.0, 5.0);
     },
     66.0},
    {"rests displaced by 0.1 to 0.3 in 2 to 6 of 12 releases", Must::not_good,
     [](Draw& draw, MadeStick& s) {
       s.displaced = draw.within(0.1, 0.3),
       s.displaced_times = static_cast<int>(draw.within(2, 6.99));
     }},
    {"a rest displaced by 0.1 to 0.3 in 1 of 12 releases", Must::be_named,
     [](Draw& draw, MadeStick& s) { s.displaced = draw.within(0.1, 0.3), s.displaced_times = 1; }},
    {"3 to 30 drop-outs of 4 to 100 ms", Must::not_good,
     [](Draw& draw, MadeStick& s) {
       s.rate_hz = draw.one_of(std::array{250.0, 500.0, 1000.0});
       s.drop_outs = static_cast<int>(draw.within(3, 30.99));
       s.drop_out_s = draw.within(0.008, 0.066);
     }},
    {"10 to 30 drop-outs of 16 to 80 ms", Must::not_good,
     [](Draw& draw, MadeStick& s) {
       s.drop_outs = static_cast<int>(draw.within(10, 30.99)), s.drop_out_s = 0.048;
     },
     66.0},
    {"one axis freezes 3 to 8 times, 0.15 to 1 s", Must::not_good,
     [](Draw& draw, MadeStick& s) {
       s.freezes = static_cast<int>(draw.within(3, 8.99)), s.freeze_s = draw.within(0.15, 0.75);
       s.frozen_axes = draw.chance(0.5) ? 1 : 2;
     },
     66.0},
    {"both axes freeze 3 to 8 times, 0.15 to 1 s", Must::not_good,
     [](Draw& draw, MadeStick& s) {
       s.freezes = static_cast<int>(draw.within(3, 8.99)), s.freeze_s = draw.within(0.15, 0.75);
       s.frozen_axes = 3;
     },
     66.0},
    {"a sector of 10 to 57 degrees reaches 0.5 to 0.8", Must::be_full,
     [](Draw& draw, MadeStick& s) {
       s.weak_rad = draw.within(-kPi, kPi), s.weak_width_rad = draw.within(10.0, 57.0) * kDegree;
       s.weak_reach = draw.within(0.5, 0.8);
     },
     125.0},
    {"jumps of single reports, 0.06 to 0.15 % of them", Must::stand_still,
     [](Draw& draw, MadeStick& s) {
       s.spike_chance = draw.within(0.0006, 0.0015), s.spike_reports = 1;
     },
     125.0},
    {"jumps of single reports, 2 % of them", Must::stand_still,
     [](Draw&, MadeStick& s) { s.spike_chance = 0.02, s.spike_reports = 1; }},
};

// ---- What the calibrated stick does

// A pad of two 16-bit axes whose left stick has this calibration, and one walker.
Simulation simulation_with(const StickCalibration& calibration) {
  static const GaitCycle cycle = clean_cycle(procedural_gait());
  SimulationConfig config;
  PadConfig& pad = config.pads.emplace_back();
  pad.layout = std::make_shared<const PadLayout>(layout_of(Controls::one_stick));
  pad.is_usable = true;
  pad.calibration.left = calibration;
  config.styles.resize(1);
  config.cycle = cycle;
  config.walkers.resize(1);
  return value_of(Simulation::create(config));
}

Report word_report(const vec2& raw) {
  std::vector<std::uint8_t> bytes;
  for (const double axis : {raw.x, -raw.y}) {
    const auto word = static_cast<std::uint16_t>(static_cast<std::int16_t>(
        std::lround(std::clamp(axis * 32767.5 - 0.5, -32768.0, 32767.0))));
    bytes.push_back(static_cast<std::uint8_t>(word & 0xff));
    bytes.push_back(static_cast<std::uint8_t>(word >> 8));
  }
  Report report = report_of(bytes);
  report.device = 0;
  return report;
}

// A minute in which the stick is released six times and left alone for ten seconds each.
StickTrack untouched_track(MadeStick stick) {
  stick.seed += 1000;
  stick.freezes = 0;
  stick.reports_changes_only = false;
  MadeMoves moves(stick);
  std::vector<vec2> path;
  for (int k = 0; k < 6; ++k) {
    moves.push(k);
    moves.release();
    const std::size_t from = moves.path().size();
    moves.rest(10.3);
    path.insert(path.end(), moves.path().begin() + static_cast<std::ptrdiff_t>(from),
                moves.path().end());
  }
  return reported(stick, path);
}

struct Untouched {
  int steps = 0;
  double walking_s = 0.0;
};
Untouched untouched(MadeStick stick, const StickCalibration& calibration) {
  // Without drift: a drifting stick would be calibrated again now and then.
  stick.drift_per_s = vec2(0.0);
  const StickTrack track = untouched_track(stick);
  Untouched found;
  const bool stays = std::none_of(track.begin(), track.end(), [&](const StickSample& sample) {
    return stick_position(calibration, sample.raw) != vec2(0.0);
  });
  if (stays) return found;
  Simulation simulation = simulation_with(calibration);
  // A pad counts only after its stick was at rest.
  simulation.step(
      std::vector<Report>{word_report(vec2(calibration.x.centre, calibration.y.centre))});
  std::size_t next = 0;
  for (int tick = 0; tick < 240 * 62; ++tick) {
    std::vector<Report> reports;
    for (; next < track.size() && track[next].time_ns * 24 <= tick * 100'000'000ll; ++next)
      reports.push_back(word_report(track[next].raw));
    simulation.step(reports);
    found.steps += simulation.heel_struck();
    found.walking_s +=
        walk_steps(simulation.walkers()[0].state).stage == Stage::idle ? 0.0 : 1.0 / 240.0;
  }
  return found;
}

// The smallest output of all directions when the stick is pushed to its gate.
double full_deflection(const MadeStick& stick, const StickCalibration& calibration) {
  double least = 1.0;
  for (int degrees = 0; degrees < 720; ++degrees) {
    const double angle = 0.5 * degrees * kDegree, radius = gate_radius(stick, angle);
    const vec2 raw = stick.centre + radius * vec2(std::cos(angle), std::sin(angle));
    least = std::min(least, glm::length(stick_position(calibration, raw)));
  }
  return least;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

using Errors = std::map<std::string, std::vector<double>>;

void add_errors(const MadeStick& stick, const StickStatistics& s, Errors& errors) {
  if (s.centre) errors["centre"].push_back(glm::length(*s.centre - stick.centre));
  if (s.sigma && !s.is_sigma_hidden)
    errors["noise"].push_back(std::fabs(s.sigma->x - stick.sigma.x));
  if (s.hysteresis) errors["hysteresis"].push_back(std::fabs(*s.hysteresis - stick.hysteresis));
  if (s.max_x)
    errors["reach"].push_back(std::fabs(*s.max_x - stick.centre.x - gate_radius(stick, 0.0)));
  if (s.min_y)
    errors["reach"].push_back(
        std::fabs(stick.centre.y - *s.min_y - gate_radius(stick, -0.5 * kPi)));
}

// The behaviour of a stick under the calibration of a sound stick of its size: the verdict is
// compared with it.
enum class Truth { sound, walks, misses, jumps, slow };
constexpr const char* kTruthNames[] = {"nothing", "walks untouched", "misses a direction", "jumps",
                                       "reports too slowly to tell"};
constexpr std::size_t kTruths = std::size(kTruthNames);

Truth truth_of(const MadeStick& stick) {
  constexpr double kSoundZone = 0.1;  // radius of a sound stick's inner zone, raw
  if (stick.rate_hz < 22.5) return Truth::slow;
  if (stick.drop_outs > 2 || stick.freezes > 2 || stick.spike_chance > 0.0) return Truth::jumps;
  if (stick.weak_width_rad > 0.0) return Truth::misses;
  std::size_t out = 0;
  const StickTrack track = untouched_track(stick);
  for (const StickSample& sample : track)
    out += glm::length(sample.raw - stick.centre) > kSoundZone;
  return 1000 * out > track.size() ? Truth::walks : Truth::sound;
}

struct Judged {
  Verdict verdict = Verdict::unknown;
  std::string reason;
  Untouched alone;
  double full = 1.0;
};

bool is_as_it_must_be(const Judged& j, Must must) {
  const bool is_usable = j.verdict == Verdict::good || j.verdict == Verdict::worn;
  switch (must) {
    case Must::be_good:
      return j.verdict == Verdict::good;
    case Must::pass:
      return is_usable;
    case Must::not_replace:
      return j.verdict != Verdict::replace;
    case Must::be_unknown:
      return j.verdict == Verdict::unknown;
    case Must::be_replace:
      return j.verdict == Verdict::replace;
    case Must::stand_still:
      return j.verdict == Verdict::replace || (is_usable && j.alone.steps == 0);
    case Must::not_good:
      return j.verdict != Verdict::good;
    case Must::be_named:
      return j.verdict != Verdict::good || j.reason.find("release") != std::string::npos;
    case Must::be_full:
      return !is_usable || j.full >= 0.96;
  }
  return false;
}

struct Row {
  int sticks = 0, right = 0, walkers = 0, steps = 0;
  std::array<int, 4> verdicts{};
  double walking_s = 0.0, full = 1.0;
  void add(const Judged& j, Must must) {
    ++sticks;
    ++verdicts[static_cast<std::size_t>(j.verdict)];
    right += is_as_it_must_be(j, must);
    walkers += j.alone.steps > 0;
    steps += j.alone.steps;
    walking_s += j.alone.walking_s;
    full = std::min(full, j.full);
  }
};

void put_on_any_pad(Draw& draw, double least_hz, MadeStick& stick) {
  stick.bits = static_cast<int>(draw.one_of(std::array{8.0, 10.0, 12.0, 16.0}));
  do {
    stick.rate_hz = draw.one_of(std::array{25.0, 30.0, 66.0, 125.0, 250.0, 500.0, 1000.0, 8000.0});
  } while (stick.rate_hz < least_hz);
  stick.jitter_ms = draw.within(0.0, 0.2) * 1000.0 / stick.rate_hz;
  stick.drop_chance = draw.chance(0.5) ? 0.0 : draw.within(0.0, 0.02);
  stick.reports_changes_only = draw.chance(0.3);
}

MadeStick stick_of(const Kind& kind, int k) {
  Draw draw(static_cast<std::uint32_t>(k));
  MadeStick stick = usual_stick(draw);
  stick.seed = static_cast<std::uint32_t>(k);
  kind.make(draw, stick);
  if (k % 4 == 0 && stick.rate_hz == 250.0 && &kind != kKinds)
    put_on_any_pad(draw, kind.least_hz, stick);
  return stick;
}

void print_rows(const std::vector<std::pair<const Kind*, Row>>& rows) {
  std::printf(
      "| made stick | must be | is | good | worn | replace | unknown | walks untouched | full |\n"
      "|---|---|---|---|---|---|---|---|---|\n");
  double walking_s = 0.0;
  int left_alone = 0;
  for (const auto& [kind, row] : rows) {
    const auto& v = row.verdicts;
    std::printf("| %s | %s | %d of %d | %d | %d | %d | %d | %d of %d: %d steps, %.1f s | %.3f |\n",
                kind->name, kMustNames[static_cast<std::size_t>(kind->must)], row.right, row.sticks,
                v[0], v[1], v[2], v[3], row.walkers, v[0] + v[1], row.steps, row.walking_s,
                row.full);
    walking_s += row.walking_s;
    left_alone += v[0] + v[1];
  }
  std::printf("\nUntouched after calibration: %.2f minutes of walking in %d minutes.\n",
              walking_s / 60.0, left_alone);
}

void print_confusion(const std::array<std::array<int, 4>, kTruths>& confusion) {
  std::printf("\n| what it does to a person | good | worn | replace | unknown |\n");
  std::printf("|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < kTruths; ++k) {
    const auto& v = confusion[k];
    std::printf("| %s | %d | %d | %d | %d |\n", kTruthNames[k], v[0], v[1], v[2], v[3]);
  }
}

void print_errors(const Errors& errors) {
  std::printf("\n| number | sticks | error, median | p95 |\n|---|---|---|---|\n");
  for (const auto& [name, values] : errors) {
    std::printf("| %s | %zu | %.4f | %.4f |\n", name.c_str(), values.size(), quantile(values, 0.5),
                quantile(values, 0.95));
  }
}

int run(int sticks, const std::string& only) {
  Errors errors;
  std::array<std::array<int, 4>, kTruths> confusion{};
  std::vector<std::pair<const Kind*, Row>> rows;
  bool is_right = true;
  for (const Kind& kind : kKinds) {
    if (!only.empty() && std::string(kind.name).find(only) == std::string::npos) continue;
    Row row;
    for (int k = 1; k <= sticks; ++k) {
      const MadeStick stick = stick_of(kind, k);
      const StickStatistics s = statistics_of(stick, made_session(stick));
      const StickAdvice advice = stick_advice(s, {});
      Judged judged{advice.verdict, advice.reason, {}, 1.0};
      if (judged.verdict == Verdict::good || judged.verdict == Verdict::worn) {
        judged.alone = untouched(stick, advice.calibration);
        judged.full = full_deflection(stick, advice.calibration);
      }
      if (kind.name[0] == 'h' && judged.verdict != Verdict::unknown) add_errors(stick, s, errors);
      ++confusion[static_cast<std::size_t>(truth_of(stick))]
                 [static_cast<std::size_t>(judged.verdict)];
      row.add(judged, kind.must);
      if (only.empty() && is_as_it_must_be(judged, kind.must)) continue;
      std::fprintf(stderr, "%s, %d (%.0f Hz, %d bits): %s, %d steps, full %.3f: %s\n", kind.name, k,
                   stick.rate_hz, stick.bits, name_of(judged.verdict), judged.alone.steps,
                   judged.full, judged.reason.c_str());
    }
    is_right = is_right && row.right == row.sticks;
    rows.emplace_back(&kind, row);
  }
  print_rows(rows);
  print_confusion(confusion);
  print_errors(errors);
  return is_right ? 0 : 1;
}

}  // namespace
}  // namespace gaitpad

int main(int argc, char** argv) {
  return gaitpad::run(argc > 1 ? std::atoi(argv[1]) : 40, argc > 2 ? argv[2] : "");
}
