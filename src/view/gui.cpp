#include "view/gui.h"

#include <backends/imgui_impl_opengl3.h>
#include <backends/imgui_impl_sdl.h>
#include <imgui.h>

#include <cfloat>

namespace gaitpad {

Gui::Gui(const WindowSurface& surface) : scale_(surface.scale()) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // view/layout.h remembers
  io.LogFilename = nullptr;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  fonts_ = load_fonts(scale_);
  ImGui_ImplSDL2_InitForOpenGL(surface.window(), surface.context());
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Gui::~Gui() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplSDL2_Shutdown();
  ImGui::DestroyContext();
}

void Gui::apply(const Theme& theme) { apply_style(theme, scale_); }

void Gui::take(const SDL_Event& event) { ImGui_ImplSDL2_ProcessEvent(&event); }

Taken Gui::taken() const noexcept {
  const ImGuiIO& io = ImGui::GetIO();
  return {io.WantTextInput, io.WantCaptureMouse};
}

void Gui::begin(const Mouse& mouse, double passed_s) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplSDL2_NewFrame();
  // The back end asks for the real pointer, which is none off the screen; events tell the same.
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = mouse.is_inside ? ImVec2(static_cast<float>(mouse.place_px.x),
                                         static_cast<float>(mouse.place_px.y))
                                : ImVec2(-FLT_MAX, -FLT_MAX);
  for (std::size_t i = 0; i < mouse.is_down.size(); ++i) io.MouseDown[i] |= mouse.is_down[i];
  if (passed_s > 0.0) io.DeltaTime = static_cast<float>(passed_s);
  ImGui::NewFrame();
}

void Gui::end() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace gaitpad
