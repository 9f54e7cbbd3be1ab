// Reads files up to a size limit and writes them atomically: a reader never sees half of one.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

// The error if `path` is not a regular file that can be read: it is missing, a folder, a FIFO, a
// device, a socket, or a file of a kernel file system such as /proc/kmsg, which may never end. The
// check does not open it, so it cannot block. Empty if it is a regular file.
std::optional<Error> no_file_problem(const std::string& path);

// The whole of a regular file of at most `max_bytes`. A FIFO or a device is an error: opening one
// may block, reading it may never end. Error: `PATH: cause`.
Result<std::string> file_text(const std::string& path, std::size_t max_bytes);

// `PATH: cannot be written: ` and the text of `number`, an errno.
Error write_error(const std::string& path, int number);

// A temporary path for a new version of `path`: hidden, in the same folder, different in every call
// and unpredictable, so that no other user can put a link there beforehand.
std::string temporary_beside(const std::string& path);

// Removes temporary files for `path` (`.NAME.PID.NUMBER` beside it) whose process was killed.
void remove_leftovers(const std::string& path);

// A new file that publish() renames to `path`; until then it has no name or a temporary one and is
// removed on destruction. It is never written through a link.
class NewFile {
 public:
  static Result<NewFile> create(const std::string& path);
  NewFile(NewFile&& other) noexcept;
  NewFile& operator=(NewFile&&) = delete;
  ~NewFile();

  const std::string& path() const { return path_; }
  int fd() const { return fd_; }
  // A path for streams that always means the open file, even if the folder has changed.
  std::string name_for_streams() const { return "/proc/self/fd/" + std::to_string(fd_); }
  std::optional<Error> write(std::string_view bytes);
  std::optional<Error> write_to_disk();  // Makes sure that the written bytes survive a power cut.
  std::optional<Error> publish();        // Renames the file to its path. Call it once.

 private:
  NewFile(std::string path, std::string temporary, int fd)
      : path_(std::move(path)), temporary_(std::move(temporary)), fd_(fd) {}

  std::string path_, temporary_;
  int fd_ = -1;
};

// A lock on the folder of `path` for one process at a time, to read, change and write a file there.
// Creates the folder. Without effect if the file system has no locks.
class FolderLock {
 public:
  static Result<FolderLock> wait(const std::string& path);
  FolderLock(FolderLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FolderLock& operator=(FolderLock&&) = delete;
  ~FolderLock();

 private:
  explicit FolderLock(int fd) : fd_(fd) {}
  int fd_;
};

// Makes the folder of `path`, writes a temporary file in it and renames that to `path`. On error a
// previous file is unchanged.
std::optional<Error> write_file(const std::string& path, std::string_view bytes);

// The error that save_text() to this path would return, as far as it can be known beforehand.
std::optional<Error> saving_problem(const std::string& path);
// write_file() for files that a user must not lose: syncs the bytes to disk before the rename and
// keeps the previous version as PATH.old. A symbolic link stays; its target is replaced.
std::optional<Error> save_text(const std::string& path, std::string_view text);

}  // namespace gaitpad
