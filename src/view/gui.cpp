#include "view/gui.h"

#include <backends/imgui_impl_opengl3.h>
#include <backends/imgui_impl_sdl.h>
#include <imgui.h>
#include <imgui_freetype.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <vector>

#include "draw/theme.h"
#include "system/whole_file.h"
#include "view/ui.h"

namespace gaitpad {
namespace {

constexpr double kBodyPixels = 14.5, kSmallPixels = 12.0, kTickPixels = 10.5, kTitlePixels = 17.0;
constexpr double kLeastScale = 0.5, kMaxAsked = 4.0;
constexpr double kMaxScale = kMaxAsked * kMostTypeSize;
constexpr double kMaxDisplayScale = 3.0;  // a larger scale of a display is assumed to be wrong
constexpr double kUsualDotsPerInch = 96.0;
constexpr std::size_t kMaxFontBytes = 64 << 20;

struct FontFiles {
  std::string family, regular, semibold;
};

// The user's own font first, then that of Debian's fonts-dejavu-core. Other installed fonts are not
// used, so that the window looks the same on every machine.
std::vector<FontFiles> candidates() {
  std::vector<FontFiles> all;
  if (const char* own = std::getenv("GAITPAD_FONT"); own != nullptr && *own != '\0') {
    all.push_back({own, own, own});
  }
  const std::string dejavu = "/usr/share/fonts/truetype/dejavu/DejaVuSans";
  all.push_back({"DejaVu Sans", dejavu + ".ttf", dejavu + "-Bold.ttf"});
  return all;
}

// Latin, Greek and Cyrillic for names, punctuation, arrows, mathematics and simple shapes.
constexpr ImWchar kRanges[] = {0x0020, 0x024f, 0x0370, 0x03ff, 0x0400, 0x04ff, 0x2010, 0x2044,
                               0x2190, 0x21ff, 0x2200, 0x22ff, 0x25a0, 0x25ff, 0};

ImFont* add_font(const std::string& bytes, double pixels) {
  ImGuiIO& io = ImGui::GetIO();
  ImFontConfig config;
  config.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
  config.GlyphRanges = kRanges;
  config.SizePixels = static_cast<float>(std::round(pixels));
  if (bytes.empty()) return io.Fonts->AddFontDefault(&config);
  void* copy = IM_ALLOC(bytes.size());  // the atlas frees it
  std::memcpy(copy, bytes.data(), bytes.size());
  return io.Fonts->AddFontFromMemoryTTF(copy, static_cast<int>(bytes.size()), config.SizePixels,
                                        &config, kRanges);
}

// Returns empty fonts if a file is not a font, which is known only when the atlas is built.
Fonts fonts_of(const std::string& family, const std::string& regular, const std::string& semibold,
               double scale) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  atlas.Clear();
  atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
  Fonts fonts;
  fonts.body = add_font(regular, kBodyPixels * scale);
  fonts.small = add_font(regular, kSmallPixels * scale);
  fonts.tick = add_font(regular, kTickPixels * scale);
  fonts.heading = add_font(semibold, kBodyPixels * scale);
  fonts.title = add_font(semibold, kTitlePixels * scale);
  fonts.family = family;
  return atlas.Build() ? fonts : Fonts{};
}

struct StyleColour {
  ImGuiCol index;
  Colour colour;
};

void set_colours(const Theme& theme, ImGuiStyle& style) {
  const Colour none{0.0, 0.0, 0.0, 0.0};
  const StyleColour colours[] = {
      {ImGuiCol_Text, theme.text},
      {ImGuiCol_TextDisabled, theme.secondary},
      {ImGuiCol_WindowBg, theme.panel},
      {ImGuiCol_ChildBg, none},
      {ImGuiCol_PopupBg, theme.card},
      {ImGuiCol_Border, theme.edge},
      {ImGuiCol_FrameBg, theme.frame},
      {ImGuiCol_FrameBgHovered, faint(theme.accent, 0.35)},
      {ImGuiCol_FrameBgActive, faint(theme.accent, 0.5)},
      {ImGuiCol_ScrollbarBg, none},
      {ImGuiCol_ScrollbarGrab, faint(theme.secondary, kScrollShare)},
      {ImGuiCol_ScrollbarGrabHovered, faint(theme.secondary, 0.8)},
      {ImGuiCol_ScrollbarGrabActive, faint(theme.secondary, 0.95)},
      {ImGuiCol_CheckMark, theme.left},
      {ImGuiCol_SliderGrab, theme.left},
      {ImGuiCol_SliderGrabActive, theme.left},
      {ImGuiCol_Button, theme.frame},
      {ImGuiCol_ButtonHovered, faint(theme.accent, 0.55)},
      {ImGuiCol_ButtonActive, faint(theme.accent, 0.8)},
      {ImGuiCol_Header, faint(theme.accent, kChosenShare)},
      {ImGuiCol_HeaderHovered, faint(theme.accent, 0.55)},
      {ImGuiCol_HeaderActive, faint(theme.accent, 0.8)},
      {ImGuiCol_Separator, theme.border},
      {ImGuiCol_TextSelectedBg, faint(theme.accent, 0.6)},
      {ImGuiCol_NavHighlight, theme.accent},
      {ImGuiCol_ModalWindowDimBg, Colour{0.0, 0.0, 0.0, 0.45}},
  };
  for (const StyleColour& entry : colours) {
    style.Colors[entry.index] = imgui_colour(entry.colour);
  }
}

double bounded(double scale) noexcept {
  return std::isfinite(scale) ? std::clamp(scale, kLeastScale, kMaxScale) : 1.0;
}

}  // namespace

