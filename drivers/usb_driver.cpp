// USB pads without the kernel's input layer: HID-class pads by their own descriptors, vendor-class
// pads (Xbox) by those that their quirks state. While a pad is open the kernel's driver is
// detached, which needs the user's consent.
#include <errno.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <libusb.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <string_view>

#include "drivers/driver_rows.h"
#include "drivers/pads/pad_quirks.h"
#include "drivers/pads/pads_of_devices.h"
#include "drivers/shared_pads.h"
#include "drivers/system_nodes.h"
#include "drivers/usb_interfaces.h"
#include "drivers/usb_reattach.h"
#include "drivers/usb_transfers.h"
#include "gaitpad/descriptor.h"
#include "system/clock.h"
#include "system/descriptors.h"

namespace gaitpad {

namespace {

using std::chrono::milliseconds;

constexpr unsigned int kControlTimeoutMs = 500;
constexpr std::uint8_t kFromInterface = 0xa1, kStandardFromInterface = 0x81, kToInterface = 0x21;
constexpr std::uint8_t kGetReport = 0x01, kSetReport = 0x09, kSetIdle = 0x0a, kGetDescriptor = 0x06;
constexpr std::uint16_t kReportDescriptor = 0x2200, kInputReport = 0x0100, kFeatureReport = 0x0300;

struct FreeConfig {
  void operator()(libusb_config_descriptor* config) const { libusb_free_config_descriptor(config); }
};

// ---- Taking the interface from the kernel

// An error: `NODE: WHAT: the library's word for the error`.
Error usb_error(const std::string& node, std::string_view what, int error) {
  return Error{fmt::format("{}: {}: {}", node, what, libusb_strerror(error))};
}

struct ExitContext {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
struct CloseHandle {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};

// Starts libusb without discovery, if it can do that for one context: the devices are known from
// sysfs. Its options for all contexts are left to the host program.
int start_libusb(libusb_context*& context) {
#if LIBUSB_API_VERSION >= 0x0100010A
  const libusb_init_option option = {LIBUSB_OPTION_NO_DEVICE_DISCOVERY, {0}};
  return libusb_init_context(&context, &option, 1);
#else
  return libusb_init(&context);
#endif
}

// A claimed USB interface: its device's node is open and the kernel driver detached. All of it is
// undone at the end, even if the process dies. Each pad has its own context, so that it receives no
// events of other pads.
class ClaimedInterface {
 public:
  static Result<std::unique_ptr<ClaimedInterface>> claim(const std::string& node,
                                                         const UsbInterface& interface);
  ~ClaimedInterface();
  libusb_context* context() const { return context_.get(); }
  libusb_device_handle* handle() const { return handle_.get(); }

 private:
  explicit ClaimedInterface(std::uint8_t number) : number_(number) {}
  Result<bool> open(const std::string& node);
  Result<bool> detach_and_claim(const std::string& node, const std::string& kernel_driver);

