#include "view/file_browser.h"

#include <gtest/gtest.h>

#include <fstream>

#include "view/ui_fixture.h"
#include "view/widgets.h"

namespace gaitpad {
namespace {

// Bytes that this process has read so far.
long long bytes_read() {
  std::ifstream file("/proc/self/io");
  std::string name;
  long long count = -1;
  file >> name >> count;
  return count;
}

class OpenBrowser : public UiTest {};

// The browser reads its bundled and recent files when it opens.
TEST_F(OpenBrowser, ReadsNoFileWhileItIsShown) {
  if (bytes_read() < 0) GTEST_SKIP() << "this kernel does not count what a process reads";
  FileBrowser browser("");
  browser.open({kSourceFolder + "/config"});
  const auto draw_browser = [&] {
    const UiInput input{*frame, cast, history};
    UiOutput out;
    ImGui::NewFrame();
    clear_items();
    Ui ui{input, theme_of(state.theme), fonts, 1.0f, state, out};
    browser.draw(ui, {1280.0f, 720.0f});
    ImGui::Render();
  };
  draw_browser();
  draw_browser();
  EXPECT_NE(find("browser bundled 0"), nullptr);
  const long long before = bytes_read();
  for (int i = 0; i < 60; ++i) draw_browser();
  EXPECT_LT(bytes_read() - before, 4096) << "in 60 frames";
}

}  // namespace
}  // namespace gaitpad
