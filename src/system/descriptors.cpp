#include "system/descriptors.h"

#include <poll.h>

#include <cerrno>

namespace gaitpad {

int write_all(int fd, std::string_view bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t count = ::write(fd, bytes.data(), bytes.size());
    if (count > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(count));
    } else if (count == 0 || errno != EINTR) {
      return count == 0 ? EIO : errno;
    }
  }
  return 0;
}

std::optional<std::size_t> read_ready(int fd, std::span<char> bytes) noexcept {
  pollfd ready = {fd, POLLIN, 0};
  if (::poll(&ready, 1, 0) <= 0) return std::nullopt;
  const ssize_t count = ::read(fd, bytes.data(), bytes.size());
  if (count < 0 && (errno == EINTR || errno == EAGAIN)) return std::nullopt;
  return count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace gaitpad
