#include "system/child_process.h"

#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace gaitpad {
namespace {

// Returns 0 or an errno.
int spawn(std::vector<std::string>& words, int input, int printed, int& process) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  ::posix_spawn_file_actions_init(&files);
  ::posix_spawnattr_init(&attributes);
  ::posix_spawn_file_actions_adddup2(&files, input, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, printed, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&files, printed, STDERR_FILENO);
  sigset_t none, defaults;
  ::sigemptyset(&none);
  ::sigemptyset(&defaults);
  ::sigaddset(&defaults, SIGPIPE);
  ::posix_spawnattr_setsigmask(&attributes, &none);
  ::posix_spawnattr_setsigdefault(&attributes, &defaults);
  ::posix_spawnattr_setpgroup(&attributes, 0);
  ::posix_spawnattr_setflags(
      &attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  const int cause = ::posix_spawnp(&process, argv[0], &files, &attributes, argv.data(), environ);
  ::posix_spawnattr_destroy(&attributes);
  ::posix_spawn_file_actions_destroy(&files);
  return cause;
}

}  // namespace

bool is_in_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::string_view folders = path != nullptr ? path : "";
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    const std::string file = std::string(folder.empty() ? "." : folder) + "/" + program;
    if (::access(file.c_str(), X_OK) == 0) return true;
    folders.remove_prefix(std::min(folder.size() + 1, folders.size()));
  }
  return false;
}

std::optional<Error> ChildProcess::start(std::vector<std::string> words) {
  const std::string program = words.front();
  const auto problem = [&program](int cause) {
    return Error{program + " does not start: " + std::strerror(cause)};
  };
  // Use a socket instead of a pipe: send() accepts MSG_NOSIGNAL, so that the program's end does not
  // kill this one.
  int ends[2] = {-1, -1};
  printed_ = OwnedFd(::memfd_create(program.c_str(), MFD_CLOEXEC));
  if (printed_.get() < 0 || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    return problem(errno);
  input_ = OwnedFd(ends[0]);
  const OwnedFd other_end(ends[1]);
  const int cause = spawn(words, other_end.get(), printed_.get(), process_);
  if (cause == 0) return std::nullopt;
  process_ = -1;
  return problem(cause);
}

bool ChildProcess::write(std::span<const std::uint8_t> bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t count = ::send(input_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

void ChildProcess::wait_for_end() noexcept {
  input_ = OwnedFd();
  while (process_ > 0 && ::waitpid(process_, &status_, 0) < 0 && errno == EINTR) continue;
  process_ = -1;
}

void ChildProcess::kill() noexcept {
  if (process_ > 0) ::kill(process_, SIGKILL);
  wait_for_end();
}

std::optional<int> ChildProcess::exit_status() const noexcept {
  return WIFEXITED(status_) ? std::optional(WEXITSTATUS(status_)) : std::nullopt;
}

int ChildProcess::ending_signal() const noexcept {
  return WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
}

std::string ChildProcess::last_line() const {
  constexpr off_t kEnough = 400;
  const off_t size = ::lseek(printed_.get(), 0, SEEK_END);
  std::string text(static_cast<std::size_t>(std::clamp<off_t>(size, 0, kEnough)), '\0');
  const ssize_t count =
      ::pread(printed_.get(), text.data(), text.size(), std::max<off_t>(size - kEnough, 0));
  text.resize(static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
  text.erase(0, text.find_last_of("\r\n") + 1);
  return text;
}

}  // namespace gaitpad
