// gaitpad play [PAD]: a live pad walks characters, in a window or without one.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/shown_number.h"
#include "gaitpad/live.h"
#include "session/walk_export.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"
#include "tools/gaitpad/window_options.h"
#ifdef GAITPAD_HAS_WINDOW
#include "session/show.h"
#include "system/whole_file.h"
#endif

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

constexpr const char* kPlayCommand = "play";
// Time between two status lines of a session without a window.
constexpr std::chrono::milliseconds kLook{50};

struct PlayArguments {
  SessionSpec spec;
  WindowArguments window;
  double seconds = 0.0;
  std::string report_times;  // path of the file for --report-times; empty: none
  bool no_window = false, no_rumble = false, json = false, takes_commands = false;
};

std::string status_text(const LiveStatus& status, const TickSample& last, int rate_hz) {
  const PadStreamCounts& pads = status.pads;
  return fmt::format(
      "{:.1f} s  pads {}  stick {} {}  reports {}  lost {}  tick {:.0f} us  wait {:.0f} "
      "us"
      "  overruns {}",
      static_cast<double>(status.ticks) / rate_hz, pads.plugged - pads.unplugged,
      signed_number(last.stick_x, 2), signed_number(last.stick_y, 2), pads.reports, pads.lost,
      status.tick_us_median, status.wait_us_median, status.overruns);
}

// A file with a row for each input report: its arrival, and the begin of the tick that used it. The
// file appears when it is complete.
class ReportTimes {
 public:
  // An empty path: no file.
  static Result<ReportTimes> open(const std::string& path) {
    ReportTimes times;
    if (path.empty()) return times;
    auto file = NewFile::create(path);
    if (!file) return file.error();
    times.file_.emplace(std::move(*file));
    times.problem_ = times.file_->write("tick,device,arrival_ns,begin_ns\n");
    return times;
  }
  void write(LiveSession& session) {
    std::string rows;
    for (ReportTime time; file_ && session.take_report_time(time);)
      rows += fmt::format("{},{},{},{}\n", time.tick, time.device, time.arrival_ns, time.begin_ns);
    if (!rows.empty() && !problem_) problem_ = file_->write(rows);
  }
  // Names the file. Error: it could not be written.
  std::optional<Error> finish() {
    if (file_ && !problem_) problem_ = file_->publish();
    return problem_;
  }

 private:
  std::optional<NewFile> file_;
  std::optional<Error> problem_;  // the first failure
};

// Runs until the recording or the user ends it.
void walk_without_window(const PlayArguments& arguments, RunEnd& end, LiveSession& session,
                         ReportTimes& times) {
  StatusLine line(2);
  MissingPad missing(kPlayCommand, arguments.spec.pad.selector);
  const int rate_hz = session.cast().rate_hz;
  InputLines input;
  TickSample last;
  while (!end.is_reached() && !session.has_ended()) {
    print_remarks(kPlayCommand, session.take_remarks(), &line);
    missing.look(session.status().pads.plugged, line);
    if (arguments.takes_commands) {
      for (const std::string& command : input.take_lines()) session.command(command);
    }
    times.write(session);
    while (session.take_sample(last)) {
    }
    if (line.is_terminal()) line.show(status_text(session.status(), last, rate_hz));
    const pollfd stdin_fd = input.fd();
    end.wait(kLook, std::span(&stdin_fd, arguments.takes_commands ? 1 : 0));
  }
  missing.finish(session.status().pads.plugged, line);
}

void print_text(const PlayArguments& arguments, const LiveStatus& status, const RunSummary& run) {
  const std::string& record = arguments.spec.live.record;
  print_session(record.empty() ? "live" : record, run);
  for (std::size_t i = 0; i < run.walkers.size(); ++i) print_character(run, i, Way::left_out);
  say("a tick takes {:.0f} us (at most {:.0f}), a report waits {:.0f} us for it (at most {:.0f}); "
      "{} ticks were late, {} reports lost\n",
      status.tick_us_median, status.tick_us_max, status.wait_us_median, status.wait_us_max,
      status.overruns, status.pads.lost);
  if (status.frame_us_p99 > 0.0) {
    say("from the stick to the frame: {:.1f} ms (99 of 100 within {:.1f} ms)\n",
        status.frame_us_p50 / 1000.0, status.frame_us_p99 / 1000.0);
  }
}

