#include "drivers/pads/pads_of_devices.h"

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

#include "gaitpad/descriptor.h"
#include "hid/descriptor_items.h"

namespace gaitpad {

namespace {

// ---- The GameCube adapter. Bytes are from SDL's SDL_hidapi_gamecube.c.

constexpr std::uint16_t kNintendo = 0x057e, kAdapter = 0x0337;
constexpr std::uint16_t kPlugPage = 0xff37;  // usages ff37:0001 .. 0004 mark the plug of a listing
constexpr int kPlugs = 4;
// Report 21: for each plug a type byte, two of buttons, two sticks, two triggers.
constexpr std::uint8_t kPlugReport = 0x21, kSetMotors = 0x11;
// SDL sends the id alone, by libusb; hidraw refuses a report without data (Linux hidraw.c).
constexpr std::array<std::uint8_t, 2> kStart = {0x13, 0x00};
// Bits of the type: a controller is there; it is a wireless one (without a motor); the second USB
// cable, which feeds the motors, is plugged in.
constexpr std::uint8_t kHasController = 0x30, kIsWireless = 0x20, kHasPower = 0x04;
constexpr std::size_t kPlugBytes = 9, kReportBytes = 1 + kPlugs * kPlugBytes;
// The sticks of these controllers move by 88 counts, not to the ends of their bytes.
constexpr double kMiddle = 127.5, kCentre = 128.0, kReach = 88.0;

std::vector<std::uint8_t> plug_descriptor(int plug) {
  const auto before = static_cast<std::uint8_t>(kPlugBytes * (plug - 1) + 1),
             behind = static_cast<std::uint8_t>(kPlugBytes * (kPlugs - plug));
  std::vector<std::uint8_t> d = {
      0x05, 0x01, 0x09, 0x05,   0xa1, 0x01, 0x85, kPlugReport,  // collection: game pad
      0x75, 0x08, 0x95, before, 0x81, 0x03,                     // other plugs' bytes; the type
      0x05, 0x09, 0x19, 0x01,   0x29, 0x0c, 0x15, 0x00,        0x25, 0x01,  // 12 buttons
      0x75, 0x01, 0x95, 0x0c,   0x81, 0x02, 0x95, 0x04,        0x81, 0x03,  //
      0x05, 0x01, 0x09, 0x30,   0x09, 0x31, 0x09, 0x32,        0x09, 0x35,  // stick, C stick
      0x26, 0xff, 0x00, 0x75,   0x08, 0x95, 0x04, 0x81,        0x02,        //
      0x09, 0x33, 0x09, 0x34,   0x95, 0x02, 0x81, 0x02};                    // triggers L and R
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

class GameCubePlug final : public PadQuirks {
 public:
  GameCubePlug(int plug, const std::string& adapter)
      : plug_(static_cast<std::size_t>(plug) - 1), motors_(motors_of(adapter)) {}

  void start(PadPort& port, StartedBy) override { port.write(kStart); }
  bool accept(std::span<const std::uint8_t> packet, OutPacket& reply) noexcept override {
    reply.size = 0;
    if (packet.empty() || packet[0] != kPlugReport || packet.size() != kReportBytes) return false;
    const std::uint8_t type = packet[1 + kPlugBytes * plug_];
    has_pad_ = (type & kHasController) != 0;
    has_motor_ = (type & kHasPower) != 0 && (type & kIsWireless) == 0;
    return has_pad_;
  }
  bool has_pad() const noexcept override { return has_pad_; }
  // The motors can only be on or off.
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
  std::size_t plug_;  // number of the plug, from 0
  std::shared_ptr<AdapterMotors> motors_;
  bool has_pad_ = true, has_motor_ = false;
};

// ---- Several pad collections in one descriptor

// Replaces the pad collections of the other listings; HID does not define this usage.
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

// The pad collections with X and Y; none if they share a report.
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

// Indices of the least significant bytes of the application collections' usages.
std::vector<std::size_t> application_usages(const std::vector<std::uint8_t>& d) {
  std::vector<std::size_t> places;
  int depth = 0;
  std::size_t usage_at = 0;
  for (std::size_t at = 0; at < d.size();) {
    const std::uint8_t prefix = d[at];
    if (prefix == 0xfe) {  // skips a long item
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

// Passes on the reports of one collection.
class OneOfSeveral final : public PadQuirks {
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

std::unique_ptr<PadQuirks> make_one_of_several_quirks(const DeviceInfo& device) {
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

// ---- Two Joy-Cons as one pad

namespace {

using Status = Device::Status;

enum : std::uint16_t { kLeft = 0x2006, kRight = 0x2007, kPair = 0x2008, kGrip = 0x200e };

// The Joy-Cons' full report, from dekuNukem's Nintendo_Switch_Reverse_Engineering
// (bluetooth_hid_notes.md): buttons of the right one, shared ones, buttons of the left one; then
// three bytes for each stick.
constexpr std::uint8_t kFull = 0x30;
constexpr std::size_t kRightButtons = 3, kSharedButtons = 4, kLeftButtons = 5, kLeftStick = 6,
                      kRightStick = 9, kStickBytes = 3, kPairBytes = kPairSideByte;
// Shared buttons of the left one (minus, stick, capture) and the right one (plus, ...).
constexpr std::uint8_t kSharedLeft = 0x29, kSharedRight = 0x16;
constexpr std::array<std::uint8_t, kStickBytes> kCentred = {0x00, 0x08, 0x80};
// After this number of skipped reports in a row read() returns, so that other pads are read.
constexpr int kMaxSkippedInARow = 64;

DeviceInfo pair_info(const DeviceInfo& left, const DeviceInfo& right) {
  DeviceInfo pair = left;
  pair.product = kPair;
  pair.name = "Joy-Con pair";
  pair.unique_id += "+" + right.unique_id;
  pair.physical_path += "+" + right.physical_path;
  return pair;
}

class JoyConPair final : public Device {
 public:
  JoyConPair(std::unique_ptr<Device> left, std::unique_ptr<Device> right)
      : sides_{std::move(left), std::move(right)},
        info_(pair_info(sides_[0]->info(), sides_[1]->info())) {
    std::copy(kCentred.begin(), kCentred.end(), state_.begin() + kLeftStick);
    std::copy(kCentred.begin(), kCentred.end(), state_.begin() + kRightStick);
    collect_fds();
  }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override {
    return std::span(fds_).first(fd_count_);
  }

  // Reads the sides in turns, so that a fast side does not keep the slow one waiting.
  Status read(Report& report) noexcept override {
    int silent = 0;
    for (int i = 0; i < kMaxSkippedInARow && silent < 2; ++i) {
      turn_ = 1 - turn_;
      const Status status = sides_[turn_]->read(report);
      if (status == Status::gone) return status;
      silent = status == Status::nothing ? silent + 1 : 0;
      if (status == Status::report && merge(report)) return status;
    }
    collect_fds();
    return Status::nothing;
  }

  bool rumble(const Rumble& strengths) noexcept override {
    const bool left = sides_[0]->rumble(strengths), right = sides_[1]->rumble(strengths);
    return left || right;
  }

  // A single Joy-Con's sticks are for holding it sideways, a pair's for holding it upright.
  std::optional<FactorySticks> factory_sticks() const override {
    const auto left = sides_[0]->factory_sticks(), right = sides_[1]->factory_sticks();
    if (!left && !right) return std::nullopt;
    FactorySticks both;
    if (left) {
      both.left_x = left->left_y;
      both.left_y = mirrored(left->left_x);
    }
    if (right) {
      both.right_x = mirrored(right->left_y);
      both.right_y = right->left_x;
    }
    return both;
  }
  // Each side has a gyroscope; that of the right side is used for the pair.
  std::optional<FactoryGyro> factory_gyro() const override { return sides_[1]->factory_gyro(); }
  std::int64_t lost() const noexcept override { return sides_[0]->lost() + sides_[1]->lost(); }
  std::vector<std::string> take_remarks() override {
    std::vector<std::string> remarks = sides_[0]->take_remarks(), more = sides_[1]->take_remarks();
    std::move(more.begin(), more.end(), std::back_inserter(remarks));
    return remarks;
  }

 private:
  void collect_fds() noexcept {
    fd_count_ = 0;
    for (const auto& side : sides_) {
      for (const pollfd& fd : side->poll_fds()) {
        if (fd_count_ < fds_.size()) fds_[fd_count_++] = fd;
      }
    }
  }

  // Merges this side's half into the common state, and puts the state into the report.
  bool merge(Report& report) noexcept {
    if (report.size < kPairBytes || report.bytes[0] != kFull) return false;
    const bool is_left = turn_ == 0;
    const std::uint8_t own = is_left ? kSharedLeft : kSharedRight;
    const std::size_t buttons = is_left ? kLeftButtons : kRightButtons;
    const std::size_t stick = is_left ? kLeftStick : kRightStick;
    state_[buttons] = report.bytes[buttons];
    state_[kSharedButtons] = static_cast<std::uint8_t>((state_[kSharedButtons] & ~own) |
                                                       (report.bytes[kSharedButtons] & own));
    std::copy_n(report.bytes.begin() + stick, kStickBytes, state_.begin() + stick);
    std::copy(state_.begin() + kRightButtons, state_.end(), report.bytes.begin() + kRightButtons);
    report.bytes[kPairSideByte] = is_left ? kPairLeft : kPairRight;
    return true;
  }

  std::array<std::unique_ptr<Device>, 2> sides_;  // the left and the right Joy-Con
  DeviceInfo info_;
  std::size_t turn_ = 1;  // index of the side that was read last
  std::array<std::uint8_t, kPairBytes> state_{};
  std::array<pollfd, 8> fds_{};
  std::size_t fd_count_ = 0;
};

bool is_joy_con(const DeviceListing& single, std::uint16_t product) {
  const DeviceInfo& info = single.info;
  if (info.vendor != kNintendo || info.product != product || !single.problem.empty()) return false;
  // NES controllers have the same ids as a Joy-Con, so the name decides.
  return product == kGrip || info.name.find("NES") == std::string::npos;
}

DeviceListing joined(const DeviceListing& left, const DeviceListing& right) {
  DeviceListing pair = left;
  pair.info = pair_info(left.info, right.info);
  pair.node = left.node + "+" + right.node;
  pair.pad_path = left.pad_path + "+" + right.pad_path;
  pair.parts = {left.pad_path, right.pad_path};
  return pair;
}

}  // namespace

std::vector<DeviceListing> joy_con_pairs(const std::vector<DeviceListing>& singles) {
  std::vector<DeviceListing> pairs;
  const auto find_pairs = [&](std::uint16_t one, std::uint16_t other) {
    std::vector<const DeviceListing*> left, right;
    for (const DeviceListing& single : singles) {
      if (is_joy_con(single, one) && (one != other || left.size() == right.size()))
        left.push_back(&single);
      else if (is_joy_con(single, other))
        right.push_back(&single);
    }
    for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i)
      pairs.push_back(joined(*left[i], *right[i]));
  };
  find_pairs(kLeft, kRight);
  find_pairs(kGrip, kGrip);
  return pairs;
}

Result<std::unique_ptr<Device>> join_joy_cons(std::unique_ptr<Device> one,
                                              std::unique_ptr<Device> other) {
  if (one->info().product == kRight) std::swap(one, other);
  if (one->info().product != kLeft || other->info().product != kRight)
    return Error{"these are not a left and a right Joy-Con"};
  return std::unique_ptr<Device>(std::make_unique<JoyConPair>(std::move(one), std::move(other)));
}

// ---- Receivers

std::string port_behind_receiver(const std::string& port, std::string_view kernel_driver,
                                 unsigned interface_number) {
  if (kernel_driver != "xpad" || !port.ends_with("/input0")) return port;
  return port.substr(0, port.size() - 1) + std::to_string(interface_number);
}

std::string path_behind_receiver(const std::string& interface_path, std::string_view kernel_driver,
                                 const std::string& maker) {
  return kernel_driver == "xone-dongle" ? maker : interface_path;
}

}  // namespace gaitpad
