#include "session/pad_finder.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "base/toml_file.h"
#include "drivers/driver_entries.h"
#include "drivers/registry.h"

namespace gaitpad {
namespace {

using namespace std::chrono_literals;

constexpr auto kQuiet = 30ms, kMaxUnrest = 200ms;  // one plugging in is a volley of events
// After a failed opening; then the next driver that sees the pad has its turn.
constexpr std::chrono::milliseconds kRetries[] = {100ms, 300ms, 1000ms};
constexpr auto kSlowRetry = 5000ms;
constexpr auto kShortLife = 1000ms, kMaxRest = 1000ms;  // of a device that goes and comes
// How long a pad that was just plugged in may take until the preferred driver sees it, or until the
// kernel has found its own driver for it.
constexpr auto kDriverPatience = 700ms, kKernelPatience = 2000ms;
// The kernel shows the node before its driver has asked the pad for its unique id.
constexpr auto kIdPatience = 1000ms;
constexpr auto kGonePatience = 3000ms;
constexpr auto kProblemPatience = 1500ms;  // permissions come a moment after the node
constexpr auto kIdleLook = 30'000ms, kLookWithoutPads = 5000ms, kLookWithoutUdev = 1000ms;

// The same for what one driver sees of one device.
std::string key_of(const PadSighting& s) {
  const DeviceInfo& info = s.listing.info;
  return fmt::format("{} {} {} {:04x}:{:04x} {}", s.driver->name, s.listing.node,
                     s.listing.pad_path, info.vendor, info.product, info.unique_id);
}

std::string name_of(const PadSighting& s) {
  const DeviceInfo& info = s.listing.info;
  return fmt::format("{} ({}, {})", in_quotes(info.name), s.driver->name, s.listing.node);
}

// By drivers that ask the pad for its Bluetooth address.
bool lacks_its_id(const PadSighting& s) {
  const std::string& kernel = s.listing.kernel_driver;
  const bool asks = kernel == "playstation" || kernel == "sony" || kernel == "nintendo";
  return asks && s.listing.info.unique_id.empty();
}

int milliseconds_until(std::chrono::steady_clock::time_point time) {
  const auto left =
      std::chrono::ceil<std::chrono::milliseconds>(time - std::chrono::steady_clock::now());
  return static_cast<int>(std::clamp(left, 0ms, kIdleLook).count());
}

}  // namespace

PadFinder::PadFinder(Options options, PadSlots& slots, PadIo& io, Remarks& remarks)
    : options_(std::move(options)),
      slots_(slots),
      io_(io),
      remarks_(remarks),
      is_recording_(is_recording(options_.wish.pad)) {
  if (options_.first) known_.push_back({*options_.first, true});
}

void PadFinder::stop() {
  is_ending_ = true;
  bell_.ring();
  if (thread_.joinable()) thread_.join();
}

std::optional<Error> PadFinder::start() {
  if (bell_.fd() < 0) return Error{"no file descriptors are left for pads"};
  std::promise<std::optional<Error>> first_look;
  auto outcome = first_look.get_future();
  thread_ =
      std::thread([this, promise = std::move(first_look)]() mutable { run(std::move(promise)); });
  return outcome.get();
}

void PadFinder::take_gone(std::uint64_t id, std::unique_ptr<Device> device) {
  {
    const std::lock_guard lock(mutex_);
    gone_.push_back({id, std::move(device)});
  }
  bell_.ring();
}

void PadFinder::run(std::promise<std::optional<Error>> first_look) {
  // Listens before it looks: what comes in between is not missed.
  if (options_.changes_fd < 0 && !is_recording_) {
    auto monitor = HotplugMonitor::create();
    if (monitor)
      monitor_.emplace(std::move(*monitor));
    else
      remarks_.add_once(monitor.error().message);
  }
  if (look(&first_look)) return;
  is_first_look_ = false;
  while (!is_ending_) {
    wait();
    if (is_ending_) return;
    close_gone();
    if (is_recording_) continue;
    if (auto problem = look(nullptr)) remarks_.add_once(problem->message);
  }
}

void PadFinder::wait() {
  const int changes = monitor_ ? monitor_->fd() : options_.changes_fd;
  pollfd fds[] = {{bell_.fd(), POLLIN, 0}, {changes, POLLIN, 0}};
  ::poll(fds, 2, is_recording_ ? -1 : milliseconds_until(next_look_));
  bell_.clear();
  // Whatever the socket says, an overflow too, the devices are looked at.
  if (fds[1].revents != 0) let_settle(changes);
}

void PadFinder::let_settle(int changes_fd) {
  const Clock::time_point end = Clock::now() + kMaxUnrest;
  pollfd changes{changes_fd, POLLIN, 0};
  do {
    std::uint64_t ignored = 0;
    if (monitor_)
      monitor_->has_changed();
    else
      static_cast<void>(!::read(changes_fd, &ignored, sizeof(ignored)));
  } while (!is_ending_ && Clock::now() < end &&
           ::poll(&changes, 1, static_cast<int>(kQuiet.count())) > 0);
}

void PadFinder::look_no_later_than(Clock::time_point time) {
  next_look_ = std::min(next_look_, time);
}

// Tells whoever waits for the first look as soon as it is known whether the wish makes sense.
std::optional<Error> PadFinder::look(std::promise<std::optional<Error>>* first_look) {
  now_ = Clock::now();
  const auto answer = [first_look](std::optional<Error> error) {
    if (first_look != nullptr) first_look->set_value(error);
    return error;
  };
  next_look_ = now_ + (monitor_ || options_.changes_fd >= 0 ? kIdleLook : kLookWithoutUdev);
  if (open_.empty()) look_no_later_than(now_ + kLookWithoutPads);
  auto sightings =
      pad_sightings(options_.files, options_.wish, Drivers::preferred, options_.drivers);
  if (!sightings) return answer(sightings.error());
  remember(*sightings);
  auto chosen = chosen_pads(*sightings, options_.wish);
  if (!chosen) return answer(chosen.error());
  if (is_recording_) {
    if (chosen->empty())
      return answer(Error{options_.wish.pad + ": none of its devices is a pad with a stick"});
    awaited_ends_ = static_cast<int>(chosen->size());
  }
  answer(std::nullopt);
  for (const PadSighting& s : *chosen) {
    if (is_ending_) return std::nullopt;
    consider(s);
  }
  tell_problems(*sightings, *chosen);
  return std::nullopt;
}

void PadFinder::remember(std::vector<PadSighting>& sightings) {
  for (auto& [key, candidate] : candidates_) candidate.is_seen = false;
  for (PadSighting& s : sightings) {
    const auto [entry, is_new] = candidates_.try_emplace(key_of(s));
    Candidate& candidate = entry->second;
    if (is_new) {
      candidate.first_seen = now_;
      candidate.is_from_start = is_first_look_;
    }
    candidate.is_seen = true;
    const bool is_exhausted = candidate.failures > static_cast<int>(std::size(kRetries));
    if (!is_exhausted || is_open(s) || now_ >= candidate.next_try) continue;
    look_no_later_than(candidate.next_try);
    if (s.problem.empty()) s.problem = candidate.problem;
  }
  std::erase_if(candidates_, [](const auto& entry) { return !entry.second.is_seen; });
  for (Open& open : open_) {
    if (candidates_.contains(open.key))
      open.missing_since.reset();
    else if (!open.missing_since)
      open.missing_since = now_;
  }
}

void PadFinder::close_gone() {
  std::vector<Gone> gone;
  {
    const std::lock_guard lock(mutex_);
    gone.swap(gone_);
  }
  for (const Gone& one : gone) forget(one.id);
}

void PadFinder::forget(std::uint64_t id) {
  const auto open = std::ranges::find(open_, id, &Open::id);
  if (open == open_.end()) return;
  const Clock::time_point now = Clock::now();
  known_[open->index].is_present = false;
  if (const auto entry = candidates_.find(open->key); entry != candidates_.end()) {
    Candidate& candidate = entry->second;
    const bool was_short = now - open->since < kShortLife;
    candidate.failures = was_short ? candidate.failures + 1 : 0;
    candidate.next_try =
        now + std::min<std::chrono::milliseconds>(candidate.failures * kRetries[0], kMaxRest);
  }
  open_.erase(open);
  if (is_recording_) --awaited_ends_;
}

// Itself, also where its name or unique id came after its opening, or the same pad through another
// driver.
bool PadFinder::is_open(const PadSighting& sighting) const {
  const std::string pad = pad_key(sighting);
  return std::ranges::any_of(open_, [&](const Open& o) {
    return o.pad_key == pad && (o.driver != sighting.driver || o.node == sighting.listing.node);
  });
}

// Plugged in again before the I/O thread has noticed that it was out: it is to get its old index.
bool PadFinder::is_awaiting_gone(const PadSighting& sighting) const {
  return std::ranges::any_of(open_, [this, &info = sighting.listing.info](const Open& open) {
    return open.missing_since && now_ < *open.missing_since + kGonePatience &&
           is_same_device(known_[open.index].info, info);
  });
}

std::chrono::milliseconds PadFinder::patience(const PadSighting& sighting,
                                              const Candidate& candidate) const {
  const std::string_view driver = sighting.driver->name;
  if (lacks_its_id(sighting)) return kIdPatience;
  if (is_recording_ || !options_.wish.driver.empty()) return 0ms;
  if (driver == "usb") return kKernelPatience;
  const DeviceInfo& info = sighting.listing.info;
  const bool was_here = std::ranges::any_of(known_, [&info, driver](const Known& known) {
    return known.info.driver == driver && known.info.vendor == info.vendor &&
           known.info.product == info.product;
  });
  const auto built = std::ranges::find_if(
      options_.drivers, [](const DriverEntry& entry) { return entry.find != nullptr; });
  const bool is_preferred = sighting.driver == &*built;
  return candidate.is_from_start || was_here || is_preferred ? 0ms : kDriverPatience;
}

void PadFinder::consider(const PadSighting& sighting) {
  Candidate& candidate = candidates_.at(key_of(sighting));
  if (candidate.is_refused || is_open(sighting)) return;
  if (is_awaiting_gone(sighting)) {
    look_no_later_than(now_ + kQuiet);
    return;
  }
  const auto time =
      std::max(candidate.next_try, candidate.first_seen + patience(sighting, candidate));
  if (now_ < time) {
    look_no_later_than(time);
    return;
  }
  open(sighting, candidate);
}

void PadFinder::open(const PadSighting& sighting, Candidate& candidate) {
  const Detach detach = options_.wish.driver == "usb" ? Detach::allowed : Detach::never;
  auto device = sighting.driver->open(sighting.listing, detach);
  const Clock::time_point now = Clock::now();
  if (!device) {
    const auto tries = static_cast<std::size_t>(candidate.failures++);
    const bool is_exhausted = tries >= std::size(kRetries);
    candidate.problem = device.error().message;
    candidate.next_try = now + (is_exhausted ? kSlowRetry : kRetries[tries]);
    look_no_later_than(is_exhausted ? now + kQuiet : candidate.next_try);  // for the next driver
    if (!is_recording_) return;
    remarks_.add_once(candidate.problem);
    --awaited_ends_;
    return;
  }
  PadSlot slot;
  auto problem = set_up(sighting, **device, slot);
  std::optional<std::uint16_t> index;
  if (!problem) {
    index = index_of((*device)->info());
    if (!index)
      problem = fmt::format("{}: more than {} different pads", name_of(sighting), slots_.size());
  }
  if (problem) {
    candidate.is_refused = true;
    if (!problem->empty()) remarks_.add_once(*problem);
    if (is_recording_) --awaited_ends_;
    return;
  }
  hand_over(sighting, std::move(*device), std::move(slot), *index);
}

// What a replay of a recording of this session will find, and the same for now. Else why not: empty
// where nobody needs to know, since no pad was named and this is none.
std::optional<std::string> PadFinder::set_up(const PadSighting& sighting, Device& device,
                                             PadSlot& slot) {
  const DeviceInfo& info = device.info();
  const std::optional<FactorySticks> factory = device.factory_sticks();
  std::vector<std::string> remarks;
  TraceDevice recorded = recorded_device(options_.files, info, factory, remarks);
  for (const std::string& remark : remarks) remarks_.add_once(remark);
  if (is_recording_) {
    recorded.info.mapping = info.mapping;
    const std::string own = trace_calibration(sighting.listing);
    if (!own.empty() && !options_.files.calibration) recorded.calibration = own;
  }
  auto config = pad_config(options_.files, recorded, name_of(sighting));
  if (!config) return config.error().message;
  if (!config->is_usable) return options_.wish.pad.empty() ? "" : name_of(sighting) + ": no stick";
  config->is_present = false;  // until `added` is read
  config->has_factory_sticks = factory.has_value();
  slot = {std::move(recorded), std::move(*config), {}};
  slot.layout = slot.config.layout;
  return std::nullopt;
}

// The index that it had before; among equal ones the first on the same port.
std::optional<std::uint16_t> PadFinder::index_of(const DeviceInfo& info) const {
  std::optional<std::uint16_t> on_other_port;
  for (std::uint16_t i = 0; i < known_.size(); ++i) {
    const DeviceInfo& known = known_[i].info;
    if (known_[i].is_present || !is_same_device(known, info)) continue;
    if (known.bus != info.bus || known.descriptor != info.descriptor) continue;
    if (known.physical_path == info.physical_path) return i;
    if (!on_other_port) on_other_port = i;
  }
  if (on_other_port) return on_other_port;
  if (known_.size() >= slots_.size()) return std::nullopt;
  return static_cast<std::uint16_t>(known_.size());
}

void PadFinder::hand_over(const PadSighting& sighting, std::unique_ptr<Device> device, PadSlot slot,
                          std::uint16_t index) {
  OpenedPad opened;
  opened.has_report_ids = slot.config.layout->descriptor.numbered;
  opened.is_recording = is_recording_;
  opened.index = index;
  opened.id = ++openings_;
  opened.name = name_of(sighting);
  if (index == known_.size()) {
    known_.push_back({device->info(), true});
    slots_[index] = std::move(slot);
    slots_[index].device.index = index;
  } else {
    known_[index].info = device->info();  // it may hang on another port now
    known_[index].is_present = true;
  }
  opened.device = std::move(device);
  open_.push_back({opened.id, key_of(sighting), pad_key(sighting), sighting.listing.node,
                   sighting.driver, index, Clock::now(), std::nullopt});
  io_.take_over(std::move(opened));
}

// Of each wished pad that nothing can open the first driver's cause.
void PadFinder::tell_problems(const std::vector<PadSighting>& sightings,
                              const std::vector<PadSighting>& chosen) {
  const auto wished = wished_pads(sightings, options_.wish);
  if (!wished) return;
  std::vector<std::string> settled;
  for (const PadSighting& s : chosen) settled.push_back(pad_key(s));
  for (const PadSighting& s : *wished) {
    const std::string pad = pad_key(s);
    if (s.problem.empty() || is_open(s) || std::ranges::count(settled, pad) > 0) continue;
    const Candidate& candidate = candidates_.at(key_of(s));
    const auto time = candidate.first_seen + kProblemPatience;
    look_no_later_than(std::max(now_ + kLookWithoutPads, time));
    if (!candidate.is_from_start && now_ < time) {
      look_no_later_than(time);
      continue;
    }
    remarks_.add_once(s.problem);
    settled.push_back(pad);
  }
}

}  // namespace gaitpad
