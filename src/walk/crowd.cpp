#include "gaitpad/crowd.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <functional>
#include <map>
#include <utility>

#include "base/bits.h"
#include "base/lanes.h"
#include "base/ranges.h"
#include "walk/pose.h"
#include "walk/sound_input.h"
#include "walk/steer.h"
#include "walk/walk.h"
#include "walk/walk_frame.h"

namespace gaitpad {

// A block of any width. Lanes without a walk of their own repeat the last walk.
class WalkBlock {
 public:
  virtual ~WalkBlock() = default;
  virtual std::unique_ptr<WalkBlock> clone() const = 0;
  virtual std::size_t bytes() const noexcept = 0;
  virtual Block<1> walk(int lane) const noexcept = 0;
  // Puts a walk into a lane. `before`: the numbers of its root before the last tick.
  virtual void take(const Block<1>& walk, const RootNumbers& before, int lane) noexcept = 0;
  virtual const RootNumbers& before(int lane) const noexcept = 0;
  virtual void set_detail(Detail detail, int lane) noexcept = 0;
  // True if the walk was last asked for these parameters.
  virtual bool has_asked(const GaitParams& params, int lane) const noexcept = 0;
  virtual void ask(const GaitParams& params, int lane) noexcept = 0;
  virtual void place(const Placement& placed, int lane) noexcept = 0;
  virtual void advance(const Tables& tables, IkMode mode, int parts,
                       const Poses& poses) noexcept = 0;
  double tick_s = 1.0 / 240.0;  // length of the last tick
};

namespace {

template <int kWidth>
class BlockOf final : public WalkBlock {
 public:
  explicit BlockOf(int walks) : walks_(walks) {}
  std::unique_ptr<WalkBlock> clone() const override { return std::make_unique<BlockOf>(*this); }
  std::size_t bytes() const noexcept override { return sizeof *this; }

  Block<1> walk(int lane) const noexcept override {
    Block<1> one;
    copy_walk(block_, lane, one, 0);
    return one;
  }
  void take(const Block<1>& walk, const RootNumbers& before, int lane) noexcept override {
    for_lanes(lane, [&](int w) {
      copy_walk(walk, 0, block_, w);
      before_[w] = before;
      asked_[w] = {};
    });
  }
  const RootNumbers& before(int lane) const noexcept override { return before_[lane]; }
  void set_detail(Detail detail, int lane) noexcept override {
    for_lanes(lane, [&](int w) { gaitpad::set_detail(detail, w, block_); });
  }
  bool has_asked(const GaitParams& params, int lane) const noexcept override {
    const Asked& asked = asked_[lane];
    // Equal bytes are equal parameters; asking again for equal ones of other bytes does no harm.
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison)
    return asked.is_known && std::memcmp(&asked.params, &params, sizeof params) == 0;
  }
  void ask(const GaitParams& params, int lane) noexcept override {
    Asked& asked = asked_[lane];
    std::memcpy(&asked.params, &params, sizeof params);
    asked.is_known = true;
    for_lanes(lane, [&](int w) { gaitpad::ask(params, w, block_); });
  }
  void place(const Placement& placed, int lane) noexcept override {
    for_lanes(lane, [&](int w) { gaitpad::place(placed, w, block_); });
  }
  void advance(const Tables& tables, IkMode mode, int parts, const Poses& poses) noexcept override {
    for (int w = 0; w < kWidth; ++w) before_[w] = root_numbers(block_, w);
    for (int part = 0; part < parts; ++part) {
      if constexpr (kWidth == 1) {
        gaitpad::advance(tables, mode, block_, poses);
      } else {
        gaitpad::advance(tables, block_, poses);
      }
    }
  }