  OwnedFd node_;
  std::uint8_t number_;
  std::unique_ptr<libusb_context, ExitContext> context_;
  std::unique_ptr<libusb_device_handle, CloseHandle> handle_;
  std::unique_ptr<ReattachWatcher> watcher_;  // null: nothing was detached yet
  bool is_claimed_ = false;
};

Result<std::unique_ptr<ClaimedInterface>> ClaimedInterface::claim(const std::string& node,
                                                                  const UsbInterface& interface) {
  std::unique_ptr<ClaimedInterface> claimed(new ClaimedInterface(interface.number));
  if (auto opened = claimed->open(node); !opened) return opened.error();
  if (auto taken = claimed->detach_and_claim(node, interface.kernel_driver); !taken)
    return taken.error();
  return claimed;
}

Result<bool> ClaimedInterface::open(const std::string& node) {
  node_ = OwnedFd(::open(node.c_str(), O_RDWR | O_CLOEXEC));
  if (node_.get() < 0) {
    const int cause = errno;
    const std::string problem = access_problem(node);
    return Error{problem.empty() ? fmt::format("{}: {}", node, std::strerror(cause)) : problem};
  }
  libusb_context* context = nullptr;
  int error = start_libusb(context);
  if (error != LIBUSB_SUCCESS) return usb_error(node, "libusb does not start", error);
  context_.reset(context);
  libusb_device_handle* handle = nullptr;
  error = libusb_wrap_sys_device(context, node_.get(), &handle);
  if (error != LIBUSB_SUCCESS) return usb_error(node, "cannot be opened", error);
  handle_.reset(handle);
  return true;
}

Result<bool> ClaimedInterface::detach_and_claim(const std::string& node,
                                                const std::string& kernel_driver) {
  // Start the watcher even if no driver is bound now: one may have been bound until a program that
  // had taken the pad, and that program's watcher, were killed.
  auto watcher = ReattachWatcher::start(node, number_);
  if (!watcher) return watcher.error();
  watcher_ = std::make_unique<ReattachWatcher>(std::move(*watcher));
  if (!kernel_driver.empty()) {
    const int error = libusb_detach_kernel_driver(handle(), number_);
    if (error != LIBUSB_SUCCESS && error != LIBUSB_ERROR_NOT_FOUND) {
      return usb_error(
          node, fmt::format("the kernel's driver {} cannot be detached", kernel_driver), error);
    }
  }
  const int error = libusb_claim_interface(handle(), number_);
  if (error == LIBUSB_ERROR_BUSY) return Error{node + ": another program has the pad"};
  if (error != LIBUSB_SUCCESS) return usb_error(node, "the pad cannot be taken", error);
  is_claimed_ = true;
  return true;
}

ClaimedInterface::~ClaimedInterface() {
  if (is_claimed_) libusb_release_interface(handle(), number_);
  if (!watcher_) return;
  const int error = libusb_attach_kernel_driver(handle(), number_);
  // BUSY: the interface has a driver again. NOT_FOUND: the kernel has none that fits. After any
  // other error the watcher keeps trying.
  if (error == LIBUSB_SUCCESS || error == LIBUSB_ERROR_NO_DEVICE || error == LIBUSB_ERROR_BUSY ||
      error == LIBUSB_ERROR_NOT_FOUND) {
    watcher_->dismiss();
  }
}

// ---- What the pad says of itself

struct PadDescription {
  UsbEndpoints endpoints;
  std::uint16_t hid_version = 0;  // the field bcdHID
};

void read_endpoint(const libusb_endpoint_descriptor& endpoint, UsbEndpoints& endpoints) {
  if ((endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) != LIBUSB_TRANSFER_TYPE_INTERRUPT) return;
  if ((endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) == 0) {
    if (endpoints.out == 0) endpoints.out = endpoint.bEndpointAddress;
  } else if (endpoints.in == 0) {
    // Packets per transaction of a high-bandwidth endpoint.
    const int packets = 1 + (endpoint.wMaxPacketSize >> 11 & 3);
    endpoints.in = endpoint.bEndpointAddress;
    endpoints.in_packet_bytes =
        static_cast<std::uint16_t>((endpoint.wMaxPacketSize & 0x7ff) * packets);
  }
}

PadDescription read_interface(const libusb_interface_descriptor& interface) {
  PadDescription pad;
  pad.endpoints.interface_number = interface.bInterfaceNumber;
  pad.endpoints.is_hid = interface.bInterfaceClass == kHidClass;
  for (int i = 0; i < interface.bNumEndpoints; ++i) {
    read_endpoint(interface.endpoint[i], pad.endpoints);
  }
  constexpr std::uint8_t kHidDescriptor = 0x21;
  if (interface.extra_length >= 4 && interface.extra[1] == kHidDescriptor) {
    pad.hid_version =
        static_cast<std::uint16_t>(interface.extra[2] | std::uint16_t{interface.extra[3]} << 8);
  }
  return pad;
}

Result<PadDescription> describe_pad(const std::string& node, libusb_device_handle* handle,
                                    std::uint8_t interface_number) {
  libusb_config_descriptor* active = nullptr;
  const int error = libusb_get_active_config_descriptor(libusb_get_device(handle), &active);
  if (error != LIBUSB_SUCCESS) return usb_error(node, "no configuration is active", error);
  const std::unique_ptr<libusb_config_descriptor, FreeConfig> config(active);
  for (int i = 0; i < config->bNumInterfaces; ++i) {
    const libusb_interface& interface = config->interface[i];
    if (interface.num_altsetting < 1) continue;
    if (interface.altsetting[0].bInterfaceNumber != interface_number) continue;
    const PadDescription pad = read_interface(interface.altsetting[0]);
    if (pad.endpoints.in == 0 || pad.endpoints.in_packet_bytes == 0) break;
    return pad;
  }
  return Error{node + ": no endpoint to read reports from"};
}

// The descriptor as the pad itself sends it: the kernel's copy may be corrected for the kernel's
// driver.
std::vector<std::uint8_t> report_descriptor(libusb_device_handle* handle, std::uint8_t interface) {
  std::vector<std::uint8_t> bytes(kMaxDescriptorBytes);
  const int count = libusb_control_transfer(
      handle, kStandardFromInterface, kGetDescriptor, kReportDescriptor, interface, bytes.data(),
      static_cast<std::uint16_t>(bytes.size()), kControlTimeoutMs);
  bytes.resize(static_cast<std::size_t>(std::max(count, 0)));
  return bytes;
}

// Sets the size of transfers. A report may be longer than a packet (low-speed pads have packets of
// 8 bytes). It then comes in several packets, and a transfer must have room for all of them.
void fit_transfers(const std::vector<std::uint8_t>& descriptor, UsbEndpoints& endpoints) {
  std::size_t longest = 1;
  if (const auto parsed = parse_descriptor(descriptor)) {
    endpoints.is_numbered = parsed->numbered;
    for (const ReportLength& report : parsed->reports) {
      if (report.kind != FieldKind::input) continue;
      longest = std::max(longest, report_bytes(*parsed, report.kind, report.report_id));
    }
  }
  const std::size_t packet = endpoints.in_packet_bytes;
  const std::size_t whole = (std::min(longest, kMaxReportBytes) + packet - 1) / packet * packet;
  endpoints.in_bytes = std::min(whole, std::max(kMaxReportBytes, packet));
}

// ---- An open pad

// The second interface of a pad whose first one is HID: sends commands and receives answers by its
// bulk endpoints.
class CommandInterface {
 public:
  explicit CommandInterface(libusb_device_handle* handle) : handle_(handle) {
    libusb_config_descriptor* active = nullptr;
    if (libusb_get_active_config_descriptor(libusb_get_device(handle), &active) != LIBUSB_SUCCESS)
      return;
    const std::unique_ptr<libusb_config_descriptor, FreeConfig> config(active);
    if (config->bNumInterfaces <= kNumber || config->interface[kNumber].num_altsetting < 1) return;
    const libusb_interface_descriptor& interface = config->interface[kNumber].altsetting[0];
    for (int i = 0; i < interface.bNumEndpoints; ++i) {
      const libusb_endpoint_descriptor& endpoint = interface.endpoint[i];
      if ((endpoint.bmAttributes & LIBUSB_TRANSFER_TYPE_MASK) != LIBUSB_TRANSFER_TYPE_BULK)
        continue;
      const bool is_in = (endpoint.bEndpointAddress & LIBUSB_ENDPOINT_IN) != 0;
      (is_in ? in_ : out_) = endpoint.bEndpointAddress;
    }
    is_claimed_ =
        in_ != 0 && out_ != 0 && libusb_claim_interface(handle, kNumber) == LIBUSB_SUCCESS;
  }
  CommandInterface(const CommandInterface&) = delete;
  ~CommandInterface() {
    if (is_claimed_) libusb_release_interface(handle_, kNumber);
  }

