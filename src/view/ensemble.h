// The contents of the scene: the characters of a session with their trails and names, and the
// source motion beside them.
#pragma once
#include <string>
#include <vector>

#include "scene/camera.h"
#include "scene/crowd_bodies.h"
#include "scene/mannequin.h"
#include "session/history.h"
#include "view/ui.h"

namespace gaitpad {

class Ensemble {
 public:
  explicit Ensemble(const Cast& cast);

  // Replaces the content: every character, interpolated between its two latest poses by `share` (0
  // .. 1), its trails, and the source.
  void fill(const SessionFrame& frame, const History& history, double share, const Cast& cast,
            const UiState& state, const Theme& theme, SceneContent& content);
  // The camera's target for one character or all (-1), as of the last fill().
  vec3 focus_m(int walker) const noexcept;
  // The camera's last place; members of the crowd near it are drawn in detail.
  void look_from(const vec3& eye_m) noexcept { crowd_.look_from(eye_m); }
  bool has_crowd() const noexcept { return has_crowd_; }
  bool is_on_uneven_ground() const noexcept { return terrain_ != nullptr; }
  // Height of the ground ahead (+z) minus that behind the camera's target, in metres.
  double rise_ahead_m(int walker) const noexcept;
  // Tells the camera the ground's height; call it after the camera has moved.
  void stand_on_ground(Camera& camera) const noexcept;
  // The framing that shows all characters from head to foot, with their names, at the camera's
  // angles.
  Framing framing(const Camera& camera, const Viewport& viewport, const UiState& state,
                  double scale) const;
  // Names above the heads, in window pixels.
  std::vector<UiLabel> labels(const SessionFrame& frame, const Cast& cast, const Camera& camera,
                              const Viewport& viewport, const UiState& state,
                              const Theme& theme) const;

 private:
  void stand_in_one_place(const SessionFrame& frame, const std::vector<int>& overlaid) noexcept;
  void add_trails(const History& history, int walker, const Colour& colour, SceneContent& content);
  void add_source(const SessionFrame& frame, double share, const Cast& cast, const Theme& theme,
                  SceneContent& content);

  std::int64_t trail_ticks_, point_ticks_;  // ticks that a trail covers; ticks between its points
  double ground_m(const vec3& place_m) const noexcept;
  void lift_source(std::size_t first_line, std::size_t first_joint, SceneContent& content);

  std::shared_ptr<const Terrain> terrain_;  // the ground; null: level at height 0
  std::vector<Mannequin> mannequins_;
  CrowdBodies crowd_;
  std::vector<Pose> shown_;  // the interpolated pose of each mannequin
  double source_height_m_ = 0.0;
  vec3 source_place_m_{0.0};  // place on the floor below the source's root
  bool has_source_ = false, has_crowd_ = false;
};

}  // namespace gaitpad
