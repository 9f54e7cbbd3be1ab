// Pads through Linux's hidraw, by hidapi: the bytes as the pad sent them, while the kernel's own
// driver goes on serving evdev. hidapi 0.13 gives neither the report descriptor nor anything to
// wait on, and one error for all that can go wrong; what is missing is asked of the kernel here.
#include <fmt/format.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include "drivers/driver_entries.h"
#include "drivers/hidraw_node.h"
#include "drivers/posix.h"
#include "drivers/system_nodes.h"
#include "gaitpad/descriptor.h"

namespace gaitpad {

namespace {

using namespace std::chrono_literals;
using Status = Device::Status;

constexpr int kMaxRefusedInARow = 64;  // packets looked at before other pads have their turn
constexpr int kMaxErrorsInARow = 64;   // a source that only fails is given up
constexpr int kKernelRing = 63;        // reports that hidraw keeps for a slow reader
constexpr auto kKernelStart = 3s;
constexpr long kBlindPeriod_ns = 1'000'000;

// Ready every millisecond; -1: it cannot be had.
int blind_timer() noexcept {
  const int timer = ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  const itimerspec period{{0, kBlindPeriod_ns}, {0, kBlindPeriod_ns}};
  if (timer >= 0) ::timerfd_settime(timer, 0, &period, nullptr);
  return timer;
}

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
        timer_(fd_ < 0 ? blind_timer() : -1),
        model_(make_pad_model(info_)),
        is_numbered_(has_report_ids(info_)),
        present_(is_numbered_, hidraw_input_request(node_)) {
    wait_on_[0] = {.fd = fd_ >= 0 ? fd_ : timer_.get(), .events = POLLIN, .revents = 0};
  }
  ~HidrawDevice() override {
    if (is_rumbling_ && !is_unplugged_) rumble({});
  }

  void start(StartedBy started) {
    HidrawPort port(handle_.get(), is_numbered_);
    model_->start(port, started);
    OutPacket still;
    model_->rumble({}, still);
    if (still.size == 0) return;
    sender_ = hidraw_sender(node_, is_numbered_);
    if (!sender_ && access_problem(node_).empty())
      remarks_.push_back(node_ + ": the motors cannot be reached");
  }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override {
    return std::span(wait_on_).first(present_.is_waiting() ? wait_on_.size() : 1);
  }
  Status read(Report& report) noexcept override;
  bool rumble(const Rumble& rumble) noexcept override {
    if (!sender_) return false;
    OutPacket packet;
    model_->rumble(rumble, packet);
    is_rumbling_ = rumble.strong != 0 || rumble.weak != 0;
    return sender_->send(packet);
  }
  std::optional<FactorySticks> factory_sticks() const override { return model_->factory_sticks(); }
  std::int64_t lost() const noexcept override { return lost_ + model_->lost(); }
  std::vector<std::string> take_remarks() override {
    std::vector<std::string> remarks = model_->take_remarks();
    std::move(remarks_.begin(), remarks_.end(), std::back_inserter(remarks));
    remarks_.clear();
    return remarks;
  }

 private:
  bool take(std::span<const std::uint8_t> packet, Report& report) noexcept;
  Status when_empty(Report& report) noexcept;
  bool has_hung_up(int error) const noexcept;
  Status after_error(int error) noexcept;
  void count_waiting() noexcept;

