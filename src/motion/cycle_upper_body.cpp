#include "motion/cycle_upper_body.h"

#include <algorithm>

#include "motion/body_joints.h"
#include "motion/cycle_leg.h"
#include "motion/legs.h"

namespace gaitpad {
namespace {

std::vector<vec3> standing_places(const GaitCycle& cycle) {
  const auto world = world_rotations(cycle.skeleton, cycle.standing_local.data());
  std::vector<vec3> at(world.size(), vec3(0.0));
  for (std::size_t j = 1; j < at.size(); ++j) {
    const Joint& joint = cycle.skeleton.joints[j];
    at[j] = at[joint.parent] + world[joint.parent] * joint.offset_m;
  }
  return at;
}

// One skeleton's parts and places.
struct Part {
  const GaitCycle& cycle;
  std::vector<vec3> at;
  BodyJoints joints;
  std::vector<int> neck;  // the head is its last
  explicit Part(const GaitCycle& c)
      : cycle(c),
        at(standing_places(c)),
        joints(find_body(c.skeleton, {c.leg[0].joints, c.leg[1].joints}, c.pelvis, at)),
        neck(joints.neck) {
    if (joints.head >= 0) neck.push_back(joints.head);
  }
  const std::string& name(int joint) const { return cycle.skeleton.joints[joint].name; }
  int chest() const { return joints.spine.empty() ? cycle.pelvis : joints.spine.back(); }
  bool is_in_leg(int joint) const {
    return is_ancestor(cycle.skeleton, cycle.leg[0].joints.hip, joint) ||
           is_ancestor(cycle.skeleton, cycle.leg[1].joints.hip, joint);
  }
  bool is_upper(int joint) const {
    return !is_in_leg(joint) && !is_ancestor(cycle.skeleton, joint, cycle.pelvis);
  }
  // Mean place of its children; its own where it has none away from it.
  vec3 below(int joint) const {
    vec3 sum(0.0);
    int count = 0;
    for (std::size_t j = 1; j < at.size(); ++j) {
      if (cycle.skeleton.joints[j].parent != joint) continue;
      sum += at[j];
      ++count;
    }
    return count > 0 ? sum / double(count) : at[joint];
  }
};

// The child a joint's bone may point to: the only one, else -1.
int only_child(const Part& part, int joint) {
  int child = -1;
  for (std::size_t j = 1; j < part.at.size(); ++j) {
    if (part.cycle.skeleton.joints[j].parent != joint) continue;
    if (child >= 0) return -1;
    child = static_cast<int>(j);
  }
  return child;
}

class Matcher {
 public:
  Matcher(const GaitCycle& source, const GaitCycle& character) : from_(source), to_(character) {
    const std::size_t joints = character.skeleton.joints.size();
    body_ = {std::vector<Counterpart>(joints), std::vector<int>(joints, -1),
             std::vector<vec3>(joints, vec3(0.0))};
  }

  UpperBody matched() {
    match_chain(from_.joints.spine, to_.joints.spine, from_.cycle.pelvis);
    match_chain(from_.neck, to_.neck, from_.chest());
    for (int side = 0; side < 2; ++side) match_arm(from_.joints.arm[side], to_.joints.arm[side]);
    match_names();
    aim_chain(from_.joints.spine, to_.joints.spine, first(from_.neck), first(to_.neck));
    aim_chain(from_.neck, to_.neck, -1, -1);
    return std::move(body_);
  }

 private:
  static int first(const std::vector<int>& chain) { return chain.empty() ? -1 : chain.front(); }

  void match_chain(const std::vector<int>& from, const std::vector<int>& to, int below) {
    for (std::size_t k = 1; k <= to.size(); ++k) {
      // Whole numbers, so that equal chains match exactly.
      const std::size_t lower = k * from.size() / to.size(), rest = k * from.size() % to.size();
      const auto joint = [&](std::size_t i) { return i == 0 ? below : from[i - 1]; };
      body_.from[to[k - 1]] = {joint(lower), joint(lower + (rest > 0)), double(rest) / to.size()};
    }
  }

  void match(int from, int to) {
    if (from < 0 || to < 0 || to_.cycle.skeleton.joints[to].is_end_site) return;
    body_.from[to] = {from, from, 0.0};
  }

  void match_arm(const ArmChain& from, const ArmChain& to) {
    if (!from.is_found() || !to.is_found()) return;
    match(from.collar, to.collar);
    match(from.shoulder, to.shoulder);
    match(from.elbow, to.elbow);
    match(from.wrist, to.wrist);
    if (from.collar >= 0 && to.collar >= 0 && from_.name(from.collar) == to_.name(to.collar))
      aim(from.collar, from.shoulder, to.collar, to.shoulder);
    aim(from.shoulder, from.elbow, to.shoulder, to.elbow);
    aim(from.elbow, from.wrist, to.elbow, to.wrist);
    body_.aim[to.wrist] = kChildren;
    body_.direction[to.wrist] = from_.below(from.wrist) - from_.at[from.wrist];
  }

  void aim(int from, int from_end, int to, int to_end) {
    body_.aim[to] = to_end;
    body_.direction[to] = from_.at[from_end] - from_.at[from];
  }

