// Processor time of a walk's tick over bare playback of its motion.
#include <ctime>

#include "gaitpad/crowd.h"
#include "gaitpad/walk_output.h"
#include "motion/stencil.h"
#include "tests/walk/made_block.h"

namespace gaitpad {
namespace {

constexpr int kMoments = 256;

double now_s() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}
// The quickest of seven turns, nanoseconds a call.
template <class Work>
double quickest_ns(int calls, const Work& work) {
  double best = 1e9;
  for (int turn = 0; turn < 7; ++turn) {
    const double begin = now_s();
    for (int i = 0; i < calls; ++i) work();
    best = std::min(best, (now_s() - begin) / calls);
  }
  return best * 1e9;
}

// The peer of `gaitpad bench`: one joint after another, Catmull-Rom through four samples.
void play_back(const GaitCycle& cycle, double phase, Pose& pose) {
  const Stencil at = stencil_at(phase);
  const std::size_t joints = cycle.standing_local.size();
  const quat* row[4];
  for (int k = 0; k < 4; ++k)
    row[k] = cycle.local.data() + static_cast<std::size_t>(at.index[k]) * joints;
  for (std::size_t j = 0; j < joints; ++j) {
    quat sum = row[1][j] * at.weight[1];
    for (const int k : {0, 2, 3}) {
      const double sign = glm::dot(row[k][j], row[1][j]) < 0.0 ? -1.0 : 1.0;
      sum = sum + row[k][j] * (sign * at.weight[k]);
    }
    pose.local[j] = glm::normalize(sum);
  }
}
double playback_ns() {
  Pose pose;
  double phase = 0.0;
  return quickest_ns(20000, [&] {
    play_back(adult().cycle, phase, pose);
    phase += 1.0 / 268.0;
    asm volatile("" : : "r"(&pose) : "memory");
  });
}

// Walks of many moments, which turn or go straight, some of them quicker; `after` ticks of that.
template <int kWidth>
double new_ns(const Tables& tables, const std::vector<Block<1>>& moments, int walks,
              int after = 0) {
  const int blocks = (walks + kWidth - 1) / kWidth, joints = tables.joints;
  std::vector<Block<kWidth>> block(blocks);
  std::vector<quat> local(static_cast<std::size_t>(blocks) * kWidth * joints);
  std::vector<vec3> root_m(static_cast<std::size_t>(blocks) * kWidth);
  std::vector<quat*> locals;
  std::vector<vec3*> roots;
  for (int i = 0; i < blocks * kWidth; ++i) {
    copy_walk(moments[(i * 37) % moments.size()], 0, block[i / kWidth], i % kWidth);
    locals.push_back(local.data() + static_cast<std::size_t>(i) * joints);
    roots.push_back(root_m.data() + i);
  }
  const auto step = [&] {
    for (int b = 0; b < blocks; ++b)
      advance(tables, block[b],
              Poses{locals.data() + b * kWidth, roots.data() + b * kWidth, kWidth});
  };
  for (int tick = 0; tick < after; ++tick) step();
  return quickest_ns(std::max(8, 20000 / walks), step) / walks;
}

void measure() {
  Alone walk;
  const Tables& tables = walk.tables;
  walk.walk(params_of(0.0, 0.8), 4 * kRate);
  std::vector<Block<1>> moments;
  for (int i = 0; i < kMoments; ++i) {
    walk.step();
    moments.push_back(walk.block);
    if (i % 4 == 1) moments.back().state.asked.length_m[i / 4 % 2] *= 1.05f;
    if (i % 4 == 3) moments.back().state.asked.turn_rad_s = 0.3f;
  }
  const double playback = playback_ns();
  const auto row = [&](const char* name, double ns) {
    std::printf("%-28s %7.1f ns  %5.2f x playback\n", name, ns, ns / playback);
  };
  row("playback", playback);
  row("tick, alone", new_ns<1>(tables, {moments[0]}, 1));
  Pose pose;
  WalkState state = standing(adult(), vec3(0.0), pose);
  const GaitParams params = params_of(0.0, 0.8);
  const auto step = [&] { gaitpad::advance(adult(), params, IkMode::robust, kDt, state, pose); };
  for (int tick = 0; tick < 4 * kRate; ++tick) step();
  row("advance(), alone", quickest_ns(5000, step));
  const Pose before = pose;
  step();
  Pose drawn;
  row("pose_between()",
      quickest_ns(5000, [&] { pose_between(adult(), before, pose, 0.3, drawn); }));
  constexpr int kCrowd = 1000;
  row("1,000 in lanes of 1", new_ns<1>(tables, moments, kCrowd));
  row("1,000 in lanes of 4", new_ns<4>(tables, moments, kCrowd));
  if (__builtin_cpu_supports("avx2"))
    row("1,000 in lanes of 8", new_ns<8>(tables, moments, kCrowd));
  if (__builtin_cpu_supports("avx512dq")) {
    row("1,000 in lanes of 16", new_ns<16>(tables, moments, kCrowd));
    row("a second later", new_ns<16>(tables, moments, kCrowd, kRate));
    row("100,000 in lanes of 16", new_ns<16>(tables, moments, 100 * kCrowd));
  }
  row("lanes of 4, a second later", new_ns<4>(tables, moments, kCrowd, kRate));
  // Four walks of the styles of `gaitpad bench`, over four even ones; alone, and side by side.
  std::vector<Block<1>> even, styled;
  for (const char* name : {"even", "stiff_hip", "stiff_knee", "limp_left"}) {
    for (const bool is_styled : {false, true}) {
      Alone of_style;
      of_style.walk(params_of(0.0, 0.8, is_styled ? shipped(name) : StyleValues{}), 4 * kRate);
      (is_styled ? styled : even).push_back(of_style.block);
    }
  }
  std::printf("four styled over four even: alone %.2f, in lanes of 4 %.2f\n",
              new_ns<1>(tables, styled, 4) / new_ns<1>(tables, even, 4),
              new_ns<4>(tables, styled, 4) / new_ns<4>(tables, even, 4));
  // Crowds in full, and as the tables pose them; even ones, and of those styles.
  const auto model = std::make_shared<const WalkModel>(adult());
  std::vector<CrowdMember> members(kCrowd);
  for (CrowdMember& member : members) member.model = model;
  constexpr const char* kStyles[] = {"even", "stiff_hip", "stiff_knee", "limp_left"};
  for (const bool is_styled : {false, true}) {
    Crowd crowd = value_of(Crowd::create(members, IkMode::robust));
    for (int i = 0; i < kCrowd; ++i)
      crowd.params()[i] = params_of(i % 4 == 3 ? 0.3 : 0.0, 0.8,
                                    is_styled ? shipped(kStyles[i / 4 % 4]) : StyleValues{});
    for (const Detail detail : {Detail::full, Detail::tables}) {
      for (int i = 0; i < kCrowd; ++i) crowd.set_detail(i, detail);
      for (int i = 0; i < 600; ++i) crowd.advance(kDt);
      const std::string name = std::string(is_styled ? "Crowd of styles" : "Crowd, 1,000") +
                               (detail == Detail::full ? ", widest lanes" : ", by the tables");
      row(name.c_str(), quickest_ns(20, [&] { crowd.advance(kDt); }) / kCrowd);
    }
  }
}

}  // namespace
}  // namespace gaitpad

int main() { gaitpad::measure(); }