  std::size_t ask(std::span<const std::uint8_t> packet, std::span<std::uint8_t> answer) noexcept {
    int done = 0;
    std::vector<std::uint8_t> out(packet.begin(), packet.end());
    if (!is_claimed_ ||
        libusb_bulk_transfer(handle_, out_, out.data(), static_cast<int>(out.size()), &done,
                             kControlTimeoutMs) != LIBUSB_SUCCESS)
      return 0;
    if (libusb_bulk_transfer(handle_, in_, answer.data(), static_cast<int>(answer.size()), &done,
                             kAnswerMs) != LIBUSB_SUCCESS)
      return 0;
    return static_cast<std::size_t>(std::max(done, 0));
  }

 private:
  static constexpr int kNumber = 1;
  static constexpr unsigned int kAnswerMs = 100;
  libusb_device_handle* handle_;
  std::uint8_t in_ = 0, out_ = 0;
  bool is_claimed_ = false;
};

// Lets quirks exchange packets with the pad while it starts; here waiting is allowed.
class StartPort final : public PadPort {
 public:
  StartPort(UsbTransfers& transfers, libusb_device_handle* handle, std::uint8_t interface)
      : transfers_(transfers), handle_(handle), interface_(interface) {}

  bool write(std::span<const std::uint8_t> packet) noexcept override {
    OutPacket out;
    return out.set(packet) && transfers_.send(out) && transfers_.flush(milliseconds(200));
  }

