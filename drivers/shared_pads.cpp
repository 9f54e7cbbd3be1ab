#include "drivers/shared_pads.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

#include "drivers/pads/pads_of_devices.h"
#include "system/descriptors.h"

namespace gaitpad {

namespace {

constexpr int kMaxPackets = 64;  // after this number of packets in a row other pads get their turn
constexpr std::size_t kInbox = 64;  // most packets of a pad that wait to be read

// Lets quirks write to the device; reading is not possible here.
class WritingPort final : public PadPort {
 public:
  explicit WritingPort(PacketSource& source) : source_(source) {}
  bool write(std::span<const std::uint8_t> packet) noexcept override {
    OutPacket out;
    return out.set(packet) && source_.send(out);
  }
  std::size_t read(std::span<std::uint8_t>, std::chrono::milliseconds) noexcept override {
    return 0;
  }
  std::size_t feature(std::uint8_t, std::span<std::uint8_t>) noexcept override { return 0; }

 private:
  PacketSource& source_;
};

}  // namespace

class SharedPad final : public Device {
 public:
  SharedPad(std::shared_ptr<SharedDevice> device, DeviceInfo info)
      : device_(std::move(device)), info_(std::move(info)), quirks_(make_pad_quirks(info_)) {
    const std::lock_guard lock(device_->mutex);
    const auto fds = device_->source->poll_fds();
    fds_.assign(fds.begin(), fds.end());
    if (bell_.fd() >= 0) fds_.push_back({.fd = bell_.fd(), .events = POLLIN, .revents = 0});
    WritingPort port(*device_->source);
    quirks_->start(port, StartedBy::us);
    device_->pads.push_back(this);
  }
  ~SharedPad() override {
    if (is_rumbling_) rumble({});
    const std::lock_guard lock(device_->mutex);
    std::erase(device_->pads, this);
  }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return fds_; }

  Status read(Report& report) noexcept override {
    const std::lock_guard lock(device_->mutex);
    if (take_own(report)) return Status::report;
    Status status = Status::report;
    for (int i = 0; i < kMaxPackets && status == Status::report && count_ < kInbox; ++i) {
      status = device_->source->read(report);
      if (status != Status::report) break;
      for (SharedPad* pad : device_->pads) pad->put(report, pad == this ? Ring::no : Ring::yes);
    }
    if (take_own(report)) return Status::report;
    bell_.clear();
    return status == Status::gone ? Status::gone : Status::nothing;
  }

  void hand_on_raw() noexcept override { is_raw_ = true; }

  bool rumble(const Rumble& strengths) noexcept override {
    const std::lock_guard lock(device_->mutex);
    OutPacket packet;
    quirks_->rumble(strengths, packet);
    if (packet.size == 0 || !device_->source->send(packet)) return false;
    is_rumbling_ = strengths.strong != 0 || strengths.weak != 0;
    return true;
  }

  std::optional<FactorySticks> factory_sticks() const override { return quirks_->factory_sticks(); }
  std::optional<FactoryGyro> factory_gyro() const override { return quirks_->factory_gyro(); }
  std::int64_t lost() const noexcept override {
    const std::lock_guard lock(device_->mutex);
    return lost_ + device_->source->lost();
  }
  std::vector<std::string> take_remarks() override { return quirks_->take_remarks(); }

 private:
  enum class Ring { no, yes };

  // Adds a packet; drops the oldest one if the pad's packets are not read.
  void put(const Report& packet, Ring ring) noexcept {
    if (count_ == kInbox) {
      ++lost_;
      first_ = (first_ + 1) % kInbox;
      --count_;
    }
    inbox_[(first_ + count_++) % kInbox] = packet;
    if (ring == Ring::yes) bell_.ring();
  }

  bool take_own(Report& report) noexcept {
    while (count_ > 0) {
      report = inbox_[first_];
      first_ = (first_ + 1) % kInbox;
      --count_;
      OutPacket reply;
      const bool is_input = quirks_->accept({report.bytes.data(), report.size}, reply);
      if (is_raw_ || plug_.has_changed(*quirks_, report) || is_input) return true;
    }
    return false;
  }

  std::shared_ptr<SharedDevice> device_;
  DeviceInfo info_;
  std::unique_ptr<PadQuirks> quirks_;
  Bell bell_;  // rings when another pad's read has put packets into the inbox
  std::vector<pollfd> fds_;
  std::array<Report, kInbox> inbox_;
  std::size_t first_ = 0, count_ = 0;
  PlugWatch plug_;
  std::int64_t lost_ = 0;
  bool is_rumbling_ = false, is_raw_ = false;
};

std::unique_ptr<Device> open_shared_pad(std::shared_ptr<SharedDevice> device, DeviceInfo info) {
  return std::make_unique<SharedPad>(std::move(device), std::move(info));
}

}  // namespace gaitpad
