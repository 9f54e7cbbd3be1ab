// gaitpad: one program with sub-commands. Parses; the commands do the rest.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "tools/gaitpad/commands.h"

namespace {

constexpr int kWrongUsage = 2;

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A physical gamepad walks a motion-captured character.", "gaitpad");
  app.set_version_flag("--version", "gaitpad " GAITPAD_VERSION);
  app.require_subcommand(1);
  app.footer("gaitpad COMMAND --help says more. Exit status: 0 done, 1 failed, 2 wrong usage.");

  int status = 0;
  gaitpad::add_replay(app, status);
  gaitpad::add_decode(app, status);
  gaitpad::add_motion(app, status);
  gaitpad::add_ik(app, status);
  gaitpad::add_bench(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kWrongUsage;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    std::fputs("gaitpad: standard output cannot be written\n", stderr);
    return 1;
  }
  return status;
}
