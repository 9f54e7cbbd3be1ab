// The terminal as a device: its size, and its mode for single keys.
#pragma once
#include <cstddef>
#include <optional>

namespace gaitpad {

// Opens standard descriptors that the caller has closed. Otherwise a pad or a recording would get
// such a number, and output for the terminal would be written into it. They are opened in the wrong
// direction, so that using them fails as on closed ones.
void hold_standard_descriptors() noexcept;

bool is_terminal(int fd) noexcept;

struct TerminalSize {
  std::size_t columns = 0, rows = 0;  // 0: unknown
};
// Nothing if the descriptor is not a terminal.
std::optional<TerminalSize> terminal_size(int fd) noexcept;

// While it lives, the terminal of standard input gives single keys at once and does not show them.
// The terminal's mode is restored by the destructor and when the process is stopped (Ctrl-Z) or
// quit (Ctrl-\), and changed again when the process continues. Ctrl-C still sends a signal. At most
// one object at a time. Without effect if standard input is not a terminal.
class SingleKeyMode {
 public:
  // Whether keys count that were pressed before the object was made.
  enum class Earlier { count, forgotten };
  explicit SingleKeyMode(Earlier earlier);
  ~SingleKeyMode();
  SingleKeyMode(const SingleKeyMode&) = delete;
  SingleKeyMode& operator=(const SingleKeyMode&) = delete;
  bool is_terminal() const noexcept { return is_terminal_; }

 private:
  bool is_terminal_ = false;
};

}  // namespace gaitpad
