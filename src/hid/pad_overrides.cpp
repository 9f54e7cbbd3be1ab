#include "gaitpad/pad_overrides.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/text.h"
#include "files/toml_file.h"
#include "hid/trace_lines.h"

namespace gaitpad {

namespace {

constexpr std::size_t kMaxMapPads = 256;
constexpr std::size_t kMaxProducts = 64;
constexpr std::size_t kMaxSources = 8;

// Cuts `text` off before `mark` and returns what was behind it; empty: there is no such mark.
std::string_view cut_behind(std::string_view& text, char mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) return {};
  const std::string_view tail = trimmed(text.substr(at + 1));
  text = trimmed(text.substr(0, at));
  return tail;
}

std::optional<ControlSource> source_of(std::string_view text) {
  ControlSource source;
  const bool has_mask = text.find('&') != std::string_view::npos;
  const auto mask = hexadecimal(cut_behind(text, '&'), 0xffffffff);
  const bool has_occurrence = text.find('/') != std::string_view::npos;
  const auto occurrence = decimal(cut_behind(text, '/'), 1000);
  if (has_mask && (!mask || *mask == 0)) return std::nullopt;
  if (has_occurrence && (!occurrence || *occurrence == 0)) return std::nullopt;
  source.mask = mask.value_or(0);
  source.occurrence = static_cast<std::uint32_t>(occurrence.value_or(1));
  for (const auto& [word, side] :
       {std::pair<std::string_view, StickSide>("negative ", StickSide::negative),
        {"positive ", StickSide::positive}}) {
    if (!text.starts_with(word)) continue;
    source.side = side;
    text = trimmed(text.substr(word.size()));
  }
  if (text.starts_with('-')) {
    source.reversed = true;
    text = trimmed(text.substr(1));
  }
  constexpr std::pair<std::string_view, std::uint8_t> kHats[] = {
      {"hat up", 1}, {"hat right", 2}, {"hat down", 4}, {"hat left", 8}};
  for (const auto& [name, directions] : kHats) {
    if (text != name) continue;
    source.usage = usage::kHatSwitch;
    source.directions = directions;
    return source;
  }
  constexpr std::string_view kButton = "button ";
  if (text.starts_with(kButton)) {
    const auto number = decimal(trimmed(text.substr(kButton.size())), 0xffff);
    if (!number || *number == 0) return std::nullopt;
    source.usage = usage_of(usage::kButtonPage, static_cast<std::uint16_t>(*number));
    return source;
  }
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto page = hexadecimal(text.substr(0, colon), 0xffff);
  const auto id = hexadecimal(text.substr(colon + 1), 0xffff);
  if (!page || !id) return std::nullopt;
  source.usage = usage_of(static_cast<std::uint16_t>(*page), static_cast<std::uint16_t>(*id));
  return source;
}

template <std::size_t N>
void read_controls(TomlTable pad, std::string_view key,
                   const std::array<std::string_view, N>& names,
                   std::array<std::optional<ControlSources>, N>& controls) {
  auto table = pad.table(key);
  if (!table) return;
  for (std::size_t i = 0; i < N; ++i) {
    const auto text = table->string(names[i]);
    if (!text) continue;
    auto sources = parse_sources(*text);
    if (!sources) {
      table->reject(names[i], sources.error().message);
      continue;
    }
    controls[i] = std::move(*sources);
  }
}

std::optional<std::uint32_t> device_id(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  const auto vendor = hexadecimal(text.substr(0, colon), 0xffff);
  const auto product = hexadecimal(text.substr(colon + 1), 0xffff);
  if (!vendor || !product) return std::nullopt;
  return (*vendor << 16) | *product;
}

void read_identity(TomlTable& pad, PadOverride& result) {
  result.name = pad.string("name").value_or("");
  if (const auto vendor = pad.integer("vendor", 0, 0xffff)) {
    result.vendor = static_cast<std::uint16_t>(*vendor);
  }
  for (const double p :
       pad.numbers("products", 1, kMaxProducts, 0, 0xffff).value_or(std::vector<double>{})) {
    if (p != static_cast<double>(static_cast<std::uint16_t>(p))) {
      pad.reject("products", "products are whole numbers");
    }
    result.products.push_back(static_cast<std::uint16_t>(p));
  }
  for (const std::string& id :
       pad.strings("ids", kMaxProducts).value_or(std::vector<std::string>{})) {
    const auto number = device_id(id);
    if (!number) pad.reject("ids", in_quotes(id) + " is no vendor:product such as 054c:0268");
    result.ids.push_back(number.value_or(0));
  }
  result.drivers = pad.strings("drivers", 16).value_or(std::vector<std::string>{});
  if (const auto bus = pad.integer("bus", 0, 0xffff)) result.bus = static_cast<BusType>(*bus);
  if (const auto text = pad.string("application")) {
    result.application = device_id(*text);  // a usage is written in the form of two ids
    if (!result.application)
      pad.reject("application", in_quotes(*text) + " is no usage such as ff5d:0001");
  }
  if (const auto versions = pad.numbers("versions", 2, 2, 0, 0xffff)) {
    result.first_version = static_cast<std::uint16_t>((*versions)[0]);
    result.last_version = static_cast<std::uint16_t>((*versions)[1]);
  }
}

void read_order(TomlTable& pad, PadOverride& result) {
  constexpr std::pair<std::string_view, ButtonOrder> kOrders[] = {
      {"direct_input", ButtonOrder::direct_input},
      {"top_first", ButtonOrder::top_first},
      {"android", ButtonOrder::android},
      {"xinput", ButtonOrder::xinput}};
  const auto text = pad.string("button_order");
  if (!text) return;
  for (const auto& [name, order] : kOrders) {
    if (*text == name) result.order = order;
  }
  if (!result.order) {
    pad.reject("button_order", fmt::format("unknown button order {}; one of direct_input, android, "
                                           "top_first, xinput",
                                           in_quotes(*text)));
  }
}

void read_replacement(TomlTable& pad, PadOverride& result) {
  auto table = pad.table("replace");
  if (!table) return;
  table->require("descriptor");
  table->require("lengths");
  const std::string hex = table->string("descriptor").value_or("");
  std::string line(hex);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  Words count(line);
  int words = 0;
  while (!count.next().empty()) ++words;
  DescriptorReplacement& replacement = result.replacement;
  const std::string counted = fmt::format("{} {}", words, line);
  Words bytes(counted);
  if (auto cause = append_bytes(bytes, kMaxDescriptorBytes, replacement.descriptor)) {
    table->reject("descriptor", *cause);
    return;
  }
  if (auto parsed = parse_descriptor(replacement.descriptor); !parsed) {
    table->reject("descriptor", parsed.error().message);
  }
  for (const double n :
       table->numbers("lengths", 1, 16, 1, kMaxReportBytes).value_or(std::vector<double>{})) {
    replacement.lengths.push_back(static_cast<std::uint16_t>(n));
  }
  // The controls named for the device's own descriptor also count here, unless they are named anew.
  replacement.controls = result.controls;
  if (table->has("axes")) replacement.controls.axes = {};
  if (table->has("buttons")) replacement.controls.buttons = {};
  read_controls(*table, "axes", kAxisNames, replacement.controls.axes);
  read_controls(*table, "buttons", kButtonNames, replacement.controls.buttons);
}

PadOverride read_pad(TomlTable pad, const std::string& name) {
  PadOverride result;
  result.origin = fmt::format("{}:{}", name, pad.line());
  read_identity(pad, result);
  read_order(pad, result);
  result.is_pad = pad.boolean("pad");
  result.streams = pad.boolean("streams").value_or(false);
  read_controls(pad, "axes", kAxisNames, result.controls.axes);
  read_controls(pad, "buttons", kButtonNames, result.controls.buttons);
  read_replacement(pad, result);
  return result;
}

Result<PadOverrides> read_file(TomlFile file) {
  PadOverrides result;
  TomlTable root = file.root();
  for (TomlTable& pad : root.tables("pad", kMaxMapPads))
    result.push_back(read_pad(pad, file.name()));
  if (auto problem = file.problem()) return *problem;
  if (result.empty()) return Error{file.name() + ":1: there is no [[pad]]"};
  return result;
}

}  // namespace

