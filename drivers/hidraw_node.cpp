#include "drivers/hidraw_node.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "drivers/open_descriptors.h"
#include "drivers/system_nodes.h"

namespace gaitpad {

using namespace std::chrono_literals;

namespace {

// The kernel takes the report id always, 0 where the pad has none; a pad model gives it only where
// there is one.
bool write_packet(hid_device* handle, bool is_numbered, std::span<const std::uint8_t> packet) {
  if (packet.empty()) return false;
  if (is_numbered) return hid_write(handle, packet.data(), packet.size()) >= 0;
  std::vector<std::uint8_t> with_id(packet.size() + 1, 0);
  std::copy(packet.begin(), packet.end(), with_id.begin() + 1);
  return hid_write(handle, with_id.data(), with_id.size()) >= 0;
}

}  // namespace

// hidapi keeps its descriptor to itself, but without it the I/O thread could not sleep until this
// pad or another has something: it is looked for among this process's.
Result<OpenNode> open_hidraw_node(const std::string& node) {
  struct stat status {};
  if (::stat(node.c_str(), &status) != 0)
    return Error{fmt::format("{}: {}", node, std::strerror(errno))};
  if (!S_ISCHR(status.st_mode)) return Error{node + ": is no device node"};
  const OpenDescriptors before = open_descriptors(status.st_rdev);
  OpenNode opened{Handle(hid_open_path(node.c_str()))};
  if (!opened.handle) {
    const std::string problem = access_problem(node);
    return Error{problem.empty() ? node + ": is no HID device, or it has just gone" : problem};
  }
  opened.fd = new_descriptor(before, open_descriptors(status.st_rdev));
  return opened;
}

std::vector<std::uint8_t> hidraw_descriptor(int fd) {
  int size = 0;
  hidraw_report_descriptor descriptor{};
  if (fd < 0 || ::ioctl(fd, HIDIOCGRDESCSIZE, &size) < 0) return {};
  if (size <= 0 || size > HID_MAX_DESCRIPTOR_SIZE) return {};
  descriptor.size = static_cast<unsigned>(size);
  if (::ioctl(fd, HIDIOCGRDESC, &descriptor) < 0) return {};
  return std::vector<std::uint8_t>(descriptor.value, descriptor.value + size);
}

bool is_another_hidraw(int fd, const DeviceInfo& info) {
  hidraw_devinfo now{};
  if (fd < 0 || ::ioctl(fd, HIDIOCGRAWINFO, &now) < 0) return false;
  std::array<char, 256> port{};
  if (::ioctl(fd, HIDIOCGRAWPHYS(port.size() - 1), port.data()) < 0) return false;
  return static_cast<std::uint16_t>(now.vendor) != info.vendor ||
         static_cast<std::uint16_t>(now.product) != info.product ||
         (!info.physical_path.empty() && info.physical_path != port.data());
}

bool HidrawPort::write(std::span<const std::uint8_t> packet) noexcept {
  return write_packet(handle_, is_numbered_, packet);
}

std::size_t HidrawPort::read(std::span<std::uint8_t> packet,
                             std::chrono::milliseconds timeout) noexcept {
  const int size = hid_read_timeout(handle_, packet.data(), packet.size(),
                                    static_cast<int>(std::clamp(timeout, 0ms, 2000ms).count()));
  return size > 0 ? std::min(static_cast<std::size_t>(size), packet.size()) : 0;
}

std::size_t HidrawPort::feature(std::uint8_t id, std::span<std::uint8_t> packet) noexcept {
  if (packet.empty()) return 0;
  packet[0] = id;
  const int size = hid_get_feature_report(handle_, packet.data(), packet.size());
  if (size <= 0 || packet[0] != id) return 0;
  return std::min(static_cast<std::size_t>(size), packet.size());
}

std::unique_ptr<PacketSender> hidraw_sender(const std::string& node, bool is_numbered) {
  const std::shared_ptr<hid_device> handle(hid_open_path(node.c_str()), CloseHandle());
  if (!handle) return nullptr;
  return PacketSender::create([handle, is_numbered](std::span<const std::uint8_t> packet) {
    return write_packet(handle.get(), is_numbered, packet);
  });
}

PresentState::Ask hidraw_input_request(const std::string& node) {
  const std::shared_ptr<hid_device> handle(hid_open_path(node.c_str()), CloseHandle());
  if (!handle) return nullptr;
  return [handle](std::uint8_t id, std::span<std::uint8_t> answer) -> std::size_t {
    if (answer.empty()) return 0;
    answer[0] = id;
    const int size = hid_get_input_report(handle.get(), answer.data(), answer.size());
    return size > 0 ? static_cast<std::size_t>(size) : 0;
  };
}

}  // namespace gaitpad
