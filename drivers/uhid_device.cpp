#include "drivers/uhid_device.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/uhid.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/text.h"

namespace gaitpad {
namespace {

// Copies a text into a field of the kernel's structures, cut to fit.
template <std::size_t n>
void put_text(const std::string& text, std::uint8_t (&field)[n]) {
  std::copy_n(text.begin(), std::min(text.size(), n - 1), field);
}

bool write_event(int fd, const uhid_event& event) noexcept {
  return ::write(fd, &event, sizeof event) == sizeof event;
}

}  // namespace

Result<UhidDevice> UhidDevice::create(const DeviceInfo& info) {
  constexpr const char* kNode = "/dev/uhid";
  OwnedFd fd(::open(kNode, O_RDWR | O_CLOEXEC | O_NONBLOCK));
  if (fd.get() < 0) {
    const int error = errno;
    return Error{fmt::format("{}: no device can be made there: {}{}", kNode, std::strerror(error),
                             error == ENOENT   ? "; run: sudo modprobe uhid"
                             : error == EACCES ? "; run it as root"
                                               : "")};
  }
  uhid_event event{};
  event.type = UHID_CREATE2;
  uhid_create2_req& request = event.u.create2;
  if (info.descriptor.size() > sizeof request.rd_data)
    return Error{
        fmt::format("{}: a descriptor of {} bytes is too long", info.name, info.descriptor.size())};
  put_text(info.name, request.name);
  put_text(info.physical_path, request.phys);
  put_text(info.unique_id, request.uniq);
  std::ranges::copy(info.descriptor, request.rd_data);
  request.rd_size = static_cast<std::uint16_t>(info.descriptor.size());
  request.bus = static_cast<std::uint16_t>(info.bus);
  request.vendor = info.vendor;
  request.product = info.product;
  request.version = info.version;
  if (!write_event(fd.get(), event))
    return Error{fmt::format("{}: {} is refused: {}", kNode, info.name, std::strerror(errno))};
  return UhidDevice(std::move(fd));
}

void UhidDevice::answer() noexcept {
  uhid_event event{};
  while (::read(fd_.get(), &event, sizeof event) > 0) {
    uhid_event reply{};
    if (event.type == UHID_START) {
      is_bound_ = true;
    } else if (event.type == UHID_GET_REPORT) {
      reply.type = UHID_GET_REPORT_REPLY;
      reply.u.get_report_reply.id = event.u.get_report.id;
      reply.u.get_report_reply.err = EIO;
    } else if (event.type == UHID_SET_REPORT) {
      reply.type = UHID_SET_REPORT_REPLY;
      reply.u.set_report_reply.id = event.u.set_report.id;
      reply.u.set_report_reply.err = EIO;
    }
    if (reply.type != 0) static_cast<void>(write_event(fd_.get(), reply));
    event = {};
  }
}

bool UhidDevice::send(std::span<const std::uint8_t> report) noexcept {
  uhid_event event{};
  event.type = UHID_INPUT2;
  event.u.input2.size = static_cast<std::uint16_t>(report.size());
  std::ranges::copy(report, event.u.input2.data);
  return write_event(fd_.get(), event);
}

std::optional<Error> UhidDevices::plug(std::size_t device) {
  if (devices_[device]) return std::nullopt;
  auto made = UhidDevice::create(recorded_[device].info);
  if (!made) return made.error();
  devices_[device].emplace(std::move(*made));
  return std::nullopt;
}

std::optional<Error> UhidDevices::plug_all() {
  for (std::size_t i = 0; i < devices_.size(); ++i) {
    if (auto problem = plug(i)) return problem;
  }
  return std::nullopt;
}

std::vector<pollfd> UhidDevices::fds() const {
  std::vector<pollfd> fds;
  for (const auto& device : devices_) {
    if (device) fds.push_back(device->fd());
  }
  return fds;
}

void UhidDevices::answer() noexcept {
  for (auto& device : devices_) {
    if (device) device->answer();
  }
}

bool UhidDevices::are_bound() const noexcept {
  return std::ranges::all_of(devices_, [](const auto& d) { return !d || d->is_bound(); });
}

std::optional<Error> UhidDevices::take(const Report& report) {
  if (report.kind == ReportKind::added) return plug(report.device);
  auto& device = devices_[report.device];
  if (report.kind == ReportKind::removed) device.reset();
  if (report.kind != ReportKind::input || !device) return std::nullopt;
  if (device->send({report.bytes.data(), report.size})) return std::nullopt;
  return Error{printable(recorded_[report.device].info.name) + ": the kernel refuses its reports"};
}

}  // namespace gaitpad
