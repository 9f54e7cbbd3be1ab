#include "check/expectation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/text.h"
#include "check/pose_track.h"
#include "files/toml_file.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr double kMostValue = 1e9;  // largest number that an expectation may hold
constexpr const char* kHashKey = "pose_hash";

// The value with six significant digits, as in a file.
std::string number_text(double value) {
  return fmt::format("{:.6g}", value == 0.0 ? 0.0 : value);  // avoids -0
}
double rounded(double value) { return parse_number<double>(number_text(value)).value_or(value); }

}  // namespace

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

// --- measuring a run

double worse_slip_m(double before_m, double slip_m) noexcept {
  if (std::isnan(before_m) || slip_m <= before_m) return before_m;
  return slip_m;
}

void RunMeter::look(const WalkerSample& sample, const Walker& walker, Character& character) const {
  const WalkFrame frame = walk_frame(walker);
  character.walking_ticks += sample.stage != Stage::idle;
  for (const Side side : {kLeftSide, kRightSide}) {
    Foot& foot = character.feet[side];
    if (frame.steps[side] > foot.steps) {
      foot.steps = frame.steps[side];
      foot.sum_m += frame.stride_m[side];
    }
    for (std::size_t j = 0; j < foot.least_rad.size(); ++j) {
      const double angle_rad = sample.joint_rad[side][j];
      foot.least_rad[j] = ticks_ == 1 ? angle_rad : std::min(foot.least_rad[j], angle_rad);
      foot.most_rad[j] = ticks_ == 1 ? angle_rad : std::max(foot.most_rad[j], angle_rad);
    }
    const std::array points = {std::pair(sample.heel_planted[side], sample.heel_m[side]),
                               std::pair(sample.toe_planted[side], sample.toe_m[side])};
    for (std::size_t p = 0; p < points.size(); ++p) {
      const auto& [is_planted, place_m] = points[p];
      if (is_planted && foot.is_planted[p]) {
        character.slip_m = worse_slip_m(character.slip_m, glm::length(place_m - foot.planted_m[p]));
      } else if (is_planted) {
        foot.planted_m[p] = place_m;
      }
      foot.is_planted[p] = is_planted;
    }
  }
}

void RunMeter::look(const Simulation& simulation) {
  copy_sample(simulation, sample_);
  characters_.resize(simulation.walkers().size());
  ++ticks_;
  for (std::size_t i = 0; i < characters_.size(); ++i)
    look(sample_.walkers[i], simulation.walkers()[i], characters_[i]);
}

Measured RunMeter::finish(const Simulation& simulation, const RunSummary& summary) const {
  Measured measured;
  measured.pose_hash = summary.pose_hash;
  const auto set_run = [&](RunMeasure m, std::int64_t n) {
    measured.run[m] = static_cast<double>(n);
  };
  set_run(kTicks, summary.ticks);
  set_run(kReports, summary.reports);
  set_run(kBadReports, summary.bad_reports);
  set_run(kBadCommands, summary.bad_commands);
  set_run(kDamagedLines, summary.damaged_lines);
  measured.characters.resize(summary.walkers.size());
  for (std::size_t i = 0; i < characters_.size(); ++i) {
    const Character& c = characters_[i];
    const WalkerSummary& walker = summary.walkers[i];
    const WalkFrame frame = walk_frame(simulation.walkers()[i]);
    auto& m = measured.characters[i];
    m[kStepsLeft] = walker.steps[kLeftSide];
    m[kStepsRight] = walker.steps[kRightSide];
    m[kIkFailures] = static_cast<double>(walker.ik_failures);
    m[kDistance] = walker.distance_m;
    if (c.walking_ticks > 0)
      m[kSpeed] = walker.distance_m * summary.rate_hz / static_cast<double>(c.walking_ticks);
    m[kHeading] = frame.heading_rad;
    m[kEndX] = frame.pelvis_m.x;
    m[kEndZ] = frame.pelvis_m.z;
    for (const Side side : {kLeftSide, kRightSide}) {
      const Foot& foot = c.feet[side];
      if (foot.steps > 0) m[static_cast<int>(kStepLeft) + side] = foot.sum_m / foot.steps;
      for (std::size_t j = 0; j < foot.least_rad.size(); ++j)
        m[static_cast<std::size_t>(kHipLeft) + 2 * j + side] =
            kDegrees * (foot.most_rad[j] - foot.least_rad[j]);
    }
    m[kSlip] = c.slip_m;
  }
  return measured;
}

// --- the file

