#include "drivers/system_nodes.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

// What real hardware shows is proved in the rig (tools/rig); here what holds on every machine.

TEST(SystemNodes, EveryNodeIsADeviceFileWithASysfsFolder) {
  for (const char* subsystem : {"hidraw", "input", "usb"}) {
    for (const SystemNode& node : system_nodes(subsystem)) {
      EXPECT_TRUE(node.node.starts_with("/dev/")) << node.node;
      EXPECT_TRUE(node.sysfs_path.starts_with("/sys/")) << node.sysfs_path;
      EXPECT_LE(node.descriptor.size(), 4096u);
    }
  }
}

TEST(SystemNodes, AnUnknownSubsystemHasNoNodes) { EXPECT_TRUE(system_nodes("none").empty()); }

TEST(SystemNodes, AnInterfaceThatIsNotThereHasNoPath) {
  EXPECT_EQ(usb_interface_path("99-9:1.0"), "");
}

TEST(AccessProblem, AMissingNodeIsSaidToBeMissing) {
  EXPECT_EQ(access_problem("/dev/none/hidraw0"), "/dev/none/hidraw0: No such file or directory");
}

TEST(AccessProblem, NoneWhereTheUserMayReadAndWrite) { EXPECT_EQ(access_problem("/dev/null"), ""); }

TEST(AccessProblem, NamesOwnerAndModeOfWhatIsForbidden) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may open everything; the rig tries it as a user";
  OwnFolder folder;
  const std::string path = folder.write("node");
  std::filesystem::permissions(path, std::filesystem::perms::none);
  const std::string problem = access_problem(path);
  EXPECT_NE(problem.find("permission denied"), std::string::npos) << problem;
  EXPECT_NE(problem.find("mode 0000"), std::string::npos) << problem;
}

TEST(HotplugMonitor, HasSomethingToWaitForAndNothingToTellAtFirst) {
  auto monitor = HotplugMonitor::create();
  if (!monitor) GTEST_SKIP() << monitor.error().message;
  EXPECT_GE(monitor->fd(), 0);
  HotplugMonitor moved = std::move(*monitor);
  EXPECT_GE(moved.fd(), 0);
}

}  // namespace
}  // namespace gaitpad
