// Measures when a report reaches user space. Reads COUNT reports of a pad by one way and prints for
// each the time right after reading it and the number that the sender wrote into its left stick.
//
//   rig_latency WAY VENDOR:PRODUCT COUNT       WAY: bare_hidraw, bare_evdev, or a driver's name
//
// Says `ready` when the pad is open; ends after COUNT reports or a second of silence. `bare_*` is
// only poll() and read() on the node: the reference for a driver. Prints `NANOSECONDS NUMBER`,
// CLOCK_MONOTONIC, number = x + 256 y of an 8-bit stick.
#include <fcntl.h>
#include <linux/input.h>
#include <poll.h>
#include <time.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "drivers/system_nodes.h"
#include "gaitpad/decode.h"
#include "gaitpad/driver_registry.h"

namespace gaitpad {
namespace {

constexpr int kPatienceMs = 1000;

struct Reading {
  std::int64_t time_ns = 0;
  int number = 0;
};

std::int64_t now_ns() {
  timespec now = {};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void say_ready() {
  std::puts("ready");
  std::fflush(stdout);
}

int fail(const std::string& sentence) {
  std::fprintf(stderr, "rig_latency: %s\n", sentence.c_str());
  return 1;
}

std::string node_of(const char* subsystem, int vendor, int product) {
  for (const SystemNode& node : system_nodes(subsystem)) {
    const bool is_pad = subsystem != std::string("input") || node.is_joystick;
    if (node.vendor == vendor && node.product == product && is_pad) return node.node;
  }
  return {};
}

// Reads a node by poll() and read() alone. The generic pad's report begins with x and y.
std::vector<Reading> read_bare_hidraw(int fd, std::size_t count) {
  std::vector<Reading> readings;
  readings.reserve(count);
  pollfd waiting{fd, POLLIN, 0};
  unsigned char bytes[64];
  while (readings.size() < count && ::poll(&waiting, 1, kPatienceMs) == 1) {
    const auto size = ::read(fd, bytes, sizeof bytes);
    if (size < 2) break;
    readings.push_back({now_ns(), bytes[0] + 256 * bytes[1]});
  }
  return readings;
}

std::vector<Reading> read_bare_evdev(int fd, std::size_t count) {
  std::vector<Reading> readings;
  readings.reserve(count);
  pollfd waiting{fd, POLLIN, 0};
  input_event events[64];
  int x = 0, y = 0;
  while (readings.size() < count && ::poll(&waiting, 1, kPatienceMs) == 1) {
    const auto size = ::read(fd, events, sizeof events);
    const std::int64_t time_ns = now_ns();
    if (size <= 0) break;
    for (std::size_t i = 0; i < static_cast<std::size_t>(size) / sizeof(input_event); ++i) {
      const input_event& e = events[i];
      if (e.type == EV_ABS && e.code == ABS_X) x = e.value;
      if (e.type == EV_ABS && e.code == ABS_Y) y = e.value;
      if (e.type == EV_SYN && e.code == SYN_REPORT) readings.push_back({time_ns, x + 256 * y});
    }
  }
  return readings;
}

int byte_of(float axis) { return static_cast<int>(std::lround((axis + 1.0f) * 127.5f)); }

// Reads a driver's device as the I/O thread does.
std::vector<Reading> read_device(Device& device, const PadLayout& layout, std::size_t count) {
  std::vector<Reading> readings;
  readings.reserve(count);
  auto report = std::make_unique<Report>();
  PadState state;
  std::int64_t newest_ns = now_ns();
  // SDL's timer is always ready, so the clock decides about silence.
  while (readings.size() < count && now_ns() - newest_ns < kPatienceMs * 1'000'000LL) {
    std::vector<pollfd> waiting(device.poll_fds().begin(), device.poll_fds().end());
    if (::poll(waiting.data(), waiting.size(), kPatienceMs) <= 0) break;
    Device::Status status;
    while ((status = device.read(*report)) == Device::Status::report) {
      const std::int64_t time_ns = newest_ns = now_ns();
      if (!decode(layout, *report, state)) continue;
      // Decoded y grows forward, the report's byte backwards.
      readings.push_back(
          {time_ns, byte_of(state.axis[kLeftX]) + 256 * byte_of(-state.axis[kLeftY])});
    }
    if (status == Device::Status::gone) break;
  }
  return readings;
}

int by_driver(const DriverEntry& driver, int vendor, int product, std::size_t count,
              std::vector<Reading>& readings) {
  if (driver.find == nullptr) return fail(std::string("built without ") + driver.library);
  for (const DeviceListing& listing : driver.find()) {
    const DeviceInfo& info = listing.info;
    if (info.vendor != vendor || info.product != product || !listing.problem.empty()) continue;
    auto device = driver.open(listing, Detach::allowed);
    if (!device) return fail(device.error().message);
    const auto layout = pad_layout((*device)->info(), {});
    if (!layout) return fail(layout.error().message);
    say_ready();
    readings = read_device(**device, *layout, count);
    return 0;
  }
  return fail("no such pad");
}

int by_hand(bool is_hidraw, int vendor, int product, std::size_t count,
            std::vector<Reading>& readings) {
  const std::string node = node_of(is_hidraw ? "hidraw" : "input", vendor, product);
  const int fd = ::open(node.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return fail(node + ": cannot be opened");
  say_ready();
  readings = is_hidraw ? read_bare_hidraw(fd, count) : read_bare_evdev(fd, count);
  ::close(fd);
  return 0;
}

int run(int argc, char** argv) {
  unsigned vendor = 0, product = 0;
  if (argc != 4 || std::sscanf(argv[2], "%x:%x", &vendor, &product) != 2) {
    std::fprintf(stderr, "usage: rig_latency WAY VENDOR:PRODUCT COUNT\n");
    return 2;
  }
  const std::string way = argv[1];
  const auto count = static_cast<std::size_t>(std::atoi(argv[3]));
  std::vector<Reading> readings;
  int status = 0;
  if (way == "bare_hidraw" || way == "bare_evdev") {
    status = by_hand(way == "bare_hidraw", vendor, product, count, readings);
  } else if (const DriverEntry* driver = find_driver(way)) {
    status = by_driver(*driver, vendor, product, count, readings);
  } else {
    status = fail("no driver is called " + way);
  }
  for (const Reading& r : readings)
    std::printf("%lld %d\n", static_cast<long long>(r.time_ns), r.number);
  return status;
}

}  // namespace
}  // namespace gaitpad

int main(int argc, char** argv) { return gaitpad::run(argc, argv); }