  DeviceInfo info_;
  std::string node_;
  Handle handle_;
  int fd_ = -1;    // the handle's
  OwnedFd timer_;  // where that is unknown
  std::array<pollfd, 3> wait_on_{};
  std::unique_ptr<PadModel> model_;
  std::unique_ptr<PacketSender> sender_;  // null: no motors
  bool is_numbered_;
  PresentState present_;
  bool is_rumbling_ = false;
  bool is_unplugged_ = false;  // what came before is still to be read
  int errors_in_row_ = 0;
  int waiting_ = 0;         // reports read since there were none
  bool was_empty_ = false;  // once: what waited before that had waited for the opening
  bool was_late_ = false;
  std::int64_t lost_ = 0;
  std::vector<std::string> remarks_;
  // One byte more than a report may have, to see that one has more.
  std::array<std::uint8_t, kMaxReportBytes + 1> buffer_{};
};

Status HidrawDevice::read(Report& report) noexcept {
  std::uint64_t ticks = 0;
  if (timer_.get() >= 0 && ::read(timer_.get(), &ticks, sizeof ticks) < 0) ticks = 0;
  for (int i = 0; i < kMaxRefusedInARow; ++i) {
    errno = 0;
    // With a timeout hidapi refuses to read on once the pad is gone; without, an unplugged node
    // gives what it still holds and then an error, and never waits.
    const int size =
        hid_read_timeout(handle_.get(), buffer_.data(), buffer_.size(), is_unplugged_ ? -1 : 0);
    const int error = errno;
    if (size <= 0 && is_unplugged_) return Status::gone;
    if (size == 0) return when_empty(report);
    if (size < 0 && !has_hung_up(error)) return after_error(error);
    if (size < 0) {
      is_unplugged_ = true;
      continue;
    }
    errors_in_row_ = 0;
    count_waiting();
    if (take(std::span(buffer_).first(static_cast<std::size_t>(size)), report))
      return Status::report;
  }
  return Status::nothing;  // there may be more: the node stays ready
}

bool HidrawDevice::take(std::span<const std::uint8_t> packet, Report& report) noexcept {
  if (packet.size() > kMaxReportBytes) {
    ++lost_;
    return false;
  }
  report.time_ns = now_ns();
  OutPacket reply;
  const bool is_input = model_->accept(packet, reply);
  if (reply.size > 0 && sender_) sender_->send(reply);
  if (!is_input) return false;
  present_.heard(packet);
  report.kind = ReportKind::input;
  report.size = static_cast<std::uint16_t>(packet.size());
  std::copy(packet.begin(), packet.end(), report.bytes.begin());
  return true;
}

// hidapi answers -1 for the hang-up that its poll() sees (no error number then) and for every
// failure of a call.
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

// The kernel drops the newest report when nobody has read as many as it keeps, and tells nobody.
void HidrawDevice::count_waiting() noexcept {
  if (++waiting_ != kKernelRing || !was_empty_) return;
  ++lost_;
  if (!std::exchange(was_late_, true))
    remarks_.push_back(node_ + ": was read too late; the kernel may have dropped reports");
}

// The last moment in which an answer of the pad's is newer than all its reports.
Status HidrawDevice::when_empty(Report& report) noexcept {
  was_empty_ = true;
  if (std::exchange(waiting_, 0) >= kKernelRing) present_.missed();
  const std::span<const std::uint8_t> answer = present_.take();
  std::ranges::copy(present_.poll_fds(), wait_on_.begin() + 1);
  return !answer.empty() && take(answer, report) ? Status::report : Status::nothing;
}

// While it binds, hid-nintendo asks the pad for its calibration and takes any answer for its own:
// it is left alone until its input device stands.
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

// Not by hid_enumerate(): it sees the same nodes and tells less of them, and a pad that was plugged
// in between two lists would look like another one without a name.
std::vector<DeviceListing> find_hidraw_devices() {
  std::vector<DeviceListing> listings;
  for (const SystemNode& node : system_nodes("hidraw"))
    listings.push_back(listing_of(node, "hidraw"));
  for (DeviceListing& listing : listings) listing.problem = access_problem(listing.node);
  return listings;
}

Result<std::unique_ptr<Device>> open_hidraw_device(const DeviceListing& listing, Detach) {
  const StartedBy started = started_by(listing.kernel_driver);
  if (listing.kernel_driver == "nintendo") wait_for_kernel(listing.node);
  auto opened = open_hidraw_node(listing.node);
  if (!opened) return opened.error();
  if (is_another_hidraw(opened->fd, listing.info))
    return Error{listing.node + ": has become another device"};
  DeviceInfo info = listing.info;
  info.driver = "hidraw";
  if (auto descriptor = hidraw_descriptor(opened->fd); !descriptor.empty())
    info.descriptor = std::move(descriptor);
  if (info.descriptor.empty())
    return Error{listing.node + ": its report descriptor cannot be read"};
  auto device = std::make_unique<HidrawDevice>(std::move(info), listing.node, std::move(*opened));
  if (device->poll_fds().front().fd < 0)
    return Error{listing.node + ": cannot be waited for: too many open files"};
  device->start(started);
  return Result<std::unique_ptr<Device>>(std::move(device));
}

}  // namespace gaitpad
