#include "gaitpad/followers.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/ranges.h"
#include "session/workers.h"

namespace gaitpad {
namespace {

// The formation: rows behind the first character; every second row is shifted by half a place.
constexpr double kRow_m = 1.2, kPlace_m = 1.2;
constexpr double kWidth_m = 1.5;  // width of the formation, multiplied by sqrt(number of members)
constexpr double kMostOffset_m = 0.1;  // of a random offset, so that rows are not straight

// Keeps a member in its place of the formation. It walks faster by this share for each metre that
// it is behind, slower if it is ahead (stairs slow the first character down earlier), and turns
// towards its place by kAim_rad_m for each metre sideways. The bounds keep this inconspicuous.
constexpr double kCatchUp_1_m = 0.4, kMostCatchUp = 0.15, kMostWait = 0.7;
// Share of the first character's speed that a member has at least.
constexpr double kLeastSpeed = 0.1;
constexpr double kAim_rad_m = 0.2, kMostAim_rad = 0.12;
// Rate at which a member turns towards its aim, and its limit.
constexpr double kTurn_1_s = 0.8, kMostTurn_rad_s = 0.15;

// Pseudorandom numbers, equal on every machine (splitmix64).
std::uint64_t mixed_bits(std::uint64_t number) noexcept {
  std::uint64_t x = (number + 1) * 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}
// The n-th number in [0, 1) of a member.
double random_number(std::uint64_t member, std::uint64_t n) noexcept {
  return static_cast<double>(mixed_bits(member * 8 + n) >> 11) * 0x1p-53;
}
int pick(std::uint64_t member, std::uint64_t n, std::size_t count) noexcept {
  return static_cast<int>(random_number(member, n) * static_cast<double>(count));
}

vec3 place_of(int member, int count, const vec3& middle_m) noexcept {
  const int columns = std::max(
      1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(count)) * kWidth_m / kPlace_m)));
  const int row = member / columns, column = member % columns;
  const int in_row = std::min(columns, count - row * columns);
  const auto offset_m = [member](std::uint64_t n) {
    return (2.0 * random_number(static_cast<std::uint64_t>(member), n) - 1.0) * kMostOffset_m;
  };
  const double from_middle = column - 0.5 * (in_row - 1) + (row % 2 == 0 ? 0.25 : -0.25);
  return middle_m + kLeft * (from_middle * kPlace_m + offset_m(4)) -
         kForward * ((row + 1) * kRow_m + offset_m(5));
}

// Indices of the styles with different names; of equal names the first one counts.
std::vector<int> different(const std::vector<Style>& styles) {
  std::vector<int> all;
  for (int i = 0; i < static_cast<int>(styles.size()); ++i) {
    const bool is_known = std::ranges::any_of(all, [&](int other) {
      return styles[static_cast<std::size_t>(other)].name ==
             styles[static_cast<std::size_t>(i)].name;
    });
    if (!is_known) all.push_back(i);
  }
  return all;
}

double speed_m_s(const GaitParams& params) noexcept {
  const auto& [left, right] = params.stride;
  return (left.length_m + right.length_m) / (left.time_s + right.time_s);
}

void set(GaitOverrides& overrides, GaitKey key, double value) noexcept {
  overrides.value[static_cast<std::size_t>(key)] = value;
  overrides.is_set[static_cast<std::size_t>(key)] = true;
}

}  // namespace

Character follower_build(const Character& first, int number) {
  const auto n = static_cast<std::uint64_t>(number) + 0x10000;
  Character build = first;
  build.skeleton.clear();
  build.scale *= 0.88 + 0.24 * random_number(n, 0);
  build.leg_ratio *= 0.95 + 0.1 * random_number(n, 1);
  return build;
}

std::optional<Error> check(const Followers::Options& options) {
  const std::string what = "Followers::Options: ";
  if (auto problem = range_problem(what + "count", options.count, 0.0, kMaxFollowers))
    return problem;
  if (auto problem = choice_problem(what + "ik", options.ik, IkMode::robust)) return problem;
  if (auto problem = range_problem(what + "threads", options.threads, 1.0, kMaxCrowdThreads))
    return problem;
  if (auto problem = range_problem(what + "shown", options.shown, 0.0, kMaxFollowers))
    return problem;
  if (auto problem = vector_problem(what + "first_m", options.first_m, kFarthest_m)) return problem;
  return vector_problem(what + "middle_m", options.middle_m, kFarthest_m);
}

Result<Followers> Followers::create(const Options& options,
                                    const std::vector<std::shared_ptr<const WalkModel>>& builds,
                                    const std::vector<Style>& styles) {
  if (auto problem = check(options)) return *problem;
  if (builds.empty()) return Error{"Followers: builds is empty, one is needed"};
  if (styles.empty()) return Error{"Followers: styles is empty, one is needed"};
  for (std::size_t i = 0; i < builds.size(); ++i) {
    if (!builds[i]) return Error{"Followers: builds[" + std::to_string(i) + "] is null"};
  }
  for (const Style& style : styles) {
    if (auto problem = check(style)) return *problem;
  }
  return Followers(options, builds, styles);
}

