// The measurements of `gaitpad bench` as a table for people.
#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bench/measured.h"

namespace gaitpad {

std::string lanes_text(int lanes);  // The width of a pass in words: `8 lanes (AVX-512)`.

// A row for each measurement, below headings; the last line gives a character's memory. `list` is
// list_of(rows). `core`: as Cores::core().
std::vector<std::string> bench_lines(const std::vector<BenchRow>& rows,
                                     const nlohmann::ordered_json& list, int core, int rounds);

}  // namespace gaitpad
