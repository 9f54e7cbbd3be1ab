// The input files of a session: kept while they are read, or given back from a recording.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

struct InputFile {
  std::string path, bytes;
  bool operator==(const InputFile&) const = default;
};
// The input files of a session. While an object lives, it keeps the text of every file that
// input_text() reads on this thread. Paths inside `folder` are read from `held` instead of the
// disk. Objects nest: an outer one also keeps what an inner one reads from the disk.
class InputFiles {
 public:
  // The paths of `held` are relative to `folder`. `held` is unused without a folder.
  explicit InputFiles(const std::string& folder = "", std::vector<InputFile> held = {});
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;
  ~InputFiles();

  // Files read from the disk so far, each once.
  const std::vector<InputFile>& read() const { return read_; }

 private:
  friend Result<std::string> input_text(const std::string& path, std::size_t max_bytes);
  friend bool is_input(const std::string& path);
  friend std::vector<std::string> inputs_in(const std::string& folder);
  friend std::string beside(const std::string& path, const std::string& name);
  static const InputFiles* holder_of(const std::string& path);
  const InputFile* find(const std::string& path) const;

  std::string folder_;  // path of the folder; ends in `/`
  std::vector<InputFile> held_, read_;
  InputFiles* outer_;
};
// file_text() for the input files of a session.
Result<std::string> input_text(const std::string& path, std::size_t max_bytes);
// True for a regular file on the disk or in `held`.
bool is_input(const std::string& path);
// The paths of a folder's entries, unordered; empty if there is no such folder.
std::vector<std::string> inputs_in(const std::string& folder);
// Resolves `name` as written in the file `path`: relative to its folder unless it is absolute.
std::string beside(const std::string& path, const std::string& name);

}  // namespace gaitpad
