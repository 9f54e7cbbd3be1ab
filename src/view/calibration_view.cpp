#include <SDL2/SDL_scancode.h>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <optional>

#include "pads/calibration_store.h"
#include "pads/guided_calibration.h"
#include "stick_picture/stick_picture.h"
#include "view/pad_dialog.h"

namespace gaitpad {
namespace {

// The dialog's size at scale 1.
constexpr double kCalibrationWidth = 900.0, kCalibrationHeight = 600.0;
constexpr double kWaitingHeight = 150.0;
// Usual and least side of a control's picture, at scale 1.
constexpr double kPlane = 150.0, kLeastPlane = 64.0;
// Room that the guide's buttons need in one row, at scale 1.
constexpr double kButtonsWidth = 690.0;
constexpr const char* kTitles[] = {"Left stick", "Right stick"};

std::string shown_name(const DeviceInfo& info) {
  const std::string name = drawable(info.name);
  return name.empty() ? fmt::format("{:04x}:{:04x}", info.vendor, info.product) : name;
}

ImVec2 operator+(const ImVec2& a, const ImVec2& b) { return {a.x + b.x, a.y + b.y}; }

// Places the next button beside the last one, or below it if the dialog is too narrow.
void go_beside_or_below(const Ui& ui, const char* label) {
  const float end =
      ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + button_width(ui, label, {});
  if (end <= ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
}

// Draws a stick's raw position in a circle, or a trigger's as a bar.
void draw_place(Ui& ui, const GuideProgress& control, bool is_stick, const ImVec2& at, float size) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto clamped = [](double v) { return static_cast<float>(std::clamp(v, -1.0, 1.0)); };
  list.AddRectFilled(at, at + ImVec2(size, size), packed(ui.theme.plot), ui.px(5));
  const ImVec2 middle = at + ImVec2(size / 2, size / 2);
  const float reach = size * 0.44f;
  if (is_stick) {
    list.AddCircle(middle, reach, packed(ui.theme.border), 48, ui.px(1.5));
    list.AddLine(middle + ImVec2(-reach, 0), middle + ImVec2(reach, 0), packed(ui.theme.border));
    list.AddLine(middle + ImVec2(0, -reach), middle + ImVec2(0, reach), packed(ui.theme.border));
    list.AddCircleFilled(
        middle + ImVec2(clamped(control.raw.x) * reach, -clamped(control.raw.y) * reach), ui.px(6),
        packed(ui.theme.left));
    return;
  }
  const float filled = 2.0f * reach * std::max(clamped(control.raw.x), 0.0f);
  const ImVec2 low = middle + ImVec2(-ui.px(14), reach), high = middle + ImVec2(ui.px(14), -reach);
  list.AddRectFilled(ImVec2(low.x, high.y), ImVec2(high.x, low.y), packed(ui.theme.frame),
                     ui.px(4));
  list.AddRectFilled(ImVec2(low.x, low.y - filled), ImVec2(high.x, low.y), packed(ui.theme.left),
                     ui.px(4));
}

class CalibrationView final : public PadDialog {
 public:
  CalibrationView(const PadDialogOptions& options, PadFiles files,
                  std::unique_ptr<GuidedCalibration> guided)
      : options_(options), files_(std::move(files)), guided_(std::move(guided)) {}
  ~CalibrationView() override {
    if (texture_ != 0) glDeleteTextures(1, &texture_);
  }
  State draw(Ui& ui, const ImVec2& window_px, std::vector<std::string>& messages) override;

 private:
  void read_pad(std::vector<std::string>& messages);
  void finish(std::vector<std::string>& messages);
  void draw_guide(Ui& ui, CalibrationGuide& guide, float height_px);
  void draw_control(Ui& ui, const GuideProgress& control, bool is_stick, float size_px);
  void draw_result(Ui& ui, float height_px);
  void draw_guide_buttons(Ui& ui, CalibrationGuide& guide);
  void draw_result_buttons(Ui& ui, std::vector<std::string>& messages);
  void upload_picture();

