// What replay and play share: the options of a session, declared once, and how a summary is
// printed.
#pragma once
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "gaitpad/setup.h"

namespace gaitpad {

struct SessionArguments {
  SessionOptions options;
  std::string ik = "robust";
  int rate_hz = 0;  // 0: not given
};
void add_session_options(CLI::App& command, SessionArguments& arguments,
                         const std::string& default_rate);
// The options as given, with the folders of configuration.
SessionOptions session_options(const SessionArguments& arguments);

// One object for one character, else a list.
void print_summaries_json(const std::vector<nlohmann::ordered_json>& summaries);
// `SOURCE: 120 reports, 480 ticks ...`, then what each character did, from line 2 on by
// `print_character`.
void print_session(const std::string& source, const nlohmann::ordered_json& first);
// `distance_m` below 0: not known.
void print_character(std::size_t index, const nlohmann::ordered_json& summary, double distance_m);

}  // namespace gaitpad
