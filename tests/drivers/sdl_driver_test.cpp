// SDL's virtual joysticks replace hardware.
#ifdef GAITPAD_HAS_SDL
#include <SDL2/SDL.h>
#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>

#include "drivers/driver_rows.h"
#include "gaitpad/decode.h"
#include "gaitpad/driver_registry.h"
#include "hid/evdev_layout.h"
#include "hid/sdl_lines.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

struct Motors {
  int strong = -1, weak = -1;
};

// A joystick that is plugged in while the object exists; values count from the next update on.
class VirtualPad {
 public:
  explicit VirtualPad(const char* name, SDL_JoystickType type = SDL_JOYSTICK_TYPE_GAMECONTROLLER) {
    find_sdl_devices();  // starts SDL
    SDL_VirtualJoystickDesc desc{};
    desc.version = SDL_VIRTUAL_JOYSTICK_DESC_VERSION;
    desc.type = static_cast<Uint16>(type);
    desc.naxes = 6;
    desc.nbuttons = SDL_CONTROLLER_BUTTON_MAX;
    desc.vendor_id = 0x1209;
    desc.product_id = 0x0001;
    desc.button_mask = (1u << SDL_CONTROLLER_BUTTON_MAX) - 1;
    desc.axis_mask = 0x3f;
    desc.name = name;
    desc.userdata = &motors;
    desc.Rumble = [](void* to, Uint16 strong, Uint16 weak) {
      *static_cast<Motors*>(to) = {strong, weak};
      return 0;
    };
    index_ = SDL_JoystickAttachVirtualEx(&desc);
    joystick = SDL_JoystickOpen(index_);
    EXPECT_NE(joystick, nullptr) << SDL_GetError();
  }
  ~VirtualPad() {
    unplug();
    SDL_JoystickClose(joystick);
  }
  void unplug() {
    const SDL_JoystickID id = SDL_JoystickInstanceID(joystick);
    for (int i = 0; i < SDL_NumJoysticks(); ++i) {
      if (SDL_JoystickGetDeviceInstanceID(i) == id) SDL_JoystickDetachVirtual(i);
    }
  }
  SDL_Joystick* joystick = nullptr;
  Motors motors;

 private:
  int index_ = -1;
};

std::optional<DeviceListing> listing_of(const std::string& name) {
  const auto all = find_sdl_devices();
  const auto it = std::find_if(all.begin(), all.end(),
                               [&](const DeviceListing& l) { return l.info.name == name; });
  if (it == all.end()) return std::nullopt;
  return *it;
}

std::unique_ptr<Device> opened(const std::string& name) {
  return value_of(open_sdl_device(listing_of(name).value(), Detach::never));
}

// Reads like the I/O thread.
std::vector<Report> reports_of(Device& device) {
  pollfd fd = device.poll_fds()[0];
  EXPECT_EQ(::poll(&fd, 1, 60000), 1);
  std::vector<Report> reports;
  Report report;
  while (device.read(report) == Device::Status::report) reports.push_back(report);
  return reports;
}

PadState decoded(const Device& device, const std::vector<Report>& reports) {
  PadState state;
  // Without a report, at() throws and the test ends.
  const Report& last = reports.at(reports.size() - 1);
  EXPECT_TRUE(decode(value_of(pad_layout(device.info(), {})), last, state));
  return state;
}

TEST(SdlDriver, ListsWhatSdlSees) {
  VirtualPad pad("Listed Pad");
  const auto listing = listing_of("Listed Pad");
  ASSERT_TRUE(listing);
  EXPECT_EQ(listing->info.driver, "sdl");
  EXPECT_EQ(listing->info.vendor, 0x1209);
  EXPECT_EQ(listing->info.product, 0x0001);
  EXPECT_EQ(listing->problem, "");
  EXPECT_NE(listing->node, "");
  EXPECT_NE(listing->info.mapping.find(",leftx:a0,"), std::string::npos);
  pad.unplug();
  EXPECT_FALSE(listing_of("Listed Pad"));
  const auto device = open_sdl_device(*listing, Detach::never);
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().message, listing->node + ": SDL has no such joystick");
}

