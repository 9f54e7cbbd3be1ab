// gaitpad: one program with sub-commands. main() parses; the commands do the work.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/suggestion.h"
#include "base/text.h"
#include "gaitpad/driver_registry.h"
#include "terminal/terminal.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace {

constexpr int kFailed = 1;

struct Example {
  const char* command;
  const char* lines;  // example command lines, each beginning with the command
};
constexpr Example kExamples[] = {
    {"play",
     "gaitpad play\n"
     "gaitpad play --character child --style limp_left --record mine.hid\n"
     "gaitpad play --terrain stairs\n"},
    {"replay",
     "gaitpad replay mine.hid --out out\n"
     "gaitpad replay mine.hid --style tired --terrain stairs --out out --gltf\n"
     "gaitpad replay mine.hid --view\n"
     "gaitpad replay walks/*.hid --out out\n"},
    {"record", "gaitpad record --out mine.hid --seconds 20\n"},
    {"pads", "gaitpad pads\n"},
    {"doctor", "gaitpad doctor\nsudo gaitpad doctor --install-rules\n"},
    {"decode", "gaitpad decode mine.hid --descriptor\ngaitpad decode /dev/hidraw0\n"},
    {"monitor", "gaitpad monitor\n"},
    {"calibrate", "gaitpad calibrate\ngaitpad calibrate --trace mine.hid --out mine.toml\n"},
    {"forward", "gaitpad forward\ngaitpad forward --as xbox360 --install\n"},
    {"motion", "gaitpad motion keyframe_walk\ngaitpad motion walk.bvh --json\n"},
    {"ik", "gaitpad ik chain.toml --mode paper\n"},
    {"figures", "gaitpad figures --out figures\n"},
    {"bench", "gaitpad bench\ngaitpad bench --plot cost.png\n"},
    {"selftest", "gaitpad selftest\n"},
    {"map", "gaitpad map\ngaitpad map 0810:0001\n"},
    {"list", "gaitpad list\ngaitpad list styles\n"},
};

// Appends examples to each command's footer.
void add_examples(CLI::App& app) {
  for (const Example& example : kExamples) {
    CLI::App* command = app.get_subcommand(example.command);
    std::string text = command->get_footer();
    if (!text.empty()) text += "\n";
    text += "Examples:\n";
    for (std::string_view rest = example.lines; !rest.empty();)
      text += fmt::format("  {}\n", gaitpad::take_line(rest));
    text.pop_back();
    command->footer(text);
  }
}

std::vector<std::string> command_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands(nullptr)) names.push_back(command->get_name());
  return names;
}

// Treats `gaitpad help [COMMAND]` as `gaitpad [COMMAND] --help`, and `gaitpad` alone as `gaitpad
// --help`. An unknown command gives the usual error.
std::vector<std::string> arguments_of(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  if (words.empty()) return {"--help"};
  if (words.front() != "help") return words;
  words.erase(words.begin());
  const std::vector<std::string> names = command_names(app);
  if (words.empty() || std::ranges::count(names, words.front()) > 0) words.emplace_back("--help");
  return words;
}

// Names the unknown command, else the first unknown option, else the first unexpected word, and
// suggests a similar name.
std::string unexpected(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  const std::vector<std::string> words = app.remaining(true);
  const auto option = std::ranges::find_if(
      words, [](const std::string& word) { return word.size() > 1 && word.starts_with('-'); });
  if (chosen.empty() && !words.empty() && option != words.begin()) {
    std::string meant = gaitpad::suggestion(words.front(), command_names(app));
    if (meant.empty())
      meant = fmt::format("; known: {}, help", fmt::join(command_names(app), ", "));
    return fmt::format("gaitpad: unknown command {}{}", gaitpad::in_quotes(words.front()), meant);
  }
  const CLI::App& command = chosen.empty() ? app : *chosen.front();
  const std::string name = chosen.empty() ? "gaitpad" : "gaitpad " + command.get_name();
  if (option == words.end())
    return fmt::format("{}: unexpected argument {}", name, gaitpad::in_quotes(words.front()));
  std::vector<std::string> known;
  for (const CLI::Option* o : command.get_options()) {
    for (const std::string& long_name : o->get_lnames()) known.push_back("--" + long_name);
  }
  const std::string word = option->substr(0, option->find('='));
  return fmt::format("{}: unknown option {}{}", name, gaitpad::in_quotes(word),
                     gaitpad::suggestion(word, known));
}

