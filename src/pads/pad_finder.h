// The finder thread of a PadStream: looks at the devices whenever something was plugged in or out,
// opens the chosen pads, sets them up and hands them over.
//
// Nodes appear in any order and get their permissions at any moment. So an opening that failed is
// tried again a little later, a pad that was just plugged in gets a moment to show itself to the
// preferred driver, and devices are looked at now and then even if udev says nothing.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/system_nodes.h"
#include "gaitpad/driver.h"
#include "gaitpad/pad_configuration.h"
#include "gaitpad/pad_stream.h"
#include "gaitpad/result.h"
#include "system/descriptors.h"

namespace gaitpad {

// Sentences for the user from any thread, kept until they are taken.
class Remarks {
 public:
  void add(std::string sentence) {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() < kMaxWaiting) waiting_.push_back(std::move(sentence));
  }
  void add_once(const std::string& sentence) {
    const std::lock_guard lock(mutex_);
    if (said_.size() >= kMaxSaid || waiting_.size() >= kMaxWaiting) return;
    if (said_.insert(sentence).second) waiting_.push_back(sentence);
  }
  std::vector<std::string> take_all() {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
  }

 private:
  static constexpr std::size_t kMaxWaiting = 256, kMaxSaid = 4096;
  std::mutex mutex_;
  std::vector<std::string> waiting_;
  std::set<std::string> said_;
};

// The facts about a pad. A message: the finder makes it, the reader of the stream owns it.
struct KnownPad {
  TraceDevice device;
  PadConfig config;                         // the configuration, which the reader moves out
  std::shared_ptr<const PadLayout> layout;  // the layout in `config`
};

// A device that has just been opened. A message from the finder to the I/O thread.
struct OpenedPad {
  std::unique_ptr<Device> device;
  std::uint16_t index = 0;          // index of the device in its reports, < kMaxPads
  std::uint64_t id = 0;             // number of this opening
  std::unique_ptr<KnownPad> known;  // null: the index was used before, so the reader knows the pad
  std::shared_ptr<const PadLayout> layout;
  bool is_recording = false;  // users are not told of its end as of an unplugging
  bool is_raw = false;        // its packets are passed on even if they are no reports
  bool is_keyboard = false;   // it is not counted as a pad that was plugged in
  std::string name;           // the name for sentences to the user
};

class PadFinder {
 public:
  struct Options {
    PadFiles files;
    PadSelector selector;
    std::span<const DriverEntry> drivers;
    bool is_raw = false;
    // For tests: readable means a change, in place of udev; one read() resets it.
    int changes_fd = -1;
    std::optional<DeviceInfo> first;  // a device that has index 0 and was opened elsewhere
  };
  using HandOver = std::function<void(OpenedPad)>;        // is called on the finder thread, as
                                                          // Release is
  using Release = std::function<void(std::uint64_t id)>;  // asks the I/O thread to end an opening
  PadFinder(Options options, HandOver hand_over, Release release, Remarks& remarks);
  ~PadFinder() { stop(); }

  // Returns after the first look, before anything is opened. Error: the selector is invalid.
  std::optional<Error> start();
  void stop();  // Waits for openings that have begun.
  // Any thread: this opening has ended. The finder thread closes the device.
  void take_back(std::uint64_t id, std::unique_ptr<Device> device);
  // Any thread: the reports of this opening contain no stick. Another driver that sees the pad is
  // tried.
  void tell_stickless(std::uint64_t id, const std::string& sentence);
  bool has_ended() const noexcept { return awaited_ends_.load() == 0; }

 private:
  using Clock = std::chrono::steady_clock;
  // A device as one driver sees it, while it is there.
  struct Candidate {
    Clock::time_point first_seen, next_try;
    int failures = 0;
    bool is_refused = false;     // its opening showed that it is not a pad
    bool is_from_start = false;  // it was there when the finder started
    bool is_seen = true;         // it was there at the last look
    std::string problem;
    // No stick in its reports, as `problem` says; it stays open if no other driver can serve.
    bool is_stickless = false;
  };
  struct Open {
    std::uint64_t id = 0;
    std::string key, pad_key, node;
    const DriverEntry* driver = nullptr;
    std::uint16_t index = 0;
    Clock::time_point since;
    std::vector<std::string> parts;  // pad paths of the joined devices, as in
                                     // DeviceListing
    // Since when it has not been seen, though its device was not given back.
    std::optional<Clock::time_point> missing_since;
    bool is_stickless = false, is_released = false;
  };
  // Each opening has its own thread, so that a pad that does not answer delays no other.
  struct Opening {
    PadSighting sighting;
    // The result, guarded by the mutex; none: the opening has not ended.
    std::optional<Result<std::unique_ptr<Device>>> outcome;
    std::thread thread;
  };
  struct Gone {
    std::uint64_t id;
    std::unique_ptr<Device> device;
  };
  struct Stickless {
    std::uint64_t id;
    std::string sentence;
  };
  struct Index {  // the device that an index of the stream stands for
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
  bool clear_the_way(const PadSighting& sighting);
  bool is_awaiting_gone(const PadSighting& sighting) const;
  std::chrono::milliseconds patience(const PadSighting& sighting, const Candidate& candidate) const;
  void consider(const PadSighting& sighting);
  void open(const PadSighting& sighting);
  void await_openings(std::size_t before);
  void take_openings();
  void settle(const PadSighting& sighting, Result<std::unique_ptr<Device>> device);
  std::optional<std::string> set_up(const PadSighting& sighting, Device& device, KnownPad& pad);
  std::optional<std::uint16_t> index_of(const DeviceInfo& info) const;
  void hand_over(const PadSighting& sighting, std::unique_ptr<Device> device,
                 std::unique_ptr<KnownPad> known, std::uint16_t index);
  void tell_problems(const std::vector<PadSighting>& sightings,
                     const std::vector<PadSighting>& chosen);

  const Options options_;
  const HandOver hand_over_;
  const Release release_;
  Remarks& remarks_;
  const bool is_recording_;

  Bell bell_;
  std::atomic<bool> is_ending_{false};
  // Number of a recording's devices that have not ended; -1: it is not a recording.
  std::atomic<int> awaited_ends_{-1};
  std::mutex mutex_;
  std::vector<Gone> gone_;            // guarded by the mutex
  std::vector<Stickless> stickless_;  // guarded by the mutex
  bool awaits_openings_ = false;      // guarded by the mutex
  std::condition_variable opened_;

  // Used by the finder thread only.
  std::optional<HotplugMonitor> monitor_;
  Clock::time_point now_, next_look_;
  bool is_first_look_ = true;
  std::map<std::string, Candidate> candidates_;
  std::vector<Open> open_;
  std::vector<std::unique_ptr<Opening>> openings_;  // in the order in which they began
  std::vector<Index> indices_;
  std::uint64_t opened_count_ = 0;
  std::thread thread_;
};

}  // namespace gaitpad
