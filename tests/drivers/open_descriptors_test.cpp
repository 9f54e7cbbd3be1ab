#ifdef GAITPAD_HAS_HIDRAW
#include "drivers/open_descriptors.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

namespace gaitpad {
namespace {

TEST(OpenDescriptors, TheNewOneIsTheOneThatWasNotThere) {
  EXPECT_EQ(new_descriptor({3, 5}, {3, 5, 8}), 8);
  EXPECT_EQ(new_descriptor({}, {4}), 4);
  EXPECT_EQ(new_descriptor({4}, {4}), 4) << "closed by another thread, its number used again";
  EXPECT_EQ(new_descriptor({3, 4}, {3, 4}), -1);
  EXPECT_EQ(new_descriptor({3}, {3, 4, 5}), -1);
  EXPECT_EQ(new_descriptor({3}, {}), -1);
}

TEST(OpenDescriptors, AreThoseOfTheNode) {
  struct stat status {};
  ASSERT_EQ(::stat("/dev/null", &status), 0);
  const OpenDescriptors before = open_descriptors(status.st_rdev);
  const int fd = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int other = ::open("/dev/zero", O_RDONLY | O_CLOEXEC);
  EXPECT_EQ(new_descriptor(before, open_descriptors(status.st_rdev)), fd);
  ::close(fd);
  ::close(other);
}

}  // namespace
}  // namespace gaitpad
#endif  // GAITPAD_HAS_HIDRAW
