// What a person asked for by key, button or panel, done.
#include <SDL2/SDL.h>
#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "gaitpad/config_files.h"
#include "view/window_loop.h"

namespace gaitpad {
namespace {

constexpr double kSlowMotion = 0.25;

// The styles that a command may name, each once.
std::vector<std::string> style_names(const Cast& cast) {
  std::vector<std::string> names;
  for (const std::string& name : cast.styles)
    if (std::ranges::count(names, name) == 0) names.push_back(name);
  return names;
}

}  // namespace

void WindowLoop::obey(const UiOutput& out) {
  for (const Action action : out.actions) obey(action);
  for (const std::string& command : out.commands) show_->command(command);
  if (out.seek_tick) show_->seek(*out.seek_tick);
  if (out.pace) show_->set_pace(*out.pace);
  if (out.is_looping) show_->set_looping(*out.is_looping);
  if (out.save_style) save_walkers_style(*out.save_style);
  if (out.dismisses_messages) messages_.clear();
  if (const auto file = std::exchange(chosen_file_, std::nullopt)) open_file(*file);
  if (calibration_ && calibration_state_ != CalibrationView::State::goes_on)
    end_calibration(calibration_state_);
}

void WindowLoop::obey(Action action) {
  if (obey_running(action) || obey_view(action)) return;
  obey_other(action);
}

bool WindowLoop::obey_running(Action action) {
  switch (action) {
    case Action::pause:
      if (show_->pace() > 0.0) {
        pace_before_pause_ = show_->pace();
        show_->set_pace(0.0);
      } else {
        show_->set_pace(pace_before_pause_);
      }
      return true;
    case Action::step:
      step();
      return true;
    case Action::slow_motion:
      show_->set_pace(show_->pace() == kSlowMotion ? 1.0 : kSlowMotion);
      return true;
    case Action::reset:
      reset();
      return true;
    case Action::next_style:
      turn_styles(1);
      return true;
    case Action::previous_style:
      turn_styles(-1);
      return true;
    default:
      break;
  }
  if (action < Action::style_1 || action > Action::style_9) return false;
  const auto names = style_names(show_->cast());
  const auto index = static_cast<std::size_t>(action) - static_cast<std::size_t>(Action::style_1);
  if (index < names.size()) set_style(names[index]);
  return true;
}

bool WindowLoop::obey_view(Action action) {
  switch (action) {
    case Action::next_walker:
      if (++state_.walker >= static_cast<int>(show_->cast().members.size())) state_.walker = -1;
      return true;
    case Action::follow:
      camera_.is_following = !camera_.is_following;
      return true;
    case Action::reset_camera:
      is_camera_new_ = true;
      return true;
    case Action::theme:
      state_.theme = state_.theme == ThemeName::dark ? ThemeName::light : ThemeName::dark;
      return true;
    case Action::trails:
      state_.has_trails = !state_.has_trails;
      return true;
    case Action::source:
      state_.has_source = !state_.has_source;
      return true;
    case Action::help:
      state_.is_help_open = !state_.is_help_open;
      return true;
    case Action::fullscreen: {
      const bool is_full = (SDL_GetWindowFlags(surface_->window()) & SDL_WINDOW_FULLSCREEN) != 0;
      SDL_SetWindowFullscreen(surface_->window(), is_full ? 0 : SDL_WINDOW_FULLSCREEN_DESKTOP);
      return true;
    }
    default:
      break;
  }
  if (action < Action::panel_pad || action > Action::panel_loop) return false;
  turn_panel(static_cast<Panel>(static_cast<int>(action) - static_cast<int>(Action::panel_pad)));
  return true;
}

void WindowLoop::obey_other(Action action) {
  switch (action) {
    case Action::record:
      turn_recording();
      break;
    case Action::screenshot:
      wants_screenshot_ = true;
      break;
    case Action::open_file:
      browser_.open();
      break;
    case Action::next_terrain:
      turn_terrains();
      break;
    case Action::calibrate:
      begin_calibration();
      break;
    case Action::back:
      go_back();
      break;
    case Action::quit:
      is_quitting_ = true;
      break;
    default:
      break;
  }
}

void WindowLoop::turn_panel(Panel panel) {
  bool& is_open = state_.is_open[static_cast<std::size_t>(panel)];
  is_open = !is_open;
}

void WindowLoop::step() {
  if (show_->pace() > 0.0) {
    pace_before_pause_ = show_->pace();
    show_->set_pace(0.0);
  }
  show_->step();
}

void WindowLoop::reset() {
  if (show_->is_live()) {
    show_->command("reset");
  } else {
    show_->seek(0);
  }
}

void WindowLoop::set_style(const std::string& name) {
  if (!show_->is_live()) {
    say("a recording walks in its own styles; Escape goes back to where they can be changed");
  } else if (state_.walker >= 0) {
    show_->command(fmt::format("style {} {}", state_.walker + 1, name));
  } else {
    show_->command("style " + name);
  }
}

// From the style of the chosen one, or of the first, to the one so many places on in the list.
void WindowLoop::turn_styles(int steps) {
  const auto names = style_names(show_->cast());
  const auto walker = static_cast<std::size_t>(std::max(state_.walker, 0));
  const auto index =
      static_cast<std::size_t>(std::max(show_->frame().walkers[walker].style_index, 0));
  if (names.empty() || index >= show_->cast().styles.size()) return;
  const auto count = static_cast<int>(names.size());
  const auto now = std::ranges::find(names, show_->cast().styles[index]) - names.begin();
  set_style(names[static_cast<std::size_t>((static_cast<int>(now) + steps + count) % count)]);
}

void WindowLoop::go_back() {
  if (state_.is_help_open) {
    state_.is_help_open = false;
  } else if (browser_.is_open()) {
    browser_.close();
  } else if (calibration_) {
    end_calibration(CalibrationView::State::given_up);
  } else if (live_before_) {
    const SessionSpec live = *std::exchange(live_before_, std::nullopt);
    switch_to(live);
  }
}

void WindowLoop::save_walkers_style(const std::string& name) {
  const auto walker = static_cast<std::size_t>(std::max(state_.walker, 0));
  const auto& folders = show_->options().config_folders;
  const auto path = save_style(folders, name, show_->frame().walkers[walker].style);
  if (path) show_->add_config_folder(user_config_folder());  // it may be new
  say(path ? fmt::format("kept as {}: the next session knows it", *path) : path.error().message);
}

}  // namespace gaitpad