TEST(SdlDriver, TheFirstReportIsTheStateAtTheOpening) {
  VirtualPad pad("First Pad");
  SDL_JoystickSetVirtualAxis(pad.joystick, 0, 18632);
  SDL_JoystickUpdate();
  const auto device = opened("First Pad");
  const auto reports = reports_of(*device);
  ASSERT_EQ(reports.size(), 1u);
  EXPECT_FLOAT_EQ(decoded(*device, reports).axis[kLeftX], (2.0f * 18632 + 1) / 65535);
  Report none;
  EXPECT_EQ(device->read(none), Device::Status::nothing);
}

// SDL's default mapping of a virtual joystick has a:b0 .. and the axes in the order of SDL's game
// controllers.
TEST(SdlDriver, AxesButtonsAndHatsAreDecodedByItsMapping) {
  VirtualPad pad("Moved Pad");
  const auto device = opened("Moved Pad");
  reports_of(*device);
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_LEFTX, -32768);
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_LEFTY, -32768);
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_RIGHTX, 32767);
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 32767);
  SDL_JoystickSetVirtualButton(pad.joystick, SDL_CONTROLLER_BUTTON_START, 1);
  SDL_JoystickSetVirtualButton(pad.joystick, SDL_CONTROLLER_BUTTON_A, 1);
  const auto reports = reports_of(*device);
  EXPECT_EQ(reports.size(), 1u) << "one update, one report";
  const PadState state = decoded(*device, reports);
  EXPECT_EQ(state.axis[kLeftX], -1.0f);
  EXPECT_EQ(state.axis[kLeftY], 1.0f);
  EXPECT_EQ(state.axis[kRightX], 1.0f);
  EXPECT_EQ(state.axis[kRightTrigger], 1.0f);
  EXPECT_EQ(state.buttons, 1u << kButtonA | 1u << kButtonStart);
}

// Controls have SDL's names, and are numbered as SDL does; SDL's triggers are 0 .. 32767. A virtual
// joystick has no touchpad.
TEST(SdlDriver, EveryControlOfSdlsGameControllerHasItsName) {
  VirtualPad pad("Full Pad");
  const auto device = opened("Full Pad");
  reports_of(*device);
  for (int i = 0; i < SDL_CONTROLLER_BUTTON_TOUCHPAD; ++i) {
    SDL_JoystickSetVirtualButton(pad.joystick, i, 1);
    const PadState state = decoded(*device, reports_of(*device));
    const char* name =
        SDL_GameControllerGetStringForButton(static_cast<SDL_GameControllerButton>(i));
    const auto* ours =
        std::find(std::begin(kButtonNames), std::end(kButtonNames), std::string(name));
    ASSERT_NE(ours, std::end(kButtonNames)) << name;
    EXPECT_EQ(state.buttons, 1u << (ours - std::begin(kButtonNames))) << name;
    SDL_JoystickSetVirtualButton(pad.joystick, i, 0);
    reports_of(*device);
  }
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_TRIGGERLEFT, 0);
  const PadState state = decoded(*device, reports_of(*device));
  EXPECT_NEAR(state.axis[kLeftTrigger], 0.5f, 1e-4f);
}

TEST(SdlDriver, AJoystickWithoutMappingNamesTheDriversThatNeedNone) {
  VirtualPad pad("Plain Joystick", SDL_JOYSTICK_TYPE_UNKNOWN);
  const auto listing = listing_of("Plain Joystick");
  ASSERT_TRUE(listing);
  EXPECT_EQ(listing->problem,
            listing->node + ": SDL has no mapping for it; --driver evdev and hidraw need none");
  EXPECT_FALSE(open_sdl_device(*listing, Detach::never));
}

