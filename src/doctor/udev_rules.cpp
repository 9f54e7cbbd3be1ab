#include "doctor/udev_rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace gaitpad {
namespace fs = std::filesystem;

namespace {

constexpr const char* kGrant = R"(MODE="0660", GROUP="input", TAG+="uaccess")";

std::optional<std::string> text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(in), {});
}

// Matches like udev's glob, but only with `*`, which is all that the rules use.
bool fits(std::string_view pattern, std::string_view text) {
  const std::size_t star = pattern.find('*');
  if (star == std::string_view::npos) return pattern == text;
  if (!text.starts_with(pattern.substr(0, star))) return false;
  text.remove_prefix(star);
  pattern.remove_prefix(star + 1);
  for (; !fits(pattern, text); text.remove_prefix(1)) {
    if (text.empty()) return false;
  }
  return true;
}

bool fits_one_of(std::string_view patterns, std::string_view text) {
  for (;;) {
    const std::size_t bar = patterns.find('|');
    if (fits(patterns.substr(0, bar), text)) return true;
    if (bar == std::string_view::npos) return false;
    patterns.remove_prefix(bar + 1);
  }
}

// True if every KERNELS=="..." of the line matches; false if it has none.
bool line_fits(std::string_view line, std::string_view hid_device) {
  constexpr std::string_view kKey = "KERNELS==\"";
  bool has_key = false;
  for (std::size_t at; (at = line.find(kKey)) != std::string_view::npos;) {
    line.remove_prefix(at + kKey.size());
    if (!fits_one_of(line.substr(0, line.find('"')), hid_device)) return false;
    has_key = true;
  }
  return has_key;
}

}  // namespace

std::string program() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  const char* variable = std::getenv("PATH");
  std::string_view folders = variable ? variable : "";
  while (!folders.empty()) {
    const std::size_t colon = folders.find(':');
    if (fs::equivalent(fs::path(folders.substr(0, colon)) / "gaitpad", self, error))
      return "gaitpad";
    folders.remove_prefix(colon == std::string_view::npos ? folders.size() : colon + 1);
  }
  return self.empty() ? "gaitpad" : self.string();
}

Result<RulesFile> shipped_rules(const std::vector<std::string>& config_folders,
                                const RulesTarget& target) {
  const std::string name = fs::path(target.path).filename().string();
  for (const std::string& folder : config_folders) {
    const fs::path path = fs::path(folder) / "udev" / name;
    if (auto text = text_of(path)) return RulesFile{path.string(), std::move(*text)};
  }
  return Error{fmt::format("config/udev/{}: no such file in the folders of configuration", name)};
}

std::optional<RulesFile> installed_rules() {
  for (const char* folder : {"/etc", "/run", "/usr/local/lib", "/usr/lib", "/lib"}) {
    const fs::path path = fs::path(folder) / "udev/rules.d" / fs::path(kPadRules.path).filename();
    if (auto text = text_of(path)) return RulesFile{path.string(), std::move(*text)};
  }
  return std::nullopt;
}

bool opens_hidraw(std::string_view rules, const RuleSubject& subject) {
  const std::string hid_device =
      fmt::format("{:04X}:{:04X}:{:04X}.0001", subject.bus, subject.vendor, subject.product);
  while (!rules.empty()) {
    const std::string_view line = rules.substr(0, rules.find('\n'));
    if (line.starts_with("SUBSYSTEM==\"hidraw\"") && line_fits(line, hid_device)) return true;
    rules.remove_prefix(std::min(line.size() + 1, rules.size()));
  }
  return false;
}

std::string hidraw_rule(const RuleSubject& subject) {
  const std::string interface =
      subject.interface ? fmt::format(" DEVPATH==\"*.{}/0003:*\",", *subject.interface) : "";
  return fmt::format("SUBSYSTEM==\"hidraw\", KERNELS==\"*:{:04X}:{:04X}.*\",{} {}", subject.vendor,
                     subject.product, interface, kGrant);
}

std::string usb_rule(const RuleSubject& subject) {
  return fmt::format(
      "SUBSYSTEM==\"usb\", ATTR{{idVendor}}==\"{:04x}\", ATTR{{idProduct}}==\"{:04x}\", {}",
      subject.vendor, subject.product, kGrant);
}

std::string install_command() { return fmt::format("sudo {} doctor --install-rules", program()); }

std::string manual_install_command(const RulesFile& rules) {
  return fmt::format("sudo cp {} {} && sudo sh -c '{}'", rules.path, kPadRules.path,
                     kPadRules.apply);
}

}  // namespace gaitpad