namespace {

template <std::size_t N>
std::vector<Expected> read_measures(TomlTable& table, const std::array<Measure, N>& measures) {
  std::vector<Expected> list;
  for (std::size_t i = 0; i < N; ++i) {
    const Measure& measure = measures[i];
    if (!table.has(measure.name)) continue;
    Expected expected{static_cast<int>(i), 0.0, 0.0};
    if (measure.within == 0.0) {
      constexpr std::int64_t kMost = 1'000'000'000;
      expected.value = static_cast<double>(table.integer(measure.name, 0, kMost).value_or(0));
    } else if (auto number = table.table(measure.name)) {
      number->require("value");
      number->require("within");
      expected.value = number->number("value", -kMostValue, kMostValue).value_or(0.0);
      expected.within = number->number("within", 0.0, kMostValue).value_or(0.0);
    }
    list.push_back(expected);
  }
  return list;
}

void read_options(TomlTable& options, Expectation& e) {
  SessionSpec::Walk& walk = e.walk;
  walk.motion = options.string("motion").value_or("");
  if (const auto pace = options.string("pace")) {
    walk.pace = pace_named(*pace);
    if (!walk.pace)
      options.reject("pace", fmt::format("{} is no pace: own or adult", in_quotes(*pace)));
  }
  walk.characters = options.strings("character", kMaxWalkers).value_or(walk.characters);
  walk.styles = options.strings("style", kMaxWalkers).value_or(walk.styles);
  if (const auto crowd = options.integer("crowd", 0, kMaxFollowers))
    walk.crowd = static_cast<int>(*crowd);
  walk.terrain = options.string("terrain").value_or("");
  walk.script = options.string("script").value_or("");
  if (const auto ik = options.string("ik")) {
    if (*ik != "paper" && *ik != "robust")
      options.reject("ik", fmt::format("{} is neither paper nor robust", in_quotes(*ik)));
    walk.ik = *ik == "paper" ? IkMode::paper : IkMode::robust;
  }
  if (const auto stick = options.string("stick")) {
    if (*stick != "steers" && *stick != "points")
      options.reject("stick", fmt::format("{} is neither steers nor points", in_quotes(*stick)));
    walk.stick = *stick == "points" ? StickMeans::points : StickMeans::steers;
  }
  e.pad.calibration = options.string("calibration").value_or("");
  e.pad.map = options.string("map").value_or("");
  if (const auto rate = options.integer("rate", kLeastRateHz, kMaxRateHz))
    e.rate_hz = static_cast<int>(*rate);
  e.is_lenient = options.boolean("lenient").value_or(false);
}

// The comment lines at the beginning.
std::string heading_of(std::string_view text) {
  text = without_byte_order_mark(text);
  std::string heading;
  while (text.starts_with('#')) {
    heading += trimmed(take_line(text), "\r");
    heading += '\n';
  }
  return heading;
}

std::optional<std::uint64_t> hash_of(std::string_view text) {
  return text.size() == 16 ? parse_number<std::uint64_t>(text, 16) : std::nullopt;
}

void read_files(TomlTable& files, Expectation& e) {
  for (const std::string& name : files.keys()) {
    const auto hash = hash_of(files.string(name).value_or(""));
    if (!hash) files.reject(name, "a file's hash is 16 hexadecimal digits");
    e.files.push_back({name, hash.value_or(0)});
  }
}

}  // namespace

Result<Expectation> parsed_expectation(std::string_view text, const std::string& name) {
  auto file = TomlFile::parse(text, name);
  if (!file) return file.error();
  TomlTable root = file->root();
  Expectation e;
  e.heading = heading_of(text);
  if (const auto hash = root.string(kHashKey)) {
    e.pose_hash = hash_of(*hash);
    if (!e.pose_hash)
      root.reject(kHashKey, fmt::format("{} is not 16 hexadecimal digits", in_quotes(*hash)));
  }
  e.keeps_poses = root.boolean("keep_poses").value_or(true);
  e.run = read_measures(root, kOfRun);
  if (auto options = root.table("replay")) read_options(*options, e);
  if (auto files = root.table("files")) read_files(*files, e);
  for (TomlTable& character : root.tables("character", kMaxWalkers))
    e.characters.push_back(read_measures(character, kOfCharacter));
  if (auto problem = file->problem()) return *problem;
  return e;
}

