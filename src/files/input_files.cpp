#include "files/input_files.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/text.h"
#include "system/whole_file.h"

namespace gaitpad {

namespace fs = std::filesystem;

namespace {

thread_local InputFiles* innermost = nullptr;

std::string normal(const std::string& path) { return fs::path(path).lexically_normal().string(); }

}  // namespace

InputFiles::InputFiles(const std::string& folder, std::vector<InputFile> held)
    : folder_(folder.empty() ? "" : normal(folder) + "/"),
      held_(std::move(held)),
      outer_(std::exchange(innermost, this)) {}

InputFiles::~InputFiles() { innermost = outer_; }

const InputFiles* InputFiles::holder_of(const std::string& path) {
  const std::string place = normal(path);
  for (const InputFiles* files = innermost; files != nullptr; files = files->outer_) {
    if (!files->folder_.empty() && place.starts_with(files->folder_)) return files;
  }
  return nullptr;
}

const InputFile* InputFiles::find(const std::string& path) const {
  const std::string name = normal(path).substr(folder_.size());
  for (const InputFile& file : held_) {
    if (file.path == name) return &file;
  }
  return nullptr;
}

Result<std::string> input_text(const std::string& path, std::size_t max_bytes) {
  if (const InputFiles* holder = InputFiles::holder_of(path)) {
    if (const InputFile* file = holder->find(path)) return file->bytes;
    return Error{printable(path) + ": the recording does not hold this file"};
  }
  auto text = file_text(path, max_bytes);
  if (!text) return text;
  for (InputFiles* files = innermost; files != nullptr; files = files->outer_) {
    const auto is_read = [&path](const InputFile& file) { return file.path == path; };
    if (std::none_of(files->read_.begin(), files->read_.end(), is_read))
      files->read_.push_back({path, *text});
  }
  return text;
}

bool is_input(const std::string& path) {
  if (const InputFiles* holder = InputFiles::holder_of(path)) return holder->find(path) != nullptr;
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

std::vector<std::string> inputs_in(const std::string& folder) {
  std::vector<std::string> paths;
  if (const InputFiles* holder = InputFiles::holder_of(folder + "/")) {
    const std::string inside = normal(folder + "/").substr(holder->folder_.size());
    for (const InputFile& file : holder->held_) {
      const bool is_inside =
          file.path.starts_with(inside) && file.path.find('/', inside.size()) == std::string::npos;
      if (is_inside) paths.push_back(holder->folder_ + file.path);
    }
    return paths;
  }
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    paths.push_back(it->path().string());
  return paths;
}

std::string beside(const std::string& path, const std::string& name) {
  const fs::path folder = fs::path(path).parent_path();
  const InputFiles* holder = InputFiles::holder_of(path);
  if (holder == nullptr) return (folder / name).string();
  // Clamp `..` at the folder's root: no name leads outside.
  const std::string inside = normal(folder.string() + "/").substr(holder->folder_.size());
  return holder->folder_ +
         (fs::path("/") / inside / name).lexically_normal().relative_path().string();
}

}  // namespace gaitpad
