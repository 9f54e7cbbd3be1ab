// gaitpad play [PAD]: a live pad walks characters, so far without a window.
#include <fmt/format.h>

#include <memory>

#include "session/live.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/live_run.h"
#include "tools/gaitpad/pad_options.h"
#include "tools/gaitpad/session_options.h"

namespace gaitpad {
namespace {

constexpr std::chrono::milliseconds kLook{50};  // how often the session is looked at

struct PlayArguments {
  SessionArguments session;
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
void run_session(const PlayArguments& arguments, int rate_hz, RunEnd& end, LiveSession& session) {
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

int run(const PlayArguments& arguments) {
  if (!arguments.no_window) {
    return fail("the window comes with a later version; --no-window walks without it");
  }
  RunEnd end;
  const LiveOptions options = live_options(arguments);
  auto session = LiveSession::start(options);
  if (!session) return fail(session.error().message);
  end.end_after(arguments.seconds);
  run_session(arguments, options.rate_hz, end, **session);
  auto summaries = (*session)->stop();
  print_remarks("play", (*session)->take_remarks());
  if (!summaries) return fail(summaries.error().message);
  const LiveStatus status = (*session)->status();
  for (nlohmann::ordered_json& summary : *summaries) add_status(status, summary);
  if (arguments.json) {
    print_summaries_json(*summaries);
  } else {
    print_text(arguments, status, *summaries);
  }
  return 0;
}

}  // namespace

void add_play(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("play", "walks characters by a live pad");
  const auto arguments = std::make_shared<PlayArguments>();
  add_pad_options(*command, arguments->wish);
  command->add_flag("--no-window", arguments->no_window,
                    "walk without a window (there is none yet)");
  command->add_option("--record", arguments->record, "write the session to this file (.hid)");
  add_seconds_option(*command, arguments->seconds);
  command->add_flag("--no-rumble", arguments->no_rumble, "no beat at each heel strike");
  command->add_flag("--commands", arguments->takes_commands,
                    "lines of standard input are commands, such as `style limp_left`");
  add_session_options(*command, arguments->session, std::to_string(kDefaultRateHz));
  command->add_flag("--json", arguments->json, "the summary, for machines");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
