#include "files/toml_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "base/suggestion.h"
#include "base/text.h"
#include "files/input_files.h"

namespace gaitpad {

namespace {

// Index after the string that begins at `begin` (a quote), or the end of the text.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const char three[] = {quote, quote, quote};
  const bool is_long = text.substr(begin, 3) == std::string_view(three, 3);
  const std::string_view closing(three, is_long ? 3 : 1);
  std::size_t i = begin + closing.size();
  for (; i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (text[i] == quote && text.substr(i, closing.size()) == closing) {
      i += closing.size();
      break;
    } else if (text[i] == '\n' && !is_long) {
      break;
    }
  }
  // A long string may end in up to two quotes of its own before the closing three.
  for (int n = 0; n < 2 && is_long && i < text.size() && text[i] == quote; ++n) ++i;
  return std::min(i, text.size());
}

int line_at(std::string_view text, std::size_t place) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + place, '\n'));
}

// The line of the first byte outside strings and comments that `is_wanted` accepts; 0 if there is
// none.
template <class Wanted>
int first_line(std::string_view text, Wanted is_wanted) {
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = end_of_string(text, i);
    } else if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
    } else {
      if (is_wanted(c)) return line_at(text, i);
      ++i;
    }
  }
  return 0;
}

}  // namespace

int line_of_overlong_key(std::string_view text) {
  int dots = 0;
  return first_line(text, [&dots](char c) {
    switch (c) {
      case '.':
        return ++dots >= kMaxKeyParts;
      case ',':
      case '[':
      case ']':
      case '{':
      case '}':
      case '=':
      case '\n':
        dots = 0;  // the end of a key
        return false;
      default:
        return false;
    }
  });
}

int line_of_stray_character(std::string_view text) {
  const auto is_beyond_ascii = [](char c) { return static_cast<unsigned char>(c) >= 0x80; };
  if (std::none_of(text.begin(), text.end(), is_beyond_ascii)) return 0;
  return first_line(without_byte_order_mark(text), is_beyond_ascii);
}

int line_of_invalid_utf8(std::string_view text) {
  const std::size_t place = utf8_bytes(text);
  return place == text.size() ? 0 : line_at(text, place);
}

struct TomlDocument {
  struct Visited {
    const toml::table* table;
    std::vector<std::string> known;
  };
  std::string name;
  int line_offset = 0;
  toml::table root;
  std::vector<Visited> visited;
  std::optional<Error> wrong, missing;

  int line_of(const toml::node& node) const {
    return static_cast<int>(node.source().begin.line) + line_offset;
  }
  Error error_at(int line, const std::string& cause) const {
    return Error{fmt::format("{}:{}: {}", name, line, cause)};
  }
  void note_wrong(const toml::node& node, const std::string& cause) {
    if (!wrong) wrong = error_at(line_of(node), cause);
  }
  const toml::node* asked(std::size_t index, std::string_view key) {
    Visited& visit = visited[index];
    if (std::find(visit.known.begin(), visit.known.end(), key) == visit.known.end()) {
      visit.known.emplace_back(key);
    }
    return visit.table->get(key);
  }
  std::size_t visit(const toml::table& table) {
    for (std::size_t i = 0; i < visited.size(); ++i) {
      if (visited[i].table == &table) return i;
    }
    visited.push_back({&table, {}});
    return visited.size() - 1;
  }
  std::optional<double> number_in(const toml::node& node, std::string_view what, double min,
                                  double max) {
    std::optional<double> value;
    if (const auto* whole = node.as_integer()) value = static_cast<double>(whole->get());
    if (const auto* real = node.as_floating_point()) value = real->get();
    if (!value) {
      note_wrong(node, fmt::format("{} is not a number", what));
    } else if (!(*value >= min && *value <= max) || !std::isfinite(*value)) {
      note_wrong(node, fmt::format("{} is {}, outside [{}, {}]", what, *value, min, max));
    } else {
      return *value;
    }
    return {};
  }
  // The array at the key; null if it is absent or has not min_count to max_count elements.
  const toml::array* array_at(std::size_t index, std::string_view key, std::size_t min_count,
                              std::size_t max_count, std::string_view of) {
    const toml::node* node = asked(index, key);
    if (!node) return nullptr;
    const toml::array* array = node->as_array();
    if (!array) {
      note_wrong(*node, fmt::format("{} is not an array of {}", in_quotes(key), of));
      return nullptr;
    }
    if (array->size() < min_count || array->size() > max_count) {
      const std::string wanted = min_count == max_count
                                     ? fmt::format("{}", min_count)
                                     : fmt::format("{} to {}", min_count, max_count);
      note_wrong(*node,
                 fmt::format("{} has {} elements, not {}", in_quotes(key), array->size(), wanted));
      return nullptr;
    }
    return array;
  }
};