void add_status(const LiveStatus& status, ordered_json& summary) {
  summary["time_s"] = status.time_s;
  summary["time_policy"] = status.time_policy;
  summary["overruns"] = status.overruns;
  summary["standstills"] = status.standstills;
  summary["overloads"] = status.overloads;
  summary["skipped_s"] = status.skipped_s;
  summary["late_us_median"] = status.late_us_median;
  summary["late_us_max"] = status.late_us_max;
  summary["tick_us_median"] = status.tick_us_median;
  summary["tick_us_max"] = status.tick_us_max;
  summary["wait_us_median"] = status.wait_us_median;
  summary["wait_us_max"] = status.wait_us_max;
  summary["frame_us_p50"] = status.frame_us_p50;
  summary["frame_us_p99"] = status.frame_us_p99;
  summary["lost"] = status.pads.lost;
  summary["plugged"] = status.pads.plugged;
  summary["unplugged"] = status.pads.unplugged;
  summary["recording_lost"] = status.recording_lost;
  summary["streamed"] = status.streamed;
}

// The exit status: 1 if the requested pad never came or a command was invalid.
int status_of(const PlayArguments& arguments, const LiveStatus& status, const RunSummary& run) {
  const bool is_alone = is_choosy(arguments.spec.pad.selector) && status.pads.plugged == 0;
  const std::int64_t wrong = run.bad_commands + status.pads.commands_left_out;
  const bool is_wrong = arguments.takes_commands && wrong > 0;
  if (is_wrong)
    print_remarks(kPlayCommand, {fmt::format("{} commands could not be obeyed", wrong)});
  return is_alone || is_wrong ? 1 : 0;
}

int run_without_window(const PlayArguments& arguments) {
  RunEnd end;
  auto times = ReportTimes::open(arguments.report_times);
  if (!times) return fail(kPlayCommand, times.error().message);
  SessionSpec unseen = arguments.spec;
  unseen.walk.shows_crowd = false;
  unseen.live.frame_ticks = 0;
  auto session = LiveSession::start(unseen);
  if (!session) return fail(kPlayCommand, session.error().message);
  end.end_after(arguments.seconds);
  walk_without_window(arguments, end, **session, *times);
  const auto run = (*session)->stop();
  times->write(**session);
  print_remarks(kPlayCommand, (*session)->take_remarks());
  if (!run) return fail(kPlayCommand, run.error().message);
  if (const auto problem = times->finish()) return fail(kPlayCommand, problem->message);
  const LiveStatus status = (*session)->status();
  if (arguments.json) {
    std::vector<ordered_json> summaries;
    for (std::size_t i = 0; i < run->walkers.size(); ++i)
      add_status(status, summaries.emplace_back(summary_json(*run, i)));
    print_json(one_or_list(summaries));
  } else {
    print_text(arguments, status, *run);
  }
  return status_of(arguments, status, *run);
}

// True for pictures of a recording: they show its exact walk, independent of the clock.
bool is_playback(const PlayArguments& arguments) {
  return makes_pictures(arguments.window) && is_recording(arguments.spec.pad.selector.pad);
}

#ifdef GAITPAD_HAS_WINDOW

// The paper's demonstration: four ways to walk on the same stick.
void take_default_cast(SessionSpec::Walk& walk) {
  if (walk.characters.empty() && walk.styles.empty())
    walk.styles = {"even", "stiff_hip", "stiff_knee", "limp_left"};
}

WindowOptions options_of_window(const PlayArguments& arguments, InputLines& input) {
  const bool has_end =
      arguments.window.frames > 0 || arguments.seconds > 0.0 || is_playback(arguments);
  WindowOptions options = window_options(arguments.window, has_end);
  options.session = arguments.spec;
  take_default_cast(options.session.walk);
  if (is_playback(arguments)) options.session.replay.trace = arguments.spec.pad.selector.pad;
  if (makes_pictures(arguments.window) && options.frames == 0 && arguments.seconds > 0.0)
    options.frames = static_cast<int>(std::clamp(arguments.seconds * kPictureRateHz, 1.0, 1e8));
  if (arguments.takes_commands) options.take_commands = [&input] { return input.take_lines(); };
  return options;
}