// Until the pad has sent something, the kernel reports 0, the end of both axes.
TEST(SdlDriver, AStickInACornerAtTheOpeningIsNotReported) {
  VirtualPad pad("Silent Pad");
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_LEFTX, -32768);
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_LEFTY, -32768);
  SDL_JoystickUpdate();
  const auto device = opened("Silent Pad");
  EXPECT_TRUE(reports_of(*device).empty());
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_LEFTX, 0);
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_LEFTY, 0);
  EXPECT_EQ(reports_of(*device).size(), 1u);
}

// SDL reports one control after the other, though the pad sent them in one report.
TEST(SdlDriver, ChangesAreOneReportButTheSecondOfAControlBeginsAnother) {
  VirtualPad pad("Quick Pad");
  const auto device = opened("Quick Pad");
  reports_of(*device);
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_LEFTX, 20000);
  SDL_JoystickSetVirtualButton(pad.joystick, SDL_CONTROLLER_BUTTON_A, 1);
  SDL_JoystickUpdate();
  SDL_JoystickSetVirtualAxis(pad.joystick, SDL_CONTROLLER_AXIS_LEFTY, 20000);
  SDL_JoystickSetVirtualButton(pad.joystick, SDL_CONTROLLER_BUTTON_A, 0);
  SDL_JoystickUpdate();
  const auto reports = reports_of(*device);
  ASSERT_EQ(reports.size(), 2u);
  EXPECT_EQ(decoded(*device, {reports[0]}).buttons, 1u << kButtonA);
  EXPECT_GT(decoded(*device, {reports[0]}).axis[kLeftX], 0.6f);
  EXPECT_EQ(decoded(*device, {reports[1]}).buttons, 0u);
  EXPECT_LT(decoded(*device, {reports[1]}).axis[kLeftY], -0.6f);
}

// Every change arrives, even if another thread (a window's loop) updates SDL.
TEST(SdlDriver, ChangesThatAnotherUpdateFoundAreNotLost) {
  VirtualPad pad("Hasty Pad");
  const auto device = opened("Hasty Pad");
  reports_of(*device);
  for (const bool down : {true, false, true}) {
    SDL_JoystickSetVirtualButton(pad.joystick, 0, down ? 1 : 0);
    SDL_JoystickUpdate();
  }
  SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT);
  const auto reports = reports_of(*device);
  ASSERT_EQ(reports.size(), 3u);
  for (std::size_t i = 1; i < reports.size(); ++i) {
    EXPECT_GE(reports[i].time_ns, reports[i - 1].time_ns);
  }
}

TEST(SdlDriver, AReaderThatStaysAwayLosesTheOldestAndKnowsHowMany) {
  VirtualPad pad("Late Pad");
  const auto device = opened("Late Pad");
  reports_of(*device);
  constexpr int kChanges = 10000, kKept = 8192;
  for (int i = 1; i <= kChanges; ++i) {
    SDL_JoystickSetVirtualAxis(pad.joystick, 0, static_cast<Sint16>(i));
    SDL_JoystickUpdate();
  }
  const auto reports = reports_of(*device);
  EXPECT_EQ(reports.size(), std::size_t{kKept});
  EXPECT_EQ(device->lost(), kChanges - kKept);
  EXPECT_FLOAT_EQ(decoded(*device, reports).axis[kLeftX], (2.0f * kChanges + 1) / 65535);
}

TEST(SdlDriver, TwoOpenPadsEachGetTheirOwn) {
  VirtualPad first("Twin A"), second("Twin B");
  const auto a = opened("Twin A"), b = opened("Twin B");
  reports_of(*a);
  reports_of(*b);
  SDL_JoystickSetVirtualButton(second.joystick, 0, 1);
  SDL_JoystickSetVirtualButton(first.joystick, 1, 1);
  EXPECT_EQ(decoded(*a, reports_of(*a)).buttons, 1u << kButtonB);
  EXPECT_EQ(decoded(*b, reports_of(*b)).buttons, 1u << kButtonA);
}

