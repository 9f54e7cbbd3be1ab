// The crowd as flat capsules: many characters, each in the colour of its style.
#pragma once
#include <vector>

#include "draw/theme.h"
#include "gaitpad/session_frame.h"
#include "scene/mannequin.h"
#include "scene/scene.h"

namespace gaitpad {

class CrowdBodies {
 public:
  CrowdBodies() = default;  // Has no members.
  explicit CrowdBodies(const Cast& cast);

  // The place of the eye in the next fill(): members near it are drawn with all bones.
  void look_from(const vec3& eye_m) noexcept { eye_m_ = eye_m; }
  // Replaces the crowd in the scene: all members, interpolated between their two latest poses by
  // `share` (0 .. 1). `focus_m`: centre of the drawn floor. `terrain`: null if level at height 0.
  void fill(const FollowerPoses& poses, double share, const Theme& theme, const Terrain* terrain,
            const vec3& focus_m, SceneContent& content);

 private:
  struct Member {
    int mannequin = 0, style = 0, joints = 0;
  };
  void add(const Mannequin& mannequin, const Colour& colour, const Terrain* terrain,
           SceneContent& content);

  // Mannequins with all bones and with few, one for each build.
  std::vector<Mannequin> full_, coarse_;
  std::vector<Member> members_;
  std::size_t joints_ = 0;  // number of joints of all members
  vec3 eye_m_{0.0, 1.6, 9.0};
  Pose pose_;
  JointFrames frames_;
};

}  // namespace gaitpad