namespace {

template <std::size_t N>
void write_measures(const std::vector<Expected>& list, const std::array<Measure, N>& measures,
                    std::string& text) {
  for (const Expected& expected : list) {
    const Measure& measure = measures[expected.measure];
    const std::string value = number_text(expected.value);
    text += measure.within == 0.0 ? fmt::format("{} = {:.0f}\n", measure.name, expected.value)
                                  : fmt::format("{} = {{ value = {}, within = {} }}\n",
                                                measure.name, value, number_text(expected.within));
  }
}

std::string options_text(const Expectation& e) {
  const SessionSpec::Walk& walk = e.walk;
  std::string text;
  const auto add = [&text](std::string_view key, const std::string& value) {
    if (!value.empty()) text += fmt::format("{} = {}\n", key, toml_string(value));
  };
  const auto add_list = [&text](std::string_view key, const std::vector<std::string>& values) {
    if (values.empty()) return;
    std::string list;
    for (const std::string& value : values) list += (list.empty() ? "" : ", ") + toml_string(value);
    text += fmt::format("{} = [{}]\n", key, list);
  };
  add("motion", walk.motion);
  if (walk.pace) add("pace", std::string(name_of(*walk.pace)));
  add_list("character", walk.characters);
  add_list("style", walk.styles);
  if (walk.crowd) text += fmt::format("crowd = {}\n", *walk.crowd);
  add("terrain", walk.terrain);
  add("script", walk.script);
  if (walk.ik) add("ik", *walk.ik == IkMode::paper ? "paper" : "robust");
  if (walk.stick == StickMeans::points) add("stick", "points");
  add("calibration", e.pad.calibration);
  add("map", e.pad.map);
  if (e.rate_hz) text += fmt::format("rate = {}\n", *e.rate_hz);
  if (e.is_lenient) text += "lenient = true\n";
  return text.empty() ? text : "\n[replay]\n" + text;
}

}  // namespace

std::string expectation_text(const Expectation& e) {
  std::string text = e.heading;
  if (text.empty()) text = "# What gaitpad check expects. gaitpad check --update renews it.\n";
  if (e.pose_hash) text += fmt::format("{} = \"{}\"\n", kHashKey, hash_text(*e.pose_hash));
  if (!e.keeps_poses) text += "keep_poses = false\n";
  write_measures(e.run, kOfRun, text);
  text += options_text(e);
  if (!e.files.empty()) text += "\n[files]\n";
  for (const ExpectedFile& file : e.files)
    text += fmt::format("{} = \"{}\"\n", toml_string(file.name), hash_text(file.hash));
  for (const auto& character : e.characters) {
    text += "\n[[character]]\n";
    write_measures(character, kOfCharacter, text);
  }
  return text;
}

SessionSpec session_of(const Expectation& expectation, const std::string& folder,
                       const std::string& trace) {
  const auto placed = [&folder](std::string& path) {
    if (!path.empty()) path = (fs::path(folder) / path).lexically_normal().string();
  };
  // FILE|NAME: distinguished as in config_file(), and motions by their extension.
  const auto placed_if_path = [&placed](std::string& path) {
    const bool is_file = path.find('/') != path.npos || path.ends_with(".toml") ||
                         path.ends_with(".bvh") || path.ends_with(".amc");
    if (is_file) placed(path);
  };
  SessionSpec spec;
  spec.walk = expectation.walk;
  spec.walk.shows_crowd = false;
  spec.pad = expectation.pad;
  spec.rate_hz = expectation.rate_hz;
  spec.replay.trace = trace;
  spec.replay.damage = expectation.is_lenient ? Damage::skip : Damage::refuse;
  placed_if_path(spec.walk.motion);
  placed_if_path(spec.walk.terrain);
  for (std::string& character : spec.walk.characters) placed_if_path(character);
  for (std::string& style : spec.walk.styles) placed_if_path(style);
  placed(spec.walk.script);
  placed(spec.pad.calibration);
  placed(spec.pad.map);
  return spec;
}

// --- judging and renewing

