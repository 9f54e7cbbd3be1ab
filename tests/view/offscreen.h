// A surface in memory for tests that draw. Without OpenGL these tests are skipped, with the reason.
#pragma once
#include <gtest/gtest.h>

#include "view/surface.h"

namespace gaitpad {

inline SurfaceOptions hidden(int width, int height, double scale = 1.0) {
  SurfaceOptions options;
  options.width = width;
  options.height = height;
  options.scale = scale;
  options.is_hidden = true;
  return options;
}

// Declares `name`, a reference to a surface, or skips the test.
#define GAITPAD_OFFSCREEN(name, ...)                                 \
  auto name##_opened = WindowSurface::open(hidden(__VA_ARGS__));     \
  if (!name##_opened) GTEST_SKIP() << name##_opened.error().message; \
  WindowSurface& name = **name##_opened

}  // namespace gaitpad