  const PadDialogOptions options_;
  const PadFiles files_;
  std::unique_ptr<GuidedCalibration> guided_;  // null once the guide is done
  bool is_pad_told_ = false;
  State state_ = State::goes_on;
  // Set once the guide is done.
  GuidedPad pad_;
  std::optional<PadAnalysis> analysis_;
  CalibrationFile file_;
  std::string target_, problem_;
  unsigned texture_ = 0;
  int picture_width_ = 0, picture_height_ = 0;
};

void CalibrationView::read_pad(std::vector<std::string>& messages) {
  if (!guided_) return;
  guided_->look(std::chrono::milliseconds(0));
  std::ranges::move(guided_->take_remarks(), std::back_inserter(messages));
  CalibrationGuide* guide = guided_->guide();
  if (guide == nullptr) {
    if (!guided_->has_ended()) return;
    messages.emplace_back("no pad was found that can be calibrated");
    state_ = State::ended;
    return;
  }
  if (!is_pad_told_) {
    is_pad_told_ = true;
    const std::string remark = driver_remark(guided_->pad());
    if (!remark.empty()) messages.push_back(shown_name(guided_->pad()) + ": " + remark);
    if (guide->steps().size() <= 1) {  // the only step is `done`
      messages.push_back(shown_name(guided_->pad()) + ": has no stick to calibrate");
      state_ = State::ended;
      return;
    }
  }
  if (guide->step() == GuideStep::done) finish(messages);
}

// Analyses the recorded tracks and releases the pad.
void CalibrationView::finish(std::vector<std::string>& messages) {
  pad_ = guided_->finish();
  guided_.reset();
  analysis_ = analysis_of(pad_.layout, pad_.tracks, pad_.frame);
  for (std::string& question : axes_questions(pad_)) messages.push_back(std::move(question));
  if (!is_useful(*analysis_)) problem_ = "no stick is known well enough: nothing to save";
  file_ = calibration_for(pad_.info, pad_.has_factory_sticks);
  const std::string own = options_.calibration_folder.empty()
                              ? ""
                              : calibration_path(options_.calibration_folder, file_);
  const auto target = calibration_target(own, file_);
  if (target) {
    target_ = *target;
    take_what_holds(files_, pad_.info, target_, file_, messages);
  } else {
    problem_ = target.error().message;
  }
  take_advice(*analysis_, file_);
  take_gyro_bias(pad_, file_);
  file_.measured_on = today();
  upload_picture();
}

void CalibrationView::upload_picture() {
  std::vector<StickPicture> pictures;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto& stick = analysis_->stick[i];
    if (stick) pictures.push_back({kTitles[i], stick->tracks, &stick->statistics, &stick->advice});
  }
  const Surface surface =
      stick_picture(fmt::format("{}, {}", shown_name(pad_.info), today()), pictures);
  cairo_surface_flush(surface.get());
  const unsigned char* bytes = cairo_image_surface_get_data(surface.get());
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS || bytes == nullptr) return;
  picture_width_ = cairo_image_surface_get_width(surface.get());
  picture_height_ = cairo_image_surface_get_height(surface.get());
  glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  // Cairo stores a pixel as a number in the machine's byte order; its upper byte is unused.
  glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, picture_width_, picture_height_, 0, GL_BGRA,
               GL_UNSIGNED_INT_8_8_8_8_REV, bytes);
  glGenerateMipmap(GL_TEXTURE_2D);
  glBindTexture(GL_TEXTURE_2D, 0);
}

void CalibrationView::draw_control(Ui& ui, const GuideProgress& control, bool is_stick,
                                   float size_px) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  draw_place(ui, control, is_stick, at, size_px);
  ImGui::Dummy(ImVec2(size_px, size_px));
  ImGui::SameLine(0.0f, ui.px(16));
  ImGui::BeginGroup();
  text_line(ui, ui.fonts.heading, ui.theme.text, control.control);
  progress_bar(ui, control.done);
  note(ui, control.text, 4);
  ImGui::EndGroup();
  keep_area("calibration of the " + control.control, at, ImGui::GetItemRectMax());
}

// The guide scrolls if the window is lower than the text and the smallest pictures.
void CalibrationView::draw_guide(Ui& ui, CalibrationGuide& guide, float height_px) {
  ImGui::BeginChild("guide", ImVec2(0.0f, height_px - ImGui::GetCursorPosY()));
  draw_step(ui,
            fmt::format("Step {} of {}: {}", guide.index() + 1, guide.steps().size() - 1,
                        name_of(guide.step())),
            shown_name(guided_->pad()),
            guided_->is_plugged() ? guide.instruction()
                                  : "Unplugged: plug it in again to continue from here.");
  const bool is_of_sticks = guide.step() != GuideStep::triggers;
  const auto controls = guide.progress();
  const float gap_px = ui.px(8), spacing_px = gap_px + 2.0f * ImGui::GetStyle().ItemSpacing.y;
  const float each_px = ImGui::GetContentRegionAvail().y /
                            static_cast<float>(std::max<std::size_t>(controls.size(), 1)) -
                        spacing_px;
  const float size_px = std::clamp(each_px, ui.px(kLeastPlane), ui.px(kPlane));
  for (const GuideProgress& control : controls) {
    draw_control(ui, control, is_of_sticks, size_px);
    ImGui::Dummy(ImVec2(0.0f, gap_px));
  }
  ImGui::EndChild();
}

