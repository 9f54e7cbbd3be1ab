#include "check/trace_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "base/text.h"
#include "check/expectation.h"
#include "check/pose_track.h"
#include "files/toml_file.h"
#include "session/playback.h"
#include "session/workers.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kRecording = ".hid", kExpectation = ".expect.toml";
constexpr std::size_t kMaxPosesBytes = std::size_t{256} << 20;

std::optional<std::string> without_end(const std::string& path, std::string_view end) {
  const bool has_it = path.size() > end.size() && path.ends_with(end);
  return has_it ? std::optional(path.substr(0, path.size() - end.size())) : std::nullopt;
}

std::optional<Error> search(const std::string& folder, bool updates, FoundTraces& found) {
  std::error_code error;
  fs::recursive_directory_iterator next(folder, error), end;
  for (; !error && next != end; next.increment(error)) {
    const std::string path = next->path().string();
    const bool is_hidden = next->path().filename().string().starts_with('.');
    std::error_code ignored;
    if (is_hidden && next->is_directory(ignored)) next.disable_recursion_pending();
    if (is_hidden || !next->is_regular_file(ignored)) continue;
    if (const auto stem = without_end(path, kExpectation)) {
      found.traces.push_back({*stem});
    } else if (const auto recording = without_end(path, kRecording)) {
      if (updates) found.traces.push_back({*recording});
      if (!fs::exists(*recording + std::string(kExpectation), ignored))
        found.without.push_back(path);
    }
  }
  if (error) return Error{fmt::format("{}: {}", folder, error.message())};
  return std::nullopt;
}

}  // namespace

Result<FoundTraces> found_traces(const std::vector<std::string>& paths, bool updates) {
  FoundTraces found;
  for (const std::string& path : paths) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (fs::is_directory(status)) {
      if (auto problem = search(path, updates, found)) return *problem;
      continue;
    }
    auto stem = without_end(path, kExpectation);
    if (!stem) stem = without_end(path, kRecording);
    if (!fs::exists(status)) return Error{path + ": no such file or folder"};
    if (!stem)
      return Error{path + ": neither a folder, nor a recording (.hid), nor an expectation"};
    found.traces.push_back({*stem});
  }
  std::ranges::sort(found.without);
  std::ranges::sort(found.traces, {}, &CheckedTrace::path);
  const auto is_same = [](const CheckedTrace& a, const CheckedTrace& b) {
    return a.path == b.path;
  };
  found.traces.erase(std::unique(found.traces.begin(), found.traces.end(), is_same),
                     found.traces.end());
  return found;
}

// --- one recording