  std::size_t read(std::span<std::uint8_t> packet, milliseconds timeout) noexcept override {
    const auto end = std::chrono::steady_clock::now() + timeout;
    while (!transfers_.take_packet(report_)) {
      const auto left = std::chrono::ceil<milliseconds>(end - std::chrono::steady_clock::now());
      if (left.count() <= 0 || transfers_.is_gone()) return 0;
      transfers_.handle_events(left);
    }
    const std::size_t size = std::min<std::size_t>(packet.size(), report_.size);
    std::copy_n(report_.bytes.begin(), size, packet.begin());
    return size;
  }

  std::size_t feature(std::uint8_t id, std::span<std::uint8_t> packet) noexcept override {
    return get_report(kFeatureReport, id, packet);
  }
  std::size_t input(std::uint8_t id, std::span<std::uint8_t> packet) noexcept override {
    return get_report(kInputReport, id, packet);
  }

  std::size_t command(std::span<const std::uint8_t> packet,
                      std::span<std::uint8_t> answer) noexcept override {
    if (!commands_) commands_ = std::make_unique<CommandInterface>(handle_);
    return commands_->ask(packet, answer);
  }

  bool send_feature(std::span<const std::uint8_t> packet) noexcept override {
    if (packet.empty() || packet.size() > kMaxReportBytes) return false;
    const std::size_t skip = packet[0] == 0 ? 1 : 0;
    std::vector<std::uint8_t> data(packet.begin() + static_cast<std::ptrdiff_t>(skip),
                                   packet.end());
    return libusb_control_transfer(handle_, kToInterface, kSetReport,
                                   static_cast<std::uint16_t>(kFeatureReport | packet[0]),
                                   interface_, data.data(), static_cast<std::uint16_t>(data.size()),
                                   kControlTimeoutMs) >= 0;
  }

 private:
  // Asks for a report. `packet` begins with the id 0 if the pad has no ids, though the pad sends
  // none.
  std::size_t get_report(std::uint16_t kind, std::uint8_t id,
                         std::span<std::uint8_t> packet) noexcept {
    const std::size_t skip = id == 0 ? 1 : 0;
    if (packet.size() <= skip || packet.size() > kMaxReportBytes + skip) return 0;
    packet[0] = id;
    const int count = libusb_control_transfer(
        handle_, kFromInterface, kGetReport, static_cast<std::uint16_t>(kind | id), interface_,
        packet.data() + skip, static_cast<std::uint16_t>(packet.size() - skip), kControlTimeoutMs);
    const bool is_other = kind == kInputReport && packet[0] != id;
    return count <= 0 || is_other ? 0 : static_cast<std::size_t>(count) + skip;
  }

