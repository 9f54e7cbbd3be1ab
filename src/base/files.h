// Files read with a bound and written so that a reader never sees half of one.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "gaitpad/result.h"

namespace gaitpad {

// Why `path` is no file to be read, at once and without opening it: it does not exist, or it is a
// folder, a FIFO, a device, a socket, or a file of a kernel file system such as /proc/kmsg, which
// may never end. None: it is one.
std::optional<Error> no_file_problem(const std::string& path);

// The whole of a regular file of at most `max_bytes`. A FIFO or a device is an error: opening one
// could hang, reading it never end. Error: `PATH: cause`.
Result<std::string> file_text(const std::string& path, std::size_t max_bytes);

// `PATH: cannot be written: ` and the cause that `number`, an errno, stands for.
Error write_error(const std::string& path, int number);

// Where to write what becomes `path` when it is complete: hidden, in the same folder, different for
// every call, and not to be guessed, so that nobody can put a link there beforehand.
std::string temporary_beside(const std::string& path);

// Removes temporary files for `path` (`.NAME.PID.NUMBER` beside it) whose process was killed.
void remove_leftovers(const std::string& path);

// A file on its way to `path`, under a temporary name: new, and never through a link. Without
// publish() it is removed.
class NewFile {
 public:
  static Result<NewFile> create(const std::string& path);
  NewFile(NewFile&& other) noexcept;
  NewFile& operator=(NewFile&&) = delete;
  ~NewFile();

  const std::string& path() const { return path_; }
  int fd() const { return fd_; }
  // A name of the open file for streams, whatever stands in the folder by now.
  std::string name_for_streams() const { return "/proc/self/fd/" + std::to_string(fd_); }
  std::optional<Error> write(std::string_view bytes);
  std::optional<Error> write_to_disk();  // what was written survives a power cut
  std::optional<Error> publish();        // renames it; once

 private:
  NewFile(std::string path, std::string temporary, int fd)
      : path_(std::move(path)), temporary_(std::move(temporary)), fd_(fd) {}

  std::string path_, temporary_;
  int fd_ = -1;
};

// Makes the folder of `path`, writes a temporary file in it and renames that to `path`. On error
// what stood there before is unchanged.
std::optional<Error> write_file(const std::string& path, std::string_view bytes);

// Why save_text() to this path would fail, as far as that shows before it is tried.
std::optional<Error> saving_problem(const std::string& path);
// write_file() for what a user must not lose: the bytes are on the disk before the rename, and what
// stood there before is kept as PATH.old. Where `path` is a symbolic link, both happen where it
// points to and it stays a link.
std::optional<Error> save_text(const std::string& path, std::string_view text);

}  // namespace gaitpad
