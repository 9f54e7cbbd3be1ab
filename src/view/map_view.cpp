// The mapping dialog in the window, for pads with wrong axes or buttons.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "pads/mapping_dialog.h"
#include "view/pad_dialog.h"

namespace gaitpad {
namespace {

constexpr double kMapWidth = 760.0, kMapHeight = 320.0;  // the dialog's size at scale 1

class MapView final : public PadDialog {
 public:
  explicit MapView(std::unique_ptr<MappingDialog> mapping) : mapping_(std::move(mapping)) {}
  State draw(Ui& ui, const ImVec2& window_px, std::vector<std::string>& messages) override;

 private:
  void draw_prompt(Ui& ui);
  State keep(std::vector<std::string>& messages) const;

  std::unique_ptr<MappingDialog> mapping_;
};

void MapView::draw_prompt(Ui& ui) {
  const std::size_t steps = MappingDialog::step_count();
  std::string request = "Plug a pad in.";
  if (const char* prompt = mapping_->prompt()) {
    request = std::string(prompt) + ".";
    request[0] = static_cast<char>(request[0] - 'a' + 'A');
  } else if (mapping_->has_pad()) {
    request = "Let everything go.";
  }
  const bool has_pad = mapping_->has_pad();
  draw_step(ui,
            has_pad ? fmt::format("Control {} of {}", std::min(mapping_->step() + 1, steps), steps)
                    : "Which control is which",
            has_pad ? drawable(mapping_->pad().name) : "No pad is connected.", request);
  progress_bar(ui, static_cast<double>(mapping_->step()) / static_cast<double>(steps));
  if (!mapping_->last_found().empty()) note(ui, "Found: " + mapping_->last_found(), 1);
}

PadDialog::State MapView::keep(std::vector<std::string>& messages) const {
  const auto line = mapping_->keep("");
  messages.push_back(line ? fmt::format("{} controls are kept in {}; games that use SDL read the "
                                        "same line: {}",
                                        mapping_->found(), user_mapping_file(), *line)
                          : line.error().message);
  return State::ended;
}

PadDialog::State MapView::draw(Ui& ui, const ImVec2& window_px,
                               std::vector<std::string>& messages) {
  mapping_->look(std::chrono::milliseconds(0));
  std::ranges::move(mapping_->take_remarks(), std::back_inserter(messages));
  if (mapping_->is_done() || mapping_->has_ended()) {
    if (mapping_->has_left_stick()) return keep(messages);
    messages.emplace_back("the left stick was not found; nothing is kept");
    return State::ended;
  }
  State state = State::goes_on;
  const ImVec2 size = begin_modal(ui, "map", kMapWidth, kMapHeight, window_px);
  draw_prompt(ui);
  go_to_buttons(size.y);
  if (key_button(ui, "map skip", "The pad has none  (Enter)", SDLK_RETURN)) mapping_->skip();
  ImGui::SameLine();
  if (mapping_->has_left_stick()) {
    ButtonLook look;
    look.is_primary = true;
    if (button(ui, "map keep", "Keep what was found", look)) state = keep(messages);
    ImGui::SameLine();
  }
  if (button(ui, "map give up", "Give up  (Esc)")) state = State::ended;
  end_modal();
  return state;
}

}  // namespace

Result<std::unique_ptr<PadDialog>> start_mapping(const PadDialogOptions& options) {
  const auto files = load_pad_files(options.config_folders, options.map, "");
  if (!files) return files.error();
  auto mapping = MappingDialog::start(*files, options.selector);
  if (!mapping) return mapping.error();
  return std::unique_ptr<PadDialog>(new MapView(std::move(*mapping)));
}

}  // namespace gaitpad
