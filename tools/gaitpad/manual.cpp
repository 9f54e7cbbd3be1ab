// The manual pages, from the texts of --help: `gaitpad __manual FOLDER` writes gaitpad.1, and
// gaitpad-COMMAND.1 for each command.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/text.h"
#include "system/whole_file.h"
#include "tools/gaitpad/commands.h"

namespace gaitpad {
namespace {

constexpr std::string_view kExamples = "Examples:";

// Escapes text for troff: backslashes and hyphens are literal, and no line is a request.
std::string roff(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool begins_line = i == 0 || text[i - 1] == '\n';
    if (begins_line && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else {
      out += c;
    }
  }
  return out;
}

std::string page_name(const CLI::App& app) {
  const CLI::App* parent = app.get_parent();
  return parent == nullptr ? app.get_name() : parent->get_name() + "-" + app.get_name();
}

std::string invocation(const CLI::App& app) {
  const CLI::App* parent = app.get_parent();
  return parent == nullptr ? app.get_name() : parent->get_name() + " " + app.get_name();
}

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  std::vector<const CLI::App*> commands;
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (!command->get_group().empty()) commands.push_back(command);
  }
  return commands;
}

// `-j,--jobs INT:INT in [1 - 1024]` as in --help: names bold, the type in italics.
std::string option_heading(const CLI::Option& option) {
  std::string names;
  if (option.get_positional()) {
    names = "\\fI" + roff(option.get_name(true, false)) + "\\fR";
  } else {
    for (const std::string& name : option.get_snames())
      names += (names.empty() ? "\\fB" : ", \\fB") + roff("-" + name) + "\\fR";
    for (const std::string& name : option.get_lnames())
      names += (names.empty() ? "\\fB" : ", \\fB") + roff("--" + name) + "\\fR";
  }
  const bool has_type = option.get_items_expected_max() > 0 && !option.get_type_name().empty();
  if (has_type && !(option.get_positional() && option.get_type_name() == "TEXT"))
    names += " \\fI" + roff(option.get_type_name()) + "\\fR";
  return names;
}

void add_options(const CLI::App& app, bool are_positional, std::string& page) {
  std::string section;
  for (const CLI::Option* option : app.get_options()) {
    const bool is_positional = option->get_positional();
    if (is_positional != are_positional || option->get_group().empty()) continue;
    section +=
        fmt::format(".TP\n{}\n{}\n", option_heading(*option), roff(option->get_description()));
    if (!option->get_default_str().empty())
      section += fmt::format("Default: {}\n", roff(option->get_default_str()));
  }
  if (!section.empty())
    page += fmt::format(".SH {}\n{}", are_positional ? "ARGUMENTS" : "OPTIONS", section);
}

std::string synopsis(const CLI::App& app) {
  std::string text = fmt::format("\\fB{}\\fR", roff(invocation(app)));
  if (app.get_parent() == nullptr) return text + " \\fICOMMAND\\fR [\\fIOPTION\\fR]...";
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_positional()) continue;
    const char* dots = option->get_items_expected_max() > 1 ? "..." : "";
    const std::string name = "\\fI" + roff(option->get_name(true, false)) + "\\fR" + dots;
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  return text + " [\\fIOPTION\\fR]...";
}

// The footer's text before its examples, and the examples, one command a line.
std::pair<std::string, std::string> footer_parts(const CLI::App& app) {
  const std::string footer = app.get_footer();
  const std::size_t at = footer.find(kExamples);
  std::string words(trimmed(std::string_view(footer).substr(0, at), " \n"));
  std::string examples;
  if (at != footer.npos) {
    std::string_view rest = std::string_view(footer).substr(at + kExamples.size());
    while (!rest.empty()) {
      const std::string_view line = trimmed(take_line(rest), " \t");
      if (!line.empty()) examples += fmt::format("{}\n", line);
    }
  }
  return {std::move(words), std::move(examples)};
}

constexpr std::string_view kSurroundings =
    ".SH FILES\n"
    ".TP\n\\fI/usr/share/gaitpad\\fR\n"
    "Styles, characters, terrain, motions, pads, recordings and udev rules.\n"
    ".TP\n\\fI~/.config/gaitpad\\fR\n"
    "The user's own files of the same kinds, and calibrations. They have precedence.\n"
    ".TP\n\\fI~/.cache/gaitpad\\fR\n"
    "Strides that were solved when a motion was loaded.\n"
    ".SH ENVIRONMENT\n"
    ".TP\n\\fBGAITPAD_CONFIG\\fR\nA folder of configuration that has precedence over all others.\n"
    ".TP\n\\fBGAITPAD_CACHE\\fR\n\\fIoff\\fR: nothing is kept.\n"
    ".TP\n\\fBGAITPAD_SHARD_INDEX\\fR, \\fBGAITPAD_SHARD_TOTAL\\fR\n"
    "The part of the recordings that \\fBgaitpad check\\fR takes, from 1 on.\n"
    ".TP\n\\fBXDG_CONFIG_HOME\\fR, \\fBXDG_CACHE_HOME\\fR\nStand for ~/.config and ~/.cache.\n";

std::string page_of(const CLI::App& app, const std::string& version) {
  const auto [words, examples] = footer_parts(app);
  const CLI::App* parent = app.get_parent();
  std::string description = app.get_description();
  while (description.ends_with('.')) description.pop_back();
  std::string sentence = description;
  sentence[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(sentence[0])));
  std::string page = fmt::format(
      ".TH \"{0}\" 1 \"\" \"gaitpad {1}\" \"User Commands\"\n.nh\n.ad l\n.SH NAME\n{2} \\- {3}\n"
      ".SH SYNOPSIS\n{4}\n.SH DESCRIPTION\n{5}.\n",
      page_name(app), version, roff(page_name(app)), roff(description), synopsis(app),
      roff(sentence));
  if (!words.empty()) page += fmt::format(".PP\n{}\n", roff(words));
  if (parent == nullptr) {
    page += ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(app)) {
      page += fmt::format(".TP\n\\fB{}\\fR\n{}; see \\fB{}\\fR(1)\n", roff(command->get_name()),
                          roff(command->get_description()), roff(page_name(*command)));
    }
  }
  add_options(app, true, page);
  add_options(app, false, page);
  if (!examples.empty()) page += fmt::format(".SH EXAMPLES\n.nf\n{}.fi\n", roff(examples));
  if (parent == nullptr) page += kSurroundings;
  page += ".SH SEE ALSO\n";
  std::string others;
  for (const CLI::App* other : commands_of(parent == nullptr ? app : *parent)) {
    if (other != &app) others += fmt::format(",\n.BR {} (1)", roff(page_name(*other)));
  }
  if (parent != nullptr) others = ",\n.BR gaitpad (1)" + others;
  return page + others.substr(2) + "\n";
}

}  // namespace

std::optional<Error> write_manual(const CLI::App& app, const std::string& folder) {
  const std::string version = app.version().substr(app.version().find(' ') + 1);
  std::vector<const CLI::App*> pages = commands_of(app);
  pages.push_back(&app);
  for (const CLI::App* page : pages) {
    const std::string path = fmt::format("{}/{}.1", folder, page_name(*page));
    if (auto problem = write_file(path, page_of(*page, version))) return problem;
  }
  return std::nullopt;
}

}  // namespace gaitpad
