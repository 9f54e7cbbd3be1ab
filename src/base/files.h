// Files read with a bound and written so that a reader never sees half of one.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gaitpad/result.h"

namespace gaitpad {

// Why `path` is no file to be read, at once and without opening it: it does not exist, or it is a
// folder, a FIFO, a device, a socket, or a file of a kernel file system such as /proc/kmsg, which
// may never end. None: it is one.
std::optional<Error> no_file_problem(const std::string& path);

// The whole of a regular file of at most `max_bytes`. A FIFO or a device is an error: opening one
// could hang, reading it never end. Error: `PATH: cause`.
Result<std::string> file_text(const std::string& path, std::size_t max_bytes);

struct InputFile {
  std::string path, bytes;
};
// The files that a session is made of. While it lives, what input_text() reads on this thread is
// kept here. Paths inside `folder` stand for `held` and not for files on the disk. They nest: an
// outer one keeps what an inner one reads from the disk, too.
class InputFiles {
 public:
  // The paths of `held` are relative to `folder`. Without a folder nothing is held.
  explicit InputFiles(const std::string& folder = "", std::vector<InputFile> held = {});
  InputFiles(const InputFiles&) = delete;
  InputFiles& operator=(const InputFiles&) = delete;
  ~InputFiles();

  // Read from the disk so far, each once.
  const std::vector<InputFile>& read() const { return read_; }

 private:
  friend Result<std::string> input_text(const std::string& path, std::size_t max_bytes);
  friend bool is_input(const std::string& path);
  friend std::vector<std::string> inputs_in(const std::string& folder);
  friend std::string beside(const std::string& path, const std::string& name);
  static const InputFiles* holder_of(const std::string& path);
  const InputFile* find(const std::string& path) const;

  std::string folder_;  // ends in `/`
  std::vector<InputFile> held_, read_;
  InputFiles* outer_;
};
// file_text() of what a session is made of.
Result<std::string> input_text(const std::string& path, std::size_t max_bytes);
// Whether it is a regular file.
bool is_input(const std::string& path);
// The paths of what stands in a folder, in no order; none if there is no such folder.
std::vector<std::string> inputs_in(const std::string& folder);
// What `name` means in the file `path`: relative to its folder, unless it is absolute.
std::string beside(const std::string& path, const std::string& name);

// `PATH: cannot be written: ` and the cause that `number`, an errno, stands for.
Error write_error(const std::string& path, int number);

// Where to write what becomes `path` when it is complete: hidden, in the same folder, different for
// every call, and not to be guessed, so that nobody can put a link there beforehand.
std::string temporary_beside(const std::string& path);

// Removes temporary files for `path` (`.NAME.PID.NUMBER` beside it) whose process was killed.
void remove_leftovers(const std::string& path);

// A file on its way to `path`, without a name or under a temporary one: new, and never through a
// link. Without publish() it is removed.
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

// Held by one process at a time for the folder of a path: for a file that is read, changed and
// written. Makes the folder. Where the file system has no locks nothing is locked.
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
