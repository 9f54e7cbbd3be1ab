#include "drivers/usb_reattach.h"

#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <linux/usbdevice_fs.h>
#include <signal.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstring>

namespace gaitpad {

namespace {

// Everything up to `watch` runs in the child of a process with threads, so it uses system calls
// only: no heap, no locks, and nothing that a sanitizer would check.

// `again`: the attempt came too early. The dying process holds the interface until its node is
// closed, a little later than the link.
enum class Attempt { again, done };

Attempt try_to_reattach(const char* node, int interface_number) {
  const int fd = ::open(node, O_RDWR | O_CLOEXEC);
  if (fd < 0) return errno == EINTR || errno == EMFILE ? Attempt::again : Attempt::done;
  usbdevfs_ioctl connect = {};
  connect.ifno = interface_number;
  connect.ioctl_code = USBDEVFS_CONNECT;
  Attempt result = Attempt::done;
  if (::ioctl(fd, USBDEVFS_IOCTL, &connect) < 0 && errno == EBUSY) {
    usbdevfs_getdriver holder = {};
    holder.interface = static_cast<unsigned int>(interface_number);
    const bool is_held = ::ioctl(fd, USBDEVFS_GETDRIVER, &holder) == 0;
    const bool by_kernel = is_held && std::strcmp(holder.driver, "usbfs") != 0;
    if (!by_kernel) result = Attempt::again;
  }
  ::close(fd);
  return result;
}

// Closes all descriptors but `kept`, so that no pipe or node of the parent stays open in the child.
void close_others(int kept) {
  bool is_closed = false;
#ifdef SYS_close_range
  is_closed = ::syscall(SYS_close_range, kept + 1, ~0u, 0) == 0;
#endif
  for (int fd = kept + 1; !is_closed && fd < 4096; ++fd) ::close(fd);
  for (int fd = 0; fd < kept; ++fd) ::close(fd);
}

// Ends the child process without the cleanup of the program or of a sanitizer.
[[noreturn]] void leave(int status) {
  for (;;) ::syscall(SYS_exit_group, status);
}

[[noreturn]] void watch(int link, const char* node, int interface_number) {
  constexpr int kAttempts = 250;
  constexpr timespec kPause = {0, 20'000'000};
  ::setsid();  // Ctrl-C in the terminal must not end the watcher
  // Make the watcher a grandchild, which this process need not wait for by waitpid().
  if (const pid_t watcher = ::_Fork(); watcher != 0) leave(watcher < 0 ? errno : 0);
  close_others(link);
  char word = 0;
  ssize_t count = 0;
  do {
    count = ::read(link, &word, 1);
  } while (count < 0 && errno == EINTR);
  if (count > 0) leave(0);  // the parent has dismissed the watcher
  for (int i = 0; i < kAttempts; ++i) {
    if (try_to_reattach(node, interface_number) == Attempt::done) break;
    ::nanosleep(&kPause, nullptr);
  }
  leave(0);
}

Error start_error(const std::string& node, int error) {
  return Error{
      fmt::format("{}: no process can be started that gives the pad back to the kernel: {}", node,
                  std::strerror(error))};
}

}  // namespace

Result<ReattachWatcher> ReattachWatcher::start(const std::string& node,
                                               std::uint8_t interface_number) {
  int ends[2] = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)
    return start_error(node, errno);
  // All signals are blocked in the child, so that no handler of the parent runs there.
  sigset_t all = {}, before = {};
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t process = ::fork();
  if (process == 0) watch(ends[0], node.c_str(), interface_number);
  int cause = process < 0 ? errno : 0, status = 0;
  // waitpid() fails if the program lets the kernel remove its children's records.
  if (process > 0 && ::waitpid(process, &status, 0) == process) cause = WEXITSTATUS(status);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  ::close(ends[0]);
  OwnedFd link(ends[1]);
  if (cause == 0) return ReattachWatcher(std::move(link));
  return start_error(node, cause);
}

void ReattachWatcher::dismiss() noexcept {
  const char word = 1;
  if (link_.get() >= 0) static_cast<void>(::send(link_.get(), &word, 1, MSG_NOSIGNAL));
  link_ = OwnedFd();
}

}  // namespace gaitpad