// Handles `gaitpad __complete WORD...` and `gaitpad __manual FOLDER`, for completions and packages.
// Returns the exit status; nothing if the arguments are others.
std::optional<int> answer_shell(const CLI::App& app, int argc, char** argv) {
  const std::string_view asked = argc > 1 ? argv[1] : "";
  if (asked == "__complete") {
    gaitpad::print_completions(app, {argv + 2, argv + argc});
    return 0;
  }
  if (asked != "__manual" || argc != 3) return std::nullopt;
  const auto problem = gaitpad::write_manual(app, argv[2]);
  return problem ? gaitpad::fail("__manual", problem->message) : 0;
}

// Prints help and version on standard output, wrong usage on standard error. The text may quote
// arguments.
int tell(const CLI::App& app, const CLI::ParseError& error) {
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    gaitpad::warn(unexpected(app) + "\nRun with --help for more information.\n");
    return gaitpad::kWrongUsage;
  }
  std::ostringstream help, usage;
  const bool is_done = app.exit(error, help, usage) == 0;
  gaitpad::say(stdout, gaitpad::printable_lines(help.str()));
  gaitpad::warn(gaitpad::printable_lines(usage.str()));
  if (!is_done) return gaitpad::kWrongUsage;
  return 0;
}

// Adds the commands with their examples. The chosen command sets `status`.
void add_commands(CLI::App& app, int& status) {
  gaitpad::add_play(app, status);
  gaitpad::add_replay(app, status);
  gaitpad::add_record(app, status);
  gaitpad::add_pads(app, status);
  gaitpad::add_doctor(app, status);
  gaitpad::add_decode(app, status);
  gaitpad::add_monitor(app, status);
  gaitpad::add_calibrate(app, status);
  gaitpad::add_forward(app, status);
  gaitpad::add_selftest(app, status);
  gaitpad::add_motion(app, status);
  gaitpad::add_ik(app, status);
  gaitpad::add_figures(app, status);
  gaitpad::add_bench(app, status);
  gaitpad::add_check(app, status);
  gaitpad::add_list(app, status);
  gaitpad::add_map(app, status);
  add_examples(app);
  // Set the footer last: commands that are added later would inherit it.
  app.footer(
      "gaitpad help COMMAND explains a command. Exit status: 0 done, 1 failed, 2 wrong usage,\n"
      "128 and the signal's number for work that Ctrl-C cut off.\n"
      "Examples:\n"
      "  gaitpad play                            walk with a pad, or with W A S D\n"
      "  gaitpad replay mine.hid --out out       a recording becomes BVH, CSV and JSON\n"
      "  gaitpad list styles                     the ways to walk\n"
      "  gaitpad doctor                          why a pad does not work");
}

bool is_flushed() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A physical gamepad walks a motion-captured character.", "gaitpad");
  app.set_version_flag("--version", "gaitpad " GAITPAD_VERSION);
  gaitpad::hold_standard_descriptors();
  std::signal(SIGXFSZ, SIG_IGN);  // writing beyond the size limit is an ordinary write error
  int status = 0;
  bool is_written = true;
  add_commands(app, status);
  std::vector<std::string> words = arguments_of(app, argc, argv);
  if (const std::string problem = gaitpad::config_problem(); !problem.empty()) {
    gaitpad::warn(fmt::format("gaitpad: {}\n", problem));
    return kFailed;
  }
  std::ranges::reverse(words);  // CLI11 expects them reversed
  try {
    if (const auto answered = answer_shell(app, argc, argv)) return *answered;
    app.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    try {
      status = tell(app, error);
    } catch (const std::system_error&) {
      is_written = false;
    }
    // An exception of a command, for example by fmt::print on a full disk.
  } catch (const std::system_error& error) {
    if (error.code() == std::errc::resource_unavailable_try_again) {
      gaitpad::warn(fmt::format("gaitpad: no thread can be started: {}\n", error.code().message()));
      return kFailed;
    }
    is_written = false;
  }
  if (is_written && is_flushed()) return status;
  gaitpad::warn("gaitpad: standard output cannot be written\n");
  return kFailed;
}
