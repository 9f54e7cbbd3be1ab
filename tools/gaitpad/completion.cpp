// Completions of the command line for bash, zsh and fish (tools/package/completions): `gaitpad
// __complete WORD... PREFIX`, with the words after `gaitpad`. Prints a candidate a line, with a tab
// and its description, and `:files` or `:folders` if the shell should add those. Commands and
// options come from the commands themselves.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "drivers/system_nodes.h"
#include "gaitpad/config_files.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"

namespace gaitpad {
namespace {

using Words = std::vector<std::string>;

class Candidates {
 public:
  Candidates(std::string prefix, std::string lead)
      : prefix_(std::move(prefix)), lead_(std::move(lead)) {}
  void add(const std::string& word, const std::string& description = "") {
    if (!word.starts_with(prefix_) || !seen_.insert(word).second) return;
    lines_.push_back(lead_ + printable(word) + "\t" + printable(description));
  }
  // Adds `:files` or `:folders`, so that the shell adds those.
  void add_from_shell(const char* kind) { lines_.emplace_back(kind); }
  void print() const {
    for (const std::string& line : lines_) fmt::print("{}\n", line);
  }

 private:
  // Prefix of the word to complete, and the text before it in the word: `--style=`.
  std::string prefix_, lead_;
  std::set<std::string> seen_;
  Words lines_;
};

// Folders of configuration whose files options take by name, by the option's type.
constexpr std::pair<std::string_view, const char*> kNamed[] = {{"--style", "styles"},
                                                               {"--character", "characters"},
                                                               {"--terrain", "terrain"},
                                                               {"--motion", "motions"}};

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

bool has_name(const CLI::Option& option, const std::string& word) {
  return word.starts_with("--") ? option.check_lname(word.substr(2))
                                : word.size() == 2 && option.check_sname(word.substr(1));
}

void add_pads(Candidates& candidates) {
  for (const SystemNode& node : system_nodes("input")) {
    if (node.is_joystick && !node.is_motion_sensor) candidates.add(node.node, node.name);
  }
}

// Adds the values of the option if its type lists them: `TEXT:{own,adult}`.
bool add_set(const CLI::Option& option, Candidates& candidates) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{'), end = type.find('}');
  if (begin == type.npos || end == type.npos || end < begin) return false;
  std::string_view rest = std::string_view(type).substr(begin + 1, end - begin - 1);
  while (!rest.empty()) candidates.add(std::string(trimmed(take_part(rest, ','))));
  return true;
}

// True if the option is a positional whose description contains `what`.
bool is_about(const CLI::Option& option, std::string_view what) {
  return option.get_positional() && option.get_description().find(what) != std::string::npos;
}

void add_values(const CLI::Option& option, Candidates& candidates) {
  if (add_set(option, candidates)) return;
  for (const auto& [name, folder] : kNamed) {
    const bool is_motion = name == "--motion" && is_about(option, "config/motions");
    if (!is_motion && !has_name(option, std::string(name))) continue;
    for (const std::string& file : config_files(config_folders(), folder))
      candidates.add(config_name(file));
  }
  const std::string type = option.get_type_name();
  const bool is_number = type.starts_with("INT") || type.starts_with("UINT") ||
                         type.starts_with("FLOAT") || type.find(" in [") != type.npos;
  if (is_number) return;
  if (is_about(option, " pad")) add_pads(candidates);
  const bool is_folder = option.get_description().starts_with("folder");
  candidates.add_from_shell(is_folder ? ":folders" : ":files");
}

const CLI::Option* option_named(const CLI::App& command, const std::string& word) {
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional() && has_name(*option, word)) return option;
  }
  return nullptr;
}

// The positional that the next word belongs to; null: none is left.
const CLI::Option* next_positional(const CLI::App& command, const Words& words) {
  int count = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string name = words[i].substr(0, words[i].find('='));
    if (!words[i].starts_with('-') || words[i] == "-") {
      ++count;
    } else if (const CLI::Option* option = option_named(command, name)) {
      if (takes_value(*option) && name == words[i]) ++i;
    }
  }
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    count -= option->get_items_expected_max();
    if (count < 0) return option;
  }
  return nullptr;
}

void add_options(const CLI::App& command, Candidates& candidates) {
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional() || option->get_group().empty()) continue;
    for (const std::string& name : option->get_lnames())
      candidates.add("--" + name, option->get_description());
  }
}

void add_commands(const CLI::App& app, Candidates& candidates) {
  for (const CLI::App* command : app.get_subcommands(nullptr)) {
    if (!command->get_group().empty())
      candidates.add(command->get_name(), command->get_description());
  }
}

}  // namespace

void print_completions(const CLI::App& app, Words words) {
  if (words.empty()) words.emplace_back();
  // bash passes `--style=limp` as several words.
  std::string prefix = words.back(), lead;
  words.pop_back();
  if (prefix == "=") prefix.clear();
  std::erase(words, "=");
  const CLI::App* command = nullptr;
  if (!words.empty()) {
    for (const CLI::App* candidate : app.get_subcommands(nullptr))
      if (candidate->get_name() == words.front()) command = candidate;
    words.erase(words.begin());
  }
  if (const std::size_t equals = prefix.find('=');
      prefix.starts_with("--") && equals != prefix.npos) {
    lead = prefix.substr(0, equals + 1);
    words.push_back(prefix.substr(0, equals));
    prefix.erase(0, equals + 1);
  }
  Candidates candidates(prefix, lead);
  const CLI::App& asked = command != nullptr ? *command : app;
  const CLI::Option* option = words.empty() ? nullptr : option_named(asked, words.back());
  if (option != nullptr && takes_value(*option)) {
    add_values(*option, candidates);
  } else if (prefix.starts_with('-')) {
    add_options(asked, candidates);
  } else if (command == nullptr) {
    if (words.empty()) add_commands(app, candidates);
  } else if (const CLI::Option* positional = next_positional(asked, words)) {
    add_values(*positional, candidates);
  }
  candidates.print();
}

}  // namespace gaitpad
