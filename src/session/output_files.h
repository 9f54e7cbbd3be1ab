// The files of one run: they appear in their folder together and complete, or not at all.
#pragma once
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"

namespace gaitpad {

// Everything is written under temporary names in the same folder; publish() renames. Without it the
// temporaries vanish, and files of an earlier run stay as they were.
class OutputFiles {
 public:
  // Makes the folder where it is missing.
  static Result<OutputFiles> open(const std::string& folder);
  // A new file, empty so far; the stream lives as long as this object. What cannot be written to it
  // comes out of publish().
  Result<std::ostream*> add(const std::string& name);
  std::optional<Error> publish();
  // A file without a name in the same folder, to write and read while running; it is gone with its
  // stream, whatever happens.
  Result<std::fstream> scratch() const;

  OutputFiles(OutputFiles&&) noexcept = default;
  OutputFiles& operator=(OutputFiles&&) = delete;
  ~OutputFiles();

 private:
  struct File {
    std::string path, temporary;
    std::unique_ptr<std::ofstream> stream;
  };
  explicit OutputFiles(std::string folder) : folder_(std::move(folder)) {}

  std::string folder_;
  std::vector<File> files_;
};

// One file alone, the same way; its folder is made.
std::optional<Error> write_file(const std::string& path, const std::string& bytes);

}  // namespace gaitpad
