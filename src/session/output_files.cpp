#include "session/output_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace gaitpad {
namespace fs = std::filesystem;
namespace {

Error failure(const std::string& path, int number) {
  return Error{fmt::format("{}: cannot be written: {}", path, std::strerror(number))};
}

}  // namespace

Result<OutputFiles> OutputFiles::open(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) return Error{fmt::format("{}: cannot be made: {}", folder, error.message())};
  if (!fs::is_directory(folder, error)) return failure(folder, ENOTDIR);
  return OutputFiles(folder);
}

Result<std::ostream*> OutputFiles::add(const std::string& name) {
  File file;
  file.path = (fs::path(folder_) / name).string();
  file.temporary = (fs::path(folder_) / fmt::format(".{}.{}", name, ::getpid())).string();
  std::error_code ignored;
  if (fs::is_directory(file.path, ignored)) return failure(file.path, EISDIR);
  errno = 0;
  file.stream = std::make_unique<std::ofstream>(file.temporary, std::ios::binary);
  if (!*file.stream) return failure(file.path, errno);
  files_.push_back(std::move(file));
  return files_.back().stream.get();
}

Result<std::fstream> OutputFiles::scratch() const {
  const std::string path = (fs::path(folder_) / fmt::format(".scratch.{}", ::getpid())).string();
  errno = 0;
  std::fstream stream(path, std::ios::binary | std::ios::in | std::ios::out | std::ios::trunc);
  if (!stream) return failure(path, errno);
  std::error_code ignored;
  fs::remove(path, ignored);  // the stream keeps what it is open on
  return stream;
}

std::optional<Error> OutputFiles::publish() {
  for (const File& file : files_) {
    errno = 0;
    file.stream->close();
    if (file.stream->fail()) return failure(file.path, errno != 0 ? errno : EIO);
  }
  for (File& file : files_) {
    if (std::rename(file.temporary.c_str(), file.path.c_str()) != 0) {
      return failure(file.path, errno);
    }
    file.temporary.clear();
  }
  return std::nullopt;
}

OutputFiles::~OutputFiles() {
  for (File& file : files_) {
    file.stream.reset();
    std::error_code ignored;
    if (!file.temporary.empty()) fs::remove(file.temporary, ignored);
  }
}

std::optional<Error> write_file(const std::string& path, const std::string& bytes) {
  const std::filesystem::path file(path);
  if (!file.has_filename()) return Error{path + ": is no file's name"};
  auto files = OutputFiles::open(file.has_parent_path() ? file.parent_path().string() : ".");
  if (!files) return files.error();
  auto stream = files->add(file.filename().string());
  if (!stream) return stream.error();
  **stream << bytes;
  return files->publish();
}

}  // namespace gaitpad