 private:
  struct Asked {
    GaitParams params;
    bool is_known = false;
  };
  template <class Work>
  void for_lanes(int lane, const Work& work) noexcept {
    work(lane);
    for (int w = walks_; lane == walks_ - 1 && w < kWidth; ++w) work(w);
  }
  Block<kWidth> block_{};
  std::array<RootNumbers, kWidth> before_;
  std::array<Asked, kWidth> asked_;
  int walks_;
};

template <int kCount = 0>
std::unique_ptr<WalkBlock> make_block(int width, int walks) {
  constexpr int kWidth = kLaneCounts[kCount];
  if constexpr (kWidth > 1)
    if (width < kWidth) return make_block<kCount + 1>(width, walks);
  return std::make_unique<BlockOf<kWidth>>(walks);
}
// Width of the narrowest block that holds `walks`, at most `widest`.
int width_for(int walks, int widest) noexcept {
  int width = widest;
  for (const int narrower : kLaneCounts)
    if (narrower < width && narrower >= walks) width = narrower;
  return width;
}

// What of a tick a style asks for, in an order in which neighbours share one part.
enum class StyleKind { even, upper_body, both, legs };
StyleKind style_kind(const GaitParams& params) noexcept {
  const bool legs = params.weight != GaitParams{}.weight;
  if (is_plain(params.body)) return legs ? StyleKind::legs : StyleKind::even;
  return legs ? StyleKind::both : StyleKind::upper_body;
}
int widest_block(IkMode mode) noexcept { return mode == IkMode::paper ? 1 : lanes_in_use(); }

}  // namespace

Crowd::Crowd() noexcept = default;
Crowd::~Crowd() = default;
Crowd::Crowd(Crowd&& from) noexcept = default;
Crowd& Crowd::operator=(Crowd&& from) noexcept = default;
Crowd::Crowd(const Crowd& from)
    : mode_(from.mode_),
      order_(from.order_),
      block_begin_(from.block_begin_),
      lane_(from.lane_),
      models_(from.models_),
      params_(from.params_),
      details_(from.details_),
      placed_(from.placed_),
      bad_inputs_(from.bad_inputs_),
      roots_m_(from.roots_m_),
      first_joint_(from.first_joint_),
      local_(from.local_) {
  for (const auto& block : from.blocks_) blocks_.push_back(block->clone());
}
Crowd& Crowd::operator=(const Crowd& from) {
  if (this != &from) *this = Crowd(from);
  return *this;
}

Crowd::Crowd(std::span<const CrowdMember> members, IkMode mode)
    : mode_(mode),
      lane_(members.size()),
      params_(members.size()),
      details_(members.size()),
      placed_(members.size()),
      bad_inputs_(members.size()),
      roots_m_(members.size()) {
  models_.reserve(members.size());
  first_joint_.reserve(members.size() + 1);
  for (const CrowdMember& member : members) {
    models_.push_back(member.model);
    first_joint_.push_back(first_joint_.back() + member.model->cycle.skeleton.joints.size());
  }
  local_.resize(first_joint_.back());
  std::map<const WalkModel*, std::vector<int>> by_model;
  for (std::size_t i = 0; i < members.size(); ++i)
    by_model[members[i].model.get()].push_back(static_cast<int>(i));
  const int widest = widest_block(mode);
  for (const auto& [model, numbers] : by_model) {
    for (std::size_t i = 0; i < numbers.size();) {
      const int left = static_cast<int>(numbers.size() - i), width = width_for(left, widest),
                walks = std::min(width, left);
      block_begin_.push_back(static_cast<int>(order_.size()));
      for (int lane = 0; lane < walks; ++lane, ++i) {
        lane_[numbers[i]] = {static_cast<int>(blocks_.size()), lane};
        order_.push_back(numbers[i]);
      }
      blocks_.push_back(make_block(width, walks));
    }
  }
  block_begin_.push_back(static_cast<int>(order_.size()));
  for (std::size_t i = 0; i < members.size(); ++i) restart(static_cast<int>(i), members[i].place_m);
}

Result<Crowd> Crowd::create(std::span<const CrowdMember> members, IkMode mode) {
  for (std::size_t i = 0; i < members.size(); ++i) {
    const std::string member = "members[" + std::to_string(i) + "]";
    if (!members[i].model) return Error{member + ".model is null"};
    if (auto problem = vector_problem(member + ".place_m", members[i].place_m, kFarthest_m))
      return *problem;
  }
  return Crowd(members, mode);
}

