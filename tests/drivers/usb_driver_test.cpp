// Tests without hardware, by fake sysfs folders. The rig (tools/rig) tests packets, plugging and
// taking pads from the kernel.
#include <errno.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "drivers/driver_rows.h"
#include "drivers/usb_interfaces.h"
#include "drivers/usb_reattach.h"
#include "system/descriptors.h"
#include "tests/own_folder.h"

#ifdef GAITPAD_HAS_USB
#include <libusb-1.0/libusb.h>

static int default_options = 0;  // number of options set for contexts that are made later

extern "C" int libusb_set_option(libusb_context* context, enum libusb_option, ...) {
  default_options += context == nullptr;
  return LIBUSB_SUCCESS;
}
#endif

namespace gaitpad {
namespace {

namespace fs = std::filesystem;

class UsbFolders : public testing::Test {
 protected:
  static void write(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
  }

  // `ids` as sysfs writes them: class, subclass, protocol.
  fs::path add_interface(const std::string& number, const std::string& ids) const {
    const fs::path folder = device_ / ("1-1.2:1." + number);
    write(folder / "bInterfaceNumber", "0" + number + "\n");
    write(folder / "bInterfaceClass", ids.substr(0, 2) + "\n");
    write(folder / "bInterfaceSubClass", ids.substr(3, 2) + "\n");
    write(folder / "bInterfaceProtocol", ids.substr(6, 2) + "\n");
    return folder;
  }
  static void add_endpoint(const fs::path& folder) {
    write(folder / "ep_81" / "direction", "in\n");
    write(folder / "ep_81" / "type", "Interrupt\n");
    write(folder / "ep_81" / "interval", "4ms\n");
  }
  void bind(const fs::path& folder, const std::string& driver) const {
    fs::create_directories(root_ / "drivers" / driver);
    fs::create_directory_symlink(root_ / "drivers" / driver, folder / "driver");
  }

