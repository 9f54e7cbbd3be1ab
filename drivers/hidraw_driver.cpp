// Pads through Linux's hidraw, by hidapi: the bytes as the pad sent them, while the kernel's own
// driver goes on serving evdev. hidapi 0.13 gives no report descriptor, nothing to poll(), and the
// same error for every failure; this driver asks the kernel for what is missing.
#include <fcntl.h>
#include <fmt/format.h>
#include <hidapi/hidapi.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "drivers/driver_rows.h"
#include "drivers/open_descriptors.h"
#include "drivers/pads/packet_sender.h"
#include "drivers/pads/pad_quirks.h"
#include "drivers/pads/pads_of_devices.h"
#include "drivers/system_nodes.h"
#include "gaitpad/descriptor.h"
#include "system/clock.h"
#include "system/descriptors.h"

namespace gaitpad {

namespace {

using namespace std::chrono_literals;
using Status = Device::Status;

// After this number of refused packets in a row other pads get their turn.
constexpr int kMaxRefusedInARow = 64;
constexpr int kMaxErrorsInARow = 64;  // more errors in a row: the pad counts as gone
constexpr int kKernelRing = 63;       // number of reports that hidraw keeps for a slow reader
constexpr auto kKernelStart = 3s;     // longest wait until hid-nintendo has started the pad
// Time between two reads of a pad whose descriptor is unknown.
constexpr long kBlindPeriod_ns = 1'000'000;

// ---- An open node

struct CloseHandle {
  void operator()(hid_device* handle) const noexcept { hid_close(handle); }
};
using Handle = std::unique_ptr<hid_device, CloseHandle>;

struct OpenNode {
  Handle handle;
  int fd = -1;  // the descriptor that the handle has open; -1: it was not found
};

// Puts the id 0 before the bytes if the pad has no ids: the kernel always expects an id, but quirks
// only write one that exists.
std::vector<std::uint8_t> with_id(bool is_numbered, std::span<const std::uint8_t> packet) {
  std::vector<std::uint8_t> whole(packet.begin(), packet.end());
  if (!is_numbered) whole.insert(whole.begin(), 0);
  return whole;
}

// Opens a node and finds its file descriptor among those of this process: hidapi does not expose
// it, and the I/O thread needs it for poll().
Result<OpenNode> open_hidraw_node(const std::string& node) {
  // One opening at a time: hidapi 0.13 frees its text of the last error on each opening, on any
  // thread, and the new descriptor could not be identified while another thread opens the same
  // node.
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
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

// The report descriptor; empty if it cannot be read.
std::vector<std::uint8_t> hidraw_descriptor(int fd) {
  int size = 0;
  hidraw_report_descriptor descriptor{};
  if (fd < 0 || ::ioctl(fd, HIDIOCGRDESCSIZE, &size) < 0) return {};
  if (size <= 0 || size > HID_MAX_DESCRIPTOR_SIZE) return {};
  descriptor.size = static_cast<unsigned>(size);
  if (::ioctl(fd, HIDIOCGRDESC, &descriptor) < 0) return {};
  return std::vector<std::uint8_t>(descriptor.value, descriptor.value + size);
}

// True if the node has become another device between finding and opening: node numbers are reused.
bool is_another_hidraw(int fd, const DeviceInfo& info) {
  hidraw_devinfo now{};
  if (fd < 0 || ::ioctl(fd, HIDIOCGRAWINFO, &now) < 0) return false;
  std::array<char, 256> port{};
  if (::ioctl(fd, HIDIOCGRAWPHYS(port.size() - 1), port.data()) < 0) return false;
  return static_cast<std::uint16_t>(now.vendor) != info.vendor ||
         static_cast<std::uint16_t>(now.product) != info.product ||
         (!info.physical_path.empty() && info.physical_path != port.data());
}

// Lets quirks exchange packets with the open pad.
class HidrawPort final : public PadPort {
 public:
  HidrawPort(hid_device* handle, int fd, bool is_numbered)
      : handle_(handle), fd_(fd), is_numbered_(is_numbered) {}
  bool write(std::span<const std::uint8_t> packet) noexcept override {
    const std::vector<std::uint8_t> whole = with_id(is_numbered_, packet);
    return !packet.empty() && hid_write(handle_, whole.data(), whole.size()) >= 0;
  }
  std::size_t read(std::span<std::uint8_t> packet,
                   std::chrono::milliseconds timeout) noexcept override {
    const int size = hid_read_timeout(handle_, packet.data(), packet.size(),
                                      static_cast<int>(std::clamp(timeout, 0ms, 2000ms).count()));
    return size > 0 ? std::min(static_cast<std::size_t>(size), packet.size()) : 0;
  }
  std::size_t feature(std::uint8_t id, std::span<std::uint8_t> packet) noexcept override {
    if (packet.empty()) return 0;
    packet[0] = id;
    const int size = hid_get_feature_report(handle_, packet.data(), packet.size());
    if (size <= 0 || packet[0] != id) return 0;
    return std::min(static_cast<std::size_t>(size), packet.size());
  }

  std::size_t input(std::uint8_t id, std::span<std::uint8_t> packet) noexcept override {
    if (packet.empty() || fd_ < 0) return 0;
    packet[0] = id;
    const int size = ::ioctl(fd_, HIDIOCGINPUT(packet.size()), packet.data());
    if (size <= 0 || packet[0] != id) return 0;
    return std::min(static_cast<std::size_t>(size), packet.size());
  }
  bool send_feature(std::span<const std::uint8_t> packet) noexcept override {
    return hid_send_feature_report(handle_, packet.data(), packet.size()) >= 0;
  }

 private:
  hid_device* handle_;
  int fd_;
  bool is_numbered_;
};

// Sends packets from a thread. The thread must not use the handle: hidapi writes its error text
// into it on every call. It shares the one opening; a second opening would have a queue of reports
// that is never read. Null if the descriptor is not known, or no thread can be started.
std::unique_ptr<PacketSender> hidraw_sender(int fd, bool is_numbered) {
  const auto own = std::make_shared<const OwnedFd>(fd < 0 ? -1 : ::fcntl(fd, F_DUPFD_CLOEXEC, 0));
  if (own->get() < 0) return nullptr;
  return PacketSender::create([own, is_numbered](const OutPacket& packet) {
    const auto bytes = std::span(packet.bytes).first(packet.size);
    if (bytes.empty()) return false;
    std::vector<std::uint8_t> whole = with_id(is_numbered || packet.is_feature, bytes);
    if (packet.is_feature)
      return ::ioctl(own->get(), HIDIOCSFEATURE(whole.size()), whole.data()) >= 0;
    return ::write(own->get(), whole.data(), whole.size()) >= 0;
  });
}

// ---- The device

bool has_report_ids(const DeviceInfo& info) {
  const auto descriptor = parse_descriptor(info.descriptor);
  return descriptor && descriptor->numbered;
}

class HidrawDevice final : public Device {
 public:
  HidrawDevice(DeviceInfo info, std::string node, OpenNode opened)
      : info_(std::move(info)),
        node_(std::move(node)),
        handle_(std::move(opened.handle)),
        fd_(opened.fd),
        quirks_(make_pad_quirks(info_)),
        is_numbered_(has_report_ids(info_)) {
    if (fd_ < 0) timer_.emplace().set(1, kBlindPeriod_ns);
    wait_on_ = {.fd = fd_ >= 0 ? fd_ : timer_->fd(), .events = POLLIN, .revents = 0};
  }
  ~HidrawDevice() override {
    if (is_unplugged_ || ::access(node_.c_str(), F_OK) != 0) return;
    if (is_rumbling_) rumble({});
    HidrawPort port(handle_.get(), fd_, is_numbered_);
    quirks_->stop(port);
  }

  void start(StartedBy started) {
    HidrawPort port(handle_.get(), fd_, is_numbered_);
    quirks_->start(port, started);
    quirks_->amend(info_);
    // The first packet is asked for only on a cable: over Bluetooth a pad reports when it connects,
    // and some block on requests.
    if (info_.bus == BusType::usb) first_size_ = first_packet(port, info_.descriptor, buffer_);
    OutPacket still;
    quirks_->rumble({}, still);
    if (still.size == 0 && !quirks_->replies()) return;
    sender_ = hidraw_sender(fd_, is_numbered_);
    if (!sender_ && access_problem(node_).empty())
      remarks_.push_back(node_ + ": the motors cannot be reached");
  }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return {&wait_on_, 1}; }
  Status read(Report& report) noexcept override;
  void hand_on_raw() noexcept override { is_raw_ = true; }
  bool rumble(const Rumble& rumble) noexcept override {
    if (!sender_) return false;
    OutPacket packet;
    quirks_->rumble(rumble, packet);
    is_rumbling_ = rumble.strong != 0 || rumble.weak != 0;
    return sender_->send(packet);
  }
  std::optional<FactorySticks> factory_sticks() const override { return quirks_->factory_sticks(); }
  std::optional<FactoryGyro> factory_gyro() const override { return quirks_->factory_gyro(); }
  std::int64_t lost() const noexcept override { return lost_ + quirks_->lost(); }
  std::vector<std::string> take_remarks() override {
    std::vector<std::string> remarks = quirks_->take_remarks();
    std::move(remarks_.begin(), remarks_.end(), std::back_inserter(remarks));
    remarks_.clear();
    return remarks;
  }

 private:
  bool fill(std::span<const std::uint8_t> packet, Report& report) noexcept;
  bool has_hung_up(int error) const noexcept;
  Status after_error(int error) noexcept;
  void count_waiting() noexcept;

  DeviceInfo info_;
  std::string node_;
  Handle handle_;
  int fd_ = -1;                 // the descriptor that the handle has open; -1: unknown
  std::optional<Timer> timer_;  // if the descriptor is unknown: readable every millisecond
  pollfd wait_on_{};
  std::unique_ptr<PadQuirks> quirks_;
  std::unique_ptr<PacketSender> sender_;  // null: the pad has no motors
  bool is_numbered_;
  bool is_rumbling_ = false, is_raw_ = false;
  PlugWatch plug_;
  bool is_unplugged_ = false;  // the pad is gone, but reports from before are still to be read
  int errors_in_row_ = 0;
  // Starts at the ring's size: reports from before the opening do not count as lost.
  int reports_in_row_ = kKernelRing;
  bool was_late_ = false;
  std::int64_t lost_ = 0;
  std::vector<std::string> remarks_;
  // One byte larger than the longest report, so that longer reports are detected.
  std::array<std::uint8_t, kMaxReportBytes + 1> buffer_{};
  std::size_t first_size_ = 0;  // size of the first packet, which is in buffer_; 0: it was read
};

Status HidrawDevice::read(Report& report) noexcept {
  if (timer_) timer_->take();
  if (const std::size_t size = std::exchange(first_size_, 0);
      size > 0 && fill(std::span(buffer_).first(size), report))
    return Status::report;
  for (int i = 0; i < kMaxRefusedInARow; ++i) {
    errno = 0;
    // With a timeout hidapi stops reading when the pad is gone. Without one, an unplugged node
    // gives the reports that it still holds, then an error, and never blocks.
    const int size =
        hid_read_timeout(handle_.get(), buffer_.data(), buffer_.size(), is_unplugged_ ? -1 : 0);
    const int error = errno;
    if (size <= 0 && is_unplugged_) return Status::gone;
    if (size == 0) {
      reports_in_row_ = 0;
      return Status::nothing;
    }
    if (size < 0 && !has_hung_up(error)) return after_error(error);
    if (size < 0) {
      is_unplugged_ = true;
      continue;
    }
    errors_in_row_ = 0;
    count_waiting();
    if (fill(std::span(buffer_).first(static_cast<std::size_t>(size)), report))
      return Status::report;
  }
  return Status::nothing;  // nothing yet: if there are more packets, the node stays readable
}

bool HidrawDevice::fill(std::span<const std::uint8_t> packet, Report& report) noexcept {
  if (packet.size() > kMaxReportBytes) {
    ++lost_;
    return false;
  }
  report.time_ns = now_ns();
  OutPacket reply;
  const bool is_input = quirks_->accept(packet, reply);
  if (reply.size > 0 && sender_) sender_->send(reply);
  if (!is_raw_) {
    if (plug_.has_changed(*quirks_, report)) return true;
    if (!is_input) return false;
  }
  const std::span<const std::uint8_t> input = is_raw_ ? packet : quirks_->report_of(packet);
  report.kind = ReportKind::input;
  report.size = static_cast<std::uint16_t>(input.size());
  std::copy(input.begin(), input.end(), report.bytes.begin());
  return true;
}

// hidapi returns -1 both for a hang-up that its poll() sees (errno is then 0) and for a failed
// call.
bool HidrawDevice::has_hung_up(int error) const noexcept {
  if (fd_ < 0) return error == 0 || error == EBADF;
  pollfd now{.fd = fd_, .events = POLLIN, .revents = 0};
  return ::poll(&now, 1, 0) > 0 && (now.revents & (POLLERR | POLLHUP | POLLNVAL)) != 0;
}

Status HidrawDevice::after_error(int error) noexcept {
  if (error == EINTR || error == EAGAIN) return Status::nothing;
  if ((error == ENODEV || error == EIO) && ::access(node_.c_str(), F_OK) != 0) return Status::gone;
  ++lost_;
  if (++errors_in_row_ < kMaxErrorsInARow) return Status::nothing;
  remarks_.push_back(fmt::format("{}: cannot be read: {}", node_, std::strerror(error)));
  return Status::gone;
}

// If as many reports are read without an empty read as the ring holds, it was full, and the kernel
// has dropped later ones without notice. The next report is the pad's state.
void HidrawDevice::count_waiting() noexcept {
  if (++reports_in_row_ != kKernelRing) return;
  ++lost_;
  if (!std::exchange(was_late_, true))
    remarks_.push_back(node_ + ": was read too late; the kernel may have dropped reports");
}

// While it binds, hid-nintendo asks the pad for its calibration and would take our answers for its
// own: wait until its input device exists.
void wait_for_kernel(const std::string& node) {
  const std::filesystem::path name = std::filesystem::path(node).filename();
  const std::filesystem::path device = std::filesystem::path("/sys/class/hidraw") / name / "device";
  const auto end = std::chrono::steady_clock::now() + kKernelStart;
  std::error_code error;
  while (std::chrono::steady_clock::now() < end && std::filesystem::exists(device, error) &&
         !std::filesystem::exists(device / "input", error))
    std::this_thread::sleep_for(20ms);
}

StartedBy started_by(const std::string& kernel_driver) {
  for (const char* name : {"playstation", "sony", "nintendo"})
    if (kernel_driver == name) return StartedBy::kernel;
  return StartedBy::us;
}

}  // namespace

// hid_enumerate() is not used: it sees the same nodes and tells less about them, and a pad that is
// plugged in between two lists would appear twice, once without a name.
std::vector<DeviceListing> find_hidraw_devices() {
  std::vector<DeviceListing> listings;
  for (const SystemNode& node : system_nodes("hidraw"))
    listings.push_back(listing_of(node, "hidraw"));
  for (DeviceListing& listing : listings) listing.problem = access_problem(listing.node);
  listings = with_split_pads(listings);
  std::vector<DeviceListing> pairs = joy_con_pairs(listings);
  listings.insert(listings.begin(), pairs.begin(), pairs.end());
  return listings;
}

namespace {

Result<std::unique_ptr<Device>> open_joy_cons(const DeviceListing& pair) {
  std::vector<std::unique_ptr<Device>> opened;
  for (const SystemNode& node : system_nodes("hidraw")) {
    if (std::ranges::count(pair.parts, node.pad_path) == 0) continue;
    auto device = open_hidraw_device(listing_of(node, "hidraw"), Detach::never);
    if (!device) return device.error();
    opened.push_back(std::move(*device));
  }
  if (opened.size() != 2) return Error{pair.node + ": one of the Joy-Cons has gone"};
  auto joined = join_joy_cons(std::move(opened[0]), std::move(opened[1]));
  if (!joined) return Error{pair.node + ": " + joined.error().message};
  return joined;
}

}  // namespace

Result<std::unique_ptr<Device>> open_hidraw_device(const DeviceListing& listing, Detach) {
  if (!listing.parts.empty()) return open_joy_cons(listing);
  const StartedBy started = started_by(listing.kernel_driver);
  if (listing.kernel_driver == "nintendo") wait_for_kernel(listing.node);
  const bool is_one = is_one_of_several(listing.info.descriptor);
  const std::string node = is_one ? without_number(listing.node) : listing.node;
  auto opened = open_hidraw_node(node);
  if (!opened) return opened.error();
  DeviceInfo info = listing.info;
  if (is_one) info.physical_path = without_number(info.physical_path);
  if (is_another_hidraw(opened->fd, info)) return Error{node + ": has become another device"};
  info.physical_path = listing.info.physical_path;
  info.driver = "hidraw";
  auto descriptor = hidraw_descriptor(opened->fd);
  if (!is_one && !descriptor.empty()) info.descriptor = std::move(descriptor);
  if (info.descriptor.empty())
    return Error{listing.node + ": its report descriptor cannot be read"};
  auto device = std::make_unique<HidrawDevice>(std::move(info), node, std::move(*opened));
  if (device->poll_fds().front().fd < 0)
    return Error{listing.node + ": cannot be waited for: too many open files"};
  device->start(started);
  return Result<std::unique_ptr<Device>>(std::move(device));
}

}  // namespace gaitpad
