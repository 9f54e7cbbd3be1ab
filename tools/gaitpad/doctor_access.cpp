// Whether this user may use a pad's nodes, and whether another program has taken them.
#include <fmt/format.h>
#include <grp.h>
#include <sys/stat.h>

#include <filesystem>

#include "tools/gaitpad/doctor_checks.h"

namespace gaitpad {
namespace {

constexpr mode_t kGroupMayUse = 0060;

std::string group_name(gid_t id) {
  const group* entry = ::getgrgid(id);
  return entry ? entry->gr_name : std::to_string(id);
}

std::string permission_cause(const std::string& node, const struct stat& status) {
  return fmt::format("{}: permission denied for {} (owner {}, group {}, mode {:04o})", node,
                     own_user_name(), status.st_uid == 0 ? "root" : std::to_string(status.st_uid),
                     group_name(status.st_gid), status.st_mode & 07777);
}

bool knows_seats() {
  std::error_code ignored;
  return std::filesystem::exists("/run/systemd/seats", ignored);
}

std::string permission_fix(const RulesFile& shipped, const PadHardware& pad,
                           const struct stat& status) {
  const auto installed = installed_rules();
  const bool group_may = (status.st_mode & kGroupMayUse) == kGroupMayUse && status.st_gid != 0;
  if (group_may) {
    return fmt::format("sudo usermod -aG {} {}, then log in again{}", group_name(status.st_gid),
                       own_user_name(),
                       !installed && knows_seats() ? ", or: " + install_command() : "");
  }
  const std::string& rules = installed ? installed->text : shipped.text;
  const bool is_known = opens_hidraw(rules, subject_of(pad));
  const std::string line =
      is_known ? "" : fmt::format(", with the line {}", hidraw_rule(subject_of(pad)));
  if (!installed) {
    return fmt::format("{} (no rule opens it yet; by hand: {}{})", install_command(),
                       manual_install_command(shipped), line);
  }
  if (!is_known)
    return fmt::format("{} (no rule for this pad in {}{})", install_command(), installed->path,
                       line);
  return fmt::format("sudo sh -c '{}', or plug it in again ({} is there, but was not applied)",
                     kApplyRules, installed->path);
}

}  // namespace

// True where the node can be used.
bool check_access(const std::string& node, const PadHardware& pad, Finding::State state,
                  Diagnosis& diagnosis) {
  struct stat status = {};
  if (::stat(node.c_str(), &status) != 0) {
    diagnosis.add(
        state, node, pad, node + ": the kernel has it, but it is not in /dev",
        diagnosis.machine.is_container
            ? fmt::format("start the container with --device {} and -v /run/udev:/run/udev:ro",
                          node)
            : "sudo udevadm trigger");
    return false;
  }
  if (access_problem(node).empty()) return true;
  diagnosis.add(state, node, pad, permission_cause(node, status),
                permission_fix(diagnosis.shipped, pad, status));
  return false;
}

void check_events(const PadHardware& pad, Finding::State state, Diagnosis& diagnosis) {
  for (const SystemNode& node : pad.events) {
    if (!is_pad_event(node)) {
      diagnosis.add(Finding::State::note, node.node, pad,
                    fmt::format("{}: the pad's {}, not its sticks", node.node,
                                node.is_touchpad ? "touchpad" : "motion sensors"));
    } else if (check_access(node.node, pad, state, diagnosis) && is_grabbed(node.node)) {
      const std::string users = users_of(node.node);
      diagnosis.add(state, node.node, pad,
                    fmt::format("{}: another program has it for itself{}", node.node,
                                users.empty() ? "" : ": " + users),
                    pad.hidraw.empty() ? "end that program"
                                       : "end that program, or: gaitpad play --driver hidraw");
    }
  }
}

}  // namespace gaitpad