TEST(SdlDriver, OtherEventsStayOnSdlsQueue) {
  VirtualPad pad("Shared Queue Pad");
  const auto device = opened("Shared Queue Pad");
  SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT);
  for (const Uint32 type : {Uint32{SDL_KEYDOWN}, Uint32{SDL_MOUSEMOTION}, Uint32{SDL_USEREVENT}}) {
    SDL_Event event{};
    event.type = type;
    SDL_PushEvent(&event);
  }
  SDL_JoystickSetVirtualAxis(pad.joystick, 0, 1234);
  reports_of(*device);
  SDL_Event events[16];
  EXPECT_EQ(SDL_PeepEvents(events, 16, SDL_GETEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT), 3);
  EXPECT_EQ(events[0].type, Uint32{SDL_KEYDOWN});
}

// The joystick belongs to the host program.
TEST(SdlDriver, EventsOfAJoystickThatIsNotOursStayOnSdlsQueue) {
  VirtualPad pad("Our Pad"), theirs("Their Pad");
  const auto device = opened("Our Pad");
  SDL_JoystickUpdate();
  SDL_FlushEvents(SDL_FIRSTEVENT, SDL_LASTEVENT);
  SDL_JoystickSetVirtualAxis(theirs.joystick, 0, 1234);
  SDL_JoystickSetVirtualAxis(pad.joystick, 0, 4321);
  EXPECT_FALSE(reports_of(*device).empty());
  SDL_Event events[16];
  ASSERT_EQ(SDL_PeepEvents(events, 16, SDL_GETEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT), 1);
  EXPECT_EQ(events[0].jaxis.which, SDL_JoystickInstanceID(theirs.joystick));
}

TEST(SdlDriver, AHintOfTheProgramsStays) {
  find_sdl_devices();
  EXPECT_TRUE(SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "0"));
  find_sdl_devices();
  EXPECT_STREQ(SDL_GetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS), "0");
  SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "1");
}

TEST(SdlDriver, RumbleRunsUntilItIsStopped) {
  VirtualPad pad("Shaking Pad");
  const auto device = opened("Shaking Pad");
  EXPECT_TRUE(device->rumble({.strong = 0xc000, .weak = 0x4000}));
  EXPECT_EQ(pad.motors.strong, 0xc000);
  EXPECT_EQ(pad.motors.weak, 0x4000);
  EXPECT_TRUE(device->rumble({}));
  EXPECT_EQ(pad.motors.strong, 0);
  EXPECT_EQ(pad.motors.weak, 0);
}

TEST(SdlDriver, AnUnpluggedPadIsGoneAfterWhatCameBefore) {
  VirtualPad pad("Lost Pad");
  const auto device = opened("Lost Pad");
  reports_of(*device);
  SDL_JoystickSetVirtualButton(pad.joystick, 2, 1);
  SDL_JoystickUpdate();
  pad.unplug();
  const auto reports = reports_of(*device);
  ASSERT_EQ(reports.size(), 1u) << "SDL lets go of all controls, but nobody did";
  EXPECT_EQ(decoded(*device, {reports.front()}).buttons, 1u << kButtonX);
  Report none;
  EXPECT_EQ(device->read(none), Device::Status::gone);
  EXPECT_EQ(device->read(none), Device::Status::gone);
  device->rumble({.strong = 1, .weak = 1});
}

// The finder looks for joysticks and a window's loop updates SDL while the I/O thread reads.
TEST(SdlDriver, OtherThreadsMayUseSdlMeanwhile) {
  VirtualPad pad("Busy Pad");
  const auto device = opened("Busy Pad");
  std::atomic<bool> stop{false};
  std::thread finder([&] {
    while (!stop) find_sdl_devices();
  });
  std::thread window([&] {
    SDL_Event event;
    while (!stop) {
      SDL_JoystickUpdate();
      SDL_PeepEvents(&event, 1, SDL_GETEVENT, SDL_FIRSTEVENT, SDL_LASTEVENT);
    }
  });
  std::vector<Report> last;
  for (int i = 1; i <= 100; ++i) {
    SDL_JoystickSetVirtualAxis(pad.joystick, 0, static_cast<Sint16>(i));
    const auto reports = reports_of(*device);
    if (!reports.empty()) last = {reports.back()};
  }
  stop = true;
  finder.join();
  window.join();
  const auto rest = reports_of(*device);
  if (!rest.empty()) last = {rest.back()};
  EXPECT_FLOAT_EQ(decoded(*device, last).axis[kLeftX], (2.0f * 100 + 1) / 65535);
  EXPECT_EQ(device->lost(), 0);
}

