// gaitpad pads: lists every device that a driver sees, and which of them play would take.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "gaitpad/descriptor.h"
#include "gaitpad/driver_registry.h"
#include "gaitpad/pad_stream.h"
#include "hid/usage_names.h"
#include "pad_report/decode_report.h"
#include "terminal/terminal.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

struct PadsArguments {
  PadSelector selector;
  std::string map;
  bool as_json = false;
};

struct PadRow {
  PadSighting sighting;
  bool is_chosen = false;
};

bool is_usable(const PadSighting& sighting) { return sighting.is_pad && sighting.problem.empty(); }

std::string problem_of(const PadSighting& sighting) {
  return sighting.problem.empty() && !sighting.is_pad ? "it has no stick" : sighting.problem;
}

std::string bus_name(BusType bus) {
  switch (bus) {
    case BusType::usb:
      return "usb";
    case BusType::bluetooth:
      return "bluetooth";
    case BusType::virtual_bus:
      return "virtual";
    case BusType::i2c:
      return "i2c";
    case BusType::host:
      return "host";
    case BusType::unknown:
      return "unknown";
  }
  return fmt::format("{:04x}", static_cast<unsigned>(bus));
}

// The usages of the application collections: `0001:0005`. Empty if the descriptor is not known yet.
std::vector<std::string> usages_of(const DeviceInfo& info) {
  std::vector<std::string> usages;
  const auto descriptor = parse_descriptor(info.descriptor);
  if (!descriptor) return usages;
  for (std::uint32_t usage : descriptor->applications) {
    std::string text = usage_text(usage);
    if (std::ranges::find(usages, text) == usages.end()) usages.push_back(std::move(text));
  }
  return usages;
}

std::vector<PadRow> rows_of(const std::vector<PadSighting>& sightings,
                            const std::vector<PadSighting>& chosen) {
  std::vector<PadRow> rows;
  for (const PadSighting& sighting : sightings) {
    const bool is_chosen = !chosen.empty() && chosen.front().driver == sighting.driver &&
                           chosen.front().listing.node == sighting.listing.node;
    rows.push_back({sighting, is_chosen});
  }
  std::ranges::stable_sort(rows, [](const PadRow& a, const PadRow& b) {
    const auto rank = [](const PadRow& row) {
      return row.is_chosen ? 0 : is_usable(row.sighting) ? 1 : row.sighting.is_pad ? 2 : 3;
    };
    return rank(a) < rank(b);
  });
  return rows;
}

ordered_json row_json(const PadRow& row) {
  const DeviceListing& listing = row.sighting.listing;
  const DeviceInfo& info = listing.info;
  ordered_json object = {{"driver", row.sighting.driver->name},
                         {"path", listing.node},
                         {"bus", bus_name(info.bus)},
                         {"vendor", info.vendor},
                         {"product", info.product},
                         {"name", info.name},
                         {"unique_id", info.unique_id},
                         {"port", info.physical_path},
                         {"kernel_driver", listing.kernel_driver},
                         {"usages", usages_of(info)},
                         {"poll_rate_hz", nullptr},
                         {"battery", battery_json(battery_of(listing.pad_path))},
                         {"usable", is_usable(row.sighting)},
                         {"problem", problem_of(row.sighting)},
                         {"chosen", row.is_chosen}};
  if (listing.poll_rate_hz > 0.0) object["poll_rate_hz"] = listing.poll_rate_hz;
  return object;
}

// Drivers that this build lacks, each with its problem.
std::vector<std::pair<std::string, std::string>> missing_drivers(const PadSelector& selector) {
  std::vector<std::pair<std::string, std::string>> missing;
  for (const DriverEntry& entry : drivers()) {
    if (entry.find || (!selector.driver.empty() && selector.driver != entry.name)) continue;
    missing.emplace_back(entry.name, fmt::format("built without {}", entry.library));
  }
  return missing;
}

void print_rows_json(const std::vector<PadRow>& rows, const PadSelector& selector) {
  ordered_json list = ordered_json::array();
  for (const PadRow& row : rows) list.push_back(row_json(row));
  for (const auto& [driver, problem] : missing_drivers(selector))
    list.push_back({{"driver", driver}, {"problem", problem}});
  print_json(list);
}

std::string joined(const std::vector<std::string>& texts) {
  return fmt::format("{}", fmt::join(texts, " "));
}

void print_text(const std::vector<PadRow>& rows, const PadSelector& selector) {
  std::vector<TableRow> table = {{"", "driver", "path", "bus", "vid:pid", "name", "unique id",
                                  "usages", "rate", "kernel", "usable"}};
  for (const PadRow& row : rows) {
    const DeviceListing& listing = row.sighting.listing;
    const DeviceInfo& info = listing.info;
    const std::string rate =
        listing.poll_rate_hz > 0.0 ? fmt::format("{:.0f} Hz", listing.poll_rate_hz) : "-";
    table.push_back({row.is_chosen ? "*" : "", row.sighting.driver->name, listing.node,
                     bus_name(info.bus), fmt::format("{:04x}:{:04x}", info.vendor, info.product),
                     printable(info.name), printable(info.unique_id), joined(usages_of(info)), rate,
                     listing.kernel_driver,
                     is_usable(row.sighting) ? "yes" : "no: " + problem_of(row.sighting)});
  }
  if (rows.empty()) {
    say("no device is seen by any driver; gaitpad doctor says more\n");
  } else {
    say(stdout, table_text(table));
  }
  for (const auto& [driver, problem] : missing_drivers(selector))
    say("{}: {}\n", driver, printable(problem));
  if (std::ranges::any_of(rows, &PadRow::is_chosen))
    say("* is the one that play takes until another is moved; {}\n", kHatDrives);
}

int run(const PadsArguments& arguments) {
  const auto files = pad_files(arguments.map, "");
  if (!files) return fail("pads", files.error().message);
  auto sightings = pad_sightings(*files, arguments.selector, Drivers::all);
  if (!sightings) {
    if (missing_drivers(arguments.selector).empty()) return fail("pads", sightings.error().message);
    sightings = std::vector<PadSighting>{};
  }
  const auto chosen = chosen_pads(*sightings, arguments.selector);
  if (!chosen) return fail("pads", chosen.error().message);
  const std::vector<PadRow> rows = rows_of(*sightings, *chosen);
  if (arguments.as_json) {
    print_rows_json(rows, arguments.selector);
  } else {
    print_text(rows, arguments.selector);
  }
  return 0;
}

}  // namespace

void add_pads(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("pads", "lists every device that every driver sees");
  const auto arguments = std::make_shared<PadsArguments>();
  add_driver_option(*command, arguments->selector);
  command->add_option("--map", arguments->map, "pad file that overrides config/pads");
  command->add_flag("--json", arguments->as_json, "print a JSON list of objects");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
