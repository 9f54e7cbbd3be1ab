// A synthetic walk: its feet are flat, stand still and swing at known times.
#pragma once
#include <algorithm>
#include <cmath>

#include "gaitpad/motion.h"

namespace gaitpad {

// The captured motions that are walks, except the walk in place.
constexpr const char* kCapturedWalks[] = {
    "bvhtoolbox_walk01", "cmu_006_01_iclone", "cmu_007_01_iclone", "cmu_007_04_iclone",
    "cmu_007_12_iclone", "cmu_12_01_walk",    "cmu_m21_depressed", "cmu_m21_female_walk",
    "cmu_m21_happy",     "cmu_m21_old2",      "cmu_m21_sneaky",    "cmu_m21_walk",
    "dme_example_crlf",  "dpr_walk_simple",   "mass_walk",         "sheffield_swagger"};

struct MadeWalk {
  double stride_m = 1.2, stride_s = 1.2;
  double stance = 0.62;        // duration of a stance, as a share of the stride
  double left_at = 0.5;        // left foot's strike in strides; the right one's is at 0
  double left_behind_m = 0.0;  // shift of the left footprints backwards from even steps
  double lift_m = 0.08;        // height to which a swinging foot is lifted
  double start_s = 0.0;        // time of the first frame
  double end_s = 5.0;
  double rate_hz = 120.0;
  double slide_m_s = 0.0;  // speed of a standing foot
  double hips_m = 0.74;    // height of the hips over the ankles; both legs always reach the ground
};

// A foot's height and travel at a time: still after its strike, then in the air.
struct MadeFoot {
  double height_m, z_m;
};
inline MadeFoot foot_at(const MadeWalk& walk, double strides) {
  const double place = std::floor(strides), phase = strides - place;
  const double u = std::max(0.0, (phase - walk.stance) / (1.0 - walk.stance));
  const double standing_s = std::min(phase, walk.stance) * walk.stride_s;
  const double slid_m = walk.slide_m_s * standing_s;
  const double rest_m = walk.stride_m - walk.slide_m_s * walk.stance * walk.stride_s;
  const double bump = 16.0 * u * u * (1.0 - u) * (1.0 - u);
  return {walk.lift_m * bump, place * walk.stride_m + slid_m + u * u * (3.0 - 2.0 * u) * rest_m};
}

// A walk with thighs and shanks of 0.42 m and ankles 0.08 m high.
inline Motion made_walk(const MadeWalk& walk) {
  constexpr double kBone_m = 0.42, kAnkle_m = 0.08;
  Motion m;
  m.name = "made.bvh";
  m.frame_time_s = 1.0 / walk.rate_hz;
  m.skeleton.joints.push_back({"Hips", -1, vec3(0.0), false});
  for (int side = 0; side < 2; ++side) {
    const std::string name = side == kLeftSide ? "Left" : "Right";
    const int hip = 1 + 5 * side;
    m.legs[side] = {hip, hip + 1, hip + 2, hip + 3, hip + 4};
    m.skeleton.joints.push_back({name + "UpLeg", 0, vec3(side == 0 ? 0.09 : -0.09, 0, 0), false});
    m.skeleton.joints.push_back({name + "Leg", hip, vec3(0.0, -kBone_m, 0.0), false});
    m.skeleton.joints.push_back({name + "Foot", hip + 1, vec3(0.0, -kBone_m, 0.0), false});
    m.skeleton.joints.push_back({name + "ToeBase", hip + 2, vec3(0.0, -kAnkle_m, 0.13), false});
    m.skeleton.joints.push_back({name + "Toe_End", hip + 3, vec3(0.0, 0.0, 0.06), true});
  }
  const int frames = static_cast<int>((walk.end_s - walk.start_s) * walk.rate_hz);
  for (int f = 0; f < frames; ++f) {
    const double strides = (walk.start_s + f / walk.rate_hz) / walk.stride_s;
    MotionFrame frame;
    // The hips are over a foot in the middle of its stance.
    frame.root_m = vec3(0.0, walk.hips_m + kAnkle_m, walk.stride_m * (strides - 0.5 * walk.stance));
    frame.local.assign(m.skeleton.joints.size(), kIdentity);
    for (int side = 0; side < 2; ++side) {
      const double shift = side == kLeftSide ? walk.left_at : 0.0;
      const MadeFoot foot = foot_at(walk, strides - shift);
      const double down_m = walk.hips_m - foot.height_m;
      const double behind_m = side == kLeftSide ? walk.left_behind_m : 0.0;
      const double ahead_m = foot.z_m + shift * walk.stride_m - behind_m - frame.root_m.z;
      const double reach_m = std::min(std::hypot(down_m, ahead_m), 1.999 * kBone_m);
      const double knee = 2.0 * std::acos(reach_m / (2.0 * kBone_m));
      const double thigh = std::atan2(ahead_m, down_m) + 0.5 * knee;
      frame.local[m.legs[side].hip] = rotation_x(-thigh);
      frame.local[m.legs[side].knee] = rotation_x(knee);
      frame.local[m.legs[side].ankle] = rotation_x(thigh - knee);
    }
    m.frames.push_back(frame);
  }
  return m;
}

}  // namespace gaitpad