Fonts load_fonts(double scale) {
  const double pixels = bounded(scale);
  for (const FontFiles& files : candidates()) {
    const auto regular = file_text(files.regular, kMaxFontBytes);
    if (!regular || regular->empty()) continue;
    const auto semibold = file_text(files.semibold, kMaxFontBytes);
    const bool has_semibold = semibold && !semibold->empty();
    Fonts fonts = fonts_of(files.family, *regular, has_semibold ? *semibold : *regular, pixels);
    if (fonts.body != nullptr) return fonts;
  }
  return fonts_of("built in", "", "", pixels);
}

void apply_style(const Theme& theme, double scale) {
  ImGuiStyle style;
  style.WindowPadding = {14.0f, 12.0f};
  style.FramePadding = {10.0f, 6.0f};
  style.ItemSpacing = {8.0f, 7.0f};
  style.ItemInnerSpacing = {6.0f, 4.0f};
  style.WindowRounding = 0.0f;
  style.ChildRounding = 6.0f;
  style.FrameRounding = 5.0f;
  style.PopupRounding = 6.0f;
  style.GrabRounding = 4.0f;
  style.GrabMinSize = 10.0f;
  style.ScrollbarSize = 10.0f;
  style.WindowBorderSize = 0.0f;
  style.ChildBorderSize = 0.0f;
  style.FrameBorderSize = 1.0f;
  style.WindowMinSize = {8.0f, 8.0f};
  style.DisabledAlpha = 0.5f;
  style.ScaleAllSizes(static_cast<float>(bounded(scale)));
  set_colours(theme, style);
  ImGui::GetStyle() = style;
}

double display_scale(double asked, double dots_per_inch) noexcept {
  if (asked > 0.0) return std::min(bounded(asked), kMaxAsked);
  if (const char* text = std::getenv("GDK_SCALE"); text != nullptr) {
    if (const double scale = std::strtod(text, nullptr); scale > 0.0)
      return std::min(bounded(scale), kMaxAsked);
  }
  if (!(dots_per_inch > 0.0) || !std::isfinite(dots_per_inch)) return 1.0;
  return std::clamp(dots_per_inch / kUsualDotsPerInch, 1.0, kMaxDisplayScale);
}

Gui::Gui(const WindowSurface& surface) : scale_(surface.scale()) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // ImGui writes no file: view/layout.h stores the layout
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

void Gui::set_scale(double scale) {
  scale_ = scale;
  fonts_ = load_fonts(scale_);
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  ImGui_ImplOpenGL3_CreateFontsTexture();
}

void Gui::handle_event(const SDL_Event& event) { ImGui_ImplSDL2_ProcessEvent(&event); }

TakenInput Gui::taken_input() const noexcept {
  const ImGuiIO& io = ImGui::GetIO();
  return {io.WantTextInput, io.WantCaptureMouse};
}

void Gui::begin(const Mouse& mouse, double passed_s) {
  ImGui_ImplOpenGL3_NewFrame();
  // Frees ImGui's copy of the pixels, which the texture holds now.
  ImGui::GetIO().Fonts->ClearTexData();
  ImGui_ImplSDL2_NewFrame();
  // The back end asks SDL for the pointer, which does not exist offscreen, so use the pointer's
  // place from the events.
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

void Gui::end_undrawn() { ImGui::EndFrame(); }

ImVec4 imgui_colour(const Colour& c) noexcept {
  return {static_cast<float>(c.red), static_cast<float>(c.green), static_cast<float>(c.blue),
          static_cast<float>(c.alpha)};
}

ImU32 packed(const Colour& colour) noexcept {
  const auto byte = [](double value) {
    return static_cast<ImU32>(std::clamp(value, 0.0, 1.0) * 255.0 + 0.5);
  };
  return IM_COL32(byte(colour.red), byte(colour.green), byte(colour.blue), byte(colour.alpha));
}

}  // namespace gaitpad