void CalibrationView::draw_result(Ui& ui, float height_px) {
  text_line(ui, ui.fonts.title, ui.theme.text, "What was measured");
  for (std::size_t i = 0; i < 2; ++i) {
    if (!analysis_->stick[i]) continue;
    const StickAdvice& advice = analysis_->stick[i]->advice;
    note(ui, fmt::format("{}: {}. {}", kTitles[i], name_of(advice.verdict), advice.reason), 3);
  }
  if (texture_ == 0) return;
  const float left_px = height_px - ImGui::GetCursorPosY();
  const ImVec2 room(ImGui::GetContentRegionAvail().x, std::max(left_px, ui.px(60)));
  ImGui::BeginChild("picture", room, true);
  const float width = ImGui::GetContentRegionAvail().x;
  const float height =
      width * static_cast<float>(picture_height_) / static_cast<float>(picture_width_);
  ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture_)),
               ImVec2(width, height));
  ImGui::EndChild();
}

void CalibrationView::draw_guide_buttons(Ui& ui, CalibrationGuide& guide) {
  ButtonLook next;
  next.is_primary = true;
  if (key_button(ui, "calibration skip", "Next  (Enter)", SDLK_RETURN, next)) guide.skip();
  ImGui::SameLine();
  if (key_button(ui, "calibration repeat", "Repeat  (R)", SDLK_r)) guide.repeat();
  ImGui::SameLine();
  if (key_button(ui, "calibration back", "Back  (B)", SDLK_b)) guide.back();
}

void CalibrationView::draw_result_buttons(Ui& ui, std::vector<std::string>& messages) {
  ButtonLook save;
  save.is_primary = true;
  save.is_enabled = problem_.empty();
  if (button(ui, "calibration save", "Save", save) && problem_.empty()) {
    if (auto wrong = save_calibration(target_, file_, calibration_comments(*analysis_))) {
      messages.push_back(wrong->message);
    } else {
      messages.push_back("the calibration is saved in " + target_);
      state_ = State::calibrated;
    }
  }
}

PadDialog::State CalibrationView::draw(Ui& ui, const ImVec2& window_px,
                                       std::vector<std::string>& messages) {
  read_pad(messages);
  CalibrationGuide* guide = guided_ ? guided_->guide() : nullptr;
  const bool is_waiting = guide == nullptr && !analysis_;  // a pad is not there yet
  const ImVec2 size = begin_modal(ui, "calibration", kCalibrationWidth,
                                  is_waiting ? kWaitingHeight : kCalibrationHeight, window_px);
  const ImGuiStyle& style = ImGui::GetStyle();
  const bool has_two_rows = guide != nullptr && size.x < ui.px(kButtonsWidth);
  const float buttons_y = size.y - ImGui::GetFrameHeight() - style.WindowPadding.y -
                          (has_two_rows ? ImGui::GetFrameHeightWithSpacing() : 0.0f);
  if (guide != nullptr) {
    draw_guide(ui, *guide, buttons_y - ui.px(8));
  } else if (analysis_) {
    draw_result(ui, buttons_y - ui.px(8));
  } else {
    text_line(ui, ui.fonts.title, ui.theme.text, "Calibrate the sticks");
    note(ui,
         "No pad is connected: plug one in. If one does not work, run `gaitpad doctor` in a "
         "terminal.");
  }
  ImGui::SetCursorPosY(buttons_y);
  if (guide != nullptr) draw_guide_buttons(ui, *guide);
  if (analysis_) draw_result_buttons(ui, messages);
  if (guide != nullptr || analysis_) ImGui::SameLine();
  if (button(ui, "calibration give up", "Give up  (Esc)")) state_ = State::ended;
  if (guide != nullptr) {
    constexpr const char *kMap = "Controls are wrong", *kTest = "Test this pad";
    go_beside_or_below(ui, kMap);
    if (button(ui, "calibration map", kMap)) state_ = State::wants_map;
    go_beside_or_below(ui, kTest);
    if (button(ui, "calibration test", kTest)) state_ = State::wants_test;
  }
  if (!problem_.empty()) {
    ImGui::SameLine();
    text_line(ui, ui.fonts.small, ui.theme.warning, problem_);
  }
  end_modal();
  return state_;
}

}  // namespace

Result<std::unique_ptr<PadDialog>> start_calibration(const PadDialogOptions& options) {
  auto files = load_pad_files(options.config_folders, options.map, "");
  if (!files) return files.error();
  auto guided = GuidedCalibration::start(*files, options.selector);
  if (!guided) return guided.error();
  return std::unique_ptr<PadDialog>(
      new CalibrationView(options, std::move(*files), std::move(*guided)));
}

}  // namespace gaitpad
