#include "tools/gaitpad/install_rules.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>

#include "drivers/system_users.h"
#include "system/whole_file.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

bool asks_to_install(const RulesTarget& target) {
  fmt::print(stderr, "Write this to {} and let udev apply it? [y/N] ", target.path);
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "Y" || answer == "yes";
}

std::optional<Error> write_rules(const RulesTarget& target, const std::string& text) {
  if (auto problem = write_file(target.path, text)) return problem;
  constexpr fs::perms kReadableByAll{0644};
  std::error_code error;
  fs::permissions(target.path, kReadableByAll, error);
  if (error) return write_error(target.path, error.value());
  if (std::system(target.apply) == 0) return std::nullopt;
  return Error{fmt::format("{}: is written, but udev was not told; do: sudo sh -c '{}'",
                           target.path, target.apply)};
}

}  // namespace

int install_rules(std::string_view command, const RulesTarget& target, const std::string& text,
                  bool is_agreed, const std::string& as_root) {
  fmt::print("{}", text);
  std::fflush(stdout);
  if (!is_root()) return fail(command, fmt::format("{} needs root: {}", target.path, as_root));
  if (!is_agreed && !asks_to_install(target)) return fail(command, "nothing was changed");
  if (const auto problem = write_rules(target, text)) return fail(command, problem->message);
  fmt::print(stderr, "gaitpad {}: {} is installed and applied\n", command, target.path);
  return 0;
}

}  // namespace gaitpad