DeviceInfo device_with(BusType bus, std::uint16_t vendor, std::uint16_t product,
                       std::uint16_t version) {
  DeviceInfo device;
  device.bus = bus;
  device.vendor = vendor;
  device.product = product;
  device.version = version;
  return device;
}

TEST(SdlDriver, TheDataBaseIsAskedByBusIdsAndVersion) {
  const std::string line = sdl_mapping_of(device_with(BusType::usb, 0x046d, 0xc216, 0x0110));
  EXPECT_EQ(line.substr(0, 32), "030000006d04000016c2000010010000");
  EXPECT_NE(line.find(",x:b0,"), std::string::npos) << line;
  EXPECT_NE(sdl_mapping_of(device_with(BusType::usb, 0x046d, 0xc216, 0x7777)), "")
      << "an unknown version is served by another's line";
  EXPECT_EQ(sdl_mapping_of(device_with(BusType::bluetooth, 0x046d, 0xc216, 0x0110)), "");
}

// A DualSense's own first button is the square; the kernel's first code is the cross. hidraw reads
// the pad's own order, whichever kernel driver set the input node's version. SDL adds a guess for
// each unknown pad, with a checksum of its name; its two mappings for all pads (`*`) have no GUID
// in the library.
TEST(SdlDriver, TheLibrarysTextHasTheLinesThatSdlHas) {
  find_sdl_devices();  // starts SDL
  std::vector<std::string> all = sdl_library_lines();
  ASSERT_GT(all.size(), 100u);
  for (int i = 0; i < SDL_GameControllerNumMappings(); ++i) {
    char* line = SDL_GameControllerMappingForIndex(i);
    const std::string text = line;
    SDL_free(line);
    if (text.find(",*,") != std::string::npos || text.find(",crc:") != std::string::npos) continue;
    EXPECT_TRUE(std::ranges::any_of(all, [&](const auto& l) { return text.starts_with(l); }))
        << text;
  }
}

TEST(SdlDriver, LinesThatCountTheKernelsCodesAreForNodesOnly) {
  DeviceInfo device = device_with(BusType::usb, 0x054c, 0x0ce6, 0x8111);
  const auto first = [&](const char* driver) {
    device.driver = driver;
    const std::string line = sdl_mapping_of(device);
    return line.find(",a:b0,") != std::string::npos ? "a" : line.empty() ? "none" : "x";
  };
  EXPECT_STREQ(first("evdev"), "a");
  EXPECT_STREQ(first("hidraw"), "x");
  device.version = 0x0111;
  EXPECT_STREQ(first("evdev"), "x");
  EXPECT_STREQ(first("usb"), "x");
  // Nintendo prints A on the right button; for us and SDL, A is the bottom one.
  device = device_with(BusType::usb, 0x057e, 0x2009, 0x8111);
  EXPECT_STREQ(first("evdev"), "a");
}

TEST(SdlDriver, WhatTheDataBaseDoesNotKnowIsNotGuessed) {
  VirtualPad pad("Guessed Pad");
  const auto listing = listing_of("Guessed Pad");
  ASSERT_TRUE(listing);
  EXPECT_EQ(sdl_mapping_of(device_with(BusType::usb, 0x1209, 0x0001, 0x0100)), "");
  EXPECT_EQ(sdl_mapping_of(listing->info), "");
  EXPECT_EQ(sdl_mapping_of(DeviceInfo{}), "");
}