namespace {

// All measures; a tolerance below zero is chosen later.
std::vector<Expected> all_of(int measures) {
  std::vector<Expected> list;
  for (int i = 0; i < measures; ++i) list.push_back({i, 0.0, -1.0});
  return list;
}

template <std::size_t N>
void renew(std::vector<Expected>& list, const std::array<Measure, N>& measures,
           const std::array<double, N>& values) {
  for (Expected& expected : list) {
    expected.value = rounded(values[expected.measure]);
    const double least = measures[expected.measure].within;
    if (expected.within >= 0.0) continue;
    expected.within =
        least == 0.0 ? 0.0 : std::max(least, rounded(0.01 * std::abs(expected.value)));
  }
}

template <std::size_t N>
void find_unmet(const std::vector<Expected>& list, const std::array<Measure, N>& measures,
                const std::array<double, N>& values, const std::string& whose,
                std::vector<std::string>& sentences) {
  for (const Expected& expected : list) {
    const double value = values[expected.measure];
    const bool is_count = measures[expected.measure].within == 0.0;
    // Half a unit of the sixth digit, the precision of an expectation file.
    const double rounding = is_count ? 0.0 : 5e-6 * std::abs(expected.value);
    if (std::abs(value - expected.value) <= expected.within + rounding) continue;
    sentences.push_back(fmt::format(
        "{}{} is {}, expected {}{}", whose, measures[expected.measure].name, number_text(value),
        number_text(expected.value), is_count ? "" : " within " + number_text(expected.within)));
  }
}

std::string whose(std::size_t character, std::size_t count) {
  return count > 1 ? fmt::format("character {}: ", character + 1) : "";
}

template <std::size_t N>
void find_changes(const std::vector<Expected>& before, const std::vector<Expected>& after,
                  const std::array<Measure, N>& measures, const std::string& whose,
                  std::vector<std::string>& sentences) {
  for (std::size_t i = 0; i < std::min(before.size(), after.size()); ++i) {
    if (before[i].value == after[i].value) continue;
    sentences.push_back(fmt::format("{}{}: {} -> {}", whose, measures[after[i].measure].name,
                                    number_text(before[i].value), number_text(after[i].value)));
  }
}

}  // namespace

Expectation renewed(const Expectation& expectation, const Measured& measured) {
  Expectation e = expectation;
  if (e.is_empty()) {
    e.run = all_of(kRunMeasures);
    e.characters.assign(measured.characters.size(), all_of(kCharacterMeasures));
    e.pose_hash = 0;
  }
  if (e.pose_hash) e.pose_hash = measured.pose_hash;
  renew(e.run, kOfRun, measured.run);
  e.characters.resize(std::min(e.characters.size(), measured.characters.size()));
  for (std::size_t i = 0; i < e.characters.size(); ++i)
    renew(e.characters[i], kOfCharacter, measured.characters[i]);
  return e;
}

std::vector<std::string> changed_files(const Expectation& expectation,
                                       const std::vector<ExpectedFile>& now) {
  std::vector<std::string> sentences;
  if (expectation.files.empty()) return sentences;
  constexpr const char* kSince = "since this expectation was written";
  std::vector<std::string> came;
  for (const ExpectedFile& file : now) {
    const auto before = std::ranges::find(expectation.files, file.name, &ExpectedFile::name);
    if (before == expectation.files.end()) {
      came.push_back(fmt::format("{} came to the files that are read {}", file.name, kSince));
    } else if (before->hash != file.hash) {
      sentences.push_back(fmt::format("{} changed {}", file.name, kSince));
    }
  }
  sentences.insert(sentences.end(), came.begin(), came.end());
  for (const ExpectedFile& file : expectation.files) {
    if (std::ranges::count(now, file.name, &ExpectedFile::name) == 0)
      sentences.push_back(fmt::format("{} left the files that are read {}", file.name, kSince));
  }
  return sentences;
}

std::vector<std::string> unmet_numbers(const Expectation& expectation, const Measured& measured) {
  std::vector<std::string> sentences;
  find_unmet(expectation.run, kOfRun, measured.run, "", sentences);
  const std::size_t count = expectation.characters.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (i < measured.characters.size()) {
      find_unmet(expectation.characters[i], kOfCharacter, measured.characters[i], whose(i, count),
                 sentences);
    } else {
      sentences.push_back(fmt::format("character {} is expected and does not walk", i + 1));
    }
  }
  return sentences;
}

std::vector<std::string> changes(const Expectation& before, const Expectation& after) {
  std::vector<std::string> sentences;
  if (before.pose_hash && before.pose_hash != after.pose_hash) {
    sentences.push_back(fmt::format("{}: {} -> {}", kHashKey, hash_text(*before.pose_hash),
                                    hash_text(after.pose_hash.value_or(0))));
  }
  find_changes(before.run, after.run, kOfRun, "", sentences);
  const std::size_t count = std::min(before.characters.size(), after.characters.size());
  for (std::size_t i = 0; i < count; ++i) {
    find_changes(before.characters[i], after.characters[i], kOfCharacter, whose(i, count),
                 sentences);
  }
  return sentences;
}

}  // namespace gaitpad
