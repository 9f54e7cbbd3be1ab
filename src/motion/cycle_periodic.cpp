#include "motion/cycle_periodic.h"

#include <algorithm>
#include <memory>

#include "motion/tracks.h"

namespace gaitpad {
namespace {

constexpr int kPoints = 256;    // of the closed stride, before its harmonics are taken
constexpr double kFade = 0.25;  // of the stride, at most, on either side of the seam
constexpr double kLeastFade = 0.08;
constexpr int kFullHarmonics = 10;  // the ones above fade out to kHarmonics

// Natural cubic spline through values at 0, 1, 2 ...
struct Spline {
  std::vector<double> value, curvature;
  double at(double x) const {
    const int last = static_cast<int>(value.size()) - 2;
    const int i = std::clamp(static_cast<int>(std::floor(x)), 0, last);
    const double t = x - i, s = 1.0 - t;
    return value[i] * s + value[i + 1] * t +
           ((s * s * s - s) * curvature[i] + (t * t * t - t) * curvature[i + 1]) / 6.0;
  }
};

Spline spline(std::vector<double> value) {
  const int n = static_cast<int>(value.size());
  std::vector<double> curvature(n, 0.0), upper(n, 0.0);
  for (int i = 1; i + 1 < n; ++i) {
    const double pivot = 4.0 - upper[i - 1];
    upper[i] = 1.0 / pivot;
    const double bend = 6.0 * (value[i + 1] - 2.0 * value[i] + value[i - 1]);
    curvature[i] = (bend - curvature[i - 1]) / pivot;
  }
  for (int i = n - 2; i > 0; --i) curvature[i] -= upper[i] * curvature[i + 1];
  return {std::move(value), std::move(curvature)};
}

// The frames used: the window and what lies around it.
struct Stretch {
  int first = 0, count = 0;
  double start = 0.0, period = 0.0;  // frames from `first`
  double before = 0.0, after = 0.0;  // room for fading, share of the period
  double place(double phase) const { return start + phase * period; }
};

Stretch stretch_of(const StrideWindow& w) {
  Stretch s;
  const double margin = kFade * w.period + 4.0;
  s.first = std::max(w.first, static_cast<int>(std::floor(w.start - margin)));
  const int last = std::min(w.last, static_cast<int>(std::ceil(w.start + w.period + margin)));
  s.count = last - s.first + 1;
  s.start = w.start - s.first;
  s.period = w.period;
  s.before = std::min(kFade, s.start / s.period);
  s.after = std::min(kFade, (s.count - 1 - s.start - s.period) / s.period);
  return s;
}

// x(phase) for 0 .. 1 made periodic. Where the motion goes on beyond the seam, the two sides are
// faded into each other; else the difference of value is spread over the stride, that of slope
// around the seam.
class Closer {
 public:
  explicit Closer(const Stretch& stretch)
      : s_(stretch), fades_(s_.before + s_.after >= kLeastFade) {}

  std::array<double, kPoints> closed(const Spline& x) const {
    std::array<double, kPoints> y;
    for (int i = 0; i < kPoints; ++i) {
      const double phase = double(i) / kPoints;
      y[i] = fades_ ? faded(x, phase) : levelled(x, phase);
    }
    return y;
  }

 private:
  double faded(const Spline& x, double phase) const {
    double y = x.at(s_.place(phase));
    const double share = s_.before / (s_.before + s_.after);
    if (phase > 1.0 - s_.before) {
      const double w = share * smoothstep(1.0 - s_.before, 1.0, phase);
      y = mix(y, x.at(s_.place(phase - 1.0)), w);
    } else if (phase < s_.after) {
      const double w = (1.0 - share) * (1.0 - smoothstep(0.0, s_.after, phase));
      y = mix(y, x.at(s_.place(phase + 1.0)), w);
    }
    return y;
  }
  double levelled(const Spline& x, double phase) const {
    constexpr double kReach = 0.2, kStep = 0.01;
    const double gap = x.at(s_.place(1.0)) - x.at(s_.place(0.0));
    const double slope_start = (x.at(s_.place(kStep)) - x.at(s_.place(0.0))) / kStep;
    const double slope_end = (x.at(s_.place(1.0)) - x.at(s_.place(1.0 - kStep))) / kStep;
    const double half = 0.5 * (slope_end - slope_start);
    const double from_seam = std::min(phase, 1.0 - phase);
    const double rest = std::max(0.0, 1.0 - from_seam / kReach);
    return x.at(s_.place(phase)) - gap * (phase - 0.5) + half * from_seam * rest * rest;
  }

