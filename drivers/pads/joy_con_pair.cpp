#include "drivers/pads/joy_con_pair.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

namespace gaitpad {

namespace {

using Status = Device::Status;

constexpr std::uint16_t kNintendo = 0x057e;
enum : std::uint16_t { kLeft = 0x2006, kRight = 0x2007, kPair = 0x2008, kGrip = 0x200e };

// Report 0x30, from dekuNukem's Nintendo_Switch_Reverse_Engineering (bluetooth_hid_notes.md):
// buttons of the right one, shared, of the left one; then three bytes for each stick.
constexpr std::uint8_t kFull = 0x30;
constexpr std::size_t kRightButtons = 3, kSharedButtons = 4, kLeftButtons = 5, kLeftStick = 6,
                      kRightStick = 9, kStickBytes = 3, kPairBytes = 12;
constexpr std::uint8_t kSharedLeft = 0x29, kSharedRight = 0x16;  // minus, stick, capture; plus ...
constexpr std::array<std::uint8_t, kStickBytes> kCentred = {0x00, 0x08, 0x80};
constexpr int kMaxSkippedInARow = 64;  // other reports, before other pads get their turn

// A single Joy-Con's factory sticks are for holding it sideways; these are for holding it upright.
FactoryAxis mirrored(const FactoryAxis& axis) noexcept {
  return {-axis.max, -axis.centre, -axis.min};
}

DeviceInfo pair_info(const DeviceInfo& left, const DeviceInfo& right) {
  DeviceInfo pair = left;
  pair.product = kPair;
  pair.name = "Joy-Con pair";
  pair.unique_id += "+" + right.unique_id;
  pair.physical_path += "+" + right.physical_path;
  return pair;
}

class JoyConPair final : public Device {
 public:
  JoyConPair(std::unique_ptr<Device> left, std::unique_ptr<Device> right)
      : sides_{std::move(left), std::move(right)},
        info_(pair_info(sides_[0]->info(), sides_[1]->info())) {
    std::copy(kCentred.begin(), kCentred.end(), state_.begin() + kLeftStick);
    std::copy(kCentred.begin(), kCentred.end(), state_.begin() + kRightStick);
    collect_fds();
  }

  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override {
    return std::span(fds_).first(fd_count_);
  }

  // One after the other, so that a fast side does not keep the slow one waiting.
  Status read(Report& report) noexcept override {
    int silent = 0;
    for (int i = 0; i < kMaxSkippedInARow && silent < 2; ++i) {
      turn_ = 1 - turn_;
      const Status status = sides_[turn_]->read(report);
      if (status == Status::gone) return status;
      silent = status == Status::nothing ? silent + 1 : 0;
      if (status == Status::report && merge(report)) return status;
    }
    collect_fds();
    return Status::nothing;
  }

  bool rumble(const Rumble& strengths) noexcept override {
    const bool left = sides_[0]->rumble(strengths), right = sides_[1]->rumble(strengths);
    return left || right;
  }

  std::optional<FactorySticks> factory_sticks() const override {
    const auto left = sides_[0]->factory_sticks(), right = sides_[1]->factory_sticks();
    if (!left && !right) return std::nullopt;
    FactorySticks both;
    if (left) {
      both.left_x = left->left_y;
      both.left_y = mirrored(left->left_x);
    }
    if (right) {
      both.right_x = mirrored(right->left_y);
      both.right_y = right->left_x;
    }
    return both;
  }
  std::int64_t lost() const noexcept override { return sides_[0]->lost() + sides_[1]->lost(); }
  std::vector<std::string> take_remarks() override {
    std::vector<std::string> remarks = sides_[0]->take_remarks(), more = sides_[1]->take_remarks();
    std::move(more.begin(), more.end(), std::back_inserter(remarks));
    return remarks;
  }

 private:
  void collect_fds() noexcept {
    fd_count_ = 0;
    for (const auto& side : sides_) {
      for (const pollfd& fd : side->poll_fds()) {
        if (fd_count_ < fds_.size()) fds_[fd_count_++] = fd;
      }
    }
  }

  // Takes this side's half into the common state, and puts the state into the report.
  bool merge(Report& report) noexcept {
    if (report.size < kPairBytes || report.bytes[0] != kFull) return false;
    const bool is_left = turn_ == 0;
    const std::uint8_t own = is_left ? kSharedLeft : kSharedRight;
    const std::size_t buttons = is_left ? kLeftButtons : kRightButtons;
    const std::size_t stick = is_left ? kLeftStick : kRightStick;
    state_[buttons] = report.bytes[buttons];
    state_[kSharedButtons] = static_cast<std::uint8_t>((state_[kSharedButtons] & ~own) |
                                                       (report.bytes[kSharedButtons] & own));
    std::copy_n(report.bytes.begin() + stick, kStickBytes, state_.begin() + stick);
    std::copy(state_.begin() + kRightButtons, state_.end(), report.bytes.begin() + kRightButtons);
    return true;
  }

  std::array<std::unique_ptr<Device>, 2> sides_;  // left, right
  DeviceInfo info_;
  std::size_t turn_ = 1;  // the side that was read last
  std::array<std::uint8_t, kPairBytes> state_{};
  std::array<pollfd, 8> fds_{};
  std::size_t fd_count_ = 0;
};

bool is_joy_con(const DeviceListing& single, std::uint16_t product) {
  const DeviceInfo& info = single.info;
  if (info.vendor != kNintendo || info.product != product || !single.problem.empty()) return false;
  // NES controllers have the same ids.
  return product == kGrip || info.name.find("NES") == std::string::npos;
}

DeviceListing joined(const DeviceListing& left, const DeviceListing& right) {
  DeviceListing pair = left;
  pair.info = pair_info(left.info, right.info);
  pair.node = left.node + "+" + right.node;
  pair.pad_path = left.pad_path + "+" + right.pad_path;
  pair.parts = {left.pad_path, right.pad_path};
  return pair;
}

}  // namespace

std::vector<DeviceListing> joy_con_pairs(const std::vector<DeviceListing>& singles) {
  std::vector<DeviceListing> pairs;
  const auto find_pairs = [&](std::uint16_t one, std::uint16_t other) {
    std::vector<const DeviceListing*> left, right;
    for (const DeviceListing& single : singles) {
      if (is_joy_con(single, one) && (one != other || left.size() == right.size()))
        left.push_back(&single);
      else if (is_joy_con(single, other))
        right.push_back(&single);
    }
    for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i)
      pairs.push_back(joined(*left[i], *right[i]));
  };
  find_pairs(kLeft, kRight);
  find_pairs(kGrip, kGrip);
  return pairs;
}

Result<std::unique_ptr<Device>> join_joy_cons(std::unique_ptr<Device> one,
                                              std::unique_ptr<Device> other) {
  if (one->info().product == kRight) std::swap(one, other);
  if (one->info().product != kLeft || other->info().product != kRight)
    return Error{"these are not a left and a right Joy-Con"};
  return std::unique_ptr<Device>(std::make_unique<JoyConPair>(std::move(one), std::move(other)));
}

}  // namespace gaitpad