namespace {

template <class Look>
TraceRun run_through(const PreparedTrace& prepared, Look look) {
  TraceRun run = TraceRun::begin(prepared);
  while (run.ticks() < prepared.ticks) {
    run.step(prepared);
    look(run.simulation());
  }
  return run;
}

Measured measured_run(const PreparedTrace& prepared) {
  RunMeter meter;
  const TraceRun run = run_through(prepared, [&meter](const Simulation& s) { meter.look(s); });
  RunSummary summary = run_summary(run.simulation(), cast_of(run.simulation(), prepared.config));
  summary.damaged_lines = prepared.trace.skipped_lines;
  return meter.finish(run.simulation(), summary);
}

struct KeptRun {
  PoseTrack poses;
  std::vector<vec2> sticks;  // the stick of each kept tick
};
KeptRun kept_run(const PreparedTrace& prepared) {
  KeptRun kept{PoseTrack(prepared.start, prepared.config.rate_hz, prepared.ticks), {}};
  run_through(prepared, [&kept](const Simulation& s) {
    kept.poses.add(s);
    if (kept.sticks.size() < kept.poses.kept()) kept.sticks.push_back(s.stick().left);
  });
  return kept;
}

std::string joint_text(const PoseChannel& channel, int characters) {
  if (channel.character == 0) return "the crowd";
  const std::string joint = channel.joint.empty() ? "the root" : printable(channel.joint);
  return characters > 1 ? fmt::format("{} of character {}", joint, channel.character) : joint;
}

std::string distance_text(const PoseChannel& channel, double distance) {
  if (channel.character == 0) return "";
  if (channel.joint.empty())
    return distance > 0.0 ? fmt::format(", by {:.4f} m", distance) : ", by less than 0.0002 m";
  return distance > 0.0 ? fmt::format(", by {:.2f} degrees", distance)
                        : ", by less than 0.02 degrees";
}

// The last report up to the tick, and the resulting stick.
std::string report_text(const PreparedTrace& prepared, std::size_t tick, const vec2& stick) {
  constexpr std::size_t kMostBytes = 32;
  const Trace& trace = prepared.trace;
  const TraceEvent* last = nullptr;
  int number = 0;
  for (const TraceEvent& event : trace.events) {
    if (event.tick > static_cast<std::int64_t>(tick)) break;
    if (event.kind != ReportKind::input) continue;
    last = &event;
    ++number;
  }
  if (last == nullptr) return "no report came before it";
  std::string bytes;
  for (std::size_t i = 0; i < std::min<std::size_t>(last->size, kMostBytes); ++i)
    bytes += fmt::format(" {:02x}", trace.bytes[last->first_byte + i]);
  const double at_s = static_cast<double>(last->time_us - trace.events.front().time_us) / 1e6;
  return fmt::format(
      "the report before it: number {} at {:.6f} s, used in tick {}:{}{}; the stick was at {:.3f} "
      "to the right, {:.3f} forward",
      number, at_s, last->tick, bytes, last->size > kMostBytes ? " ..." : "", stick.x, stick.y);
}

JointCurves curves_of(const PoseChannel& before, const PoseChannel& after, int rate_hz,
                      std::size_t ticks, std::size_t first_tick) {
  JointCurves curves;
  curves.is_angle = !before.joint.empty();
  curves.rate_hz = rate_hz;
  curves.first_tick = first_tick;
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    const vec3 a = shown_value(before, tick), b = shown_value(after, tick);
    for (int k = 0; k < 3; ++k) {
      curves.before[k].push_back(a[k]);
      curves.after[k].push_back(b[k]);
    }
    curves.distance.push_back(distance_of(before, after, tick));
  }
  return curves;
}

// Describes the first difference from the stored poses.
void find_difference(const CheckedTrace& trace, const Expectation& expectation,
                     const PreparedTrace& prepared, bool with_curves, CheckResult& result) {
  const auto say = [&result](std::string sentence) {
    result.details.push_back(std::move(sentence));
  };
  std::error_code ignored;
  if (!fs::exists(trace.poses(), ignored)) {
    say("no poses are kept beside the expectation, so the tick is not known; --update keeps them");
    return;
  }
  const auto bytes = file_text(trace.poses(), kMaxPosesBytes);
  if (!bytes) return say(bytes.error().message);
  const auto before = PoseTrack::parse(*bytes, trace.poses());
  if (!before) return say(before.error().message);
  if (before->pose_hash() != *expectation.pose_hash)
    return say("the poses that are kept are of another run than the expectation");
  const KeptRun run = kept_run(prepared);
  const auto found = difference(*before, run.poses);
  if (!found) return say(found.error().message);
  const std::size_t ticks = std::min(before->kept(), run.poses.kept());
  if (!*found) return say(fmt::format("the first {} ticks are the same", ticks));

  const std::vector<PoseChannel>& channels = before->channels();
  const int rate_hz = prepared.config.rate_hz;
  const int characters = static_cast<int>(prepared.config.walkers.size());
  const auto place_text = [&](const PoseDifference::Place& place) {
    const PoseChannel& channel = channels[place.channel];
    return fmt::format("tick {} ({:.3f} s): {}{}", place.tick,
                       static_cast<double>(place.tick) / rate_hz, joint_text(channel, characters),
                       distance_text(channel, place.distance));
  };
  const PoseDifference& d = **found;
  say(fmt::format("first different in {}{}", place_text(d.first),
                  d.others > 0 ? fmt::format("; {} more differ", d.others) : ""));
  say(report_text(prepared, d.first.tick, run.sticks[d.first.tick]));
  if (d.largest.distance > 0.0) say("most different in " + place_text(d.largest));
  if (!with_curves) return;
  result.curves = curves_of(channels[d.first.channel], run.poses.channels()[d.first.channel],
                            rate_hz, ticks, d.first.tick);
  result.curves->joint = joint_text(channels[d.first.channel], characters);
}