WalkState Crowd::state(int member) const noexcept {
  const auto [block, lane] = lane_[member];
  WalkState state;
  state.walk = blocks_[block]->walk(lane);
  state.placed = placed_[member];
  state.detail = details_[member];
  state.tick_s = blocks_[block]->tick_s;
  state.root = root_of(state.walk);
  state.root_before = root_of(blocks_[block]->before(lane));
  place(state.placed, 0, state.walk);
  state.bad_inputs = bad_inputs_[member];
  return state;
}

WalkFrame Crowd::frame(int member) const noexcept {
  return frame_of(*models_[member], state(member), roots_m_[member], local(member));
}

Placement Crowd::root(int member) const noexcept {
  return root_of(blocks_[lane_[member].block]->walk(lane_[member].lane));
}

void Crowd::put_state(int member, const WalkState& state) noexcept {
  const auto [block, lane] = lane_[member];
  blocks_[block]->take(state.walk, root_numbers(state.walk, 0), lane);
  blocks_[block]->set_detail(details_[member], lane);
  placed_[member] = state.placed;
  bad_inputs_[member] = state.bad_inputs;
}

void Crowd::restart(int member, const vec3& place_m) noexcept {
  if (!has(member)) return;
  Pose pose;
  put_state(member, standing(*models_[member], place_m, pose));
  store_pose(member, pose);
}

void Crowd::exchange_lanes(int member, int other) noexcept {
  if (member == other) return;
  Lane &a = lane_[member], &b = lane_[other];
  WalkBlock &of_a = *blocks_[a.block], &of_b = *blocks_[b.block];
  const Block<1> walk_a = of_a.walk(a.lane), walk_b = of_b.walk(b.lane);
  const RootNumbers before_a = of_a.before(a.lane), before_b = of_b.before(b.lane);
  of_a.take(walk_b, before_b, a.lane);
  of_b.take(walk_a, before_a, b.lane);
  std::swap(order_[block_begin_[a.block] + a.lane], order_[block_begin_[b.block] + b.lane]);
  std::swap(a, b);
}

void Crowd::set_detail(int member, Detail detail) noexcept {
  if (!has(member) || details_[member] == detail) return;
  if (!is_sound(detail)) {
    ++bad_inputs_[member];
    return;
  }
  // The member goes to the border between those of its model that are in full and the others.
  const auto before = [this](int a, int b) {
    return std::less<>()(models_[a].get(), models_[b].get());
  };
  const auto [begin, end] = std::equal_range(order_.begin(), order_.end(), member, before);
  const auto border =
      std::partition_point(begin, end, [this](int of) { return details_[of] == Detail::full; });
  exchange_lanes(member, detail == Detail::full ? *border : *(border - 1));
  details_[member] = detail;
  blocks_[lane_[member].block]->set_detail(detail, lane_[member].lane);
}

void Crowd::group_by_style() {
  const auto is_before = [this](int a, int b) {
    if (details_[a] != details_[b]) return details_[a] == Detail::full;
    const GaitParams &of_a = params_[a], &of_b = params_[b];
    const StyleKind kind_a = style_kind(of_a), kind_b = style_kind(of_b);
    if (kind_a != kind_b) return kind_a < kind_b;
    // Any order will do that puts equal styles together. Bytes have one, even of bad numbers.
    const auto bytes = []<class T>(const T& of) {
      return bits_as<std::array<std::byte, sizeof of>>(of);
    };
    return std::pair(bytes(of_a.weight), bytes(of_a.body)) <
           std::pair(bytes(of_b.weight), bytes(of_b.body));
  };
  for (std::size_t begin = 0; begin < order_.size();) {
    std::vector<int> sorted;
    for (std::size_t i = begin; i < order_.size() && models_[order_[i]] == models_[order_[begin]];
         ++i)
      sorted.push_back(order_[i]);
    std::stable_sort(sorted.begin(), sorted.end(), is_before);
    for (const int member : sorted) exchange_lanes(order_[begin++], member);
  }
}

