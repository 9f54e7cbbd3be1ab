// The panels of the window. A panel is an enumerator, a row of the table and a function that draws
// it: the button, the key, its line on the help page, the names in `window.toml` and `--panels`
// follow from the row.
#pragma once
#include <SDL2/SDL_keycode.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>

namespace gaitpad {

struct Ui;  // declared in view/widgets.h

enum class Panel : std::uint8_t { pad, control, style, graphs, solver, loop };

// Draw the content of a panel below its heading, over the width of the column.
void draw_pad_panel(Ui& ui);
void draw_control_panel(Ui& ui);
void draw_style_panel(Ui& ui);
void draw_graphs_panel(Ui& ui);
void draw_solver_panel(Ui& ui);
void draw_loop_panel(Ui& ui);

enum class PanelColumn { left, right };
// The subject of a panel: the session, the selected walker, or a walker that it changes.
enum class PanelSubject { session, walker, changed_walker };

struct PanelInfo {
  std::string_view id, title;  // words on its button; the id is also the name of its action
  SDL_Keycode key;             // key that opens and closes the panel
  PanelColumn column;          // its column while the window has two
  PanelSubject subject;
  void (*draw)(Ui& ui);
  constexpr std::string_view name() const noexcept { return id.substr(id.find(' ') + 1); }
};

// In the order of Panel, which is that of the columns and of the bar.
inline constexpr PanelInfo kPanelTable[] = {
    {"panel pad", "Pad", SDLK_F2, PanelColumn::left, PanelSubject::session, &draw_pad_panel},
    {"panel control", "Control", SDLK_F3, PanelColumn::left, PanelSubject::changed_walker,
     &draw_control_panel},
    {"panel style", "Style", SDLK_F4, PanelColumn::left, PanelSubject::changed_walker,
     &draw_style_panel},
    {"panel graphs", "Graphs", SDLK_F5, PanelColumn::right, PanelSubject::walker,
     &draw_graphs_panel},
    {"panel solver", "Solver", SDLK_F6, PanelColumn::right, PanelSubject::walker,
     &draw_solver_panel},
    {"panel loop", "Loop", SDLK_F7, PanelColumn::right, PanelSubject::session, &draw_loop_panel},
};
inline constexpr int kPanels = static_cast<int>(std::size(kPanelTable));
inline constexpr auto kPanelNames = [] {
  std::array<std::string_view, kPanels> names;
  for (std::size_t i = 0; i < names.size(); ++i) names[i] = kPanelTable[i].name();
  return names;
}();

}  // namespace gaitpad
