// gaitpad: one program with sub-commands. It parses; the commands do the rest.
#include <fcntl.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>
#include <sstream>
#include <system_error>

#include "base/text.h"
#include "tools/gaitpad/commands.h"

namespace {

constexpr int kFailed = 1, kWrongUsage = 2;

// If the caller closed a standard descriptor, its number would go to a pad or a recording, and
// output for the terminal would be written there. So it is opened here, in the wrong direction:
// using it fails as on a closed one.
void hold_standard_descriptors() {
  for (int fd = 0; fd <= 2; ++fd) {
    if (::fcntl(fd, F_GETFD) < 0)
      static_cast<void>(::open("/dev/null", fd == 0 ? O_WRONLY : O_RDONLY));
  }
}

// Help and version on standard output, a wrong usage on standard error. It may quote any argument.
int tell(const CLI::App& app, const CLI::ParseError& error) {
  std::ostringstream help, usage;
  const bool is_done = app.exit(error, help, usage) == 0;
  std::fputs(gaitpad::printable_lines(help.str()).c_str(), stdout);
  std::fputs(gaitpad::printable_lines(usage.str()).c_str(), stderr);
  if (!is_done) return kWrongUsage;
  return std::fflush(stdout) == 0 ? 0 : kFailed;
}

bool is_flushed() { return std::fflush(stdout) == 0 && std::ferror(stdout) == 0; }

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A physical gamepad walks a motion-captured character.", "gaitpad");
  app.set_version_flag("--version", "gaitpad " GAITPAD_VERSION);
  app.require_subcommand(1);
  app.footer("gaitpad COMMAND --help says more. Exit status: 0 done, 1 failed, 2 wrong usage.");

  hold_standard_descriptors();
  std::signal(SIGXFSZ, SIG_IGN);  // a file that is too large is a failed write like any other
  int status = 0;
  bool is_written = true;
  gaitpad::add_play(app, status);
  gaitpad::add_replay(app, status);
  gaitpad::add_record(app, status);
  gaitpad::add_pads(app, status);
  gaitpad::add_doctor(app, status);
  gaitpad::add_decode(app, status);
  gaitpad::add_monitor(app, status);
  gaitpad::add_calibrate(app, status);
  gaitpad::add_motion(app, status);
  gaitpad::add_ik(app, status);
  gaitpad::add_figures(app, status);
  gaitpad::add_bench(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return tell(app, error);
  } catch (const std::system_error&) {  // fmt::print on a full disk
    is_written = false;
  }
  if (is_written && is_flushed()) return status;
  std::fputs("gaitpad: standard output cannot be written\n", stderr);
  return kFailed;
}
