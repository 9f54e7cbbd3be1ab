// gaitpad map [PAD]: "push the left stick forward". Finds the field of each control, and stores the
// result for this pad as an SDL mapping, which games also read.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <utility>

#include "pads/mapping_dialog.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

constexpr const char* kMapCommand = "map";
constexpr std::chrono::milliseconds kMapWait{20};

// Asks for one control after the other until all are done or the recording ends. False: the user
// gave up.
bool ask(MappingDialog& mapping, const PadSelector& selector, RunEnd& end) {
  InputLines input;
  StatusLine line(2);
  MissingPad missing(kMapCommand, selector);
  bool is_pad_told = false;
  const char* told = nullptr;  // the prompt that was printed last; null: none
  std::size_t found = 0;
  while (!mapping.is_done() && !mapping.has_ended() && !end.is_reached()) {
    mapping.look(kMapWait);
    print_remarks(kMapCommand, mapping.take_remarks(), &line);
    missing.look(mapping.plugged(), line);
    if (mapping.has_pad() && !std::exchange(is_pad_told, true)) {
      print_remarks(
          kMapCommand,
          {mapping.pad().name + ": let everything go; s and Enter skips a step, q and Enter ends"});
    }
    for (const std::string& word : input.take_lines()) {
      if (word == "q") return false;
      if (word == "s") mapping.skip();
    }
    if (mapping.found() != found) {
      found = mapping.found();
      print_remarks(kMapCommand, {"  " + mapping.last_found()});
    }
    const char* prompt = mapping.prompt();
    if (prompt != nullptr && prompt != told) {
      print_remarks(kMapCommand, {fmt::format("{} of {}: {}", mapping.step() + 1,
                                              MappingDialog::step_count(), prompt)});
    }
    told = prompt;
  }
  missing.finish(mapping.plugged(), line);
  return end.cut_off_status() == 0;
}

int run(const PadSelector& selector, const std::string& out) {
  RunEnd end;
  const auto files = pad_files("", "");
  if (!files) return fail(kMapCommand, files.error().message);
  const auto mapping = MappingDialog::start(*files, selector);
  if (!mapping) return fail(kMapCommand, mapping.error().message);
  if (!ask(**mapping, selector, end)) {
    const int status = fail(kMapCommand, "given up; nothing is kept");
    return end.cut_off_status() != 0 ? end.cut_off_status() : status;
  }
  if (!(*mapping)->has_left_stick())
    return fail(kMapCommand, "ended before the left stick was known; nothing is kept");
  const auto line = (*mapping)->keep(out);
  if (!line) return fail(kMapCommand, line.error().message);
  fmt::print("{}\n", printable(*line));
  print_remarks(kMapCommand,
                {fmt::format("{} controls of {} are kept in {}", (*mapping)->found(),
                             (*mapping)->pad().name, out.empty() ? user_mapping_file() : out)});
  return 0;
}

}  // namespace

void add_map(CLI::App& app, int& status) {
  struct Arguments {
    PadSelector selector;
    std::string out;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "map", "asks for each stick, trigger and button of a pad whose controls are mapped wrongly");
  command->footer(
      "Saves the answers for this pad in gamecontrollerdb.txt in the user's folder, which every\n"
      "driver reads first, and prints the line: games that use SDL read it too.");
  add_pad_options(*command, arguments->selector);
  command->add_option("--out", arguments->out, "write the line to this file instead");
  command->callback([arguments, &status] { status = run(arguments->selector, arguments->out); });
}

}  // namespace gaitpad
