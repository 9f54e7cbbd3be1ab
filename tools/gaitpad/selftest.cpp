// gaitpad selftest [PAD]: guides a user with a real pad through all tests of it, and writes a
// folder with the results.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "gaitpad/pad_configuration.h"
#include "selftest/self_test.h"
#include "terminal/terminal.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

constexpr const char* kCommand = "selftest";
constexpr std::size_t kBarCells = 20;
constexpr std::int64_t kSelfTestRewriteNs = 50'000'000;

struct SelfTestArguments {
  SelfTestOptions options;
  bool as_json = false;
};

// Shows prompts on standard error, in place on a terminal, else line by line; reads keys from
// standard input.
class TerminalPerson final : public SelfTestPerson {
 public:
  explicit TerminalPerson(RunEnd& end) : end_(end) {}

  void show(const SelfTestPrompt& prompt) override {
    const std::string request =
        fmt::format("{} of {}, {}: {}", prompt.part, prompt.parts, prompt.title, prompt.request);
    if (!line_.is_terminal()) {
      if (request != printed_) fmt::print(stderr, "{}\n", request);
      printed_ = request;
      return;
    }
    const std::int64_t time_ns = now_ns();
    if (request == printed_ && time_ns < shown_ns_ + kSelfTestRewriteNs) return;
    printed_ = request;
    shown_ns_ = time_ns;
    const ScreenSize size = screen_size();
    std::vector<std::string> lines = wrapped_lines(request, size.columns);
    const auto cells = static_cast<std::size_t>(std::clamp(prompt.done, 0.0, 1.0) * kBarCells);
    const std::string bar = std::string(cells, '#') + std::string(kBarCells - cells, '.');
    for (std::string& text : wrapped_lines(fmt::format("[{}] {}", bar, prompt.seen), size.columns))
      lines.push_back(std::move(text));
    lines.emplace_back(prompt.is_question
                           ? "y yes   n no   Enter the pad has none   q quit"
                           : "Enter the pad cannot do it   n it shows something else   q quit");
    if (lines.size() > size.rows) lines.resize(size.rows);
    line_.show(lines);
  }

  Answer take_answer() override {
    if (end_.is_reached()) return Answer::quit;
    while (const std::optional<char> key = keys_.take_key()) {
      switch (*key) {
        case '\n':
        case 's':
          return Answer::next;
        case 'y':
        case 'Y':
          return Answer::yes;
        case 'n':
        case 'N':
          return Answer::no;
        case 'q':
        case 'Q':
          return Answer::quit;
        default:
          break;
      }
    }
    return keys_.is_at_end() ? Answer::quit : Answer::none;
  }

  void tell(const std::string& sentence) override { print_remarks(kCommand, {sentence}, &line_); }

 private:
  RunEnd& end_;
  StatusLine line_{2};
  TerminalKeys keys_;
  std::string printed_;
  std::int64_t shown_ns_ = 0;
};

int run(SelfTestArguments& arguments) {
  RunEnd end;
  auto files = pad_files(arguments.options.map, "");
  if (!files) return fail(kCommand, files.error().message);
  arguments.options.files = std::move(*files);
  arguments.options.config_folders = config_folders();
  Result<std::optional<SelfTestResult>> done = std::optional<SelfTestResult>();
  {
    TerminalPerson person(end);
    done = run_self_test(arguments.options, person);
  }
  if (!done) return fail(kCommand, done.error().message);
  if (!*done) return fail(kCommand, "given up; nothing was kept");
  const SelfTestResult& result = **done;
  if (arguments.as_json) {
    fmt::print("{}", result.report);
  } else {
    for (const std::string& failure : result.failures) say("failed: {}\n", printable(failure));
    say("{}: {}; docs/tested-pads.md says how to contribute it\n", printable(result.folder),
        result.failures.empty() ? "everything that was asked for was seen"
                                : fmt::format("{} failed", result.failures.size()));
  }
  return result.failures.empty() ? 0 : 1;
}

}  // namespace

void add_selftest(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "selftest",
      "tests a real pad with you: each control and driver, unplugging, rumble and a walk");
  const auto arguments = std::make_shared<SelfTestArguments>();
  arguments->options.program = "gaitpad " GAITPAD_VERSION;
  add_pad_options(*command, arguments->options.selector);
  command->add_option("--out", arguments->options.folder,
                      "the folder to make (default: selftest-VENDOR-PRODUCT-DATE-TIME)");
  command->add_option("--map", arguments->options.map, "pad file that overrides config/pads");
  command->add_flag("--json", arguments->as_json, "print the report, as in report.json");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
