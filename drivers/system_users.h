// Users and groups, the access rights of nodes, this process, and the kernel's name.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace gaitpad {

// Whom the system lets use a node.
struct NodeRights {
  std::uint64_t file = 0;      // inode; it changes if the node is made anew
  unsigned mode = 0;           // permission bits, at most 07777
  std::uint32_t group_id = 0;  // 0: root's group
  std::string owner, group;    // names; numbers if they have none
};
// Nothing if the node does not exist.
std::optional<NodeRights> node_rights(const std::string& node);

bool is_root() noexcept;
// The name of the user whose rights this process has; `user NUMBER` if it has none.
std::string own_user_name();
int own_process_id() noexcept;

struct KernelName {
  std::string release, machine;  // as `uname -r` and `uname -m` print them
};
KernelName kernel_name();

}  // namespace gaitpad
