// Fake drivers below the real stream: a test plugs pads in and out. Each pad is a socket that keeps
// packets apart, like hidraw.
#pragma once
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "gaitpad/driver.h"
#include "tests/session/made_session.h"

namespace gaitpad {

enum class FakeKind {
  sound,
  always_ready,       // the descriptor is always ready, but there is nothing to read
  closed_descriptor,  // poll() reports POLLNVAL
};

// The test's end of a plugged pad; shared with the open device.
struct FakePad {
  DeviceListing listing;
  FakeKind kind = FakeKind::sound;
  int failing_openings = 0;
  std::optional<FactorySticks> factory_sticks;
  std::optional<std::int64_t> stamp_ns;  // stamp of every report; the present time if unset
  std::atomic<int> openings{0}, closings{0};
  std::atomic<bool> keeps_closing{false};  // closing waits until this is false
  std::atomic<bool> keeps_opening{false};  // opening waits until this is false
  std::atomic<std::int64_t> lost{0};
  std::atomic<bool> is_raw{false};
  std::mutex mutex;
  std::vector<Rumble> rumbles;  // rumbles that the pad got, guarded by the mutex
  int sockets[2] = {-1, -1};    // the pad's end and the device's end

  FakePad() { static_cast<void>(!::socketpair(AF_UNIX, SOCK_SEQPACKET, 0, sockets)); }
  ~FakePad() {
    for (const int fd : sockets) {
      if (fd >= 0) ::close(fd);
    }
  }
  // Sends a report; waits while the reader is too slow. Returns false if the pad is unplugged.
  bool send(const std::vector<std::uint8_t>& bytes) const {
    return ::send(sockets[0], bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0;
  }
  bool send_axes(int x, int y) const {
    const Report r = made_report(x, y);
    return send({r.bytes.begin(), r.bytes.begin() + r.size});
  }
  std::vector<Rumble> all_rumbles() {
    const std::lock_guard lock(mutex);
    return rumbles;
  }
};

class FakeDevice final : public Device {
 public:
  explicit FakeDevice(std::shared_ptr<FakePad> pad)
      : pad_(std::move(pad)), info_(pad_->listing.info), fd_{pad_->sockets[1], POLLIN, 0} {
    if (pad_->kind == FakeKind::always_ready) {
      fd_.fd = pad_->sockets[0];
      fd_.events = POLLOUT;
    }
    if (pad_->kind == FakeKind::closed_descriptor) fd_.fd = 1 << 20;
  }
  ~FakeDevice() override {
    while (pad_->keeps_closing) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ++pad_->closings;
  }
  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return {&fd_, 1}; }
  Status read(Report& report) noexcept override {
    if (pad_->kind != FakeKind::sound) return Status::nothing;
    const ssize_t size =
        ::recv(pad_->sockets[1], report.bytes.data(), report.bytes.size(), MSG_DONTWAIT);
    if (size == 0) return Status::gone;
    if (size < 0) return Status::nothing;
    report.size = static_cast<std::uint16_t>(size);
    report.time_ns = pad_->stamp_ns.value_or(
        std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
    return Status::report;
  }
  bool rumble(const Rumble& rumble) noexcept override {
    const std::lock_guard lock(pad_->mutex);
    pad_->rumbles.push_back(rumble);
    return true;
  }
  void hand_on_raw() noexcept override { pad_->is_raw = true; }
  std::int64_t lost() const noexcept override { return pad_->lost; }
  std::optional<FactorySticks> factory_sticks() const override { return pad_->factory_sticks; }

 private:
  const std::shared_ptr<FakePad> pad_;
  const DeviceInfo info_;
  pollfd fd_;
};

enum : int { kHidraw, kEvdev, kUsb };  // positions of the drivers in FakeBus::table()

// The fake machine's sockets. Static, because a driver consists of two plain functions.
class FakeBus {
 public:
  using Pad = std::shared_ptr<FakePad>;

  FakeBus() : changes_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) { current_ = this; }
  ~FakeBus() {
    current_ = nullptr;
    ::close(changes_);
  }
  int changes_fd() const { return changes_; }

  // Makes a pad, which drivers do not list before show().
  Pad make(int driver, const std::string& unique_id, const std::string& port) const {
    auto pad = std::make_shared<FakePad>();
    pad->listing.info = made_pad();
    pad->listing.info.driver = kNames[driver];
    pad->listing.info.unique_id = unique_id;
    pad->listing.info.physical_path = port;
    pad->listing.node = std::string("/dev/") + kNames[driver] + "-" + port;
    pad->listing.pad_path = "/sys/" + port;
    return pad;
  }
  void show(int driver, const Pad& pad) {
    {
      const std::lock_guard lock(mutex_);
      pads_.emplace(driver, pad);
    }
    tell();
  }
  Pad plug(int driver, const std::string& unique_id, const std::string& port) {
    Pad pad = make(driver, unique_id, port);
    show(driver, pad);
    return pad;
  }
  // Sets the unique id later, as a kernel driver does that asks the pad first.
  void name_id(const Pad& pad, const std::string& unique_id) {
    {
      const std::lock_guard lock(mutex_);
      pad->listing.info.unique_id = unique_id;
    }
    tell();
  }
  void unplug(const Pad& pad) {
    {
      const std::lock_guard lock(mutex_);
      std::erase_if(pads_, [&pad](const auto& entry) { return entry.second == pad; });
    }
    ::shutdown(pad->sockets[0], SHUT_RDWR);
    tell();
  }
  void tell() const {
    const std::uint64_t one = 1;
    static_cast<void>(!::write(changes_, &one, sizeof(one)));
  }

  static constexpr const char* kNames[] = {"hidraw", "evdev", "usb"};
  static std::span<const DriverEntry> table();

 private:
  template <int driver>
  static std::vector<DeviceListing> find() {
    const std::lock_guard lock(current_->mutex_);
    std::vector<DeviceListing> listings;
    const auto [first, last] = current_->pads_.equal_range(driver);
    for (auto entry = first; entry != last; ++entry) listings.push_back(entry->second->listing);
    return listings;
  }
  template <int driver>
  static Result<std::unique_ptr<Device>> open(const DeviceListing& listing, Detach) {
    const Pad pad = current_->pad_at(driver, listing.node);
    if (!pad) return Error{listing.node + ": there is no such node"};
    while (pad->keeps_opening) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ++pad->openings;
    if (pad->openings <= pad->failing_openings) return Error{listing.node + ": not yet"};
    return std::unique_ptr<Device>(std::make_unique<FakeDevice>(pad));
  }
  Pad pad_at(int driver, const std::string& node) {
    const std::lock_guard lock(mutex_);
    const auto [first, last] = pads_.equal_range(driver);
    const auto found = std::find_if(
        first, last, [&node](const auto& entry) { return entry.second->listing.node == node; });
    return found == last ? nullptr : found->second;
  }
  template <int driver>
  static constexpr DriverEntry entry() {
    return {kNames[driver], "no library", &find<driver>, &open<driver>};
  }

  inline static FakeBus* current_ = nullptr;
  const int changes_;
  std::mutex mutex_;
  std::multimap<int, Pad> pads_;
};

inline std::span<const DriverEntry> FakeBus::table() {
  static constexpr DriverEntry kTable[] = {entry<0>(), entry<1>(), entry<2>()};
  return kTable;
}

}  // namespace gaitpad
