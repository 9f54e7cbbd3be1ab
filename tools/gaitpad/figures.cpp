// gaitpad figures: the paper's figures and claims out of the running code.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "paper/claims.h"
#include "session/config_files.h"
#include "session/output_files.h"
#include "tools/gaitpad/commands.h"

namespace gaitpad {
namespace {

struct FiguresArguments {
  std::string folder, motion;
  bool as_json = false;
};

int failed(const Error& error) {
  fmt::print(stderr, "gaitpad figures: {}\n", error.message);
  return 1;
}

int run(const FiguresArguments& arguments) {
  auto source = load_paper_source(arguments.motion, config_folders(GAITPAD_CONFIG_DIR));
  if (!source) return failed(source.error());
  auto study = Study::of(std::move(*source));
  if (!study) return failed(study.error());
  const std::vector<Claim> claims = all_claims(*study);
  fmt::print("{}", claims_table(claims));
  for (const Claim& c : claims) fmt::print("{} [{}] {}\n", c.name, name_of(c.mode), c.note);
  return 0;
}

}  // namespace

void add_figures(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("figures", "the paper's figures and claims");
  const auto arguments = std::make_shared<FiguresArguments>();
  command->add_option("--out", arguments->folder, "")->required();
  command->add_option("--motion", arguments->motion, "");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
