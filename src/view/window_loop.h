// What run_window() is made of: one frame after the other, and what a person's wishes change.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/calibration_view.h"
#include "view/controls.h"
#include "view/ensemble.h"
#include "view/file_browser.h"
#include "view/frame_clock.h"
#include "view/gui.h"
#include "view/messages.h"
#include "view/opening.h"
#include "view/scene.h"
#include "view/show.h"
#include "view/surface.h"
#include "view/video.h"
#include "view/window.h"

namespace gaitpad {

class WindowLoop {
 public:
  explicit WindowLoop(const WindowOptions& options);
  ~WindowLoop();
  std::optional<Error> open();
  Result<WindowResult> run();

 private:
  // window_loop.cpp: the order of a frame.
  bool makes_pictures() const noexcept;
  bool makes_still() const noexcept;  // only the last frame is to be seen
  bool draw_frame();                  // false: it was the last one
  bool is_ended();
  void take_events();
  void take_wishes(Wishes wishes);
  void take_buttons(std::vector<Action>& wanted);
  void move_camera(const Wishes& wishes);
  void call_script();
  void take_layout(const UiState& layout);
  void end_lost();
  void remember_layout();
  Result<WindowResult> result();

  // window_draw.cpp: what is seen.
  void look();
  void draw(bool is_last);
  UiOutput draw_panels(int width_px, int height_px);
  UiInput ui_input();
  const LiveStatus* shown_status();
  void draw_browser(Ui& ui, const ImVec2& window_px);
  void draw_calibration(Ui& ui, const ImVec2& window_px);
  void see_anew();  // the camera, as at the beginning
  void keep_pictures(int width_px, int height_px, bool is_last);

  // window_actions.cpp: what was asked for.
  void obey(const UiOutput& out);
  void obey(Action action);
  bool obey_running(Action action);  // of those that make the show run; false: it is another
  bool obey_view(Action action);     // of those that change what is seen
  void obey_other(Action action);
  void set_style(const std::string& name);
  void turn_styles(int steps);
  void turn_panel(Panel panel);
  void step();
  void reset();
  void go_back();
  void save_walkers_style(const std::string& name);

  // window_sessions.cpp: one show ends, another begins.
  void say(std::string sentence);
  void take_remarks();
  void install(std::unique_ptr<Show> show);
  void end_show();  // its last state stays to be seen
  bool switch_to(const SessionSpec& next);
  bool restart(Result<std::unique_ptr<Show>> show, const SessionSpec& otherwise);
  void open_file(const std::string& path);
  void turn_terrains();
  void turn_recording();
  void begin_calibration();
  void end_calibration(CalibrationView::State state);
  void take_screenshot(int width_px, int height_px);

  WindowOptions options_;
  WindowResult result_;
  std::optional<Error> failure_;  // ends the window

  // From here on in the order in which they depend on each other.
  std::unique_ptr<WindowSurface> surface_;
  std::unique_ptr<Gui> gui_;
  std::unique_ptr<Scene> scene_;
  std::unique_ptr<VideoWriter> video_;
  std::unique_ptr<CalibrationView> calibration_;
  std::unique_ptr<Show> show_;
  std::unique_ptr<Ensemble> ensemble_;
  std::optional<SessionSpec> live_before_;  // a playback: what ran before it

  UiState state_;
  UiState remembered_;  // as it was read
  std::optional<ThemeName> applied_theme_;
  Camera camera_;
  bool is_camera_new_ = true;
  SceneContent content_;
  Controls controls_;
  ButtonPresses presses_;
  FileBrowser browser_;
  Messages messages_;
  FrameClock clock_;
  LiveStatus picture_status_;
  double pace_before_pause_ = 1.0;
  std::optional<std::string> chosen_file_;  // by the browser, in this frame
  CalibrationView::State calibration_state_ = CalibrationView::State::goes_on;
  bool wants_screenshot_ = false, is_quitting_ = false, is_end_told_ = false;
};

}  // namespace gaitpad
