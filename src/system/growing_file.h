// A file that one process makes longer while others may read it.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "system/descriptors.h"

namespace gaitpad {

// Locked while it is open, so that no second process writes into it.
class GrowingFile {
 public:
  // Creates the file; replaces one that an ended process left. Never follows a link and never
  // waits. Returns 0 or an errno; EWOULDBLOCK: another process has the file open as a GrowingFile.
  int create(const std::string& path);
  // Appends the piece. Returns 0, or the errno of a failed write: the file then ends after the last
  // whole piece, unless cutting it off fails also.
  int append(std::string_view piece) noexcept;

 private:
  OwnedFd fd_;
  std::int64_t size_ = 0;  // bytes of the whole pieces
};

}  // namespace gaitpad
