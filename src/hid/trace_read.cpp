#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "hid/trace.h"
#include "hid/trace_reader.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMaxLineBytes = 1 << 20;

// Feeds a reader line by line, however the text arrives in pieces.
class LineFeed {
 public:
  LineFeed(const std::string& name, Damage damage) : reader_(name), name_(name), damage_(damage) {}

  std::optional<Error> add(std::string_view piece) {
    while (!piece.empty()) {
      const std::size_t end = piece.find('\n');
      const std::string_view part = piece.substr(0, end);
      const bool complete = end != std::string_view::npos;
      piece.remove_prefix(complete ? end + 1 : piece.size());
      if (complete && rest_.empty()) {
        if (auto error = line(part)) return error;
        continue;
      }
      // What is too long is remembered as such: cut, and no longer a line of a trace.
      rest_.append(part.substr(0, kMaxLineBytes + 1 - std::min(rest_.size(), kMaxLineBytes + 1)));
      if (complete) {
        const std::string whole = std::move(rest_);
        rest_.clear();
        if (auto error = line(whole)) return error;
      }
    }
    return std::nullopt;
  }

  Result<Trace> finish() {
    if (!rest_.empty()) {
      if (auto error = line(rest_)) return *error;
    }
    const Cause cause = reader_.finish(damage_);
    if (cause) return Error{fmt::format("{}: {}", name_, *cause)};
    return reader_.take();
  }

 private:
  std::optional<Error> line(std::string_view text) {
    ++number_;
    Cause cause;
    const bool comment = !text.empty() && text.front() == '#';
    if (text.size() > kMaxLineBytes && !comment) {
      cause = fmt::format("the line is longer than {} bytes", kMaxLineBytes);
    } else {
      cause = reader_.add(text);
    }
    if (!cause) return std::nullopt;
    const std::string sentence = fmt::format("{}:{}: {}", name_, number_, *cause);
    if (damage_ == Damage::refuse) return Error{sentence};
    reader_.skip(sentence);
    return std::nullopt;
  }

  TraceReader reader_;
  std::string name_;
  Damage damage_;
  std::string rest_;
  std::int64_t number_ = 0;
};

}  // namespace

Result<Trace> parse_trace(std::string_view text, const std::string& name, Damage damage) {
  LineFeed feed(name, damage);
  if (auto error = feed.add(text)) return *error;
  return feed.finish();
}

Result<Trace> read_trace(const std::string& path, Damage damage) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  if (!fs::exists(status)) return Error{path + ": there is no such file"};
  if (!fs::is_regular_file(status) && !fs::is_fifo(status)) {
    return Error{path + ": this is no file, a trace was expected"};
  }
  std::ifstream in(path, std::ios::binary);
  if (!in) return Error{path + ": cannot be opened for reading"};
  LineFeed feed(path, damage);
  std::vector<char> buffer(1 << 16);
  std::size_t total = 0;
  while (in.good()) {
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    const auto got = static_cast<std::size_t>(in.gcount());
    total += got;
    if (total > kMaxTraceBytes) {
      return Error{fmt::format("{}: larger than {} MiB", path, kMaxTraceBytes >> 20)};
    }
    if (auto error = feed.add({buffer.data(), got})) return *error;
  }
  if (in.bad()) return Error{path + ": reading failed"};
  return feed.finish();
}

}  // namespace gaitpad
