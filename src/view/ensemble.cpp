#include "view/ensemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gaitpad/simulation.h"
#include "scene/ground_mesh.h"

namespace gaitpad {
namespace {

constexpr double kTrail_s = 3.0;         // time that a trail covers
constexpr double kTrailPoint_s = 0.025;  // time between two points of a trail
constexpr double kLook_m = 0.95;         // height of the camera's target, for an adult
// The source's sideways distance, the same as between neighbours.
constexpr double kSourceAside_m = 1.2;
constexpr double kAdult_m = 1.8;
constexpr double kHeightOverLeg = 2.1;                    // body height / (thigh + shank)
constexpr double kOnePerson_m = 4.2;                      // least framing distance of one person
constexpr double kWithCrowd_m = 9.0;                      // least framing distance with a crowd
constexpr double kLabelAbove_m = 0.14;                    // height of a name above the head
constexpr double kHalfLabel_px = 40.0, kLabel_px = 22.0;  // half a name's width; its height
// Distance of a foot in front of or behind the root, in body heights.
constexpr double kReach = 0.25;
constexpr double kHeadReach = 0.5;  // how far the head reaches, as a share of the feet's reach

std::string with_blanks(std::string name) {
  std::ranges::replace(name, '_', ' ');
  return name;
}

bool have_one_build(const Cast& cast) {
  return std::ranges::all_of(cast.members, [&](const CastMember& member) {
    return member.character == cast.members.front().character;
  });
}

// The style's name, with the character's name if the characters differ.
std::string label_text(const WalkerFrame& walker, const Cast& cast, std::size_t index) {
  const auto style = static_cast<std::size_t>(std::max(walker.style_index, 0));
  const std::string name = style < cast.styles.size() ? with_blanks(cast.styles[style]) : "?";
  if (have_one_build(cast)) return name;
  return fmt::format("{}, {}", with_blanks(cast.members[index].character), name);
}

// The two overlaid characters if both exist, else none.
std::vector<int> overlaid_of(const UiState& state, std::size_t characters) {
  const auto is_there = [=](int i) { return i >= 0 && static_cast<std::size_t>(i) < characters; };
  const bool is_pair = state.overlaid.size() == 2 && std::ranges::all_of(state.overlaid, is_there);
  return is_pair ? state.overlaid : std::vector<int>();
}

}  // namespace

Ensemble::Ensemble(const Cast& cast)
    : trail_ticks_(std::llround(kTrail_s * cast.rate_hz)),
      point_ticks_(std::max<std::int64_t>(std::llround(kTrailPoint_s * cast.rate_hz), 1)),
      crowd_(cast),
      shown_(cast.members.size()),
      has_crowd_(!cast.crowd.empty()) {
  if (!is_flat(*cast.terrain)) terrain_ = cast.terrain;
  for (const CastMember& member : cast.members) mannequins_.push_back(mannequin_of(member.model));
  if (cast.source != nullptr)
    source_height_m_ =
        kHeightOverLeg * (cast.source->leg[0].length_m() + cast.source->leg[1].length_m()) / 2;
}

void Ensemble::fill(const SessionFrame& frame, const History& history, double share,
                    const Cast& cast, const UiState& state, const Theme& theme,
                    SceneContent& content) {
  content.capsules.clear();
  content.lines.clear();
  content.joints_m.clear();
  content.trails.clear();
  const std::size_t count =
      std::min(mannequins_.size(), static_cast<std::size_t>(std::max(frame.walker_count, 0)));
  for (std::size_t i = 0; i < count; ++i) {
    const WalkerFrame& walker = frame.walkers[i];
    interpolate(walker.before, walker.pose, share, shown_[i]);
  }
  const std::vector<int> overlaid = overlaid_of(state, count);
  stand_in_one_place(frame, overlaid);
  for (std::size_t i = 0; i < count; ++i) {
    const Colour& colour = series_colour(theme, i);
    const std::size_t first = content.capsules.size();
    add_mannequin(mannequins_[i], shown_[i], terrain_.get(), colour, content);
    const auto mark = std::ranges::find(overlaid, static_cast<int>(i));
    const int layer = mark == overlaid.end() ? 0 : static_cast<int>(mark - overlaid.begin()) + 1;
    for (std::size_t c = first; c < content.capsules.size(); ++c) content.capsules[c].layer = layer;
    // The overlaid character is drawn away from its path, so its trails are left out.
    if (state.has_trails && layer != 2) add_trails(history, static_cast<int>(i), colour, content);
  }
  has_source_ = state.has_source && cast.source != nullptr && count > 0;
  if (has_source_) add_source(frame, share, cast, theme, content);
  content.joint_colour = theme.bone;
  content.has_grid = content.has_axes = state.has_grid;
  content.has_shadows = state.has_shadows;
  content.terrain = terrain_;
  content.focus_m = focus_m(-1);
  crowd_.fill(frame.crowd, share, theme, terrain_.get(), content.focus_m, content);
}

// Places the second overlaid character at the first one's place, with the same heading.
void Ensemble::stand_in_one_place(const SessionFrame& frame,
                                  const std::vector<int>& overlaid) noexcept {
  if (overlaid.empty()) return;
  const auto first = static_cast<std::size_t>(overlaid[0]),
             second = static_cast<std::size_t>(overlaid[1]);
  const vec3& there_m = shown_[first].root_m;
  Pose& moved = shown_[second];
  const double height_m = moved.root_m.y - ground_m(moved.root_m);
  moved.root_m = vec3(there_m.x, ground_m(there_m) + height_m, there_m.z);
  moved.local[0] =
      rotation_y(frame.walkers[first].walk.heading_rad - frame.walkers[second].walk.heading_rad) *
      moved.local[0];
}

void Ensemble::add_trails(const History& history, int walker, const Colour& colour,
                          SceneContent& content) {
  const std::size_t size = history.size();
  if (size < 2) return;
  const auto w = static_cast<std::size_t>(walker);
  // Points are chosen by absolute tick, so that they stay in place while the trail grows.
  const auto last_tick = history[size - 1].tick;
  for (const Side side : {kLeftSide, kRightSide}) {
    Trail trail;
    trail.colour = colour;
    for (std::size_t i = 0; i < size; ++i) {
      const TickSample& sample = history[i];
      const bool is_old = last_tick - sample.tick > trail_ticks_;
      const bool is_between = sample.tick % point_ticks_ != 0 && i + 1 != size;
      if (is_old || is_between || sample.walker_count <= walker) continue;
      trail.points_m.push_back(sample.walkers[w].heel_m[side]);
    }
    if (trail.points_m.size() > 1) content.trails.push_back(std::move(trail));
  }
}

// Places the source beside the first character, away from the others, and moves it along.
void Ensemble::add_source(const SessionFrame& frame, double share, const Cast& cast,
                          const Theme& theme, SceneContent& content) {
  const WalkerFrame& first = frame.walkers[0];
  source_place_m_ = first.before.root_m + share * (first.pose.root_m - first.before.root_m) +
                    kSourceAside_m * kLeft;
  source_place_m_.y = ground_m(source_place_m_);
  const std::size_t lines = content.lines.size(), joints = content.joints_m.size();
  add_stick_figure(*cast.source, first.phase, first.presence, source_place_m_,
                   first.walk.heading_rad, theme.bone, content);
  lift_source(lines, joints, content);
}

// The source walks as on level ground. On steps it is lifted until no part is below the ground.
void Ensemble::lift_source(std::size_t first_line, std::size_t first_joint, SceneContent& content) {
  if (terrain_ == nullptr) return;
  double lift_m = 0.0;
  for (std::size_t i = first_line; i < content.lines.size(); ++i) {
    for (const vec3& end : {content.lines[i].a_m, content.lines[i].b_m})
      lift_m = std::max(lift_m, ground_at(*terrain_, end.x, end.z).height_m - end.y);
  }
  for (std::size_t i = first_line; i < content.lines.size(); ++i) {
    content.lines[i].a_m.y += lift_m;
    content.lines[i].b_m.y += lift_m;
  }
  for (std::size_t i = first_joint; i < content.joints_m.size(); ++i)
    content.joints_m[i].y += lift_m;
  source_place_m_.y += lift_m;
}

double Ensemble::rise_ahead_m(int walker) const noexcept {
  constexpr double kAhead_m = 3.0, kBehind_m = 1.0;
  const vec3 at = focus_m(walker);
  return ground_m(at + vec3(0.0, 0.0, kAhead_m)) - ground_m(at - vec3(0.0, 0.0, kBehind_m));
}

vec3 Ensemble::focus_m(int walker) const noexcept {
  if (shown_.empty()) return vec3(0.0, kLook_m, 0.0);
  const auto n = static_cast<std::size_t>(walker);
  if (walker >= 0 && n < shown_.size()) {
    const vec3& root = shown_[n].root_m;
    const double look_m = kLook_m * std::min(mannequins_[n].height_m / kAdult_m, 1.5);
    return vec3(root.x, ground_m(root) + look_m, root.z);
  }
  vec3 low = shown_.front().root_m, high = low;
  for (const Pose& pose : shown_) {
    low = glm::min(low, pose.root_m);
    high = glm::max(high, pose.root_m);
  }
  if (has_source_) {
    low = glm::min(low, source_place_m_);
    high = glm::max(high, source_place_m_);
  }
  const vec3 middle = (low + high) / 2.0;
  return vec3(middle.x, ground_m(middle) + kLook_m, middle.z);
}

double Ensemble::ground_m(const vec3& place_m) const noexcept {
  return terrain_ == nullptr ? 0.0 : mean_ground_m(*terrain_, place_m.x, place_m.z);
}

void Ensemble::stand_on_ground(Camera& camera) const noexcept {
  stand_on(camera, ground_m(camera.target_m), ground_m(camera.eye_m()));
}

Framing Ensemble::framing(const Camera& camera, const Viewport& viewport, const UiState& state,
                          double scale) const {
  const double label_m = state.has_names ? kLabelAbove_m : 0.0;
  const vec2 label_px = state.has_names ? vec2(kHalfLabel_px, kLabel_px) * scale : vec2(0.0);
  std::vector<vec3> points_m;
  const auto add = [&](const vec3& place_m, double floor_m, double height_m) {
    const double reach_m = kReach * height_m, top_m = floor_m + height_m + label_m;
    for (const double x : {-reach_m, reach_m}) {
      for (const double z : {-reach_m, reach_m}) {
        const vec3 foot_m = place_m + vec3(x, 0.0, z);
        points_m.emplace_back(foot_m.x, ground_m(foot_m), foot_m.z);
        points_m.emplace_back(place_m.x + kHeadReach * x, top_m, place_m.z + kHeadReach * z);
      }
    }
  };
  for (std::size_t i = 0; i < shown_.size(); ++i)
    add(shown_[i].root_m, ground_m(shown_[i].root_m), mannequins_[i].height_m);
  if (has_source_) add(source_place_m_, source_place_m_.y, source_height_m_);
  return gaitpad::framing(camera, points_m, viewport.width, viewport.height, label_px,
                          has_crowd_ ? kWithCrowd_m : kOnePerson_m);
}

std::vector<UiLabel> Ensemble::labels(const SessionFrame& frame, const Cast& cast,
                                      const Camera& camera, const Viewport& viewport,
                                      const UiState& state, const Theme& theme) const {
  std::vector<UiLabel> labels;
  if (!state.has_names) return labels;
  const auto add = [&](vec3 place_m, std::string text, const Colour& colour) {
    place_m.y += kLabelAbove_m;
    const vec3 place = projected(camera, place_m, viewport.width, viewport.height);
    if (place.z <= 0.0 || place.x < 0.0 || place.x > viewport.width || place.y < 0.0 ||
        place.y > viewport.height)
      return;
    labels.push_back({vec2(viewport.x + place.x, viewport.y + place.y), std::move(text), colour});
  };
  const std::size_t count = std::min(
      {mannequins_.size(), cast.members.size(), static_cast<std::size_t>(frame.walker_count)});
  for (std::size_t i = 0; i < count; ++i) {
    add(head_m(mannequins_[i], shown_[i]), label_text(frame.walkers[i], cast, i),
        series_colour(theme, i));
  }
  if (has_source_) add(source_place_m_ + vec3(0.0, source_height_m_, 0.0), "source", theme.bone);
  return labels;
}

}  // namespace gaitpad