  // As a whole, from its first joint; bone by bone where it is the same chain.
  void aim_chain(const std::vector<int>& from, const std::vector<int>& to, int from_end,
                 int to_end) {
    if (from.empty() || to.empty()) return;
    const bool is_same =
        from.size() == to.size() && std::ranges::equal(
                                        from, to, {}, [this](int j) { return from_.name(j); },
                                        [this](int j) { return to_.name(j); });
    if (is_same) {
      for (std::size_t k = 0; k + 1 < from.size(); ++k) aim(from[k], from[k + 1], to[k], to[k + 1]);
      if (from_end >= 0 && to_end >= 0) aim(from.back(), from_end, to.back(), to_end);
      if (from_end < 0) aim_at_only_child(from.back(), to.back());
      return;
    }
    // A head looks ahead however its neck is bent.
    if (from_end < 0) body_.aim[to.back()] = kAsItStood;
    const int last_from = from_end >= 0 ? from_end : from.back();
    const int last_to = to_end >= 0 ? to_end : to.back();
    if (last_from != from.front() && last_to != to.front())
      aim(from.front(), last_from, to.front(), last_to);
  }

  void aim_at_only_child(int from, int to) {
    const int from_child = only_child(from_, from), to_child = only_child(to_, to);
    if (from_child >= 0 && to_child >= 0) aim(from, from_child, to, to_child);
  }

  static bool is_part(const Part& part, int joint) {
    const auto has = [joint](const std::vector<int>& list) {
      return std::ranges::find(list, joint) != list.end();
    };
    return has(part.joints.spine) || has(part.neck) ||
           std::ranges::any_of(part.joints.arm, [joint](const ArmChain& arm) {
             return joint == arm.collar || joint == arm.shoulder || joint == arm.elbow ||
                    joint == arm.wrist;
           });
  }

  void match_names() {
    const auto& joints = to_.cycle.skeleton.joints;
    std::vector<int> same(joints.size(), -1);
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const int joint = static_cast<int>(j);
      const int found = from_.cycle.skeleton.find(joints[j].name);
      if (found < 0 || is_part(to_, joint) || is_part(from_, found)) continue;
      if (to_.is_upper(joint) && from_.is_upper(found)) same[j] = found;
    }
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (same[j] < 0) continue;
      match(same[j], static_cast<int>(j));
      aim_at_only_child(same[j], static_cast<int>(j));
    }
  }

 public:
  // Aims: the mean of the children; none, but the joint stays as it stood.
  static constexpr int kChildren = -2, kAsItStood = -3;

 private:
  Part from_, to_;
  UpperBody body_;
};

// From joint to where its bone ends, in its own frame, standing.
vec3 bone_of(const GaitCycle& cycle, int joint, int end) {
  if (end == Matcher::kChildren) {
    vec3 sum(0.0);
    for (const Joint& child : cycle.skeleton.joints) {
      if (child.parent == joint) sum += child.offset_m;
    }
    return sum;
  }
  vec3 v(0.0);
  for (int j = end; j > joint; j = cycle.skeleton.joints[j].parent) {
    v = cycle.skeleton.joints[j].offset_m + cycle.standing_local[j] * v;
  }
  return v;
}

quat between(const quat& a, const quat& b, double share) {
  const quat near = glm::dot(a, b) < 0.0 ? -b : b;
  return share > 0.0 ? glm::normalize(a * (1.0 - share) + near * share) : a;
}

}  // namespace

UpperBody upper_body(const GaitCycle& source, const GaitCycle& character) {
  return Matcher(source, character).matched();
}

void stand_alike(const UpperBody& body, GaitCycle& character) {
  constexpr double kLeastBone_m = 1e-4;
  const auto& joints = character.skeleton.joints;
  const auto stood = world_rotations(character.skeleton, character.standing_local.data());
  std::vector<quat> world = stood;
  for (std::size_t j = 1; j < joints.size(); ++j) {
    const quat above = world[joints[j].parent];
    world[j] = above * character.standing_local[j];
    if (body.aim[j] == Matcher::kAsItStood) {
      world[j] = stood[j];
      character.standing_local[j] = glm::normalize(glm::conjugate(above) * world[j]);
    }
    if (body.aim[j] == -1 || body.aim[j] == Matcher::kAsItStood) continue;
    const vec3 bone = world[j] * bone_of(character, static_cast<int>(j), body.aim[j]);
    const vec3 wanted = body.direction[j];
    if (glm::length(bone) < kLeastBone_m || glm::length(wanted) < kLeastBone_m) continue;
    world[j] = rotation_between(glm::normalize(bone), glm::normalize(wanted)) * world[j];
    character.standing_local[j] = glm::normalize(glm::conjugate(above) * world[j]);
  }
}

UpperBodyTurn::UpperBodyTurn(const GaitCycle& source, const UpperBody& body,
                             const GaitCycle& character)
    : source_(source),
      body_(body),
      before_(world_rotations(source.skeleton, source.standing_local.data())),
      standing_(world_rotations(character.skeleton, character.standing_local.data())) {}

void UpperBodyTurn::set_sample(int i) {
  const std::size_t joints = source_.skeleton.joints.size();
  after_ = world_rotations(source_.skeleton, source_.local.data() + i * joints);
}

quat UpperBodyTurn::world(int joint) const {
  const Counterpart& from = body_.from[joint];
  const auto turn = [this](int j) { return after_[j] * glm::conjugate(before_[j]); };
  return between(turn(from.lower), turn(from.upper), from.share) * standing_[joint];
}

}  // namespace gaitpad