  UsbTransfers& transfers_;
  libusb_device_handle* handle_;
  std::uint8_t interface_;
  std::unique_ptr<CommandInterface> commands_;  // opened by the first command
  Report report_;
};

class UsbDevice final : public Device {
 public:
  UsbDevice(DeviceInfo info, std::unique_ptr<PadQuirks> quirks,
            std::unique_ptr<ClaimedInterface> interface, std::unique_ptr<UsbTransfers> transfers)
      : info_(std::move(info)),
        quirks_(std::move(quirks)),
        interface_(std::move(interface)),
        transfers_(std::move(transfers)) {}

  ~UsbDevice() override {
    if (is_rumbling_ && rumble(Rumble{})) transfers_->flush(milliseconds(100));
    if (transfers_->is_gone()) return;
    StartPort port(*transfers_, interface_->handle(), interface_number_);
    quirks_->stop(port);
  }

  void start(const UsbInterface& interface) {
    interface_number_ = interface.number;
    StartPort port(*transfers_, interface_->handle(), interface.number);
    quirks_->start(port, StartedBy::us);
    quirks_->amend(info_);
    if (interface.ids.interface_class != kHidClass) return;
    first_.size = static_cast<std::uint16_t>(first_packet(port, info_.descriptor, first_.bytes));
  }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return transfers_->poll_fds(); }

  Status read(Report& report) noexcept override {
    if (take_input(report)) return Status::report;
    transfers_->handle_events(milliseconds(0));
    if (take_input(report)) return Status::report;
    return transfers_->is_gone() ? Status::gone : Status::nothing;
  }

  void hand_on_raw() noexcept override { is_raw_ = true; }

  bool rumble(const Rumble& strengths) noexcept override {
    OutPacket packet;
    quirks_->rumble(strengths, packet);
    if (packet.size == 0 || !transfers_->send(packet)) return false;
    is_rumbling_ = strengths.strong != 0 || strengths.weak != 0;
    return true;
  }

  std::optional<FactorySticks> factory_sticks() const override { return quirks_->factory_sticks(); }
  std::optional<FactoryGyro> factory_gyro() const override { return quirks_->factory_gyro(); }
  std::int64_t lost() const noexcept override { return transfers_->lost() + quirks_->lost(); }
  std::vector<std::string> take_remarks() override { return quirks_->take_remarks(); }

 private:
  // Fills `report` with the oldest input report that has arrived, and sends replies to the packets
  // before it.
  bool take_input(Report& report) noexcept {
    while (take_packet(report)) {
      const std::span<const std::uint8_t> packet(report.bytes.data(), report.size);
      const bool is_input = quirks_->accept(packet, reply_);
      if (reply_.size > 0) transfers_->send(reply_);
      if (is_raw_ || plug_.has_changed(*quirks_, report)) return true;
      if (!is_input) continue;
      const std::span<const std::uint8_t> input = quirks_->report_of(packet);
      if (input.data() == packet.data()) return true;
      report.size = static_cast<std::uint16_t>(input.size());
      std::copy(input.begin(), input.end(), report.bytes.begin());
      return true;
    }
    return false;
  }

  bool take_packet(Report& report) noexcept {
    if (first_.size == 0) return transfers_->take_packet(report);
    report = first_;
    report.time_ns = now_ns();
    first_.size = 0;
    return true;
  }