  Stretch s_;
  bool fades_;
};

// cos and sin of 2 pi k i / kPoints.
struct Waves {
  std::array<SinCos, kPoints> table;
  Waves() {
    for (int i = 0; i < kPoints; ++i) table[i] = sin_cos(2.0 * kPi * i / kPoints);
  }
  const SinCos& at(int k, int i) const { return table[(k * i) % kPoints]; }
};

// Harmonics that the source's frames can carry, the highest ones fading out (no ringing at
// contacts).
Fourier harmonics(const std::array<double, kPoints>& y, const Waves& waves, double period_frames) {
  Fourier f;
  for (const double v : y) f.mean += v / kPoints;
  const int most = std::min(kHarmonics, static_cast<int>(0.5 * period_frames) - 1);
  const int full = std::min(kFullHarmonics, most);
  for (int k = 1; k <= most; ++k) {
    double a = 0.0, b = 0.0;
    for (int i = 0; i < kPoints; ++i) {
      const SinCos& s = waves.at(k, i);
      a += y[i] * s.cos;
      b += y[i] * s.sin;
    }
    const double keep = 1.0 - smoothstep(full, most + 1, k);
    f.a[k - 1] = keep * 2.0 / kPoints * a;
    f.b[k - 1] = keep * 2.0 / kPoints * b;
  }
  return f;
}

double value_at(const Fourier& f, const std::array<SinCos, kHarmonics>& wave) {
  double sum = f.mean;
  for (int k = 0; k < kHarmonics; ++k) sum += f.a[k] * wave[k].cos + f.b[k] * wave[k].sin;
  return sum;
}

// The pelvis' path with the turning undone step by step, x and z then turned so that the stride
// goes along +z. Returns the heading that was taken out at each frame.
std::vector<double> straighten(const Motion& motion, const Stretch& s, double turn_rad,
                               std::array<std::vector<double>, 3>& path_m) {
  const auto world = std::make_unique<JointFrames>();
  std::vector<double> heading(s.count);
  std::vector<vec3> place(s.count);
  vec3 before(0.0);
  for (int f = 0; f < s.count; ++f) {
    heading[f] = turn_rad * (f - s.start) / s.period;
    forward_kinematics(motion, motion.frames[s.first + f], *world);
    const vec3 now = world->position_m[motion.pelvis];
    const double middle = heading[f] - 0.5 * turn_rad / s.period;
    place[f] = f == 0 ? now : place[f - 1] + rotation_y(-middle) * (now - before);
    before = now;
  }
  const auto at = [&](double x) {
    const int i = std::clamp(static_cast<int>(x), 0, s.count - 2);
    return glm::mix(place[i], place[i + 1], x - i);
  };
  const double course = heading_of(at(s.place(1.0)) - at(s.place(0.0)));
  for (int f = 0; f < s.count; ++f) {
    heading[f] += course;
    const vec3 p = rotation_y(-course) * (place[f] - place[0]);
    path_m[0].push_back(p.x);
    path_m[1].push_back(p.y + place[0].y);
    path_m[2].push_back(p.z);
  }
  return heading;
}

// A joint's rotation in the stretch, joint 0 without the heading.
quat local_at(const Motion& motion, const Stretch& s, int frame, int joint,
              const std::vector<double>& heading) {
  const quat& q = motion.frames[s.first + frame].local[joint];
  return joint == 0 ? rotation_y(-heading[frame]) * q : q;
}

quat mean_rotation(const std::vector<quat>& all) {
  quat sum = all.front();
  for (std::size_t i = 1; i < all.size(); ++i) {
    sum = sum + all[i] * (glm::dot(all[i], sum) < 0.0 ? -1.0 : 1.0);
  }
  return glm::normalize(sum);
}

}  // namespace

PeriodicMotion periodic_motion(const Motion& motion, const StrideWindow& window) {
  const Stretch s = stretch_of(window);
  const Closer closer(s);
  const auto waves = std::make_unique<Waves>();
  PeriodicMotion out;
  out.duration_s = s.period * motion.frame_time_s;

  std::array<std::vector<double>, 3> path_m;
  const std::vector<double> heading = straighten(motion, s, window.turn_rad, path_m);
  for (int axis = 0; axis < 3; ++axis) {
    const Spline whole = spline(path_m[axis]);
    const double travel = whole.at(s.place(1.0)) - whole.at(s.place(0.0));
    if (axis == 2) out.stride_m = travel;
    for (int f = 0; f < s.count; ++f) path_m[axis][f] -= travel * (f - s.start) / s.period;
    out.pelvis_m[axis] = harmonics(closer.closed(spline(path_m[axis])), *waves, s.period);
    if (axis != 1) out.pelvis_m[axis].mean = 0.0;
  }

  const int joints = static_cast<int>(motion.skeleton.joints.size());
  std::vector<quat> local(s.count);
  for (int j = 0; j < joints; ++j) {
    for (int f = 0; f < s.count; ++f) local[f] = local_at(motion, s, f, j, heading);
    out.mean.push_back(mean_rotation(local));
    std::array<std::vector<double>, 3> turn;
    for (const quat& q : local) {
      const vec3 v = rotation_vector(glm::conjugate(out.mean[j]) * q);
      for (int axis = 0; axis < 3; ++axis) turn[axis].push_back(v[axis]);
    }
    out.rotation.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      out.rotation[j][axis] = harmonics(closer.closed(spline(turn[axis])), *waves, s.period);
    }
  }
  return out;
}

PeriodicPose pose_at(const PeriodicMotion& motion, double phase) {
  std::array<SinCos, kHarmonics> wave;
  for (int k = 0; k < kHarmonics; ++k) wave[k] = sin_cos(2.0 * kPi * (k + 1) * phase);
  const auto vector_at = [&](const std::array<Fourier, 3>& f) {
    return vec3(value_at(f[0], wave), value_at(f[1], wave), value_at(f[2], wave));
  };
  PeriodicPose pose;
  pose.pelvis_m = vector_at(motion.pelvis_m);
  for (std::size_t j = 0; j < motion.mean.size(); ++j) {
    pose.local.push_back(motion.mean[j] * from_rotation_vector(vector_at(motion.rotation[j])));
  }
  return pose;
}

}  // namespace gaitpad
