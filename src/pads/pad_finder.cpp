#include "pads/pad_finder.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/text.h"
#include "drivers/driver_rows.h"
#include "drivers/system_users.h"
#include "drivers/virtual_pad.h"
#include "gaitpad/driver_registry.h"
#include "gaitpad/pad_stream.h"
#include "system/descriptors.h"

namespace gaitpad {
namespace {

// --- which devices are pads, and which of them a user means

constexpr std::string_view kTrace = "trace", kUsb = "usb", kSdl = "sdl";

Result<const DriverEntry*> driver_named(const std::string& name,
                                        std::span<const DriverEntry> table) {
  std::string known;
  for (const DriverEntry& entry : table) {
    if (name == entry.name && entry.find != nullptr) return &entry;
    if (name == entry.name)
      return Error{fmt::format("the driver \"{}\" is missing: the program was built without {}",
                               name, entry.library)};
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  return Error{fmt::format("there is no driver \"{}\" (known: {})", name, known)};
}

bool is_built(std::span<const DriverEntry> table, std::string_view name) {
  return std::ranges::any_of(
      table, [name](const DriverEntry& e) { return name == e.name && e.find != nullptr; });
}

// Whether this driver looks for pads. SDL reads the kernel's devices, which the other drivers read
// themselves.
bool is_asked(const DriverEntry& entry, Drivers which, std::span<const DriverEntry> table) {
  if (entry.find == nullptr) return false;
  if (which == Drivers::all || entry.name != kSdl) return true;
  return !is_built(table, "hidraw") && !is_built(table, "evdev");
}

std::uint64_t file_number(const std::string& node) {
  const auto rights = node_rights(node);
  return rights ? rights->file : 0;
}

PadSighting judged(const PadFiles& files, DeviceListing listing, const DriverEntry& driver) {
  PadSighting sighting{std::move(listing), &driver, true, {}};
  sighting.node_file = file_number(sighting.listing.node);
  const DeviceListing& seen = sighting.listing;
  sighting.problem = seen.problem;
  sighting.is_pad = !seen.is_other && !is_virtual_pad(seen.info);
  if (is_virtual_pad(seen.info)) {
    sighting.problem = seen.node + ": gaitpad itself makes this pad from another one";
    return sighting;
  }
  if (seen.is_other || seen.info.descriptor.empty()) return sighting;
  const auto layout = pad_layout(seen.info, files.overrides);
  sighting.is_pad = layout && layout->is_pad;
  if (sighting.is_pad || !sighting.problem.empty()) return sighting;
  sighting.problem =
      !layout ? fmt::format("{}: {}", seen.node, layout.error().message)
              : fmt::format("{}: {} is no pad: it has no joystick or gamepad with X and Y",
                            seen.node, in_quotes(seen.info.name));
  return sighting;
}

// If one driver cannot read a descriptor, another driver that can decides whether it is a pad.
void ask_the_others(std::vector<PadSighting>& sightings) {
  for (PadSighting& unknown : sightings) {
    const std::string& path = unknown.listing.pad_path;
    const bool is_judged = unknown.listing.is_other || !unknown.listing.info.descriptor.empty();
    if (is_judged || path.empty()) continue;
    bool is_known = false, is_pad = false;
    for (const PadSighting& other : sightings) {
      if (other.listing.pad_path != path || other.listing.info.descriptor.empty()) continue;
      is_known = true;
      is_pad = is_pad || other.is_pad;
    }
    unknown.is_pad = !is_known || is_pad;
    if (!unknown.is_pad && unknown.problem.empty())
      unknown.problem = fmt::format("{}: no pad", unknown.listing.node);
  }
}

Result<std::vector<PadSighting>> recorded_pads(const PadFiles& files, const PadSelector& selector,
                                               std::span<const DriverEntry> table) {
  if (!selector.driver.empty() && selector.driver != kTrace)
    return Error{
        fmt::format("{}: a recording is not for the driver \"{}\"", selector.pad, selector.driver)};
  auto driver = driver_named(std::string(kTrace), table);
  if (!driver) return driver.error();
  auto listings = trace_listings(selector.pad);
  if (!listings) return listings.error();
  std::vector<PadSighting> sightings;
  for (DeviceListing& listing : *listings)
    sightings.push_back(judged(files, std::move(listing), **driver));
  return sightings;
}

// The ways in which a text fits a pad, the least exact first. The pads that fit best are meant.
enum class Fit { none, part_of_name, name, unique_id, model, node };

// True if the text is `vvvv:pppp` in hexadecimal.
bool is_model(std::string_view text, const DeviceInfo& info) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return false;
  const auto is_id = [](std::string_view digits, std::uint16_t id) {
    return digits.size() <= 4 && parse_number<std::uint16_t>(digits, 16) == id;
  };
  return is_id(text.substr(0, colon), info.vendor) && is_id(text.substr(colon + 1), info.product);
}

struct Wanted {
  std::string text, lower_text;
  std::string node;  // the node, with links such as /dev/input/by-id/... resolved
};
Wanted wanted_of(const std::string& pad) {
  std::error_code error;
  const std::filesystem::path node = std::filesystem::canonical(pad, error);
  return {pad, lower_case(pad), error ? pad : node.string()};
}

Fit fit_of(const PadSighting& sighting, const Wanted& wanted) {
  const DeviceListing& listing = sighting.listing;
  if (listing.node == wanted.text || listing.node == wanted.node) return Fit::node;
  // A recording is listed only if it is asked for.
  if (sighting.driver->name == kTrace) return Fit::node;
  if (is_model(wanted.text, listing.info)) return Fit::model;
  if (lower_case(listing.info.unique_id) == wanted.lower_text) return Fit::unique_id;
  const std::string name = lower_case(listing.info.name);
  if (name == wanted.lower_text) return Fit::name;
  return name.find(wanted.lower_text) == std::string::npos ? Fit::none : Fit::part_of_name;
}

// Whether `whole` joins this device with another one (a pair of Joy-Cons).
bool is_part(const PadSighting& whole, const PadSighting& s) {
  return std::ranges::count(whole.listing.parts, pad_key(s)) > 0;
}

bool is_one_pad(const PadSighting& a, const PadSighting& b) {
  if (pad_key(a) == pad_key(b) || is_part(a, b) || is_part(b, a)) return true;
  const std::string& id = a.listing.info.unique_id;
  return !id.empty() && lower_case(id) == lower_case(b.listing.info.unique_id);
}

std::string described(const PadSighting& s) {
  const DeviceInfo& info = s.listing.info;
  const bool has_id = !info.unique_id.empty();
  return fmt::format("{} ({:04x}:{:04x}, {} {})", in_quotes(info.name), info.vendor, info.product,
                     has_id ? "unique id" : "port",
                     in_quotes(has_id ? info.unique_id : info.physical_path));
}

// An error if part of a name fits several pads. All of `fitting` fit it.
std::optional<Error> ambiguity(const std::vector<PadSighting>& fitting, const std::string& text) {
  std::vector<PadSighting> different;
  for (const PadSighting& s : fitting) {
    if (std::ranges::none_of(different, [&s](const PadSighting& d) { return is_one_pad(d, s); }))
      different.push_back(s);
  }
  if (different.size() < 2) return std::nullopt;
  std::string names;
  for (const PadSighting& s : different) names += (names.empty() ? "" : ", ") + described(s);
  return Error{fmt::format("\"{}\" fits {} pads: {}", text, different.size(), names)};
}

}  // namespace

std::string pad_key(const PadSighting& s) {
  if (!s.listing.pad_path.empty()) return s.listing.pad_path;
  return fmt::format("{} {}", s.driver->name, s.listing.node);
}

bool is_recording(const std::string& pad) {
  std::error_code ignored;
  return pad.ends_with(".hid") || std::filesystem::is_regular_file(pad, ignored);
}

Result<std::vector<PadSighting>> pad_sightings(const PadFiles& files, const PadSelector& selector,
                                               Drivers drivers,
                                               std::span<const DriverEntry> table) {
  if (is_recording(selector.pad)) return recorded_pads(files, selector, table);
  const DriverEntry* only = nullptr;
  if (!selector.driver.empty()) {
    auto found = driver_named(selector.driver, table);
    if (!found) return found.error();
    only = *found;
  }
  std::vector<PadSighting> sightings;
  for (const DriverEntry& entry : table) {
    if (only != nullptr ? &entry != only : !is_asked(entry, drivers, table)) continue;
    for (DeviceListing& listing : entry.find())
      sightings.push_back(judged(files, std::move(listing), entry));
  }
  ask_the_others(sightings);
  std::stable_partition(sightings.begin(), sightings.end(), std::mem_fn(&PadSighting::is_pad));
  return sightings;
}

Result<std::vector<PadSighting>> matching_pads(const std::vector<PadSighting>& sightings,
                                               const PadSelector& selector) {
  std::vector<PadSighting> pads;
  std::ranges::copy_if(sightings, std::back_inserter(pads), &PadSighting::is_pad);
  // Orders by driver, and a pair before its parts.
  std::ranges::stable_sort(pads, [](const PadSighting& one, const PadSighting& other) {
    if (one.driver != other.driver) return std::less<>()(one.driver, other.driver);
    return !one.listing.parts.empty() && other.listing.parts.empty();
  });
  if (selector.pad.empty()) return pads;

  const Wanted wanted = wanted_of(selector.pad);
  std::vector<PadSighting> fitting;
  Fit best = Fit::none;
  for (const PadSighting& s : pads) {
    const Fit fit = fit_of(s, wanted);
    if (fit == Fit::none || fit < best) continue;
    if (fit > best) fitting.clear();
    best = fit;
    fitting.push_back(s);
  }
  if (best == Fit::part_of_name || best == Fit::name) {
    if (auto error = ambiguity(fitting, selector.pad)) return *error;
  }
  if (best == Fit::none || best == Fit::node) return fitting;
  // Drivers give the same pad different names and ids. A text that fits one of them means the pad.
  std::erase_if(pads, [&fitting](const PadSighting& s) {
    return std::ranges::none_of(fitting,
                                [&s](const PadSighting& f) { return pad_key(f) == pad_key(s); });
  });
  return pads;
}

Result<std::vector<PadSighting>> chosen_pads(const std::vector<PadSighting>& sightings,
                                             const PadSelector& selector) {
  auto pads = matching_pads(sightings, selector);
  if (!pads) return pads.error();
  const Wanted wanted = wanted_of(selector.pad);
  std::vector<PadSighting> chosen;
  for (PadSighting& s : *pads) {
    const bool is_asked_for = selector.driver == kUsb || fit_of(s, wanted) == Fit::node;
    const bool is_taken = s.driver->name == kUsb && !s.listing.kernel_driver.empty();
    if (!s.problem.empty() || (is_taken && !is_asked_for)) continue;
    const auto is_served = [&s](const PadSighting& c) {
      return (c.driver != s.driver && pad_key(c) == pad_key(s)) || is_part(c, s);
    };
    if (std::ranges::none_of(chosen, is_served)) chosen.push_back(std::move(s));
  }
  return chosen;
}

bool is_same_device(const DeviceInfo& a, const DeviceInfo& b) noexcept {
  if (a.driver != b.driver || a.vendor != b.vendor || a.product != b.product) return false;
  if (!a.unique_id.empty() || !b.unique_id.empty()) return a.unique_id == b.unique_id;
  return a.physical_path == b.physical_path;
}

// --- the finder thread

namespace {

using namespace std::chrono_literals;

// One plug makes many events: wait for a pause of kQuiet, but at most kMaxUnrest.
constexpr auto kQuiet = 30ms, kMaxUnrest = 200ms;
// Waits after a failed opening. After the last one the next driver that sees the pad tries to open
// it.
constexpr std::chrono::milliseconds kRetries[] = {100ms, 300ms, 1000ms};
constexpr auto kSlowRetry = 5000ms;
constexpr auto kQuickOpening = 100ms;
// A device that is gone again within kShortLife waits up to kMaxRest before it is opened again.
constexpr auto kShortLife = 1000ms, kMaxRest = 1000ms;
// Waits for a newly plugged pad: until the preferred driver sees it, and until the kernel has bound
// its own driver to it.
constexpr auto kDriverPatience = 700ms, kKernelPatience = 2000ms;
// Longest wait for a pad's unique id: its node appears before the kernel's driver has asked for the
// id.
constexpr auto kIdPatience = 1000ms;
// Longest wait until the I/O thread gives back a pad that drivers no longer see.
constexpr auto kGonePatience = 3000ms;
// A problem is told after this time, because permissions come a moment after the node.
constexpr auto kProblemPatience = 1500ms;
// Longest times between two looks at the devices: usually, without an open pad, without udev.
constexpr auto kIdleLook = 30'000ms, kLookWithoutPads = 5000ms, kLookWithoutUdev = 1000ms;

// A key that stays the same while one driver sees one device.
std::string key_of(const PadSighting& s) {
  const DeviceInfo& info = s.listing.info;
  return fmt::format("{} {} {} {} {:04x}:{:04x} {}", s.driver->name, s.listing.node, s.node_file,
                     s.listing.pad_path, info.vendor, info.product, info.unique_id);
}

std::string name_of(const PadSighting& s) {
  const DeviceInfo& info = s.listing.info;
  return fmt::format("{} ({}, {})", in_quotes(info.name), s.driver->name, s.listing.node);
}

// True if the pad's Bluetooth address, which is its unique id, is still missing: these kernel
// drivers ask the pad for it.
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

PadFinder::PadFinder(Options options, HandOver hand_over, Release release, Remarks& remarks)
    : options_(std::move(options)),
      hand_over_(std::move(hand_over)),
      release_(std::move(release)),
      remarks_(remarks),
      is_recording_(is_recording(options_.selector.pad)) {
  if (options_.first) indices_.push_back({*options_.first, true});
}

void PadFinder::stop() {
  is_ending_ = true;
  bell_.ring();
  if (thread_.joinable()) thread_.join();
  for (const auto& opening : openings_)
    if (opening->thread.joinable()) opening->thread.join();
  openings_.clear();
}

std::optional<Error> PadFinder::start() {
  if (bell_.fd() < 0) return Error{"no file descriptors are left for pads"};
  std::promise<std::optional<Error>> first_look;
  auto outcome = first_look.get_future();
  thread_ =
      std::thread([this, promise = std::move(first_look)]() mutable { run(std::move(promise)); });
  return outcome.get();
}

void PadFinder::take_back(std::uint64_t id, std::unique_ptr<Device> device) {
  {
    const std::lock_guard lock(mutex_);
    gone_.push_back({id, std::move(device)});
  }
  bell_.ring();
}

void PadFinder::tell_stickless(std::uint64_t id, const std::string& sentence) {
  {
    const std::lock_guard lock(mutex_);
    stickless_.push_back({id, sentence});
  }
  bell_.ring();
}

void PadFinder::run(std::promise<std::optional<Error>> first_look) {
  // Listen first, then look, so that nothing that happens in between is missed.
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
    take_openings();
    if (is_recording_) continue;
    if (auto problem = look(nullptr)) remarks_.add_once(problem->message);
  }
}

void PadFinder::wait() {
  const int changes = monitor_ ? monitor_->fd() : options_.changes_fd;
  pollfd fds[] = {{bell_.fd(), POLLIN, 0}, {changes, POLLIN, 0}};
  ::poll(fds, 2, is_recording_ ? -1 : milliseconds_until(next_look_));
  bell_.clear();
  // Any event, even an overflow of the socket, only means that the devices are looked at again.
  if (fds[1].revents != 0) let_settle(changes);
}

void PadFinder::let_settle(int changes_fd) {
  const Clock::time_point end = Clock::now() + kMaxUnrest;
  pollfd changes{changes_fd, POLLIN, 0};
  do {
    if (monitor_)
      monitor_->has_changed();
    else
      clear_event(changes_fd);
  } while (!is_ending_ && Clock::now() < end &&
           ::poll(&changes, 1, static_cast<int>(kQuiet.count())) > 0);
}

void PadFinder::look_no_later_than(Clock::time_point time) {
  next_look_ = std::min(next_look_, time);
}

// Tells start() whether the selector is valid as soon as that is known.
std::optional<Error> PadFinder::look(std::promise<std::optional<Error>>* first_look) {
  now_ = Clock::now();
  const auto answer = [first_look](std::optional<Error> error) {
    if (first_look != nullptr) first_look->set_value(error);
    return error;
  };
  next_look_ = now_ + (monitor_ || options_.changes_fd >= 0 ? kIdleLook : kLookWithoutUdev);
  if (open_.empty()) look_no_later_than(now_ + kLookWithoutPads);
  auto sightings =
      pad_sightings(options_.files, options_.selector, Drivers::preferred, options_.drivers);
  if (!sightings) return answer(sightings.error());
  remember(*sightings);
  auto chosen = chosen_pads(*sightings, options_.selector);
  if (!chosen) return answer(chosen.error());
  if (is_recording_) {
    if (chosen->empty())
      return answer(Error{options_.selector.pad + ": none of its devices is a pad with a stick"});
    awaited_ends_ = static_cast<int>(chosen->size());
  }
  answer(std::nullopt);
  const std::size_t before = openings_.size();
  for (const PadSighting& s : *chosen) {
    if (is_ending_) return std::nullopt;
    consider(s);
  }
  await_openings(before);
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
    if (candidate.is_stickless) s.problem = candidate.problem;
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
  std::vector<Stickless> stickless;
  {
    const std::lock_guard lock(mutex_);
    gone.swap(gone_);
    stickless.swap(stickless_);
  }
  for (const Stickless& one : stickless) {
    const auto open = std::ranges::find(open_, one.id, &Open::id);
    if (open == open_.end()) continue;
    remarks_.add_once(one.sentence);
    open->is_stickless = true;
    if (const auto entry = candidates_.find(open->key); entry != candidates_.end()) {
      entry->second.is_stickless = true;
      entry->second.problem = one.sentence;
    }
  }
  for (const Gone& one : gone) forget(one.id);
}

void PadFinder::forget(std::uint64_t id) {
  const auto open = std::ranges::find(open_, id, &Open::id);
  if (open == open_.end()) return;
  const Clock::time_point now = Clock::now();
  indices_[open->index].is_present = false;
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

// True also while the pad is being opened, if its name or unique id came after its opening, and if
// another driver has the pad open.
bool PadFinder::is_open(const PadSighting& sighting) const {
  const std::string pad = pad_key(sighting);
  const auto is_it = [&](const std::string& key, const DriverEntry* driver,
                         const std::string& node) {
    return key == pad && (driver != sighting.driver || node == sighting.listing.node);
  };
  return std::ranges::any_of(open_,
                             [&](const Open& o) { return is_it(o.pad_key, o.driver, o.node); }) ||
         std::ranges::any_of(openings_, [&](const auto& o) {
           return is_it(pad_key(o->sighting), o->sighting.driver, o->sighting.listing.node);
         });
}

// True if nothing has to be closed before this pad is opened. Asks for the end of a single Joy-Con
// whose pair is there now, and of a driver's device whose reports contain no stick. A pair ends by
// itself when one of its parts is gone.
bool PadFinder::clear_the_way(const PadSighting& sighting) {
  bool is_clear = std::ranges::none_of(openings_, [&](const auto& opening) {
    return is_part(sighting, opening->sighting) || is_part(opening->sighting, sighting);
  });
  const std::string pad = pad_key(sighting);
  for (Open& open : open_) {
    const bool is_part = std::ranges::count(sighting.listing.parts, open.pad_key) > 0,
               is_whole = std::ranges::count(open.parts, pad) > 0,
               is_dead = open.is_stickless && open.driver != sighting.driver && open.pad_key == pad;
    if (!is_part && !is_whole && !is_dead) continue;
    is_clear = false;
    if (!is_whole && !std::exchange(open.is_released, true)) release_(open.id);
  }
  return is_clear;
}

// True if the pad was plugged in again before the I/O thread noticed that it was gone. Its opening
// waits for that, to have the same index again.
bool PadFinder::is_awaiting_gone(const PadSighting& sighting) const {
  return std::ranges::any_of(open_, [this, &info = sighting.listing.info](const Open& open) {
    return open.missing_since && now_ < *open.missing_since + kGonePatience &&
           is_same_device(indices_[open.index].info, info);
  });
}

std::chrono::milliseconds PadFinder::patience(const PadSighting& sighting,
                                              const Candidate& candidate) const {
  const std::string_view driver = sighting.driver->name;
  if (lacks_its_id(sighting)) return kIdPatience;
  if (is_recording_ || !options_.selector.driver.empty()) return 0ms;
  if (driver == "usb") return kKernelPatience;
  const DeviceInfo& info = sighting.listing.info;
  const bool was_here = std::ranges::any_of(indices_, [&info, driver](const Index& known) {
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
  if (candidate.is_refused || !clear_the_way(sighting) || is_open(sighting)) return;
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
  open(sighting);
}

// Opens a pad on a thread of its own; the devices of a recording are opened in their order.
void PadFinder::open(const PadSighting& sighting) {
  const Detach detach = detach_asked(options_.selector);
  if (is_recording_) return settle(sighting, sighting.driver->open(sighting.listing, detach));
  Opening& opening = *openings_.emplace_back(std::make_unique<Opening>());
  opening.sighting = sighting;
  const auto run = [this, &opening, detach] {
    auto device = opening.sighting.driver->open(opening.sighting.listing, detach);
    const std::lock_guard lock(mutex_);
    opening.outcome.emplace(std::move(device));
    if (awaits_openings_)
      opened_.notify_one();
    else
      bell_.ring();
  };
  try {
    opening.thread = std::thread(run);
  } catch (const std::system_error&) {
    run();  // there can be no more threads: the other pads wait for this one
  }
}

// Waits a moment for the openings that were begun after the first `before` ones, so that pads that
// open at the same time keep their order.
void PadFinder::await_openings(std::size_t before) {
  if (openings_.size() == before) return;
  {
    std::unique_lock lock(mutex_);
    awaits_openings_ = true;
    opened_.wait_for(lock, kQuickOpening, [&] {
      return std::all_of(openings_.begin() + static_cast<std::ptrdiff_t>(before), openings_.end(),
                         [](const auto& o) { return o->outcome.has_value(); });
    });
    awaits_openings_ = false;
  }
  take_openings();
}

void PadFinder::take_openings() {
  std::vector<std::unique_ptr<Opening>> ended;
  {
    const std::lock_guard lock(mutex_);
    for (auto& opening : openings_)
      if (opening->outcome) ended.push_back(std::move(opening));
  }
  std::erase(openings_, nullptr);
  for (const auto& opening : ended) {
    if (opening->thread.joinable()) opening->thread.join();
    settle(opening->sighting, std::move(*opening->outcome));
  }
}

void PadFinder::settle(const PadSighting& sighting, Result<std::unique_ptr<Device>> device) {
  const auto entry = candidates_.find(key_of(sighting));
  if (entry == candidates_.end()) return;  // the pad was unplugged meanwhile
  Candidate& candidate = entry->second;
  const Clock::time_point now = Clock::now();
  if (!device) {
    const auto tries = static_cast<std::size_t>(candidate.failures++);
    const bool is_exhausted = tries >= std::size(kRetries);
    candidate.problem = device.error().message;
    candidate.next_try = now + (is_exhausted ? kSlowRetry : kRetries[tries]);
    // Look again soon, for the next driver.
    look_no_later_than(is_exhausted ? now + kQuiet : candidate.next_try);
    if (!is_recording_) return;
    remarks_.add_once(candidate.problem);
    --awaited_ends_;
    return;
  }
  if (options_.is_raw) (*device)->hand_on_raw();
  auto pad = std::make_unique<KnownPad>();
  auto problem = set_up(sighting, **device, *pad);
  std::optional<std::uint16_t> index;
  if (!problem) {
    index = index_of((*device)->info());
    if (!index)
      problem = fmt::format("{}: more than {} different pads", name_of(sighting), kMaxPads);
  }
  if (problem) {
    candidate.is_refused = true;
    if (!problem->empty()) remarks_.add_once(*problem);
    if (is_recording_) --awaited_ends_;
    return;
  }
  hand_over(sighting, std::move(*device), std::move(pad), *index);
}

// Fills in the device as the recording of this session will state it, and the configuration that a
// replay will derive from that. Returns why the pad cannot be used; empty if users need not know,
// because they named no pad, and this device is not one.
std::optional<std::string> PadFinder::set_up(const PadSighting& sighting, Device& device,
                                             KnownPad& pad) {
  const DeviceInfo& info = device.info();
  const std::optional<FactorySticks> factory = device.factory_sticks();
  std::vector<std::string> remarks;
  auto [recorded, calibration] = recorded_device(options_.files, info, factory, remarks);
  for (const std::string& remark : remarks) remarks_.add_once(remark);
  bool has_own_calibration = false;  // true for a recording, which brings its calibration as text
  if (is_recording_) {
    recorded.info.mapping = info.mapping;
    const std::string own = trace_calibration(sighting.listing);
    has_own_calibration = !own.empty() && !options_.files.calibration;
    if (has_own_calibration) recorded.calibration = own;
  }
  const std::string name = name_of(sighting);
  auto config = has_own_calibration ? pad_config(options_.files, recorded, name)
                                    : pad_config(options_.files, recorded.info, calibration, name);
  if (!config) return config.error().message;
  if (!config->is_usable) return options_.selector.pad.empty() ? "" : name + ": no stick";
  config->is_present = false;  // true as soon as the reader has taken `added`
  config->has_factory_sticks = factory.has_value();
  config->factory_gyro = device.factory_gyro();
  pad = {std::move(recorded), std::move(*config), {}};
  pad.layout = pad.config.layout;
  return std::nullopt;
}

// The index that the device had before it was unplugged. Of equal devices the one on the same port
// is chosen.
std::optional<std::uint16_t> PadFinder::index_of(const DeviceInfo& info) const {
  std::optional<std::uint16_t> on_other_port;
  for (std::uint16_t i = 0; i < indices_.size(); ++i) {
    const DeviceInfo& known = indices_[i].info;
    if (indices_[i].is_present || !is_same_device(known, info)) continue;
    if (known.bus != info.bus || known.descriptor != info.descriptor) continue;
    if (known.physical_path == info.physical_path) return i;
    if (!on_other_port) on_other_port = i;
  }
  if (on_other_port) return on_other_port;
  if (indices_.size() >= kMaxPads) return std::nullopt;
  return static_cast<std::uint16_t>(indices_.size());
}

void PadFinder::hand_over(const PadSighting& sighting, std::unique_ptr<Device> device,
                          std::unique_ptr<KnownPad> known, std::uint16_t index) {
  OpenedPad opened;
  opened.layout = known->layout;
  opened.is_recording = is_recording_;
  opened.is_raw = options_.is_raw;
  opened.index = index;
  opened.id = ++opened_count_;
  opened.name = name_of(sighting);
  if (index == indices_.size()) {
    indices_.push_back({device->info(), true});
    known->device.index = index;
    opened.known = std::move(known);
  } else {
    // Stores the port as well, which may be another one now.
    indices_[index] = {device->info(), true};
  }
  opened.device = std::move(device);
  open_.push_back({opened.id, key_of(sighting), pad_key(sighting), sighting.listing.node,
                   sighting.driver, index, Clock::now(), sighting.listing.parts, std::nullopt});
  hand_over_(std::move(opened));
}

// For each requested pad that no driver can open, reports the first driver's error.
void PadFinder::tell_problems(const std::vector<PadSighting>& sightings,
                              const std::vector<PadSighting>& chosen) {
  const auto matching = matching_pads(sightings, options_.selector);
  if (!matching) return;
  std::vector<std::string> settled;
  for (const PadSighting& s : chosen) {
    settled.push_back(pad_key(s));
    const auto& parts = s.listing.parts;
    settled.insert(settled.end(), parts.begin(), parts.end());
  }
  for (const PadSighting& s : *matching) {
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
