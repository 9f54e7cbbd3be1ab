// Judges made sticks, healthy and faulty, whose truth is known. Prints tables in Markdown: the
// verdicts of each kind, what the calibrated stick then does untouched and at full deflection, and
// the errors of the numbers.
//   stick_verdicts [STICKS OF EACH KIND] [KIND]    default: 40, all
#include <cstdio>
#include <cstdlib>
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

struct Kind {
  const char* name;
  const char* must;  // the verdict, or what a person would see
  void (*make)(Draw&, MadeStick&);
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
    {"healthy, 250 Hz", "good", [](Draw&, MadeStick&) {}},
    {"healthy, 8 to 16 bits, 25 to 8,000 Hz, jitter, losses", "never replace",
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
    {"healthy, 20 Hz and below", "unknown",
     [](Draw& draw, MadeStick& s) { s.rate_hz = draw.within(8.0, 20.0); }},
    {"worn: noise to 0.03, hysteresis to 0.15, off its middle by up to 0.2", "good or worn",
     [](Draw& draw, MadeStick& s) {
       s.centre = draw.within(0.0, 0.2) * draw.direction();
       s.sigma = vec2(draw.within(0.003, 0.03));
       s.hysteresis = draw.within(0.02, 0.15);
     }},
    {"creeps home by up to 0.03 in 0.3 s", "good or worn",
     [](Draw& draw, MadeStick& s) { s.creep = draw.within(0.005, 0.03); }},
    {"drifts by 0.003 to 0.02 a second", "replace",
     [](Draw& draw, MadeStick& s) { s.drift_per_s = draw.within(0.003, 0.02) * draw.direction(); }},
    {"wanders by 0.1, time constant 1 to 3 s", "replace or 0 steps",
     [](Draw& draw, MadeStick& s) { s.roam = 0.1, s.roam_s = draw.within(1.0, 3.0); }},
    {"wanders by 0.04 to 0.15, time constant 1 to 5 s", "replace or 0 steps",
     [](Draw& draw, MadeStick& s) {
       s.roam = draw.within(0.04, 0.15), s.roam_s = draw.within(1.0, 5.0);
     }},
    {"wanders by 0.01 to 0.03, time constant 1 to 5 s", "replace or 0 steps",
     [](Draw& draw, MadeStick& s) {
       s.roam = draw.within(0.01, 0.03), s.roam_s = draw.within(1.0, 5.0);
     }},
    {"rests displaced by 0.1 to 0.3 in 2 to 6 of 12 releases", "not good",
     [](Draw& draw, MadeStick& s) {
       s.displaced = draw.within(0.1, 0.3),
       s.displaced_times = static_cast<int>(draw.within(2, 6.99));
     }},
    {"a rest displaced by 0.1 to 0.3 in 1 of 12 releases", "named",
     [](Draw& draw, MadeStick& s) { s.displaced = draw.within(0.1, 0.3), s.displaced_times = 1; }},
    {"3 to 30 drop-outs of 4 to 100 ms", "not good",
     [](Draw& draw, MadeStick& s) {
       s.rate_hz = draw.one_of(std::array{250.0, 500.0, 1000.0});
       s.drop_outs = static_cast<int>(draw.within(3, 30.99));
       s.drop_out_s = draw.within(0.008, 0.066);
     }},
    {"10 to 30 drop-outs of 16 to 80 ms", "not good",
     [](Draw& draw, MadeStick& s) {
       s.drop_outs = static_cast<int>(draw.within(10, 30.99)), s.drop_out_s = 0.048;
     }},
    {"one axis freezes 3 to 8 times, 0.15 to 1 s", "not good",
     [](Draw& draw, MadeStick& s) {
       s.freezes = static_cast<int>(draw.within(3, 8.99)), s.freeze_s = draw.within(0.15, 0.75);
       s.frozen_axes = draw.chance(0.5) ? 1 : 2;
     }},
    {"both axes freeze 3 to 8 times, 0.15 to 1 s", "not good",
     [](Draw& draw, MadeStick& s) {
       s.freezes = static_cast<int>(draw.within(3, 8.99)), s.freeze_s = draw.within(0.15, 0.75);
       s.frozen_axes = 3;
     }},
    {"a sector of 10 to 57 degrees reaches 0.5 to 0.8", "full >= 0.96",
     [](Draw& draw, MadeStick& s) {
       s.weak_rad = draw.within(-kPi, kPi), s.weak_width_rad = draw.within(10.0, 57.0) * kDegree;
       s.weak_reach = draw.within(0.5, 0.8);
     }},
    {"spikes, 2 % of the reports", "filter, or not \"makes up\"",
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

struct Untouched {
  int steps = 0;
  double walking = 0.0;  // share of the reports beyond the inner zone
};
// A minute in which the stick is let go six times and left alone for ten seconds each.
Untouched untouched(MadeStick stick, const StickCalibration& calibration) {
  stick.seed += 1000;
  stick.freezes = 0;
  stick.reports_changes_only = false;
  stick.drift_per_s = vec2(0.0);  // it would be calibrated again now and then
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
  Untouched found;
  const StickTrack track = reported(stick, path);
  for (const StickSample& sample : track)
    found.walking += stick_position(calibration, sample.raw) != vec2(0.0);
  if (found.walking == 0.0) return found;
  found.walking /= static_cast<double>(track.size());
  Simulation simulation = simulation_with(calibration);
  // A pad counts from when its stick was at rest.
  simulation.step(
      std::vector<Report>{word_report(vec2(calibration.x.centre, calibration.y.centre))});
  std::size_t next = 0;
  for (int tick = 0; tick < 240 * 62; ++tick) {
    vec2 raw(2.0);
    while (next < track.size() && track[next].time_ns * 24 <= tick * 100'000'000ll)
      raw = track[next++].raw;
    simulation.step(raw.x < 2.0 ? std::vector<Report>{word_report(raw)} : std::vector<Report>{});
    found.steps += simulation.heel_struck();
  }
  return found;
}

// The least output of all directions when the stick is pushed to its gate.
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

int run(int sticks, const std::string& only) {
  std::printf(
      "| made stick | must be | good | worn | replace | unknown | steps untouched (60 s) | full "
      "|\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  Errors errors;
  std::map<std::string, std::pair<Verdict, std::string>> reasons;
  for (const Kind& kind : kKinds) {
    if (!only.empty() && std::string(kind.name).find(only) == std::string::npos) continue;
    int verdicts[4] = {}, steps = 0, walkers = 0;
    double full = 1.0;
    for (int k = 1; k <= sticks; ++k) {
      Draw draw(static_cast<std::uint32_t>(k));
      MadeStick stick = usual_stick(draw);
      stick.seed = static_cast<std::uint32_t>(k);
      kind.make(draw, stick);
      const StickStatistics s = statistics_of(stick, made_session(stick));
      const StickAdvice advice = stick_advice(s, {});
      ++verdicts[static_cast<std::size_t>(advice.verdict)];
      if (kind.name[0] == 'h' && advice.verdict != Verdict::unknown) add_errors(stick, s, errors);
      int own_steps = 0;
      if (advice.verdict == Verdict::good || advice.verdict == Verdict::worn) {
        const Untouched alone = untouched(stick, advice.calibration);
        own_steps = alone.steps;
        if (!only.empty()) std::printf("walking %.4f ", alone.walking);
        full = std::min(full, full_deflection(stick, advice.calibration));
      }
      steps += own_steps;
      walkers += own_steps > 0;
      if (!only.empty()) {
        std::printf("%d: %s, %d steps, w %.4f h %.3f zone %.3f full %.3f, j %d s %d: %s\n", k,
                    name_of(advice.verdict), own_steps, s.wander, s.hysteresis.value_or(-1),
                    advice.inner_zone, full_deflection(stick, advice.calibration), int(s.jumps),
                    int(s.stuck), advice.reason.c_str());
      }
    }
    std::printf("| %s | %s | %d | %d | %d | %d | %d sticks, %d steps | %.3f |\n", kind.name,
                kind.must, verdicts[0], verdicts[1], verdicts[2], verdicts[3], walkers, steps,
                full);
    std::fflush(stdout);
  }
  std::printf("\n| number | sticks | error, median | p95 |\n|---|---|---|---|\n");
  for (const auto& [name, values] : errors) {
    std::printf("| %s | %zu | %.4f | %.4f |\n", name.c_str(), values.size(), quantile(values, 0.5),
                quantile(values, 0.95));
  }
  return 0;
}

}  // namespace
}  // namespace gaitpad

int main(int argc, char** argv) {
  return gaitpad::run(argc > 1 ? std::atoi(argv[1]) : 40, argc > 2 ? argv[2] : "");
}
