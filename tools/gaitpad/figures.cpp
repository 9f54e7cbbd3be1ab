// gaitpad figures: the paper's figures and claims out of the running code.
#include <CLI/CLI.hpp>

#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

#ifdef GAITPAD_HAS_WINDOW
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <span>

#include "gaitpad/config_files.h"
#include "paper/claims.h"
#include "paper/figures.h"

namespace gaitpad {
namespace {

struct FiguresArguments {
  std::string folder, motion;
  std::optional<Pace> pace;
  bool as_json = false;
};

// "pass 8", "FAIL 1 of 8"; "-" where the mode has none that this motion can test.
std::string verdict(std::span<const Claim> claims, IkMode mode) {
  int tested = 0, broken = 0;
  for (const Claim& c : claims) {
    tested += c.mode == mode && c.pass;
    broken += c.mode == mode && c.pass && !*c.pass;
  }
  if (tested == 0) return "-";
  return broken == 0 ? fmt::format("pass {}", tested)
                     : fmt::format("FAIL {} of {}", broken, tested);
}

// One line for each of the paper's thirty claims, with how many of its numbers hold; then the
// numbers that do not, with the reason.
void print_claims(std::span<const Claim> claims) {
  std::vector<TableRow> table = {{"claim", "section", "paper mode", "robust mode"}};
  const auto number = [](const Claim& c) { return c.name.substr(0, c.name.find(' ')); };
  for (auto begin = claims.begin(); begin != claims.end();) {
    const auto end = std::find_if(begin, claims.end(),
                                  [&](const Claim& c) { return number(c) != number(*begin); });
    const std::span<const Claim> one(begin, end);
    table.push_back({number(*begin), begin->section, verdict(one, IkMode::paper),
                     verdict(one, IkMode::robust)});
    begin = end;
  }
  print_table(table);
  say("\n");
  for (const Claim& c : claims) {
    if (!c.pass || *c.pass) continue;
    const std::string value = c.value ? fmt::format("{:.4g}", *c.value) : "not known";
    say("FAIL  {}, {} mode: {}, not {}{}{}\n", c.name, name_of(c.mode), value, c.bound,
        c.note.empty() ? "" : "; ", c.note);
  }
}

void print_summary(const std::vector<Claim>& claims, const std::string& folder) {
  print_claims(claims);
  for (const IkMode mode : {IkMode::paper, IkMode::robust}) {
    int passed = 0, broken = 0, untested = 0;
    for (const Claim& c : claims) {
      if (c.mode != mode) continue;
      (!c.pass ? untested : *c.pass ? passed : broken) += 1;
    }
    say("{:<6} mode: {} pass, {} fail, {} cannot be tested with this motion\n", name_of(mode),
        passed, broken, untested);
  }
  say("figures 2, 3, 4, 5a and 5b and claims.json (every number) are in {}; docs/paper.md says "
      "what "
      "each claim means and why some fail\n",
      printable(folder));
}

int run(const FiguresArguments& arguments) {
  auto source = load_paper_source(arguments.motion, arguments.pace, config_folders());
  if (!source) return fail("figures", source.error().message);
  auto study = Study::of(std::move(*source));
  if (!study) return fail("figures", study.error().message);
  Progress progress("figures");
  // The figures themselves are quick beside the claims.
  const std::vector<Claim> claims =
      all_claims(*study, [&progress](double share) { progress.show(0.95 * share); });
  const std::string json = claims_json(study->source().motion, claims);
  const auto problem = write_figures(arguments.folder, all_figures(*study), json);
  progress.clear();
  if (problem) return fail("figures", problem->message);
  if (arguments.as_json) {
    say("{}", json);
  } else {
    print_summary(claims, arguments.folder);
  }
  return 0;
}

}  // namespace

void add_figures(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "figures", "the paper's figures 2, 3, 4, 5a and 5b, and each of its claims as a number");
  command->footer(
      "Writes figure2, figure3, figure4, figure5a, figure5b (robust mode), figure5a_paper and\n"
      "figure5b_paper as PNG and CSV, and claims.json: every claim in the modes that it depends "
      "on.\n"
      "A claim that fails is a finding about the paper's method, not a failure of the program:\n"
      "the exit status is 0 when the files were written.");
  const auto arguments = std::make_shared<FiguresArguments>();
  command->add_option("--out", arguments->folder, "folder for the files, made where it is missing")
      ->required();
  command->add_option("--motion", arguments->motion,
                      "BVH file or .toml (default: the procedural walk)");
  add_pace_option(*command, arguments->pace);
  command->add_flag("--json", arguments->as_json, "print claims.json instead of the table");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad

#else

namespace gaitpad {

void add_figures(CLI::App& app, int& status) {
  add_missing_command(app, status, "figures",
                      "the paper's figures 2, 3, 4, 5a and 5b, and each of its claims as a number",
                      missing_window());
}

}  // namespace gaitpad

#endif