TEST(SdlDriver, EveryLineOfTheDataBaseIsUnderstood) {
  VirtualPad pad("Any Pad");
  const auto device = opened("Any Pad");
  DeviceInfo info = device->info();
  ASSERT_GT(SDL_GameControllerNumMappings(), 100);
  for (int i = 0; i < SDL_GameControllerNumMappings(); ++i) {
    char* line = SDL_GameControllerMappingForIndex(i);
    info.mapping = line;
    SDL_free(line);
    const auto descriptor = parse_descriptor(info.descriptor);
    ASSERT_TRUE(descriptor);
    const auto controls = sdl_controls(info.mapping, *descriptor, "sdl");
    EXPECT_TRUE(controls) << info.mapping << ": " << (controls ? "" : controls.error().message);
  }
}

// SDL reads the mapping that is written for a pad with a turned left stick, and its game controller
// moves like the pad in that frame.
TEST(SdlDriver, SdlReadsTheLineThatIsWritten) {
  VirtualPad pad("Written Pad");
  EvdevAbilities abilities;
  for (std::uint16_t code = 0; code < 6; ++code) abilities.axes.push_back({code, -32768, 32767});
  for (std::uint16_t i = 0; i < 11; ++i)
    abilities.keys.push_back(static_cast<std::uint16_t>(evdev::kBtnGamepad + i));
  DeviceInfo info = listing_of("Written Pad").value().info;
  info.driver = "evdev";
  info.mapping.clear();
  info.descriptor = evdev_layout(abilities, {}).descriptor;
  const auto layout = pad_layout(info, {});
  ASSERT_TRUE(layout);
  StickAxes sticks = kAxesAsLaidOut;
  sticks[kLeftX] = {kLeftY, false};
  sticks[kLeftY] = {kLeftX, true};
  info.product = 0x0077;  // other ids than those of other tests, because SDL keeps every mapping
  auto line = sdl_mapping_text(info, *layout, sticks);
  ASSERT_TRUE(line) << line.error().message;
  Uint16 vendor = 0, product = 0, version = 0, checksum = 1;
  const SDL_JoystickGUID guid = SDL_JoystickGetGUIDFromString(line->substr(0, 32).c_str());
  SDL_GetJoystickGUIDInfo(guid, &vendor, &product, &version, &checksum);
  EXPECT_EQ(vendor, 0x1209);
  EXPECT_EQ(product, 0x0077);
  EXPECT_EQ(version, info.version);
  EXPECT_EQ(checksum, 0);
  ASSERT_EQ(SDL_GameControllerAddMapping(line->c_str()), 1) << SDL_GetError();

  // The GUID of a virtual joystick has a mark that an event node's lacks.
  char own_guid[33] = {};
  SDL_JoystickGetGUIDString(SDL_JoystickGetGUID(pad.joystick), own_guid, sizeof own_guid);
  line->replace(0, 32, own_guid);
  ASSERT_GE(SDL_GameControllerAddMapping(line->c_str()), 0) << SDL_GetError();
  int index = 0;
  while (index < SDL_NumJoysticks() &&
         SDL_JoystickGetDeviceInstanceID(index) != SDL_JoystickInstanceID(pad.joystick)) {
    ++index;
  }
  SDL_GameController* controller = SDL_GameControllerOpen(index);
  ASSERT_NE(controller, nullptr) << SDL_GetError();
  SDL_JoystickSetVirtualAxis(pad.joystick, 0, 20000);  // the stick moves to the right
  SDL_JoystickSetVirtualAxis(pad.joystick, 1, 10000);  // the stick moves towards the player
  SDL_JoystickSetVirtualButton(pad.joystick, 0, 1);
  SDL_JoystickUpdate();
  // In the turned frame, what the layout calls forward is right and what it calls left is forward,
  // so a move to the right now goes backwards.
  EXPECT_NEAR(SDL_GameControllerGetAxis(controller, SDL_CONTROLLER_AXIS_LEFTX), -10000, 1);
  EXPECT_NEAR(SDL_GameControllerGetAxis(controller, SDL_CONTROLLER_AXIS_LEFTY), 20000, 1);
  EXPECT_EQ(SDL_GameControllerGetButton(controller, SDL_CONTROLLER_BUTTON_A), 1);
  SDL_GameControllerClose(controller);
}

}  // namespace
}  // namespace gaitpad
#endif  // GAITPAD_HAS_SDL