  DeviceInfo info_;
  Report first_;  // the first packet; its size is 0 before it comes
  std::unique_ptr<PadQuirks> quirks_;
  std::unique_ptr<ClaimedInterface> interface_;
  // Declared after the interface, so that it is destroyed before it.
  std::unique_ptr<UsbTransfers> transfers_;
  OutPacket reply_;
  PlugWatch plug_;
  std::uint8_t interface_number_ = 0;
  bool is_rumbling_ = false, is_raw_ = false;
};

// The quirks and descriptor of a vendor-class pad; no quirks for other pads.
VendorPad quirks_of(const UsbInterfaceClass& ids, const DeviceInfo& info) {
  for (const auto make : {make_xbox_360_pad, make_gip_pad}) {
    if (auto pad = make(ids, info); pad.quirks) return pad;
  }
  return {};
}

Result<std::unique_ptr<Device>> open_pad(const std::string& node, const UsbInterface& interface,
                                         DeviceInfo info) {
  auto claimed = ClaimedInterface::claim(node, interface);
  if (!claimed) return claimed.error();
  libusb_device_handle* const handle = (*claimed)->handle();
  auto pad = describe_pad(node, handle, interface.number);
  if (!pad) return pad.error();
  VendorPad vendor = quirks_of(interface.ids, info);
  if (!vendor.quirks) {
    vendor.descriptor = report_descriptor(handle, interface.number);
    if (vendor.descriptor.empty()) vendor.descriptor = interface.descriptor;
    if (vendor.descriptor.empty()) return Error{node + ": the pad has no report descriptor"};
    libusb_control_transfer(handle, kToInterface, kSetIdle, 0, interface.number, nullptr, 0,
                            kControlTimeoutMs);
  }
  info.descriptor = std::move(vendor.descriptor);
  if (!vendor.quirks) {
    if (info.version == 0) info.version = pad->hid_version;
    vendor.quirks = make_pad_quirks(info);
  }
  fit_transfers(info.descriptor, pad->endpoints);
  auto transfers = UsbTransfers::start((*claimed)->context(), handle, pad->endpoints);
  if (!transfers) return Error{node + ": " + transfers.error().message};
  auto device = std::make_unique<UsbDevice>(std::move(info), std::move(vendor.quirks),
                                            std::move(*claimed), std::move(*transfers));
  device->start(interface);
  return std::unique_ptr<Device>(std::move(device));
}

// ---- One of several pads of an interface

class UsbPackets final : public PacketSource {
 public:
  UsbPackets(std::unique_ptr<ClaimedInterface> interface, std::unique_ptr<UsbTransfers> transfers)
      : interface_(std::move(interface)), transfers_(std::move(transfers)) {}
  ~UsbPackets() override { transfers_->flush(milliseconds(100)); }
  std::span<const pollfd> poll_fds() const noexcept override { return transfers_->poll_fds(); }
  Device::Status read(Report& packet) noexcept override {
    if (transfers_->take_packet(packet)) return Device::Status::report;
    transfers_->handle_events(milliseconds(0));
    if (transfers_->take_packet(packet)) return Device::Status::report;
    return transfers_->is_gone() ? Device::Status::gone : Device::Status::nothing;
  }
  bool send(const OutPacket& packet) noexcept override { return transfers_->send(packet); }
  std::int64_t lost() const noexcept override { return transfers_->lost(); }

