// Strict reader of the program's TOML files. A wrong type, a value out of range, a key that nobody
// asked for and a syntax error all become one sentence: `FILE:LINE: unknown key "inner_zome"; ...`.
// Files come from strangers: at most 1 MiB, bounded depth, nothing thrown.
//
// Use: parse or load, ask every table for every key it may hold, then look at problem() once:
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

// A string as it stands in a TOML file, quotes and all; of what is no UTF-8 only ASCII is left.
std::string toml_string(std::string_view text);

struct TomlDocument;  // hides toml++

// One table of a file: a small handle, valid as long as its TomlFile. A getter returns nothing
// where the key is absent, and also where its value is wrong: then the file keeps the problem (the
// first one counts). Asking for a key makes it a known key.
class TomlTable {
 public:
  // Finite and within [min, max]; a whole number counts as a number.
  std::optional<double> number(std::string_view key, double min, double max);
  std::optional<std::int64_t> integer(std::string_view key, std::int64_t min, std::int64_t max);
  std::optional<bool> boolean(std::string_view key);
  std::optional<std::string> string(std::string_view key);
  // An array of min_count..max_count numbers, each within [min, max].
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t min_count,
                                             std::size_t max_count, double min, double max);
  std::optional<std::vector<std::string>> strings(std::string_view key, std::size_t max_count);
  std::optional<TomlTable> table(std::string_view key);
  // `[[key]]`, at most max_count; empty where absent.
  std::vector<TomlTable> tables(std::string_view key, std::size_t max_count);

  bool has(std::string_view key);
  // A problem unless the key is there.
  void require(std::string_view key);
  // The caller's own objection to a key's value, `FILE:LINE: cause` with that key's line.
  void reject(std::string_view key, const std::string& cause);

  // For tables whose keys are data: in the order of the file, none of them made known.
  std::vector<std::string> keys() const;
  int line() const;                      // where the table begins
  int line(std::string_view key) const;  // of the key's value; the table's where it is absent

 private:
  friend class TomlFile;
  TomlTable(TomlDocument& document, std::size_t index) : document_(&document), index_(index) {}
  TomlDocument* document_;
  std::size_t index_;
};

class TomlFile {
 public:
  static Result<TomlFile> load(const std::string& path);
  // `name` and `first_line` stand in the sentences (a trace carries its calibration inside).
  static Result<TomlFile> parse(std::string_view text, const std::string& name, int first_line = 1);

  TomlTable root();
  const std::string& name() const;
  // The first wrong value, else the first key that was never asked for, else a missing key.
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

// Looks over a TOML text before toml++ parses it, for what toml++ would not survive or misplace.

// A dotted key nests a table a dot, and toml++ frees nested tables by recursion.
inline constexpr int kMaxKeyParts = 16;

// The line, from 1, of the first key with more parts; 0 where there is none. Strings and comments
// are skipped as TOML says, so far as the text is valid; toml++ itself stops where it is not.
int line_of_overlong_key(std::string_view text);
// The line of the first character beyond ASCII that stands in no string and no comment, where
// TOML 1.0 has none (a mark of byte order at the very beginning is let through); 0 where there is
// none. toml++ takes some of them for white space by way of undefined behaviour.
int line_of_stray_character(std::string_view text);
// The line of the first byte that is no UTF-8; 0 where there is none. (toml++ names the line where
// it began to read ahead.)
int line_of_invalid_utf8(std::string_view text);

}  // namespace gaitpad
