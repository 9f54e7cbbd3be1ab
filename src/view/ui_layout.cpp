#include "view/ui_layout.h"

#include <algorithm>
#include <cmath>

namespace gaitpad {
namespace {

// Pixels at scale 1.
constexpr float kTopBar = 44.0f, kTimeline = 64.0f, kStatus = 24.0f;
constexpr float kLeftColumn = 268.0f, kRightColumn = 320.0f;
constexpr float kLeastScene = 260.0f;  // between two columns
constexpr float kLeastSceneBesideOne = 180.0f;
constexpr float kLeastSceneHeight = 100.0f;  // before the status line gives way

bool is_any_open(const UiState& state, bool left) noexcept {
  for (int i = 0; i < kPanels; ++i) {
    if (state.is_open[static_cast<std::size_t>(i)] && is_left(static_cast<Panel>(i)) == left) {
      return true;
    }
  }
  return false;
}

}  // namespace

bool is_left(Panel panel) noexcept {
  return panel == Panel::pad || panel == Panel::control || panel == Panel::style;
}

UiLayout ui_layout(const UiState& state, bool has_timeline, int width_px, int height_px,
                   double scale) noexcept {
  const auto px = [scale](float at_scale_1) {
    return std::round(at_scale_1 * static_cast<float>(scale));
  };
  const float width = static_cast<float>(std::max(width_px, 0));
  const float height = static_cast<float>(std::max(height_px, 0));
  UiLayout l;
  l.top = {0.0f, 0.0f, width, std::min(px(kTopBar), height)};
  float bottom = height;
  if (has_timeline && bottom - px(kTimeline) > l.top.height) {
    l.timeline = {0.0f, bottom - px(kTimeline), width, px(kTimeline)};
    bottom = l.timeline.y;
  }
  if (bottom - px(kStatus) - l.top.height >= px(kLeastSceneHeight)) {
    l.status = {0.0f, bottom - px(kStatus), width, px(kStatus)};
    bottom = l.status.y;
  }
  const float top = l.top.height, middle = std::max(bottom - top, 0.0f);
  bool has_left = is_any_open(state, true), has_right = is_any_open(state, false);
  float left = px(kLeftColumn), right = px(kRightColumn);
  if (has_left && has_right && width < left + right + px(kLeastScene)) has_right = false;
  if (has_right && width < right + px(kLeastScene)) {
    has_left = true;
    has_right = false;
  }
  if (width < left + px(kLeastSceneBesideOne)) has_left = has_right = false;
  if (has_left) l.left = {0.0f, top, left, middle};
  if (has_right) l.right = {width - right, top, right, middle};
  l.scene = {l.left.width, top, width - l.left.width - l.right.width, middle};
  return l;
}

Viewport scene_viewport(const UiState& state, bool has_timeline, int width_px, int height_px,
                        double scale) noexcept {
  const UiRect scene = ui_layout(state, has_timeline, width_px, height_px, scale).scene;
  return {static_cast<int>(scene.x), static_cast<int>(scene.y), static_cast<int>(scene.width),
          static_cast<int>(scene.height)};
}

}  // namespace gaitpad
