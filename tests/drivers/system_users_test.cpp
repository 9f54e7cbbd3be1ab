#include "drivers/system_users.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/own_folder.h"

namespace gaitpad {
namespace {

TEST(SystemUsers, ANodeHasItsModeAndOwners) {
  const auto null = node_rights("/dev/null");
  ASSERT_TRUE(null);
  EXPECT_EQ(null->owner, "root");
  EXPECT_EQ(null->group, "root");
  EXPECT_EQ(null->group_id, 0u);
  EXPECT_EQ(null->mode, 0666u);
  EXPECT_FALSE(node_rights("/dev/no such node"));
}

TEST(SystemUsers, ANewFileAtTheSamePathHasAnotherNumber) {
  const OwnFolder folder;
  const std::string path = folder.write("node"), other = folder.write("other");
  std::filesystem::permissions(path, std::filesystem::perms(0640));
  const auto before = node_rights(path);
  EXPECT_EQ(before->mode, 0640u);
  std::filesystem::rename(other, path);
  EXPECT_NE(node_rights(path)->file, before->file);
}

TEST(SystemUsers, ThisProcessAndItsKernelHaveNames) {
  EXPECT_TRUE(
      std::filesystem::equivalent("/proc/self", "/proc/" + std::to_string(own_process_id())));
  std::ifstream release_file("/proc/sys/kernel/osrelease");
  std::string release;
  std::getline(release_file, release);
  EXPECT_EQ(kernel_name().release, release);
  EXPECT_FALSE(own_user_name().empty());
  if (is_root()) EXPECT_EQ(own_user_name(), "root");
}

}  // namespace
}  // namespace gaitpad
