#include "session/pad_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <functional>
#include <iterator>
#include <string_view>
#include <utility>

#include "base/toml_file.h"
#include "drivers/driver_entries.h"

namespace gaitpad {
namespace {

constexpr std::string_view kTrace = "trace", kUsb = "usb", kSdl = "sdl";

// ASCII alone, whatever the locale.
std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

Result<const DriverEntry*> wished_driver(const std::string& name,
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

// SDL sees through the kernel's devices what the others see themselves.
bool is_asked(const DriverEntry& entry, Drivers which, std::span<const DriverEntry> table) {
  if (entry.find == nullptr) return false;
  if (which == Drivers::all || entry.name != kSdl) return true;
  return !is_built(table, "hidraw") && !is_built(table, "evdev");
}

PadSighting judged(const PadFiles& files, DeviceListing listing, const DriverEntry& driver) {
  PadSighting sighting{std::move(listing), &driver, true, {}};
  const DeviceListing& seen = sighting.listing;
  sighting.problem = seen.problem;
  sighting.is_pad = !seen.is_other;
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

// A device whose descriptor one driver cannot read is what another driver says of it.
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

Result<std::vector<PadSighting>> recorded_pads(const PadFiles& files, const PadWish& wish,
                                               std::span<const DriverEntry> table) {
  if (!wish.driver.empty() && wish.driver != kTrace)
    return Error{
        fmt::format("{}: a recording is not for the driver \"{}\"", wish.pad, wish.driver)};
  auto driver = wished_driver(std::string(kTrace), table);
  if (!driver) return driver.error();
  auto listings = trace_listings(wish.pad);
  if (!listings) return listings.error();
  std::vector<PadSighting> sightings;
  for (DeviceListing& listing : *listings)
    sightings.push_back(judged(files, std::move(listing), **driver));
  return sightings;
}

// How exactly a text fits. Whoever fits best is meant.
enum class Fit { none, part_of_name, name, unique_id, model, node };

// `vvvv:pppp` in hexadecimal.
bool is_model(std::string_view text, const DeviceInfo& info) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return false;
  const auto is_id = [](std::string_view digits, std::uint16_t id) {
    std::uint16_t value = 0;
    const char* end = digits.data() + digits.size();
    const auto read = std::from_chars(digits.data(), end, value, 16);
    return digits.size() <= 4 && read.ec == std::errc() && read.ptr == end && value == id;
  };
  return is_id(text.substr(0, colon), info.vendor) && is_id(text.substr(colon + 1), info.product);
}

struct Wanted {
  std::string text, lower_text;
  std::string node;  // links such as /dev/input/by-id/... resolved
};
Wanted wanted_of(const std::string& pad) {
  std::error_code error;
  const std::filesystem::path node = std::filesystem::canonical(pad, error);
  return {pad, lower(pad), error ? pad : node.string()};
}

Fit fit_of(const PadSighting& sighting, const Wanted& wanted) {
  const DeviceListing& listing = sighting.listing;
  if (listing.node == wanted.text || listing.node == wanted.node) return Fit::node;
  if (sighting.driver->name == kTrace) return Fit::node;  // it is listed only where it is wished
  if (is_model(wanted.text, listing.info)) return Fit::model;
  if (lower(listing.info.unique_id) == wanted.lower_text) return Fit::unique_id;
  const std::string name = lower(listing.info.name);
  if (name == wanted.lower_text) return Fit::name;
  return name.find(wanted.lower_text) == std::string::npos ? Fit::none : Fit::part_of_name;
}

bool is_one_pad(const PadSighting& a, const PadSighting& b) {
  if (pad_key(a) == pad_key(b)) return true;
  const std::string& id = a.listing.info.unique_id;
  return !id.empty() && lower(id) == lower(b.listing.info.unique_id);
}

std::string described(const PadSighting& s) {
  const DeviceInfo& info = s.listing.info;
  const bool has_id = !info.unique_id.empty();
  return fmt::format("{} ({:04x}:{:04x}, {} {})", in_quotes(info.name), info.vendor, info.product,
                     has_id ? "unique id" : "port",
                     in_quotes(has_id ? info.unique_id : info.physical_path));
}

// A part of a name must mean one pad; all of `fitting` fit it.
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

Result<std::vector<PadSighting>> pad_sightings(const PadFiles& files, const PadWish& wish,
                                               Drivers drivers,
                                               std::span<const DriverEntry> table) {
  if (is_recording(wish.pad)) return recorded_pads(files, wish, table);
  const DriverEntry* only = nullptr;
  if (!wish.driver.empty()) {
    auto found = wished_driver(wish.driver, table);
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
  std::ranges::stable_partition(sightings, &PadSighting::is_pad);
  return sightings;
}

Result<std::vector<PadSighting>> wished_pads(const std::vector<PadSighting>& sightings,
                                             const PadWish& wish) {
  std::vector<PadSighting> pads;
  std::ranges::copy_if(sightings, std::back_inserter(pads), &PadSighting::is_pad);
  std::ranges::stable_sort(pads, std::less<>(), &PadSighting::driver);
  if (wish.pad.empty()) return pads;

  const Wanted wanted = wanted_of(wish.pad);
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
    if (auto error = ambiguity(fitting, wish.pad)) return *error;
  }
  if (best == Fit::none || best == Fit::node) return fitting;
  // Drivers give one pad different names and ids; what fits one of them means the pad.
  std::erase_if(pads, [&fitting](const PadSighting& s) {
    return std::ranges::none_of(fitting,
                                [&s](const PadSighting& f) { return pad_key(f) == pad_key(s); });
  });
  return pads;
}

Result<std::vector<PadSighting>> chosen_pads(const std::vector<PadSighting>& sightings,
                                             const PadWish& wish) {
  auto pads = wished_pads(sightings, wish);
  if (!pads) return pads.error();
  const Wanted wanted = wanted_of(wish.pad);
  std::vector<PadSighting> chosen;
  for (PadSighting& s : *pads) {
    const bool is_wished = wish.driver == kUsb || fit_of(s, wanted) == Fit::node;
    const bool is_taken = s.driver->name == kUsb && !s.listing.kernel_driver.empty();
    if (!s.problem.empty() || (is_taken && !is_wished)) continue;
    const auto is_served = [&s](const PadSighting& c) {
      return c.driver != s.driver && pad_key(c) == pad_key(s);
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

}  // namespace gaitpad
