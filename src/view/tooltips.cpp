#include "view/tooltips.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "gaitpad/style.h"
#include "view/controls.h"

namespace gaitpad {
namespace {

struct Tip {
  std::string_view name;
  std::string_view text;
};

// Tips by an item's whole name.
constexpr Tip kTips[] = {
    {"play", "Pause or continue the session."},
    {"timeline play", "Pause or continue."},
    {"timeline step", "Go on by one tick."},
    {"timeline", "Drag to go to any moment. The marks are commands and plugging."},
    {"to begin", "Back to the first tick."},
    {"loop", "Begin again at the end."},
    {"pace", "How fast the recording plays."},
    {"leave playback", "Leave the recording and walk with the pad or the keyboard again."},
    {"record", "Start again and record everything that is done into a new .hid file; again: stop."},
    {"open", "Open a motion, recording, style, character, terrain or calibration."},
    {"calibrate", "Measure the sticks of the pad and keep the result for it."},
    {"help", "All keys and pad buttons."},
    {"view", "What is shown, the theme, the size of type, the ground."},
    {"menu", "More buttons, for which the window is too narrow."},
    {"trails", "The paths of the heels over the last steps."},
    {"source", "The motion that the walk is made of, as a stick figure."},
    {"grid",
     "Lines every metre and every 20 cm; from the start the blue one leads 1 m ahead, the orange "
     "one 1 m to the left."},
    {"shadows", "Shadows on the ground."},
    {"names", "Names above heads."},
    {"theme", "Dark or light."},
    {"type smaller", "Smaller type."},
    {"type larger", "Larger type."},
    {"next terrain", "Another ground. The walk starts again on it."},
    {"reset camera", "The camera as at the start."},
    {"walker all", "Select all characters: styles and sliders then change every one."},
    {"dismiss", "Close these messages."},
    {"close help", "Close this page."},
    {"leg left", "Show the left leg."},
    {"leg right", "Show the right leg."},
    {"rumble", "Let the motors of the pad beat once."},
    {"give back all", "Let the stick and the style set all values again."},
    {"ik paper", "Everybody walks by the paper's solver; recorded."},
    {"ik robust", "Everybody walks by the robust solver; recorded."},
    {"exaggerate",
     "Shows more of what the style changes, 1 to 3 times; the values below follow. all back: as it "
     "was."},
    {"save style", "Keep these values as a style of yours, to be used at once."},
    {"style name", "Letters, digits, blanks, _ and -."},
    {"own all", "Undo every change of this style."},
    {"axis weights", "Show the weight of each axis of a joint."},
    {"upper body", "Show the sliders of trunk, head, arms, hands, tiring and blending."},
    {"browser path", "A file or a folder; Enter opens it."},
    {"browser up", "The folder above."},
    {"browser open", "Open the selected file."},
    {"browser cancel", "Close without opening anything."},
    {"browser home", "Your home folder."},
    {"calibration skip", "Go on to the next step."},
    {"calibration repeat", "Measure this step again."},
    {"calibration back", "The step before."},
    {"calibration save", "Keep the calibration for this pad."},
    {"calibration test", "Test every control, driver and motor of this pad, step by step."},
    {"self test yes", "It did what was asked."},
    {"self test no", "It did something else."},
    {"self test next", "Go on: this pad has no such control."},
    {"self test give up", "Leave the test."},
    {"calibration give up", "Leave without keeping anything."},
    {"graph hip", "Flexion of the hip over the last two cycles, of each character."},
    {"graph knee", "Flexion of the knee over the last two cycles, of each character."},
    {"graph ankle", "Dorsiflexion of the ankle over the last two cycles, of each character."},
    {"graph heel", "Height of both heels above the ground, with lift, peak and landing."},
    {"graph stages", "When each foot flies and rolls, and which points stand on the ground."},
    {"graph iterations", "How many steps the solver took in each tick."},
    {"graph error", "How far the solved point is from its goal."},
    {"graph ticks", "How long each tick took."},
    {"graph waits", "How long reports waited for the tick that used them."},
    {"pad picture", "The pad: what is pressed is lit, the sticks lean as they are pushed."},
    {"pad stick left",
     "Orange: as the pad reports it, and the outline of the last ten seconds. Blue: calibrated, as "
     "the walk uses it."},
    {"pad stick right",
     "Orange: as the pad reports it, and the outline of the last ten seconds. Blue: calibrated. It "
     "turns the camera."},
};

// Tips by the beginning of an item's name.
constexpr Tip kBeginnings[] = {
    {"panel ", "Open or close this panel."},
    {"close ", "Close this panel."},
    {"walker ", "Select this character: styles and sliders then change it alone."},
    {"give back ", "Let the stick and the style set this value again."},
    {"overlay ",
     "Two that are marked stand in one place, half transparent, the second where the first walks."},
    {"own ", "The value in the style's file."},
    {"style slider ", ""},  // the style key's own tip
    {"slider ", ""},
    {"style ", "Walk like this. The change blends in over the style's time."},
    {"pace ", "How fast the recording plays."},
    {"browser recent ", "Opened before."},
    {"browser bundled ", "Comes with gaitpad."},
    {"browser filter ", "Which files are listed."},
    {"browser entry ", "Double click opens it."},
    {"help ", "What this key does."},
};

// Labels and tips of gait parameters. Those of style keys stand in the table of control/fields.cpp.
struct KeyWords {
  std::string_view key, words, text;
};
constexpr KeyWords kGaitKeyWords[] = {
    {"speed_m_s", "speed", "How fast it is to walk, in m/s. Does: over the cycle that runs."},
    {"stride_left_m", "stride",
     "Length of the left foot's step, in metres. Does: its last or running step."},
    {"stride_right_m", "stride",
     "Length of the right foot's step, in metres. Does: its last or running step."},
    {"flight_left", "flight height", "How high the left foot is lifted; 1 as in the motion."},
    {"flight_right", "flight height", "How high the right foot is lifted; 1 as in the motion."},
    {"turn_rate_rad_s", "turn rate",
     "How fast it is to turn, to the left above 0. Does: in this moment."},
};

template <class Table, class Member>
auto* row_of(const Table& table, std::string_view name, Member member) {
  const auto row = std::ranges::find(table, name, member);
  return row == std::end(table) ? nullptr : &*row;
}

std::string tip_of_key(std::string_view key) {
  if (const KeyWords* gait = row_of(kGaitKeyWords, key, &KeyWords::key))
    return std::string(gait->text);
  const StyleKey* style = row_of(style_keys(), key, &StyleKey::name);
  if (style != nullptr && !style->effect.empty()) return std::string(style->effect);
  const bool is_weight = key.find("weight.") != std::string_view::npos;
  return words_of_key(key) + (is_weight ? ": 1 moves freely, 0 is locked." : ".");
}

std::string text_of_item(std::string_view item) {
  if (const Tip* tip = row_of(kTips, item, &Tip::name)) return std::string(tip->text);
  for (const Tip& tip : kBeginnings) {
    if (!item.starts_with(tip.name)) continue;
    return tip.text.empty() ? tip_of_key(item.substr(tip.name.size())) : std::string(tip.text);
  }
  return {};
}

// Appends the key of an action that has both a button and a key.
std::string with_key(std::string text, const ActionInfo& info) {
  for (const Chord& chord : chords()) {
    if (chord.action == info.action) return fmt::format("{}  ({})", text, chord.name);
  }
  if (info.key == SDLK_UNKNOWN) return text;
  return fmt::format("{}  ({})", text, key_name(info.key));
}

}  // namespace

std::string words_of_key(std::string_view key) {
  if (const KeyWords* gait = row_of(kGaitKeyWords, key, &KeyWords::key))
    return std::string(gait->words);
  const StyleKey* style = row_of(style_keys(), key, &StyleKey::name);
  if (style == nullptr) return std::string(key);
  std::string words(style->limb);
  if (!words.empty()) words += ' ';
  words += style->words;
  std::ranges::replace(words, '_', ' ');
  return words;
}

std::string tooltip_of(std::string_view item) {
  const std::string text = text_of_item(item);
  const auto action = std::ranges::find(actions(), item, &ActionInfo::name);
  return text.empty() || action == actions().end() ? text : with_key(text, *action);
}

}  // namespace gaitpad