 private:
  std::unique_ptr<ClaimedInterface> interface_;
  // Declared after the interface, so that it is destroyed before it.
  std::unique_ptr<UsbTransfers> transfers_;
};

Result<std::shared_ptr<SharedDevice>> claim_shared(const std::string& node,
                                                   const UsbInterface& interface,
                                                   const std::vector<std::uint8_t>& descriptor) {
  auto claimed = ClaimedInterface::claim(node, interface);
  if (!claimed) return claimed.error();
  libusb_device_handle* const handle = (*claimed)->handle();
  auto pad = describe_pad(node, handle, interface.number);
  if (!pad) return pad.error();
  libusb_control_transfer(handle, kToInterface, kSetIdle, 0, interface.number, nullptr, 0,
                          kControlTimeoutMs);
  fit_transfers(descriptor, pad->endpoints);
  auto transfers = UsbTransfers::start((*claimed)->context(), handle, pad->endpoints);
  if (!transfers) return Error{node + ": " + transfers.error().message};
  return std::make_shared<SharedDevice>(
      std::make_unique<UsbPackets>(std::move(*claimed), std::move(*transfers)));
}

// The shared devices that are open, by the sysfs folders of their interfaces.
struct SharedInterfaces {
  static SharedInterfaces& all() {
    static SharedInterfaces interfaces;
    return interfaces;
  }
  std::mutex mutex;  // held also while an interface is claimed, so that none is claimed twice
  std::map<std::string, std::weak_ptr<SharedDevice>> open;
};

Result<std::unique_ptr<Device>> open_one_of_several(const DeviceListing& listing,
                                                    const std::string& node,
                                                    const UsbInterface& interface) {
  SharedInterfaces& shared = SharedInterfaces::all();
  const std::lock_guard lock(shared.mutex);
  std::weak_ptr<SharedDevice>& known = shared.open[interface.path];
  std::shared_ptr<SharedDevice> device = known.lock();
  if (!device) {
    auto claimed = claim_shared(node, interface, listing.info.descriptor);
    if (!claimed) return claimed.error();
    known = device = std::move(*claimed);
  }
  return open_shared_pad(std::move(device), listing.info);
}

bool is_shared(const std::string& interface_path) {
  SharedInterfaces& shared = SharedInterfaces::all();
  const std::lock_guard lock(shared.mutex);
  const auto known = shared.open.find(interface_path);
  return known != shared.open.end() && !known->second.expired();
}

// ---- Finding

DeviceListing listing_of(const SystemNode& device, const UsbInterface& interface) {
  DeviceListing listing;
  DeviceInfo& info = listing.info;
  info.bus = BusType::usb;
  info.vendor = device.vendor;
  info.product = device.product;
  info.driver = "usb";
  info.name = device.name.empty() ? fmt::format("USB {:04x}:{:04x}", device.vendor, device.product)
                                  : device.name;
  info.unique_id = device.unique_id;
  info.physical_path = usb_physical_path(device.sysfs_path, interface.number);
  info.version = interface.version;
  info.descriptor = interface.descriptor;
  if (auto vendor = quirks_of(interface.ids, info); vendor.quirks) {
    info.version = device.version;
    info.descriptor = std::move(vendor.descriptor);
  }
  listing.node = device.node;
  listing.pad_path = interface.path;
  listing.kernel_driver =
      interface.hid_driver.empty() ? interface.kernel_driver : interface.hid_driver;
  listing.poll_rate_hz = interface.poll_rate_hz;
  const std::string other = boot_device(interface);
  listing.problem = other.empty() ? access_problem(device.node)
                                  : fmt::format("{}: no pad: {}", device.node, other);
  return listing;
}

}  // namespace

std::vector<DeviceListing> find_usb_devices() {
  std::vector<DeviceListing> listings;
  for (const SystemNode& device : system_nodes("usb")) {
    std::vector<UsbInterface> interfaces = usb_interfaces(device.sysfs_path);
    std::erase_if(interfaces, [](const UsbInterface& i) { return !may_be_pad(i); });
    for (const UsbInterface& interface : interfaces) {
      DeviceListing listing = listing_of(device, interface);
      if (interfaces.size() > 1) listing.node += fmt::format(":{}", interface.number);
      listings.push_back(std::move(listing));
    }
  }
  return with_split_pads(listings);
}

Result<std::unique_ptr<Device>> open_usb_device(const DeviceListing& listing, Detach detach) {
  const std::string& name = listing.node;
  const auto interface = usb_interface(listing.pad_path);
  if (!interface || !may_be_pad(*interface)) return Error{name + ": the pad is gone"};
  if (const std::string other = boot_device(*interface); !other.empty()) {
    return Error{fmt::format("{}: no pad: {}", name, other)};
  }
  const std::string& holder = interface->kernel_driver;
  const bool is_one = is_one_of_several(listing.info.descriptor);
  if (holder == "usbfs" && !(is_one && is_shared(interface->path)))
    return Error{name + ": another program has the pad"};
  if (!holder.empty() && detach == Detach::never) {
    return Error{fmt::format(
        "{}: the kernel's driver {} has the pad; --driver usb takes the pad over while it runs",
        name, listing.kernel_driver.empty() ? holder : listing.kernel_driver)};
  }
  const std::string node = name.substr(0, name.find(':'));
  return is_one ? open_one_of_several(listing, node, *interface)
                : open_pad(node, *interface, listing.info);
}

}  // namespace gaitpad