std::string unmet_text(std::size_t count) {
  return count == 1 ? "1 number is not met" : fmt::format("{} numbers are not met", count);
}

void judge(const Expectation& expectation, const Measured& measured, CheckResult& result) {
  const std::vector<std::string> unmet = unmet_numbers(expectation, measured);
  const bool is_same = !expectation.pose_hash || *expectation.pose_hash == measured.pose_hash;
  result.is_met = is_same && unmet.empty();
  if (result.is_met) {
    result.verdict = "met";
  } else if (is_same) {
    result.verdict = unmet_text(unmet.size());
  } else if (unmet.empty()) {
    result.verdict =
        "another version of the walk: the poses differ and every number is met; --update takes "
        "it over";
  } else {
    result.verdict = "the poses differ and " + unmet_text(unmet.size());
  }
  result.details = unmet;
  if (is_same) return;
  result.details.push_back(fmt::format("pose_hash is {}, expected {}",
                                       hash_text(measured.pose_hash),
                                       hash_text(*expectation.pose_hash)));
}

// Files of the replay, the recording first. `folders`: of configuration.
Result<std::vector<ExpectedFile>> files_of(const CheckedTrace& trace, const PreparedTrace& prepared,
                                           const std::vector<std::string>& folders) {
  const fs::path own = fs::absolute(trace.path).lexically_normal().parent_path();
  const auto name_of = [&](const std::string& path) {
    const std::string name = name_in_folders(path, folders);
    if (!name.empty()) return "config/" + name;
    return fs::absolute(path).lexically_normal().lexically_relative(own).string();
  };
  const auto recording = file_text(trace.recording(), kMaxTraceBytes);
  if (!recording) return recording.error();
  std::vector<ExpectedFile> files = {{name_of(trace.recording()), bytes_hash(*recording)}};
  for (const UsedFile& file : prepared.used_files) {
    const std::string name = name_of(file.path);
    if (std::ranges::count(files, name, &ExpectedFile::name) == 0)
      files.push_back({name, file.hash});
  }
  return files;
}

// Puts these sentences first in a failed result.
void blame_files(std::vector<std::string> sentences, CheckResult& result) {
  if (result.is_met || sentences.empty()) return;
  sentences.push_back(std::exchange(result.verdict, sentences.front()));
  result.details.insert(result.details.begin(), sentences.begin() + 1, sentences.end());
}

// True if the stored poses are those of the expectation, or if none are wanted.
bool has_poses(const CheckedTrace& trace, const Expectation& expectation) {
  if (!expectation.keeps_poses || !expectation.pose_hash) return true;
  const auto bytes = file_text(trace.poses(), kMaxPosesBytes);
  const auto poses = bytes ? PoseTrack::parse(*bytes, trace.poses()) : bytes.error();
  return poses && poses->pose_hash() == *expectation.pose_hash;
}

std::optional<Error> update(const CheckedTrace& trace, const Expectation& before,
                            const Measured& measured, const PreparedTrace& prepared,
                            const std::vector<ExpectedFile>& files, CheckResult& result) {
  const bool is_met = result.is_met && !before.is_empty();
  if (is_met && before.files == files && has_poses(trace, before)) {
    result.verdict = "unchanged";
    return std::nullopt;
  }
  Expectation after = is_met ? before : renewed(before, measured);
  after.files = files;
  if (after.keeps_poses && after.pose_hash) {
    if (auto problem = write_file(trace.poses(), kept_run(prepared).poses.bytes())) return problem;
  } else {
    std::error_code ignored;
    fs::remove(trace.poses(), ignored);
  }
  if (auto problem = write_file(trace.expectation(), expectation_text(after))) return problem;
  result.verdict = before.is_empty() ? "written" : "renewed";
  result.details = changes(before, after);
  const std::vector<std::string> changed = changed_files(before, files);
  result.details.insert(result.details.begin(), changed.begin(), changed.end());
  result.is_met = true;
  return std::nullopt;
}