template <class Work>
void Crowd::place_anew(int member, const Work& work) noexcept {
  if (!has(member)) return;
  Pose pose;
  copy_pose(member, pose);
  WalkState moving = state(member);
  work(moving, pose);
  placed_[member] = moving.placed;
  bad_inputs_[member] = moving.bad_inputs;
  store_pose(member, pose);
}

void Crowd::move(int member, const Placement& by) noexcept {
  place_anew(member, [&](WalkState& moving, Pose& pose) { move_walk(by, moving, pose); });
}

void Crowd::put(int member, const vec3& place_m, double heading_rad) noexcept {
  place_anew(member,
             [&](WalkState& moving, Pose& pose) { put_walk(place_m, heading_rad, moving, pose); });
}

template <class Request>
bool Crowd::ask_step(int member, const Request& request) noexcept {
  if (!has(member)) return false;
  WalkState asked = state(member);
  if (!request(asked)) return false;
  const auto [number, lane] = lane_[member];
  WalkBlock& block = *blocks_[number];
  block.take(asked.walk, block.before(lane), lane);
  return true;
}

std::optional<Placement> Crowd::nearest_step(int member, const Placement& heel) const noexcept {
  if (!has(member)) return std::nullopt;
  return gaitpad::nearest_step(*models_[member], heel, state(member));
}

bool Crowd::step_to(int member, const Placement& heel) noexcept {
  return ask_step(
      member, [&](WalkState& asked) { return gaitpad::step_to(*models_[member], heel, asked); });
}

bool Crowd::push(int member, const vec3& velocity_m_s) noexcept {
  return ask_step(member, [&](WalkState& asked) { return push_walk(velocity_m_s, asked); });
}

void Crowd::store_pose(int member, const Pose& pose) noexcept {
  roots_m_[member] = pose.root_m;
  std::copy_n(pose.local.begin(), pose.joint_count,
              local_.begin() + static_cast<std::ptrdiff_t>(first_joint_[member]));
}

void Crowd::copy_pose(int member, Pose& pose) const noexcept {
  if (!has(member)) return;
  pose.root_m = roots_m_[member];
  const std::span<const quat> from = local(member);
  pose.joint_count = static_cast<int>(from.size());
  std::copy(from.begin(), from.end(), pose.local.begin());
}

std::size_t Crowd::bytes() const noexcept {
  std::size_t sum = models_.size() * (sizeof(GaitParams) + sizeof(Placement) + sizeof(vec3)) +
                    local_.size() * sizeof(quat);
  for (const auto& block : blocks_) sum += block->bytes();
  return sum;
}

int Crowd::blocks() const noexcept { return static_cast<int>(blocks_.size()); }

void Crowd::advance_block(int number, double dt_s) noexcept {
  if (number < 0 || number >= blocks()) return;
  WalkBlock& block = *blocks_[number];
  const std::span<const int> members(order_.data() + block_begin_[number],
                                     order_.data() + block_begin_[number + 1]);
  if (!is_sound_tick(dt_s)) {
    for (const int member : members) ++bad_inputs_[member];
    dt_s = block.tick_s;
  }
  block.tick_s = dt_s;
  std::array<quat*, kLaneCounts[0]> locals;
  std::array<vec3*, kLaneCounts[0]> roots_m;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const int member = members[i], lane = static_cast<int>(i);
    if (!block.has_asked(params_[member], lane)) {
      if (!is_sound(params_[member])) {
        WalkState in_force = state(member);
        params_[member] = mended_params(params_[member], in_force);
        bad_inputs_[member] = in_force.bad_inputs;
      }
      block.ask(params_[member], lane);
    }
    block.place(placed_[member], lane);
    locals[i] = local_.data() + first_joint_[member];
    roots_m[i] = &roots_m_[member];
  }
  const int parts = tick_parts(dt_s);
  const Tables tables = tables_of(*models_[members[0]], dt_s / parts);
  const Poses poses{locals.data(), roots_m.data(), static_cast<int>(members.size())};
  block.advance(tables, mode_, parts, poses);
}

void Crowd::advance(double dt_s) noexcept {
  for (int block = 0; block < blocks(); ++block) advance_block(block, dt_s);
}

}  // namespace gaitpad