Followers::Followers(const Options& options,
                     const std::vector<std::shared_ptr<const WalkModel>>& builds,
                     const std::vector<Style>& styles)
    : builds_(builds), first_m_(options.first_m), is_flat_(is_flat(*builds.front()->terrain)) {
  const std::vector<int> chosen = different(styles);
  for (int build = 0; build < static_cast<int>(builds.size()); ++build) {
    for (const int style : chosen) {
      Kind& kind = kinds_.emplace_back();
      kind.build = build;
      kind.style = style;
      kind.values = styles[static_cast<std::size_t>(style)];
      kind.values.fatigue = 0.0;  // a tired follower could not keep up, so followers do not tire
      kind.limits = gait_limits(*builds[static_cast<std::size_t>(build)]);
    }
  }
  std::vector<CrowdMember> members;
  for (int i = 0; i < options.count; ++i) {
    const auto member = static_cast<std::uint64_t>(i);
    const int build = pick(member, 0, builds.size()), style = pick(member, 1, chosen.size());
    kind_.push_back(static_cast<std::uint16_t>(static_cast<std::size_t>(build) * chosen.size() +
                                               static_cast<std::size_t>(style)));
    start_m_.push_back(place_of(i, options.count, options.middle_m));
    members.push_back({builds[static_cast<std::size_t>(build)], start_m_.back()});
  }
  crowd_ = Crowd(members, options.ik);
  for (int i = 0; i < size(); ++i) {
    const Kind& kind = kinds_[kind_[static_cast<std::size_t>(i)]];
    crowd_.params()[static_cast<std::size_t>(i)] = gait_params(Stick{}, kind.values, kind.limits);
  }
  crowd_.group_by_style();
  if (options.threads > 1) workers_ = std::make_shared<Workers>(options.threads);

  const int shown = std::min(options.count, options.shown);
  std::size_t joints = 0;
  for (int i = 0; i < shown; ++i) joints += crowd_.local(i).size();
  shown_.root_m.resize(static_cast<std::size_t>(shown));
  shown_.root_before_m.resize(static_cast<std::size_t>(shown));
  shown_.local.resize(joints);
  shown_.before.resize(joints);
  keep_shown();
  keep_shown();
}

// Overrides a stick at rest with the first character's speed and turn rate; gait_params() then
// finds the member's own steps. `ahead`: the first character's heading, a unit vector.
GaitParams Followers::params_of(int member, const GaitParams& first, const Placement& first_root,
                                double first_m_s, const vec3& ahead) const noexcept {
  const Kind& kind = kinds_[kind_[static_cast<std::size_t>(member)]];
  if (!first.walking) return gait_params(Stick{}, kind.values, kind.limits);
  const Placement root = crowd_.root(member);
  // Vector from the member to its place in the formation.
  const vec3 off_m =
      (first_root.place_m - first_m_) - (root.place_m - start_m_[static_cast<std::size_t>(member)]);
  const double behind_m = glm::dot(vec3(off_m.x, 0.0, off_m.z), ahead);
  // Sideways distance to its place, + to the left.
  const double beside_m = off_m.x * ahead.z - off_m.z * ahead.x;
  const double speed = speed_m_s(first);  // speed_m_s() is at least 0

  GaitOverrides overrides;
  GaitLimits limits = kind.limits;
  double turn_rate_rad_s = first.turn_rate_rad_s;
  if (speed > 0.0) {
    const double way = first.backward ? -1.0 : 1.0;
    const double more = std::clamp(way * behind_m * kCatchUp_1_m, -kMostWait, kMostCatchUp);
    // Stairs make the first character slower than its stick asks; use the speed of its present
    // cycle.
    const double real_m_s = is_flat_ ? speed : std::min(speed, first_m_s);
    const double wanted_m_s = std::max(real_m_s + speed * more, kLeastSpeed * speed);
    // Short legs keep up by quicker steps.
    limits.max_speed_m_s =
        std::max(limits.max_speed_m_s, first.backward ? wanted_m_s / kBackwardShare : wanted_m_s);
    set(overrides, GaitKey::speed_m_s, way * wanted_m_s);
    const double aim_rad = first_root.heading_rad +
                           std::clamp(way * beside_m * kAim_rad_m, -kMostAim_rad, kMostAim_rad);
    turn_rate_rad_s +=
        std::clamp((aim_rad - root.heading_rad) * kTurn_1_s, -kMostTurn_rad_s, kMostTurn_rad_s);
  }
  set(overrides, GaitKey::turn_rate_rad_s, turn_rate_rad_s);
  return gait_params(Stick{}, kind.values, overrides, limits);
}

void Followers::advance(const GaitParams& first, const Placement& first_root, double first_m_s,
                        double dt_s) noexcept {
  if (size() == 0) return;
  const vec3 ahead = heading_direction(first_root.heading_rad);
  const std::span<GaitParams> params = crowd_.params();
  for (int i = 0; i < size(); ++i)
    params[static_cast<std::size_t>(i)] = params_of(i, first, first_root, first_m_s, ahead);
  if (workers_ == nullptr) {
    crowd_.advance(dt_s);
  } else {
    workers_->for_each(crowd_.blocks(),
                       [this, dt_s](int block) { crowd_.advance_block(block, dt_s); });
  }
  keep_shown();
}

void Followers::restart() noexcept {
  for (int i = 0; i < size(); ++i) crowd_.restart(i, start_m_[static_cast<std::size_t>(i)]);
}

void Followers::keep_shown() noexcept {
  shown_.root_before_m.swap(shown_.root_m);
  shown_.before.swap(shown_.local);
  std::size_t joint = 0;
  for (std::size_t i = 0; i < shown_.root_m.size(); ++i) {
    const int member = static_cast<int>(i);
    shown_.root_m[i] = crowd_.root_m(member);
    for (const quat& q : crowd_.local(member)) {
      shown_.local[joint++] = {static_cast<float>(q.x), static_cast<float>(q.y),
                               static_cast<float>(q.z), static_cast<float>(q.w)};
    }
  }
}

std::size_t Followers::bytes() const noexcept {
  if (size() == 0) return 0;
  return crowd_.bytes() + shown_.local.size() * 2 * sizeof(shown_.local[0]);
}

}  // namespace gaitpad
