#include "view/window.h"

#include "view/window_loop.h"

namespace gaitpad {

Result<WindowResult> run_window(const WindowOptions& options) {
  WindowLoop loop(options);
  if (auto problem = loop.open()) return *problem;
  return loop.run();
}

}  // namespace gaitpad