// The program's start, from which the time to the first frame counts. Initialised before main(),
// after the libraries are loaded.
const std::int64_t kStarted_ns = now_ns();

// The summary of a playback in the window, with the keys that are known for it.
ordered_json playback_json(const RunSummary& run, std::size_t walker) {
  return {{"ticks", run.ticks},
          {"rate_hz", run.rate_hz},
          {"pose_hash", fmt::format("{:016x}", run.pose_hash)},
          {"motion", run.motion},
          {"character", run.walkers[walker].character}};
}

void print_window_json(const WindowResult& result) {
  std::vector<ordered_json> summaries;
  for (std::size_t i = 0; i < result.summary.walkers.size(); ++i) {
    ordered_json& summary = summaries.emplace_back(
        result.status ? summary_json(result.summary, i) : playback_json(result.summary, i));
    summary["frames"] = result.frames;
    summary["frames_per_second"] = result.frames_per_second;
    summary["first_frame_s"] = 1e-9 * static_cast<double>(result.first_frame_ns - kStarted_ns);
    if (result.status) add_status(*result.status, summary);
  }
  print_json(one_or_list(summaries));
}

int run_with_window(const PlayArguments& arguments) {
  RunEnd end;
  InputLines input;
  if (!makes_pictures(arguments.window)) end.end_after(arguments.seconds);
  WindowResult result;
  if (const int status =
          show_window(kPlayCommand, options_of_window(arguments, input), end, result))
    return status;
  if (arguments.json) {
    print_window_json(result);
  } else if (result.status && !result.summary.walkers.empty()) {
    print_text(arguments, *result.status, result.summary);
  }
  if (!result.status) return 0;
  StatusLine line(2);
  if (const PadSelector& selector = arguments.spec.pad.selector; is_choosy(selector))
    MissingPad(kPlayCommand, selector).finish(result.status->pads.plugged, line);
  return status_of(arguments, *result.status, result.summary);
}

#endif

int run(PlayArguments& arguments) {
  arguments.spec.live.rumble = !arguments.no_rumble;
#ifdef GAITPAD_HAS_WINDOW
  if (!arguments.no_window) return run_with_window(arguments);
#endif
  return run_without_window(arguments);
}

}  // namespace

void add_play(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("play", "walks characters by a live pad");
  const auto arguments = std::make_shared<PlayArguments>();
  add_pad_options(*command, arguments->spec.pad.selector);
  auto* no_window =
      command->add_flag("--no-window", arguments->no_window,
                        "walk without a window: one character, unless more are given");
  command->add_option("--record", arguments->spec.live.record,
                      "write the session to this file (.hid)");
  add_seconds_option(*command, arguments->seconds);
  command->add_flag("--no-rumble", arguments->no_rumble, "do not rumble at heel strikes");
  command->add_flag(
      "--forward", arguments->spec.live.forward,
      "make a virtual pad with the calibrated sticks for other programs (/dev/uinput)");
  command->add_flag("--commands", arguments->takes_commands,
                    "read commands such as `style limp_left` from standard input, one a line");
  auto* stream = command->add_option(
      "--stream", arguments->spec.live.stream,
      "send the poses to other programs: osc://HOST:PORT (VMC) or json://HOST:PORT; each further "
      "character uses the next port (default: 127.0.0.1, 39539 or 39540)");
  command
      ->add_option("--stream-fps", arguments->spec.live.stream_fps, "poses a second (default: 60)")
      ->check(CLI::Range(1, 1000))
      ->needs(stream);
  add_session_options(*command, arguments->spec, std::to_string(kDefaultRateHz));
  command
      ->add_option("--report-times", arguments->report_times,
                   "write the arrival of each report and the begin of its tick to this file (.csv)")
      ->needs(no_window);
  command->add_flag("--json", arguments->json, "print the summary as JSON");
  for (CLI::Option* option : add_window_options(*command, arguments->window))
    option->excludes(no_window);
  command->callback([arguments, &status] {
    if (is_playback(*arguments) && !arguments->spec.live.record.empty())
      throw CLI::ValidationError("--record", "pictures of a recording are nothing to record");
    status = run(*arguments);
  });
}

}  // namespace gaitpad
