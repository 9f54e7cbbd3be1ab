#include "view/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "base/text.h"
#include "files/toml_file.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::string_view, 2> kThemeNames = {"dark", "light"};
constexpr std::array<std::string_view, 2> kLegNames = {"left", "right"};

// Index of the key's word in `words`; none if the key is absent or its word is unknown.
template <std::size_t N>
std::optional<std::size_t> read_word(TomlTable& root, std::string_view key,
                                     const std::array<std::string_view, N>& words) {
  const auto word = root.string(key);
  if (!word) return std::nullopt;
  const auto found = std::find(words.begin(), words.end(), *word);
  if (found != words.end()) return static_cast<std::size_t>(found - words.begin());
  root.reject(key, fmt::format("{} is not one of {}", in_quotes(*word), fmt::join(words, ", ")));
  return std::nullopt;
}

void read_panels(TomlTable& root, UiState& state) {
  const auto names = root.strings("panels", kPanels);
  if (!names) return;
  state.is_open.fill(false);
  for (const std::string& name : *names) {
    const auto found = std::find(kPanelNames.begin(), kPanelNames.end(), name);
    if (found == kPanelNames.end()) {
      root.reject("panels", fmt::format("{} is not one of {}", in_quotes(name),
                                        fmt::join(kPanelNames, ", ")));
      return;
    }
    state.is_open[static_cast<std::size_t>(found - kPanelNames.begin())] = true;
  }
}

Result<UiState> read_state(const std::string& path) {
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  TomlTable root = file->root();
  UiState state;
  read_panels(root, state);
  if (const auto theme = read_word(root, "theme", kThemeNames)) {
    state.theme = static_cast<ThemeName>(*theme);
  }
  if (const auto leg = read_word(root, "graph_leg", kLegNames)) {
    state.graph_leg = static_cast<Side>(*leg);
  }
  state.type_size =
      root.number("type_size", kLeastTypeSize, kMostTypeSize).value_or(state.type_size);
  for (const ScenePart& part : kSceneParts) {
    state.*part.is_shown = root.boolean(part.name).value_or(state.*part.is_shown);
  }
  if (auto problem = file->problem()) return *problem;
  return state;
}

std::string text_of(const UiState& state) {
  std::vector<std::string> panels;
  for (std::size_t i = 0; i < kPanels; ++i) {
    if (state.is_open[i]) panels.push_back(fmt::format("\"{}\"", kPanelNames[i]));
  }
  std::string text = fmt::format(
      "# The layout of gaitpad's window; without this file it opens with its defaults.\n"
      "panels = [{}]\ntheme = \"{}\"\ngraph_leg = \"{}\"\n",
      fmt::join(panels, ", "), kThemeNames[static_cast<std::size_t>(state.theme)],
      kLegNames[static_cast<std::size_t>(state.graph_leg)]);
  text += fmt::format("type_size = {:g}\n", state.type_size);
  for (const ScenePart& part : kSceneParts) {
    text += fmt::format("{} = {}\n", part.name, state.*part.is_shown);
  }
  return text;
}

}  // namespace

Layout load_layout(const std::string& path) {
  std::error_code ignored;
  if (path.empty() || !fs::exists(path, ignored)) return {};
  auto state = read_state(path);
  if (!state) return {{}, state.error().message + "; the window opens with its defaults"};
  return {*state, ""};
}

std::optional<Error> save_layout(const std::string& path, const UiState& state) {
  return write_file(path, text_of(state));
}

}  // namespace gaitpad