std::string toml_string(std::string_view text) {
  std::string quoted = "\"";
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    const std::string_view character = text.substr(0, std::max<std::size_t>(bytes, 1));
    const auto byte = static_cast<unsigned char>(text[0]);
    if (bytes == 0) {
      quoted += '?';  // TOML allows only valid UTF-8
    } else if (byte == '"' || byte == '\\') {
      quoted += fmt::format("\\{}", character);
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += fmt::format("\\u{:04x}", static_cast<unsigned>(byte));
    } else {
      quoted += printable(character);  // \u202e in a printable text is also TOML's escape
    }
    text.remove_prefix(character.size());
  }
  return quoted + "\"";
}

std::optional<double> TomlTable::number(std::string_view key, double min, double max) {
  const toml::node* node = document_->asked(index_, key);
  return node ? document_->number_in(*node, in_quotes(key), min, max) : std::nullopt;
}

std::optional<std::int64_t> TomlTable::integer(std::string_view key, std::int64_t min,
                                               std::int64_t max) {
  const toml::node* node = document_->asked(index_, key);
  if (!node) return {};
  const auto* value = node->as_integer();
  if (!value) {
    document_->note_wrong(*node, fmt::format("{} is not a whole number", in_quotes(key)));
  } else if (value->get() < min || value->get() > max) {
    document_->note_wrong(
        *node, fmt::format("{} is {}, outside [{}, {}]", in_quotes(key), value->get(), min, max));
  } else {
    return value->get();
  }
  return {};
}

std::optional<bool> TomlTable::boolean(std::string_view key) {
  const toml::node* node = document_->asked(index_, key);
  if (!node) return {};
  if (const auto* value = node->as_boolean()) return value->get();
  document_->note_wrong(*node, fmt::format("{} is not true or false", in_quotes(key)));
  return {};
}

std::optional<std::string> TomlTable::string(std::string_view key) {
  const toml::node* node = document_->asked(index_, key);
  if (!node) return {};
  if (const auto* value = node->as_string()) return value->get();
  document_->note_wrong(*node, fmt::format("{} is not a string", in_quotes(key)));
  return {};
}

std::optional<std::vector<double>> TomlTable::numbers(std::string_view key, std::size_t min_count,
                                                      std::size_t max_count, double min,
                                                      double max) {
  const toml::array* array = document_->array_at(index_, key, min_count, max_count, "numbers");
  if (!array) return {};
  std::vector<double> values;
  for (const toml::node& element : *array) {
    const std::string what = fmt::format("{}, element {},", in_quotes(key), values.size() + 1);
    const auto value = document_->number_in(element, what, min, max);
    if (!value) return {};
    values.push_back(*value);
  }
  return values;
}

std::optional<std::vector<std::string>> TomlTable::strings(std::string_view key,
                                                           std::size_t max_count) {
  const toml::array* array = document_->array_at(index_, key, 0, max_count, "strings");
  if (!array) return {};
  std::vector<std::string> values;
  for (const toml::node& element : *array) {
    const auto* value = element.as_string();
    if (!value) {
      document_->note_wrong(element, fmt::format("{}, element {}, is not a string", in_quotes(key),
                                                 values.size() + 1));
      return {};
    }
    values.push_back(value->get());
  }
  return values;
}

std::optional<TomlTable> TomlTable::table(std::string_view key) {
  const toml::node* node = document_->asked(index_, key);
  if (!node) return {};
  if (const auto* value = node->as_table()) return TomlTable(*document_, document_->visit(*value));
  document_->note_wrong(*node, fmt::format("{} is not a table", in_quotes(key)));
  return {};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key, std::size_t max_count) {
  std::vector<TomlTable> found;
  const toml::array* array = document_->array_at(index_, key, 0, max_count, "tables");
  if (!array) return found;
  for (const toml::node& element : *array) {
    const auto* value = element.as_table();
    if (!value) {
      document_->note_wrong(
          element, fmt::format("{}, element {}, is not a table", in_quotes(key), found.size() + 1));
      return {};
    }
    found.push_back(TomlTable(*document_, document_->visit(*value)));
  }
  return found;
}

