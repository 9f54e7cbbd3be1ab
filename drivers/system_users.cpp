#include "drivers/system_users.h"

#include <grp.h>
#include <pwd.h>
#include <sys/stat.h>
#include <sys/utsname.h>
#include <unistd.h>

namespace gaitpad {

std::optional<NodeRights> node_rights(const std::string& node) {
  struct stat status = {};
  if (::stat(node.c_str(), &status) != 0) return std::nullopt;
  const passwd* owner = ::getpwuid(status.st_uid);
  const std::string owner_name = owner ? owner->pw_name : std::to_string(status.st_uid);
  const group* owners = ::getgrgid(status.st_gid);
  const std::string group_name = owners ? owners->gr_name : std::to_string(status.st_gid);
  return NodeRights{status.st_ino, status.st_mode & 07777u, status.st_gid, owner_name, group_name};
}

bool is_root() noexcept { return ::geteuid() == 0; }

std::string own_user_name() {
  const passwd* user = ::getpwuid(::geteuid());
  return user ? user->pw_name : "user " + std::to_string(::geteuid());
}

int own_process_id() noexcept { return ::getpid(); }

KernelName kernel_name() {
  utsname system = {};
  ::uname(&system);
  return {system.release, system.machine};
}

}  // namespace gaitpad
