// gaitpad list: names for options: styles, characters, terrains, motions, pads, recordings.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <memory>
#include <nlohmann/json.hpp>

#include "gaitpad/config_files.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

struct Kind {
  std::string_view name, folder, option, ending;
};
constexpr std::array<Kind, 6> kKinds = {{
    {"styles", "styles", "--style NAME", ".toml"},
    {"characters", "characters", "--character NAME", ".toml"},
    {"terrains", "terrain", "--terrain NAME", ".toml"},
    {"motions", "motions", "--motion NAME", ".toml"},
    {"pads", "pads", "rules for pads, by vendor; gaitpad pads lists those that are plugged in",
     ".toml"},
    {"traces", "traces", "recordings: gaitpad replay FILE", ".hid"},
}};

struct Entry {
  std::string name, path, summary;
};

// The entries of a kind. Recordings are listed by their path, all others by their name.
std::vector<Entry> entries_of(const Kind& kind, const std::vector<std::string>& folders) {
  std::vector<Entry> entries;
  for (const std::string& path : config_files(folders, std::string(kind.folder), kind.ending)) {
    const bool is_trace = kind.ending == ".hid";
    entries.push_back({is_trace ? path : config_name(path), path, config_summary(path)});
  }
  return entries;
}

void print_kind(const Kind& kind, const std::vector<Entry>& entries) {
  say("{} ({})\n", kind.name, kind.option);
  std::size_t width = 0;
  for (const Entry& entry : entries) width = std::max(width, entry.name.size());
  for (const Entry& entry : entries) {
    const std::string name = printable(entry.name);
    say("{}\n", entry.summary.empty() ? "  " + name
                                      : fmt::format("  {:<{}}  {}", name, width, entry.summary));
  }
}

int run(const std::string& wanted, bool as_json) {
  const std::vector<std::string> folders = config_folders();
  nlohmann::ordered_json all = nlohmann::ordered_json::object();
  for (const Kind& kind : kKinds) {
    if (!wanted.empty() && wanted != kind.name) continue;
    const std::vector<Entry> entries = entries_of(kind, folders);
    if (!as_json) print_kind(kind, entries);
    for (const Entry& entry : entries)
      all[std::string(kind.name)].push_back(
          {{"name", entry.name}, {"file", entry.path}, {"summary", entry.summary}});
  }
  if (as_json) print_json(all);
  return 0;
}

}  // namespace

void add_list(CLI::App& app, int& status) {
  struct Arguments {
    std::string kind;
    bool as_json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "list",
      "lists the styles, characters, terrains, motions, pads and recordings that have names");
  std::vector<std::string> kinds;
  for (const Kind& kind : kKinds) kinds.emplace_back(kind.name);
  command->add_option("KIND", arguments->kind, "list only this kind (default: all)")
      ->check(CLI::IsMember(kinds));
  command->add_flag("--json", arguments->as_json, "print names, files and summaries as JSON");
  command->callback([arguments, &status] { status = run(arguments->kind, arguments->as_json); });
}

}  // namespace gaitpad
