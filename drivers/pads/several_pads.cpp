#include "drivers/pads/several_pads.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include "drivers/pads/pad_model.h"
#include "gaitpad/descriptor.h"
#include "hid/descriptor_items.h"

namespace gaitpad {

namespace {

// ---- The GameCube adapter. Bytes are from SDL's SDL_hidapi_gamecube.c.

constexpr std::uint16_t kNintendo = 0x057e, kAdapter = 0x0337;
constexpr std::uint16_t kPlugPage = 0xff37;  // ff37:0001 .. 0004 mark the plug that a listing is
constexpr int kPlugs = 4;
// Report 21: for each plug a type byte, two of buttons, two sticks, two triggers.
constexpr std::uint8_t kPlugReport = 0x21, kSetMotors = 0x11;
// SDL sends the id alone, by libusb; hidraw refuses a report without data (Linux hidraw.c).
constexpr std::array<std::uint8_t, 2> kStart = {0x13, 0x00};
// Bits of the type: has a controller, it is a wireless one (without a motor), the second USB cable
// that feeds the motors is plugged in.
constexpr std::uint8_t kHasController = 0x30, kIsWireless = 0x20, kHasPower = 0x04;
constexpr std::size_t kPlugBytes = 9, kReportBytes = 1 + kPlugs * kPlugBytes;
// The sticks of these controllers move by 88 counts, not to the ends of their bytes.
constexpr double kMiddle = 127.5, kCentre = 128.0, kReach = 88.0;

std::vector<std::uint8_t> plug_descriptor(int plug) {
  const auto before = static_cast<std::uint8_t>(kPlugBytes * (plug - 1) + 1),
             behind = static_cast<std::uint8_t>(kPlugBytes * (kPlugs - plug));
  std::vector<std::uint8_t> d = {
      0x05, 0x01, 0x09, 0x05,   0xa1, 0x01, 0x85, kPlugReport,              // game pad
      0x75, 0x08, 0x95, before, 0x81, 0x03,                                 // other plugs, type
      0x05, 0x09, 0x19, 0x01,   0x29, 0x0c, 0x15, 0x00,        0x25, 0x01,  // 12 buttons
      0x75, 0x01, 0x95, 0x0c,   0x81, 0x02, 0x95, 0x04,        0x81, 0x03,  //
      0x05, 0x01, 0x09, 0x30,   0x09, 0x31, 0x09, 0x32,        0x09, 0x35,  // stick, C stick
      0x26, 0xff, 0x00, 0x75,   0x08, 0x95, 0x04, 0x81,        0x02,        //
      0x09, 0x33, 0x09, 0x34,   0x95, 0x02, 0x81, 0x02};                    // triggers
  if (behind > 0) d.insert(d.end(), {0x95, behind, 0x81, 0x03});
  d.insert(d.end(),
           {0xc0, 0x06, 0x37, 0xff, 0x09, static_cast<std::uint8_t>(plug), 0xa1, 0x01, 0xc0});
  return d;
}

// Which motors run. One packet sets them all, so the plugs of an adapter share this.
using AdapterMotors = std::array<std::atomic<bool>, kPlugs>;

std::shared_ptr<AdapterMotors> motors_of(const std::string& adapter) {
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<AdapterMotors>> adapters;
  const std::lock_guard lock(mutex);
  std::erase_if(adapters, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<AdapterMotors>& known = adapters[adapter];
  auto motors = known.lock();
  if (!motors) known = motors = std::make_shared<AdapterMotors>();
  return motors;
}

class GameCubePlug final : public PadModel {
 public:
  GameCubePlug(int plug, const std::string& adapter)
      : plug_(static_cast<std::size_t>(plug) - 1), motors_(motors_of(adapter)) {}

  void start(PadPort& port, StartedBy) override { port.write(kStart); }
  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept override {
    reply.size = 0;
    if (packet.empty() || packet[0] != kPlugReport || packet.size() != kReportBytes) return false;
    const std::uint8_t type = packet[1 + kPlugBytes * plug_];
    is_plugged_ = (type & kHasController) != 0;
    has_motor_ = (type & kHasPower) != 0 && (type & kIsWireless) == 0;
    return is_plugged_;
  }
  bool is_plugged() const noexcept override { return is_plugged_; }
  // The motors only know on and off.
  void rumble(const Rumble& rumble, OutPacket& packet) noexcept override {
    (*motors_)[plug_] = has_motor_ && (rumble.strong != 0 || rumble.weak != 0);
    packet = {};
    packet.bytes[0] = kSetMotors;
    for (std::size_t i = 0; i < motors_->size(); ++i) packet.bytes[1 + i] = (*motors_)[i] ? 1 : 0;
    packet.size = 1 + motors_->size();
  }
  std::optional<FactorySticks> factory_sticks() const override {
    constexpr FactoryAxis kAxis{(kCentre - kReach - kMiddle) / kMiddle,
                                (kCentre - kMiddle) / kMiddle,
                                (kCentre + kReach - kMiddle) / kMiddle};
    return FactorySticks{kAxis, kAxis, kAxis, kAxis};
  }

 private:
  std::size_t plug_;  // from 0
  std::shared_ptr<AdapterMotors> motors_;
  bool is_plugged_ = true, has_motor_ = false;
};

// ---- Several pad collections in one descriptor

// A pad collection of another listing; the usage is undefined in HID.
constexpr std::uint32_t kOtherPad = usage_of(0x01, 0x00);

bool is_pad(std::uint32_t application) {
  return application == usage::kJoystick || application == usage::kGamePad ||
         application == usage::kMultiAxis;
}

struct PadCollection {
  std::size_t application = 0;  // index in ReportDescriptor::applications
  bool has_x = false, has_y = false;
  std::set<std::uint8_t> ids;
};

// Those with X and Y; none if they share a report.
std::vector<PadCollection> pad_collections(const ReportDescriptor& d) {
  std::vector<PadCollection> all(d.applications.size());
  for (const Field& f : d.fields) {
    if (f.kind != FieldKind::input || f.application >= all.size()) continue;
    PadCollection& collection = all[f.application];
    collection.application = f.application;
    collection.ids.insert(f.report_id);
    collection.has_x = collection.has_x || f.usage == usage::kX;
    collection.has_y = collection.has_y || f.usage == usage::kY;
  }
  std::erase_if(all, [&d](const PadCollection& c) {
    return !c.has_x || !c.has_y || !is_pad(d.applications[c.application]);
  });
  std::set<std::uint8_t> seen;
  for (const PadCollection& c : all) {
    for (const std::uint8_t id : c.ids) {
      if (id == 0 || !seen.insert(id).second) return {};
    }
  }
  return all;
}

// Where the usage of each application collection stands: its least significant byte.
std::vector<std::size_t> application_usages(const std::vector<std::uint8_t>& d) {
  std::vector<std::size_t> places;
  int depth = 0;
  std::size_t usage_at = 0;
  for (std::size_t at = 0; at < d.size();) {
    const std::uint8_t prefix = d[at];
    if (prefix == 0xfe) {  // a long item
      at += 3 + (at + 1 < d.size() ? d[at + 1] : 0u);
      continue;
    }
    const std::size_t size = (prefix & 3) == 3 ? 4 : prefix & 3u;
    const auto type = static_cast<ItemType>(prefix >> 2 & 3);
    const std::uint8_t item = prefix >> 4;
    if (type == ItemType::local && item == tag::kUsage && size > 0 && usage_at == 0)
      usage_at = at + 1;
    if (type == ItemType::main) {
      if (item == tag::kCollection && depth++ == 0 && at + 1 < d.size() && d[at + 1] == 0x01)
        places.push_back(usage_at);
      if (item == tag::kEndCollection && depth > 0) --depth;
      usage_at = 0;
    }
    at += 1 + size;
  }
  return places;
}

std::vector<std::uint8_t> without_other_pads(std::vector<std::uint8_t> descriptor,
                                             const std::vector<PadCollection>& pads,
                                             std::size_t kept) {
  const std::vector<std::size_t> usages = application_usages(descriptor);
  for (std::size_t i = 0; i < pads.size(); ++i) {
    const std::size_t n = pads[i].application;
    if (i != kept && n < usages.size() && usages[n] < descriptor.size())
      descriptor[usages[n]] = 0x00;
  }
  return descriptor;
}

// Hands on the reports of one collection.
class OneOfSeveral final : public PadModel {
 public:
  explicit OneOfSeveral(std::set<std::uint8_t> others) : others_(std::move(others)) {}
  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept override {
    reply.size = 0;
    return !packet.empty() && others_.count(packet[0]) == 0;
  }

 private:
  std::set<std::uint8_t> others_;
};

DeviceListing listing_of(const DeviceListing& device, int number,
                         std::vector<std::uint8_t> descriptor) {
  DeviceListing pad = device;
  pad.info.descriptor = std::move(descriptor);
  if (number == 1) return pad;
  const std::string suffix = fmt::format(":{}", number);
  pad.node += suffix;
  pad.info.name += fmt::format(" {}", number);
  pad.info.physical_path += suffix;
  if (!pad.info.unique_id.empty()) pad.info.unique_id += suffix;
  return pad;
}

}  // namespace

std::vector<DeviceListing> split_pads(const DeviceListing& device) {
  std::vector<DeviceListing> listings;
  const DeviceInfo& info = device.info;
  if (info.vendor == kNintendo && info.product == kAdapter) {
    for (int plug = 1; plug <= kPlugs; ++plug)
      listings.push_back(listing_of(device, plug, plug_descriptor(plug)));
    return listings;
  }
  const auto parsed = parse_descriptor(info.descriptor);
  if (!parsed) return listings;
  const std::vector<PadCollection> pads = pad_collections(*parsed);
  if (pads.size() < 2) return listings;
  for (std::size_t i = 0; i < pads.size(); ++i)
    listings.push_back(
        listing_of(device, static_cast<int>(i) + 1, without_other_pads(info.descriptor, pads, i)));
  return listings;
}

std::vector<DeviceListing> with_split_pads(const std::vector<DeviceListing>& devices) {
  std::vector<DeviceListing> listings;
  for (const DeviceListing& device : devices) {
    std::vector<DeviceListing> pads = split_pads(device);
    if (pads.empty()) pads.push_back(device);
    std::move(pads.begin(), pads.end(), std::back_inserter(listings));
  }
  return listings;
}

std::string without_number(const std::string& part) {
  const std::size_t colon = part.rfind(':');
  if (colon == std::string::npos || colon + 2 != part.size() || part.back() < '2' ||
      part.back() > '9')
    return part;
  return part.substr(0, colon);
}

bool is_one_of_several(const std::vector<std::uint8_t>& descriptor) {
  const auto parsed = parse_descriptor(descriptor);
  return parsed && std::ranges::any_of(parsed->applications, [](std::uint32_t application) {
           return application == kOtherPad || page_of(application) == kPlugPage;
         });
}

std::unique_ptr<PadModel> make_one_of_several_model(const DeviceInfo& device) {
  const auto parsed = parse_descriptor(device.descriptor);
  if (!parsed) return nullptr;
  std::set<std::uint8_t> others;
  for (const Field& f : parsed->fields) {
    if (f.application < parsed->applications.size() &&
        parsed->applications[f.application] == kOtherPad)
      others.insert(f.report_id);
  }
  if (!others.empty()) return std::make_unique<OneOfSeveral>(std::move(others));
  for (const std::uint32_t application : parsed->applications) {
    if (page_of(application) == kPlugPage && id_of(application) >= 1 &&
        id_of(application) <= kPlugs)
      return std::make_unique<GameCubePlug>(static_cast<int>(id_of(application)),
                                            without_number(device.physical_path));
  }
  return nullptr;
}

}  // namespace gaitpad
