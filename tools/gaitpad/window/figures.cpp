// The paper's figures and claims, drawn and printed.
#include "paper/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "gaitpad/config_files.h"
#include "paper/claims.h"
#include "terminal/terminal.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"
#include "tools/gaitpad/window/drawings.h"

namespace gaitpad {
namespace {

// "pass 8", "FAIL 1 of 8"; "-" if this motion can test no claim in the mode.
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

// Prints a line for each of the paper's thirty claims, with the number of its values that hold;
// then the failed values, with the reason.
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
  say(stdout, table_text(table));
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

}  // namespace

int run_figures(const FiguresArguments& arguments) {
  auto source = load_paper_source(arguments.motion, arguments.pace, config_folders());
  if (!source) return fail("figures", source.error().message);
  auto study = Study::of(std::move(*source));
  if (!study) return fail("figures", study.error().message);
  Progress progress("figures");
  // Drawing the figures is fast compared with the claims.
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

}  // namespace gaitpad
