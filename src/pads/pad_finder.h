// The finder thread: looks at the devices whenever something was plugged in or out, opens the
// chosen pads, sets them up and hands them to the I/O thread.
//
// Nodes appear in an order and get their permissions at a moment that nobody promises. So an
// opening that failed is tried again a little later, a pad that was just plugged in is given a
// moment to show itself to the driver that is preferred, and devices are looked at now and then
// without a word from udev.
#pragma once
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "drivers/system_nodes.h"
#include "gaitpad/driver.h"
#include "gaitpad/pad_setup.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "pads/pad_io.h"
#include "pads/pad_queue.h"

namespace gaitpad {

// Written by the finder before the device is handed to the I/O thread, then never again: whoever
// has read the device's first `added` may use it.
struct PadSlot {
  TraceDevice device;
  PadConfig config;                         // the reader takes it out
  std::shared_ptr<const PadLayout> layout;  // the same as in `config`
};
using PadSlots = std::array<PadSlot, kMaxTraceDevices>;

class PadFinder {
 public:
  struct Options {
    PadFiles files;
    PadWish wish;
    std::span<const DriverEntry> drivers;
    int changes_fd = -1;  // in place of udev's word, for tests; one read() makes it silent
    std::optional<DeviceInfo> first;  // has index 0 and is opened by somebody else
  };
  PadFinder(Options options, PadSlots& slots, PadIo& io, Remarks& remarks);
  ~PadFinder() { stop(); }

  // Returns after the first look, before anything is opened. Error where the wish is wrong.
  std::optional<Error> start();
  void stop();  // an opening that is on its way is waited for
  // Any thread: this opening has come to its end, its device is to be closed.
  void take_gone(std::uint64_t id, std::unique_ptr<Device> device);
  bool has_ended() const noexcept { return awaited_ends_.load() == 0; }

 private:
  using Clock = std::chrono::steady_clock;
  // A device as one driver sees it, for as long as it is seen.
  struct Candidate {
    Clock::time_point first_seen, next_try;
    int failures = 0;
    bool is_refused = false;     // it is no pad, as its opening told
    bool is_from_start = false;  // it was there at the first look
    bool is_seen = true;         // at the last look
    std::string problem;
  };
  struct Open {
    std::uint64_t id = 0;
    std::string key, pad_key, node;
    const DriverEntry* driver = nullptr;
    std::uint16_t index = 0;
    Clock::time_point since;
    std::optional<Clock::time_point> missing_since;  // not seen any more, but not yet gone
  };
  struct Gone {
    std::uint64_t id;
    std::unique_ptr<Device> device;
  };
  struct Known {  // an index in PadSlots
    DeviceInfo info;
    bool is_present = false;
  };

  void run(std::promise<std::optional<Error>> first_look);
  void wait();
  void let_settle(int changes_fd);
  std::optional<Error> look(std::promise<std::optional<Error>>* first_look);
  void remember(std::vector<PadSighting>& sightings);
  void close_gone();
  void forget(std::uint64_t id);
  void look_no_later_than(Clock::time_point time);
  bool is_open(const PadSighting& sighting) const;
  bool is_awaiting_gone(const PadSighting& sighting) const;
  std::chrono::milliseconds patience(const PadSighting& sighting, const Candidate& candidate) const;
  void consider(const PadSighting& sighting);
  void open(const PadSighting& sighting, Candidate& candidate);
  std::optional<std::string> set_up(const PadSighting& sighting, Device& device, PadSlot& slot);
  std::optional<std::uint16_t> index_of(const DeviceInfo& info) const;
  void hand_over(const PadSighting& sighting, std::unique_ptr<Device> device, PadSlot slot,
                 std::uint16_t index);
  void tell_problems(const std::vector<PadSighting>& sightings,
                     const std::vector<PadSighting>& chosen);

  const Options options_;
  PadSlots& slots_;
  PadIo& io_;
  Remarks& remarks_;
  const bool is_recording_;

  WakeFd bell_;
  std::atomic<bool> is_ending_{false};
  std::atomic<int> awaited_ends_{-1};  // of a recording's devices; -1: there is none
  std::mutex mutex_;
  std::vector<Gone> gone_;

  // The finder thread's own.
  std::optional<HotplugMonitor> monitor_;
  Clock::time_point now_, next_look_;
  bool is_first_look_ = true;
  std::map<std::string, Candidate> candidates_;
  std::vector<Open> open_;
  std::vector<Known> known_;
  std::uint64_t openings_ = 0;
  std::thread thread_;
};

}  // namespace gaitpad
