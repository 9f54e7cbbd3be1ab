#include "doctor/user_unit.h"

#include <fmt/format.h>

#include <filesystem>

namespace gaitpad {

std::string unit_word(const std::string& word) {
  std::string text = "\"";
  for (const char c : word) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) {
      text += fmt::format("\\x{:02x}", byte);
      continue;
    }
    if (c == '"' || c == '\\') text += '\\';
    if (c == '%' || c == '$') text += c;
    text += c;
  }
  return text + '"';
}

std::string user_unit_text(const std::vector<std::string>& arguments) {
  std::string command = unit_word(std::filesystem::read_symlink("/proc/self/exe").string());
  for (const std::string& word : arguments) command += " " + unit_word(word);
  return fmt::format(
      "[Unit]\n"
      "Description=A calibrated pad in place of the real one, for every program\n"
      "Documentation=man:gaitpad-forward(1)\n"
      "\n"
      "[Service]\n"
      "ExecStart={}\n"
      "Restart=on-failure\n"
      "RestartSec=5\n"
      "\n"
      "[Install]\n"
      "WantedBy=default.target\n",
      command);
}

}  // namespace gaitpad