bool TomlTable::has(std::string_view key) { return document_->asked(index_, key) != nullptr; }

void TomlTable::require(std::string_view key) {
  if (document_->asked(index_, key) || document_->missing) return;
  document_->missing =
      document_->error_at(line(), fmt::format("key {} is missing", in_quotes(key)));
}

void TomlTable::reject(std::string_view key, const std::string& cause) {
  if (!document_->wrong) document_->wrong = document_->error_at(line(key), cause);
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::pair<toml::source_position, std::string>> ordered;
  for (const auto& [key, node] : *document_->visited[index_].table) {
    ordered.emplace_back(key.source().begin, std::string(key.str()));
  }
  std::sort(ordered.begin(), ordered.end());
  std::vector<std::string> names;
  for (auto& [place, key] : ordered) names.push_back(std::move(key));
  return names;
}

int TomlTable::line() const {
  // The root table of an empty text has no line.
  const int line = document_->line_of(*document_->visited[index_].table);
  return std::max(line, 1 + document_->line_offset);
}

int TomlTable::line(std::string_view key) const {
  const toml::node* node = document_->visited[index_].table->get(key);
  return node ? document_->line_of(*node) : line();
}

Result<TomlFile> TomlFile::load(const std::string& path) {
  auto text = input_text(path, kMaxTomlBytes);
  if (!text) return text.error();
  return parse(*text, path);
}

Result<TomlFile> TomlFile::parse(std::string_view text, const std::string& name, int first_line) {
  auto document = std::make_unique<TomlDocument>();
  document->name = printable(name);
  document->line_offset = first_line - 1;
  if (text.size() > kMaxTomlBytes) {
    return Error{fmt::format("{}: larger than {} bytes", document->name, kMaxTomlBytes)};
  }
  const auto damage_at = [&](int line, const std::string& cause) {
    return document->error_at(line + document->line_offset, cause);
  };
  if (const int line = line_of_invalid_utf8(text)) return damage_at(line, "not UTF-8");
  if (const int line = line_of_stray_character(text))
    return damage_at(line, "a character beyond ASCII outside of strings and comments");
  if (const int line = line_of_overlong_key(text)) {
    return damage_at(line, fmt::format("a key of more than {} parts", kMaxKeyParts));
  }
  try {
    document->root = toml::parse(text);
  } catch (const toml::parse_error& error) {
    return damage_at(static_cast<int>(error.source().begin.line), printable(error.description()));
  } catch (const std::exception& error) {
    return Error{fmt::format("{}: {}", document->name, printable(error.what()))};
  }
  document->visit(document->root);
  return TomlFile(std::move(document));
}

TomlTable TomlFile::root() { return TomlTable(*document_, 0); }
const std::string& TomlFile::name() const { return document_->name; }

std::optional<Error> TomlFile::problem() const {
  if (document_->wrong) return document_->wrong;
  const toml::key* first = nullptr;
  const TomlDocument::Visited* owner = nullptr;
  for (const TomlDocument::Visited& visit : document_->visited) {
    for (const auto& [key, node] : *visit.table) {
      const bool is_known =
          std::find(visit.known.begin(), visit.known.end(), key.str()) != visit.known.end();
      if (is_known || (first && first->source().begin < key.source().begin)) continue;
      first = &key;
      owner = &visit;
    }
  }
  if (!first) return document_->missing;
  return document_->error_at(static_cast<int>(first->source().begin.line) + document_->line_offset,
                             fmt::format("unknown key {}{}", in_quotes(first->str()),
                                         suggestion(first->str(), owner->known)));
}

TomlFile::TomlFile(std::unique_ptr<TomlDocument> document) : document_(std::move(document)) {}
TomlFile::TomlFile(TomlFile&&) noexcept = default;
TomlFile& TomlFile::operator=(TomlFile&&) noexcept = default;
TomlFile::~TomlFile() = default;

}  // namespace gaitpad