  OwnFolder own_;
  const fs::path root_ = own_.path, device_ = root_ / "0000:00:14.0" / "usb1" / "1-1" / "1-1.2";
};

TEST_F(UsbFolders, AHidPadIsKnownWithWhatTheKernelMadeOfIt) {
  const fs::path folder = add_interface("3", "03 00 00");
  add_endpoint(folder);
  bind(folder, "usbhid");
  const fs::path hid = folder / "0003:054C:09CC.0007";
  write(hid / "report_descriptor", std::string("\x05\x01\x09\x05", 4));
  write(hid / "input" / "input9" / "id" / "version", "8111\n");
  bind(hid, "playstation");
  const auto interfaces = usb_interfaces(device_.string());
  ASSERT_EQ(interfaces.size(), 1u);
  const UsbInterface& pad = interfaces[0];
  EXPECT_EQ(pad.path, folder.string());
  EXPECT_EQ(pad.number, 3);
  EXPECT_EQ(pad.kernel_driver, "usbhid");
  EXPECT_EQ(pad.hid_driver, "playstation");
  EXPECT_EQ(pad.version, 0x8111);
  EXPECT_EQ(pad.descriptor, (std::vector<std::uint8_t>{0x05, 0x01, 0x09, 0x05}));
  EXPECT_DOUBLE_EQ(pad.poll_rate_hz, 250.0);
  EXPECT_TRUE(may_be_pad(pad));
  EXPECT_EQ(boot_device(pad), "");
}

TEST_F(UsbFolders, OfAnXbox360PadOnlyThePadItselfCounts) {
  add_endpoint(add_interface("0", "ff 5d 01"));
  add_endpoint(add_interface("1", "ff 5d 03"));  // the headset's interface
  add_interface("3", "ff fd 13");                // the interface for security
  const auto interfaces = usb_interfaces(device_.string());
  ASSERT_EQ(interfaces.size(), 3u);
  EXPECT_TRUE(may_be_pad(interfaces[0]));
  EXPECT_FALSE(may_be_pad(interfaces[1]));
  EXPECT_FALSE(may_be_pad(interfaces[2]));
}

TEST_F(UsbFolders, OfAnXboxOnePadTheFirstInterfaceCounts) {
  add_endpoint(add_interface("0", "ff 47 d0"));
  add_endpoint(add_interface("1", "ff 47 d0"));  // the interface for audio
  const auto interfaces = usb_interfaces(device_.string());
  ASSERT_EQ(interfaces.size(), 2u);
  EXPECT_TRUE(may_be_pad(interfaces[0]));
  EXPECT_FALSE(may_be_pad(interfaces[1]));
}

TEST_F(UsbFolders, KeyboardsAndMiceAreNamedAsSuch) {
  add_endpoint(add_interface("0", "03 01 01"));
  add_endpoint(add_interface("1", "03 01 02"));
  const auto interfaces = usb_interfaces(device_.string());
  ASSERT_EQ(interfaces.size(), 2u);
  EXPECT_EQ(boot_device(interfaces[0]), "it is a keyboard");
  EXPECT_EQ(boot_device(interfaces[1]), "it is a mouse");
}

TEST_F(UsbFolders, WithoutReportsToReadItIsNoPad) {
  add_interface("0", "03 00 00");
  EXPECT_FALSE(may_be_pad(usb_interfaces(device_.string())[0]));
}

TEST_F(UsbFolders, OddContentsAreNoTrouble) {
  const fs::path folder = add_interface("0", "03 00 00");
  write(folder / "bInterfaceClass", "zz\n");
  fs::remove(folder / "bInterfaceProtocol");
  write(folder / "ep_81" / "interval", "-1ms\n");
  // An interface that is being made or removed has no files yet.
  fs::create_directories(device_ / "1-1.2:1.7");
  const auto interfaces = usb_interfaces(device_.string());
  ASSERT_EQ(interfaces.size(), 1u);
  EXPECT_FALSE(may_be_pad(interfaces[0]));
  EXPECT_TRUE(usb_interfaces("/nonexistent").empty());
  EXPECT_FALSE(usb_interface("/nonexistent"));
}

TEST_F(UsbFolders, TheirPortIsWrittenAsTheKernelDoes) {
  EXPECT_EQ(usb_physical_path(device_.string(), 3), "usb-0000:00:14.0-1.2/input3");
  EXPECT_EQ(usb_physical_path("/sys/devices/platform/dummy_hcd.0/usb1/1-1", 0),
            "usb-dummy_hcd.0-1/input0");
  EXPECT_EQ(usb_physical_path("/sys/nowhere", 0), "");
  EXPECT_EQ(usb_physical_path("", 0), "");
}

// The watcher re-attaches the driver by opening the device's node; here the node is a FIFO, which
// shows that it is opened. The watcher has another parent from its beginning, so that no zombie of
// it stays in a host.
class ReattachWatcherTest : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::mkfifo(fifo_.c_str(), 0600), 0);
    reader_ = OwnedFd(::open(fifo_.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
    ASSERT_GE(reader_.get(), 0);
  }
  // True if the watcher opens the node, and closes it, within this time.
  bool is_opened(int wait_ms) const {
    pollfd hung_up{.fd = reader_.get(), .events = POLLIN, .revents = 0};
    return ::poll(&hung_up, 1, wait_ms) == 1;
  }
  static bool has_child() { return ::waitpid(-1, nullptr, WNOHANG) != -1 || errno != ECHILD; }

  OwnFolder folder_;
  const std::string fifo_ = (folder_.path / "node").string();
  OwnedFd reader_;
};

TEST_F(ReattachWatcherTest, IsNoChildAndDoesNothingWhenItIsDismissed) {
  auto watcher = ReattachWatcher::start(fifo_, 0);
  ASSERT_TRUE(watcher) << watcher.error().message;
  EXPECT_FALSE(has_child());
  watcher->dismiss();
  EXPECT_FALSE(is_opened(100));
  EXPECT_FALSE(has_child());
}

TEST_F(ReattachWatcherTest, IsNoChildAndReattachesWhenItsOwnerIsGone) {
  {
    auto watcher = ReattachWatcher::start(fifo_, 0);
    ASSERT_TRUE(watcher) << watcher.error().message;
  }
  EXPECT_TRUE(is_opened(60000));
  EXPECT_FALSE(has_child());
}

#ifdef GAITPAD_HAS_USB
TEST_F(UsbFolders, APadOfTheKernelsIsTakenWithConsentOnly) {
  const fs::path folder = add_interface("0", "ff 5d 01");
  add_endpoint(folder);
  bind(folder, "xpad");
  DeviceListing listing;
  listing.node = "/dev/bus/usb/999/999";
  listing.pad_path = folder.string();
  listing.kernel_driver = "xpad";
  const auto device = open_usb_device(listing, Detach::never);
  ASSERT_FALSE(device);
  EXPECT_EQ(
      device.error().message,
      "/dev/bus/usb/999/999: the kernel's driver xpad has the pad; --driver usb takes the pad "
      "over while it runs");
  const auto taken = open_usb_device(listing, Detach::allowed);
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().message, "/dev/bus/usb/999/999: No such file or directory");
}

TEST_F(UsbFolders, APadThatIsGoneOrHeldByAProgramIsNotOpened) {
  DeviceListing listing;
  listing.node = "/dev/bus/usb/999/999:1";
  listing.pad_path = "/nonexistent";
  EXPECT_EQ(open_usb_device(listing, Detach::allowed).error().message,
            "/dev/bus/usb/999/999:1: the pad is gone");
  const fs::path folder = add_interface("0", "ff 5d 01");
  add_endpoint(folder);
  bind(folder, "usbfs");
  listing.pad_path = folder.string();
  EXPECT_EQ(open_usb_device(listing, Detach::allowed).error().message,
            "/dev/bus/usb/999/999:1: another program has the pad");
}

// The host program may use libusb as well, so the driver must not change its options.
TEST_F(UsbFolders, NoOptionOfAllContextsIsSet) {
  const fs::path folder = add_interface("0", "ff 5d 01");
  add_endpoint(folder);
  own_.write("node", "");  // the node is an ordinary file, which can only be opened
  DeviceListing listing;
  listing.node = own_.at("node");
  listing.pad_path = folder.string();
  default_options = 0;
  EXPECT_FALSE(open_usb_device(listing, Detach::allowed));
  EXPECT_EQ(default_options, 0);
}

TEST_F(UsbFolders, KeyboardsAreNeverTaken) {
  const fs::path folder = add_interface("0", "03 01 01");
  add_endpoint(folder);
  bind(folder, "usbhid");
  DeviceListing listing;
  listing.node = "/dev/bus/usb/999/999";
  listing.pad_path = folder.string();
  EXPECT_EQ(open_usb_device(listing, Detach::allowed).error().message,
            "/dev/bus/usb/999/999: no pad: it is a keyboard");
}

#endif

}  // namespace
}  // namespace gaitpad
