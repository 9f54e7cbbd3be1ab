// A strict reader of TOML files. A syntax error, a wrong type, a value out of range and a key that
// the caller did not ask for all become one sentence: `FILE:LINE: unknown key "inner_zome"; did you
// mean ...?`. Size and depth are bounded and nothing is thrown, so any file is safe to read.
//
// Ask every table for every key that it may hold, then look at problem() once:
//   auto file = TomlFile::load(path);
//   if (!file) return file.error();
//   TomlTable root = file->root();
//   style.fatigue = root.number("fatigue", 0.0, 1.0).value_or(0.0);
//   if (auto problem = file->problem()) return *problem;
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

inline constexpr std::size_t kMaxTomlBytes = 1 << 20;

// The text as a TOML string, with its quotes. If it is not UTF-8, bytes beyond ASCII become '?'.
std::string toml_string(std::string_view text);

struct TomlDocument;  // keeps toml++ out of this header

// One table of a file: a small handle, valid as long as its TomlFile. A getter returns nothing if
// the key is absent or its value is wrong; the file keeps the first wrong value as its problem().
// Asking for a key makes it known.
class TomlTable {
 public:
  // A finite number within [min, max]; integers are also numbers.
  std::optional<double> number(std::string_view key, double min, double max);
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t min, std::int64_t max);
  std::optional<bool> boolean(std::string_view key);
  std::optional<std::string> string(std::string_view key);
  // An array of min_count..max_count numbers, each within [min, max].
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t min_count,
                                             std::size_t max_count, double min, double max);
  std::optional<std::vector<std::string>> strings(std::string_view key, std::size_t max_count);
  std::optional<TomlTable> table(std::string_view key);
  // The tables of `[[key]]`, at most max_count; empty if absent.
  std::vector<TomlTable> tables(std::string_view key, std::size_t max_count);

  bool has(std::string_view key);
  // Reports a problem if the key is absent.
  void require(std::string_view key);
  // Reports the problem `FILE:LINE: cause` with the line of that key's value.
  void reject(std::string_view key, const std::string& cause);

  // All keys in the order of the file, for tables whose keys are data. They do not become known.
  std::vector<std::string> keys() const;
  int line() const;  // Number of the table's first line.
  // Number of the key's line; the table's if the key is absent.
  int line(std::string_view key) const;

 private:
  friend class TomlFile;
  TomlTable(TomlDocument& document, std::size_t index) : document_(&document), index_(index) {}
  TomlDocument* document_;
  std::size_t index_;
};

class TomlFile {
 public:
  static Result<TomlFile> load(const std::string& path);
  // Errors name `name` and count lines from `first_line`: a trace, for example, contains a
  // calibration.
  static Result<TomlFile> parse(std::string_view text, const std::string& name, int first_line = 1);

  TomlTable root();
  const std::string& name() const;
  // The first wrong value, otherwise the first key that was never asked for, otherwise a missing
  // key.
  std::optional<Error> problem() const;

  TomlFile(TomlFile&&) noexcept;
  TomlFile& operator=(TomlFile&&) noexcept;
  TomlFile(const TomlFile&) = delete;
  TomlFile& operator=(const TomlFile&) = delete;
  ~TomlFile();

 private:
  explicit TomlFile(std::unique_ptr<TomlDocument> document);
  std::unique_ptr<TomlDocument> document_;
};

// Checks for texts on which toml++ would crash or name the wrong line. Each returns a line from 1,
// or 0 if nothing is wrong.

// Each dot of a key nests a table, and toml++ frees nested tables by recursion.
inline constexpr int kMaxKeyParts = 16;

// The first key with more parts. Skips strings and comments; correct up to the first syntax error,
// where toml++ stops.
int line_of_overlong_key(std::string_view text);
// The first character beyond ASCII outside of strings and comments, where TOML 1.0 allows only a
// byte order mark at the beginning. toml++ reads some of them as white space, with undefined
// behaviour.
int line_of_stray_character(std::string_view text);
// The first byte that is not UTF-8. toml++ would name the line at which it began to read ahead.
int line_of_invalid_utf8(std::string_view text);

}  // namespace gaitpad