std::optional<Error> check(const CheckedTrace& trace, const CheckOptions& options, SetUps& set_ups,
                           CheckResult& result) {
  std::error_code ignored;
  Expectation expectation;
  if (fs::exists(trace.expectation(), ignored)) {
    const auto text = file_text(trace.expectation(), kMaxTomlBytes);
    if (!text) return text.error();
    auto parsed = parsed_expectation(*text, trace.expectation());
    if (!parsed) return parsed.error();
    expectation = std::move(*parsed);
  } else if (!options.updates) {
    return Error{trace.recording() + ": has no expectation beside it; --update writes one"};
  }
  if (expectation.is_empty() && !options.updates)
    return Error{trace.expectation() + ": expects nothing yet; --update fills it in"};
  SessionSpec session =
      session_of(expectation, fs::path(trace.path).parent_path().string(), trace.recording());
  session.config_folders = options.config_folders;
  session.replay.max_hours = options.max_hours;
  session.replay.user_styles = options.user_styles;
  auto prepared = prepared_trace(session, set_ups);
  if (!prepared) return prepared.error();
  const auto files = files_of(trace, *prepared, options.config_folders);
  if (!files) return files.error();
  const Measured measured = measured_run(*prepared);
  judge(expectation, measured, result);
  CheckResult first_difference;  // found before an update replaces the stored poses
  if (expectation.pose_hash && *expectation.pose_hash != measured.pose_hash)
    find_difference(trace, expectation, *prepared, options.with_curves, first_difference);
  if (options.updates) {
    if (auto problem = update(trace, expectation, measured, *prepared, *files, result))
      return problem;
  }
  result.curves = std::move(first_difference.curves);
  result.details.insert(result.details.end(), first_difference.details.begin(),
                        first_difference.details.end());
  const std::vector<std::string>& remarks = prepared->config.remarks;
  result.details.insert(result.details.end(), remarks.begin(), remarks.end());
  blame_files(changed_files(expectation, *files), result);
  return std::nullopt;
}

CheckResult checked(const CheckedTrace& trace, const CheckOptions& options, SetUps& set_ups) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  CheckResult result;
  if (auto problem = check(trace, options, set_ups, result)) {
    result = {};
    result.verdict = problem->message;
  }
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return result;
}

}  // namespace

void check_all(const std::vector<CheckedTrace>& traces, const CheckOptions& options, int threads,
               const std::function<void(std::size_t, CheckResult&&)>& take) {
  std::atomic<std::size_t> next{0};
  std::mutex mutex;
  std::vector<std::optional<CheckResult>> waiting(traces.size());
  std::size_t taken = 0;
  std::exception_ptr thrown;  // an exception of `take` (a full disk), which the caller gets
  const auto work = [&] {
    SetUps set_ups;
    for (std::size_t i; (i = next.fetch_add(1)) < traces.size();) {
      CheckResult result = checked(traces[i], options, set_ups);
      const std::lock_guard lock(mutex);
      waiting[i] = std::move(result);
      try {
        for (; !thrown && taken < traces.size() && waiting[taken]; ++taken) {
          take(taken, std::move(*waiting[taken]));
          waiting[taken].reset();
        }
      } catch (...) {
        thrown = std::current_exception();
        next = traces.size();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (int i = startable_threads(threads); i > 1; --i) others.emplace_back(work);
    work();
  }
  if (thrown) std::rethrow_exception(thrown);
}

std::optional<Shard> parse_shard(std::string_view text) {
  constexpr int kMaxShards = 100'000;
  Shard shard;
  shard.index = parse_number<int>(take_part(text, '/')).value_or(0);
  shard.total = parse_number<int>(text).value_or(0);
  const bool is_sound = shard.index >= 1 && shard.index <= shard.total && shard.total <= kMaxShards;
  return is_sound ? std::optional(shard) : std::nullopt;
}

std::vector<CheckedTrace> part_of(const std::vector<CheckedTrace>& traces, const Shard& shard) {
  std::vector<CheckedTrace> part;
  for (std::size_t i = shard.index - 1; i < traces.size(); i += shard.total)
    part.push_back(traces[i]);
  return part;
}

std::string picture_path(const std::string& folder, const CheckedTrace& trace) {
  std::filesystem::path place = folder;
  for (const std::filesystem::path& part : std::filesystem::path(trace.path).lexically_normal()) {
    if (part != ".." && part != "." && !part.is_absolute()) place /= part;
  }
  return place.string() + ".png";
}

}  // namespace gaitpad