Result<ControlSources> parse_sources(std::string_view text) {
  ControlSources sources;
  if (trimmed(text).empty()) return sources;  // the pad has no such control
  while (true) {
    const std::size_t end = text.find('|');
    const std::string_view part = trimmed(text.substr(0, end));
    const auto source = source_of(part);
    if (!source) {
      return Error{in_quotes(part) +
                   " is neither a usage such as 0001:0030 nor a button such as \"button 3\""};
    }
    if (sources.size() >= kMaxSources) {
      return Error{fmt::format("more than {} sources for one control", kMaxSources)};
    }
    sources.push_back(*source);
    if (end == std::string_view::npos) return sources;
    text.remove_prefix(end + 1);
  }
}

Result<PadOverrides> load_pad_file(const std::string& path) {
  auto file = TomlFile::load(path);
  if (!file) return file.error();
  return read_file(std::move(*file));
}

Result<PadOverrides> parse_pad_file(std::string_view text, const std::string& name) {
  auto file = TomlFile::parse(text, name);
  if (!file) return file.error();
  return read_file(std::move(*file));
}

Result<PadOverrides> load_pad_folder(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::vector<std::string> paths;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == ".toml") paths.push_back(it->path().string());
  }
  if (error) return Error{folder + ": cannot be read: " + error.message()};
  std::sort(paths.begin(), paths.end());
  PadOverrides all;
  for (const std::string& path : paths) {
    auto pads = load_pad_file(path);
    if (!pads) return pads.error();
    all.insert(all.end(), pads->begin(), pads->end());
  }
  return all;
}

namespace {

template <class T, class U>
bool allows(const std::vector<T>& allowed, const U& value) noexcept {
  return allowed.empty() || std::find(allowed.begin(), allowed.end(), value) != allowed.end();
}

bool has_application(const DeviceInfo& device, std::uint32_t application) {
  const auto parsed = parse_descriptor(device.descriptor);
  return parsed && std::find(parsed->applications.begin(), parsed->applications.end(),
                             application) != parsed->applications.end();
}

}  // namespace

const PadOverride* find_override(const PadOverrides& overrides, const DeviceInfo& device) noexcept {
  std::string_view driver = device.driver;
  if (driver.empty()) driver = "hidraw";
  const std::uint32_t id = (std::uint32_t{device.vendor} << 16) | device.product;
  for (const PadOverride& o : overrides) {
    if (o.vendor && *o.vendor != device.vendor) continue;
    if (o.bus && *o.bus != device.bus) continue;
    if (device.version < o.first_version || device.version > o.last_version) continue;
    if (!allows(o.products, device.product) || !allows(o.ids, id)) continue;
    if (!allows(o.drivers, driver)) continue;
    if (o.application && !has_application(device, *o.application)) continue;
    return &o;
  }
  return nullptr;
}

}  // namespace gaitpad
