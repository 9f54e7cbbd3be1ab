// A surface shows what was drawn on it.
#include "view/surface.h"

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "tests/own_folder.h"
#include "view/offscreen.h"

namespace gaitpad {
namespace {

using Rgb = std::array<int, 3>;

Rgb at(const Pixels& pixels, int x, int y) {
  const std::uint8_t* p = pixels.rgba.data() + 4 * (y * pixels.width + x);
  return {p[0], p[1], p[2]};
}

// Three bars on top of each other in the lower left quarter, red on green; the rest blue.
Pixels drawn_corner(int width, int height) {
  const auto fill = [](int x, int y, int w, int h, float red, float green, float blue) {
    glScissor(x, y, w, h);
    glClearColor(red, green, blue, 0.25f);
    glClear(GL_COLOR_BUFFER_BIT);
  };
  glEnable(GL_SCISSOR_TEST);
  fill(0, 0, width, height, 0, 0, 1);
  fill(0, 0, width / 2, height / 2, 0, 1, 0);
  fill(0, 0, width / 2, height / 4, 1, 0, 0);
  glDisable(GL_SCISSOR_TEST);
  return read_pixels(width, height);
}

TEST(Surface, PixelsAreReadFromTheTopAndAreOpaque) {
  GAITPAD_OFFSCREEN(surface, 101, 80);
  int width = 0, height = 0;
  surface.size(width, height);
  ASSERT_EQ(width, 101);
  ASSERT_EQ(height, 80);
  surface.begin();
  const Pixels pixels = drawn_corner(width, height);
  EXPECT_EQ(at(pixels, 2, 2), (Rgb{0, 0, 255}));
  EXPECT_EQ(at(pixels, 2, 45), (Rgb{0, 255, 0}));
  EXPECT_EQ(at(pixels, 2, 79), (Rgb{255, 0, 0}));
  EXPECT_EQ(at(pixels, 98, 79), (Rgb{0, 0, 255}));
  for (std::size_t i = 3; i < pixels.rgba.size(); i += 4) ASSERT_EQ(pixels.rgba[i], 255);
}

TEST(Surface, ScaleMultipliesThePixels) {
  GAITPAD_OFFSCREEN(surface, 320, 180, 2.0);
  int width = 0, height = 0;
  surface.size(width, height);
  EXPECT_EQ(width, 640);
  EXPECT_EQ(height, 360);
  EXPECT_EQ(surface.scale(), 2.0);
}

TEST(Surface, AWindowThatIsMadeLargerHasMorePixels) {
  GAITPAD_OFFSCREEN(surface, 320, 180);
  surface.begin();
  EXPECT_EQ(at(drawn_corner(320, 180), 319, 0), (Rgb{0, 0, 255}));
  surface.show();
  SDL_SetWindowSize(surface.window(), 500, 300);
  SDL_PumpEvents();
  surface.begin();
  int width = 0, height = 0;
  surface.size(width, height);
  EXPECT_EQ(width, 500);
  EXPECT_EQ(height, 300);
  EXPECT_EQ(at(drawn_corner(500, 300), 499, 0), (Rgb{0, 0, 255}));
}

// As in the program, the driver starts and reads SDL's joysticks on its own thread, at any time
// after the window was opened, and they outlive the window.
TEST(Surface, JoysticksOnAnotherThreadOutliveTheWindow) {
  {
    GAITPAD_OFFSCREEN(surface, 64, 64);
    std::thread driver([] {
      ASSERT_EQ(SDL_InitSubSystem(SDL_INIT_JOYSTICK), 0);
      for (int i = 0; i < 20; ++i) SDL_JoystickUpdate();
      SDL_TLSCleanup();
    });
    for (int i = 0; i < 20; ++i) {
      SDL_Event event;
      while (SDL_PollEvent(&event)) continue;
      surface.show();
    }
    driver.join();
  }
  EXPECT_EQ(SDL_WasInit(SDL_INIT_VIDEO), 0u);
  EXPECT_NE(SDL_WasInit(SDL_INIT_JOYSTICK), 0u);
  SDL_QuitSubSystem(SDL_INIT_JOYSTICK);
}

TEST(Surface, WithoutADisplayAWindowIsRefusedAndItSaysWhatWorks) {
  const Environment x11("DISPLAY", nullptr), wayland("WAYLAND_DISPLAY", nullptr),
      folder("XDG_RUNTIME_DIR", "/nowhere"), driver("SDL_VIDEODRIVER", nullptr);
  SurfaceOptions options;
  options.width = options.height = 64;
  const auto surface = WindowSurface::open(options);
  if (surface) GTEST_SKIP() << "this machine's console is a display";
  EXPECT_NE(surface.error().message.find("no display"), std::string::npos);
  EXPECT_NE(surface.error().message.find("--screenshot"), std::string::npos);
  EXPECT_EQ(SDL_WasInit(SDL_INIT_VIDEO), 0u);
}

TEST(Surface, AnUnknownDisplayIsNamed) {
  const Environment driver("SDL_VIDEODRIVER", "no_such_driver");
  const auto surface = WindowSurface::open(SurfaceOptions{});
  ASSERT_FALSE(surface);
  EXPECT_NE(surface.error().message.find("no_such_driver"), std::string::npos)
      << surface.error().message;
}

}  // namespace
}  // namespace gaitpad
