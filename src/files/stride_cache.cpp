#include "files/stride_cache.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include "files/made_strides.h"
#include "gaitpad/clean_strides.h"
#include "gaitpad/hash.h"
#include "strides/solver_input.h"
#include "system/whole_file.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

// A hash of the sources; CMakeLists.txt sets it.
#ifdef GAITPAD_STRIDES_VERSION
constexpr std::uint64_t kVersion = GAITPAD_STRIDES_VERSION;
#else
constexpr std::uint64_t kVersion = 0;  // version of a build without a cache: files are neither read
                                       // nor written
#endif
constexpr std::size_t kMostFiles = 64;
constexpr const char* kEnding = ".strides";

std::uint64_t hash_of(const std::vector<double>& numbers) {
  WordHash hash;
  hash.add(std::bit_cast<double>(kVersion));
  for (const double number : numbers) hash.add(number);
  return hash.value();
}

// A file: version, input, solution, and a hash of all three. Numbers have their memory format.
std::vector<double> file_numbers(const std::vector<double>& input, const StrideFamily& family) {
  std::vector<double> numbers = {std::bit_cast<double>(kVersion)};
  numbers.insert(numbers.end(), input.begin(), input.end());
  for_each_number(family, [&numbers](double number) { numbers.push_back(number); });
  numbers.push_back(std::bit_cast<double>(hash_of(numbers)));
  return numbers;
}

std::string path_in(const std::string& folder, const std::vector<double>& input) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  const std::uint64_t hash = hash_of(input);
  std::string name;
  for (int shift = 60; shift >= 0; shift -= 4) name += kDigits[hash >> shift & 15];
  return (fs::path(folder) / (name + kEnding)).string();
}

StrideFamily empty_family() {
  StrideFamily family;
  family.table.resize(kStrideRatios);
  family.back.resize(kBackRatios);
  return family;
}

// The built-in walk's strides, if `input` is the built-in walk.
std::optional<StrideFamily> made_family([[maybe_unused]] const std::vector<double>& input) {
#ifdef GAITPAD_HAS_MADE_STRIDES
  const std::span<const std::uint64_t> made = made_strides();
  if (made.size() < input.size() ||
      std::memcmp(made.data(), input.data(), input.size() * sizeof(double)) != 0)
    return std::nullopt;
  StrideFamily family = empty_family();
  const std::uint64_t* next = made.data() + input.size();
  for_each_number(family, [&next](double& number) { number = std::bit_cast<double>(*next++); });
  return family;
#else
  return std::nullopt;
#endif
}

std::optional<StrideFamily> read_family(const std::string& path, const std::vector<double>& input) {
  StrideFamily family = empty_family();
  const std::size_t size = file_numbers(input, family).size() * sizeof(double);
  const auto bytes = file_text(path, size);
  if (!bytes || bytes->size() != size) return std::nullopt;
  std::vector<double> numbers(size / sizeof(double));
  std::memcpy(numbers.data(), bytes->data(), size);
  const auto at = [&numbers](std::size_t n) { return std::bit_cast<std::uint64_t>(numbers[n]); };
  const std::uint64_t hash = at(numbers.size() - 1);
  numbers.pop_back();
  if (at(0) != kVersion || hash != hash_of(numbers)) return std::nullopt;
  if (std::memcmp(&numbers[1], input.data(), input.size() * sizeof(double)) != 0)
    return std::nullopt;
  const double* next = &numbers[1] + input.size();
  for_each_number(family, [&next](double& number) { number = *next++; });
  return family;
}

void delete_oldest(const std::string& folder) {
  std::error_code error;
  std::vector<std::pair<fs::file_time_type, fs::path>> files;
  fs::directory_iterator entry(folder, error);
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() != kEnding) continue;
    std::error_code gone;  // ignored: another process may have deleted the file
    const auto time = entry->last_write_time(gone);
    if (!gone) files.emplace_back(time, entry->path());
  }
  if (files.size() <= kMostFiles) return;
  std::sort(files.begin(), files.end());
  for (std::size_t i = 0; i < files.size() - kMostFiles; ++i) fs::remove(files[i].second, error);
}

}  // namespace

std::string stride_cache_folder() {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return fs::path(value != nullptr ? value : "");
  };
  if (variable("GAITPAD_CACHE") == "off") return "";
  fs::path cache = variable("XDG_CACHE_HOME");
  if (cache.is_relative()) {
    const fs::path home = variable("HOME");
    if (home.is_relative()) return "";
    cache = home / ".cache";
  }
  return (cache / "gaitpad" / "strides").string();
}

Result<GaitCycle> cached_clean_strides(GaitCycle cycle, const std::string& folder) {
  const std::vector<double> input = solver_input(cycle);
  if (auto family = made_family(input)) {
    cycle.strides = std::make_shared<const StrideFamily>(std::move(*family));
    return cycle;
  }
  if (folder.empty() || kVersion == 0) return with_clean_strides(std::move(cycle));
  const std::string path = path_in(folder, input);
  if (auto family = read_family(path, input)) {
    cycle.strides = std::make_shared<const StrideFamily>(std::move(*family));
    return cycle;
  }
  auto solved = with_clean_strides(std::move(cycle));
  if (!solved) return solved;
  const std::vector<double> numbers = file_numbers(input, *solved->strides);
  const std::string_view bytes(reinterpret_cast<const char*>(numbers.data()),
                               numbers.size() * sizeof(double));
  if (!write_file(path, bytes)) delete_oldest(folder);
  return solved;
}

}  // namespace gaitpad
