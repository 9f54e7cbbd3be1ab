#include "system/growing_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>

namespace gaitpad {

int GrowingFile::create(const std::string& path) {
  // O_NONBLOCK: a pipe without a reader is an error instead of a wait.
  const OwnedFd left(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK));
  if (left.get() < 0 && errno != ENOENT) return errno;
  if (left.get() >= 0 && ::flock(left.get(), LOCK_EX | LOCK_NB) != 0) return EWOULDBLOCK;
  ::unlink(path.c_str());
  OwnedFd file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0666));
  if (file.get() < 0 || ::flock(file.get(), LOCK_EX | LOCK_NB) != 0) return errno;
  fd_ = std::move(file);
  size_ = 0;
  return 0;
}

int GrowingFile::append(std::string_view piece) noexcept {
  const int problem = write_all(fd_.get(), piece);
  if (problem == 0) {
    size_ += static_cast<std::int64_t>(piece.size());
  } else {
    static_cast<void>(!::ftruncate(fd_.get(), size_));
  }
  return problem;
}

}  // namespace gaitpad
