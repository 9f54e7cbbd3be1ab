// gaitpad figures: the paper's figures and claims, computed by the running code.
#include <CLI/CLI.hpp>

#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"
#include "tools/gaitpad/window_module.h"

#ifdef GAITPAD_HAS_WINDOW
#include <memory>

namespace gaitpad {
namespace {

int run(const FiguresArguments& arguments) {
  const auto module = window_module();
  return module ? (*module)->run_figures(arguments) : fail("figures", module.error().message);
}

}  // namespace

void add_figures(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand(
      "figures", "draws the paper's figures 2, 3, 4, 5a and 5b, and measures each of its claims");
  command->footer(
      "Writes figure2, figure3, figure4, figure5a, figure5b (robust mode), figure5a_paper and\n"
      "figure5b_paper as PNG and CSV, and claims.json: every claim in the modes that it depends "
      "on.\n"
      "A claim that fails is a finding about the paper's method, not a failure of the program:\n"
      "the exit status is 0 when the files were written.");
  const auto arguments = std::make_shared<FiguresArguments>();
  command->add_option("--out", arguments->folder, "folder for the files; made if it is missing")
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
  add_missing_command(
      app, status, "figures",
      "draws the paper's figures 2, 3, 4, 5a and 5b, and measures each of its claims",
      missing_window());
}

}  // namespace gaitpad

#endif
