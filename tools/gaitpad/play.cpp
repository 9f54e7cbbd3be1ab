// gaitpad play [PAD]: a live pad walks characters, in a window or without one.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "gaitpad/live.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/live_run.h"
#include "tools/gaitpad/pad_options.h"
#include "tools/gaitpad/session_options.h"
#include "tools/gaitpad/window_options.h"
#include "view/show.h"

namespace gaitpad {
namespace {

constexpr std::chrono::milliseconds kLook{50};  // how often the session is looked at

struct PlayArguments {
  SessionArguments session;
  WindowArguments window;
  PadWish wish;
  std::string record;
  double seconds = 0.0;
  bool no_window = false, no_rumble = false, json = false, takes_commands = false;
};

int fail(const std::string& sentence) {
  fmt::print(stderr, "gaitpad play: {}\n", sentence);
  return 1;
}

LiveOptions live_options(const PlayArguments& arguments) {
  LiveOptions options;
  options.session = session_options(arguments.session);
  options.wish = arguments.wish;
  if (arguments.session.rate_hz > 0) options.rate_hz = arguments.session.rate_hz;
  options.record = arguments.record;
  options.rumble = !arguments.no_rumble;
  return options;
}

std::string status_text(const LiveStatus& status, const SessionFrame& frame, int rate_hz) {
  const PadStreamCounts& pads = status.pads;
  return fmt::format(
      "{:.1f} s  pads {}  stick {:+.2f} {:+.2f}  reports {}  lost {}  tick {:.0f} us  wait {:.0f} "
      "us"
      "  overruns {}",
      static_cast<double>(status.ticks) / rate_hz, pads.plugged - pads.unplugged,
      frame.stick.left.x, frame.stick.left.y, pads.reports, pads.lost, status.tick_us_median,
      status.wait_us_median, status.overruns);
}

// Until the end, the recording's or the user's.
void walk_unseen(const PlayArguments& arguments, int rate_hz, RunEnd& end, LiveSession& session) {
  StatusLine line(2);
  MissingPad missing("play", arguments.wish);
  InputLines input;
  while (!end.is_reached() && !session.has_ended()) {
    print_remarks("play", session.take_remarks(), &line);
    missing.look(session.status().pads.plugged, line);
    if (arguments.takes_commands) {
      for (const std::string& command : input.take()) session.command(command);
    }
    bool is_new = false;
    if (line.is_terminal())
      line.show(status_text(session.status(), session.latest(is_new), rate_hz));
    const pollfd stdin_fd = input.fd();
    end.wait(kLook, std::span(&stdin_fd, arguments.takes_commands ? 1 : 0));
  }
  missing.finish(session.status().pads.plugged, line);
}

void print_text(const PlayArguments& arguments, const LiveStatus& status,
                const std::vector<nlohmann::ordered_json>& summaries) {
  print_session(arguments.record.empty() ? "live" : arguments.record, summaries.front());
  for (std::size_t i = 0; i < summaries.size(); ++i) print_character(i, summaries[i], -1.0);
  fmt::print(
      "a tick takes {:.0f} us (at most {:.0f}), a report waits {:.0f} us for it (at most {:.0f}); "
      "{} ticks were late, {} reports lost\n",
      status.tick_us_median, status.tick_us_max, status.wait_us_median, status.wait_us_max,
      status.overruns, status.pads.lost);
}

void print_result(const PlayArguments& arguments, const LiveStatus& status,
                  std::vector<nlohmann::ordered_json> summaries) {
  for (nlohmann::ordered_json& summary : summaries) add_status(status, summary);
  if (arguments.json) {
    print_summaries_json(summaries);
  } else if (!summaries.empty()) {
    print_text(arguments, status, summaries);
  }
}

int run_without_window(const PlayArguments& arguments) {
  RunEnd end;
  const LiveOptions options = live_options(arguments);
  auto session = LiveSession::start(options);
  if (!session) return fail(session.error().message);
  end.end_after(arguments.seconds);
  walk_unseen(arguments, options.rate_hz, end, **session);
  auto summaries = (*session)->stop();
  print_remarks("play", (*session)->take_remarks());
  if (!summaries) return fail(summaries.error().message);
  print_result(arguments, (*session)->status(), std::move(*summaries));
  return 0;
}

// The paper's demonstration: four ways to walk on the same stick.
void take_default_cast(SessionOptions& session) {
  if (session.characters.empty() && session.styles.empty())
    session.styles = {"even", "stiff_hip", "stiff_knee", "limp_left"};
}

// Pictures of a recording are made of its exact course, not of its times.
bool is_playback(const PlayArguments& arguments) {
  return makes_pictures(arguments.window) && is_recording(arguments.wish.pad);
}

WindowOptions options_of_window(const PlayArguments& arguments, RunEnd& end, InputLines& input) {
  const bool has_end =
      arguments.window.frames > 0 || arguments.seconds > 0.0 || is_playback(arguments);
  WindowOptions options = window_options(arguments.window, has_end);
  options.live = live_options(arguments);
  take_default_cast(options.live.session);
  options.is_trace_rate_given = arguments.session.rate_hz > 0;
  if (is_playback(arguments)) options.trace = arguments.wish.pad;
  if (makes_pictures(arguments.window) && options.frames == 0 && arguments.seconds > 0.0)
    options.frames = static_cast<int>(std::clamp(arguments.seconds * kPictureRateHz, 1.0, 1e8));
  options.is_ended_from_outside = [&end] { return end.is_reached(); };
  if (arguments.takes_commands) options.take_commands = [&input] { return input.take(); };
  return options;
}

int run_with_window(const PlayArguments& arguments) {
  RunEnd end;
  InputLines input;
  if (!makes_pictures(arguments.window)) end.end_after(arguments.seconds);
  auto result = run_window(options_of_window(arguments, end, input));
  if (!result) return fail(result.error().message);
  print_remarks("play", result->remarks);
  for (nlohmann::ordered_json& summary : result->summaries) {
    summary["frames"] = result->frames;
    summary["frames_per_second"] = result->frames_per_second;
  }
  if (result->status) {
    print_result(arguments, *result->status, std::move(result->summaries));
  } else if (arguments.json) {
    print_summaries_json(result->summaries);
  }
  return 0;
}

}  // namespace

void add_play(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("play", "walks characters by a live pad");
  const auto arguments = std::make_shared<PlayArguments>();
  add_pad_options(*command, arguments->wish);
  auto* no_window =
      command->add_flag("--no-window", arguments->no_window,
                        "walk without a window: one character, unless more are given");
  command->add_option("--record", arguments->record, "write the session to this file (.hid)");
  add_seconds_option(*command, arguments->seconds);
  command->add_flag("--no-rumble", arguments->no_rumble, "no beat at each heel strike");
  command->add_flag("--commands", arguments->takes_commands,
                    "lines of standard input are commands, such as `style limp_left`");
  add_session_options(*command, arguments->session, std::to_string(kDefaultRateHz));
  command->add_flag("--json", arguments->json, "the summary, for machines");
  for (CLI::Option* option : add_window_options(*command, arguments->window))
    option->excludes(no_window);
  command->callback([arguments, &status] {
    if (is_playback(*arguments) && !arguments->record.empty())
      throw CLI::ValidationError("--record", "pictures of a recording are nothing to record");
    status = arguments->no_window ? run_without_window(*arguments) : run_with_window(*arguments);
  });
}

}  // namespace gaitpad
