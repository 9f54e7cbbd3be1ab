// Streams in a host program that also uses SDL, hidapi and libusb.
#if defined(GAITPAD_HAS_SDL) && defined(GAITPAD_HAS_HIDRAW) && defined(GAITPAD_HAS_USB)
#include <SDL2/SDL.h>
#include <gtest/gtest.h>
#include <hidapi/hidapi.h>
#include <libusb-1.0/libusb.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "gaitpad/driver_registry.h"
#include "gaitpad/pad_stream.h"
#include "tests/comes_true.h"
#include "tests/pads/fake_drivers.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

std::unique_ptr<PadStream> stream_of(FakeBus& bus) {
  PadStreamOptions options;
  options.drivers = FakeBus::table();
  options.changes_fd = bus.changes_fd();
  return value_of(PadStream::start(std::move(options)));
}

// Neither a pad without an entry in any file starts SDL, nor a twin PlayStation 2 adapter, whose
// entry is only in SDL's library.
TEST(Guest, SdlIsNotStartedForAPadsMapping) {
  DeviceInfo twin;
  twin.bus = BusType::usb;
  twin.vendor = 0x0810;
  twin.product = 0x0001;
  twin.version = 0x0110;
  EXPECT_NE(sdl_mapping_of(twin).find(",leftx:a0,"), std::string::npos);
  FakeBus bus;
  bus.show(kHidraw, bus.make(kHidraw, "A", "port1"));
  const auto stream = stream_of(bus);
  EXPECT_TRUE(comes_true([&] { return stream->front() != nullptr; }));
  EXPECT_EQ(SDL_WasInit(SDL_INIT_JOYSTICK | SDL_INIT_EVENTS), 0u);
}

TEST(Guest, AHostsOwnLibrariesRunBesideTwoStreams) {
  FakeBus bus;
  bus.show(kHidraw, bus.make(kHidraw, "A", "port1"));
  ASSERT_EQ(SDL_SetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, "0"), SDL_TRUE);
  std::atomic<bool> stop{false};
  std::atomic<int> rounds{0};
  std::thread host([&] {
    while (!stop) {
      EXPECT_EQ(SDL_InitSubSystem(SDL_INIT_JOYSTICK), 0);
      SDL_JoystickUpdate();
      SDL_QuitSubSystem(SDL_INIT_JOYSTICK);
      hid_free_enumeration(hid_enumerate(0x1209, 0x0001));
      libusb_context* context = nullptr;
      if (libusb_init(&context) == LIBUSB_SUCCESS) libusb_exit(context);
      ++rounds;
    }
    SDL_TLSCleanup();
  });
  const auto one = stream_of(bus);
  const auto other = value_of(PadStream::start({}));  // a second stream, with the machine's drivers
  EXPECT_TRUE(comes_true([&] { return one->front() != nullptr && rounds > 3; }));
  stop = true;
  host.join();
  EXPECT_STREQ(SDL_GetHint(SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS), "0");
  EXPECT_EQ(SDL_WasInit(SDL_INIT_JOYSTICK), 0u);
}

}  // namespace
}  // namespace gaitpad
#endif
