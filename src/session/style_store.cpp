#include "session/style_store.h"

#include <fmt/format.h>

#include <algorithm>

#include "session/config_files.h"
#include "session/user_files.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxNameBytes = 48;

bool is_plain(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
         c == '-';
}

Result<std::string> file_name(std::string name) {
  while (!name.empty() && name.back() == ' ') name.pop_back();
  name.erase(0, std::min(name.find_first_not_of(' '), name.size()));
  std::ranges::replace(name, ' ', '_');
  if (name.empty()) return Error{"a style needs a name"};
  if (name.size() > kMaxNameBytes || !std::ranges::all_of(name, is_plain)) {
    return Error{
        fmt::format("a style's name is of at most {} letters, digits, _ and -", kMaxNameBytes)};
  }
  return name;
}

}  // namespace

Result<std::string> save_style(const std::vector<std::string>& config_folders,
                               const std::string& name, const StyleValues& values) {
  const auto plain = file_name(name);
  if (!plain) return plain.error();
  const std::string user = user_config_folder();
  if (user.empty())
    return Error{"neither XDG_CONFIG_HOME nor HOME names a folder for styles of your own"};
  std::vector<std::string> others = config_folders;
  std::erase(others, user);
  for (const std::string& path : config_files(others, "styles")) {
    if (config_name(path) != *plain) continue;
    return Error{
        fmt::format("there is a style \"{}\" already ({}): choose another name", *plain, path)};
  }
  Style style;
  static_cast<StyleValues&>(style) = values;
  style.name = *plain;
  const std::string path = fmt::format("{}/styles/{}.toml", user, *plain);
  if (auto problem = save_text(path, style_text(style))) return *problem;
  return path;
}

}  // namespace gaitpad
