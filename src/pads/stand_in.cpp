#include "pads/stand_in.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "gaitpad/calibration.h"
#include "system/clock.h"

namespace gaitpad {
namespace {

bool filters_jumps(const Calibration& c) { return c.left.filters_jumps || c.right.filters_jumps; }

VirtualPadState calibrated(const Calibration& c, const PadState& state) noexcept {
  return {stick_position(c, state),
          {trigger_position(c.left_trigger, state.axis[kLeftTrigger]),
           trigger_position(c.right_trigger, state.axis[kRightTrigger])},
          state.buttons};
}

Error grab_error(const std::string& node, int error) {
  if (error == EBUSY) return Error{node + ": another program has this pad for itself"};
  return Error{fmt::format("{}: cannot be taken: {}", node, std::strerror(error))};
}

}  // namespace

std::optional<Error> StandIn::plug(const DeviceListing& listing) {
  auto node = options_.open(listing);
  if (!node) return node.error();
  const DeviceInfo& info = (*node)->info();
  const auto recorded = recorded_device(options_.files, info, std::nullopt, remarks_);
  auto config =
      pad_config(options_.files, recorded.device.info, recorded.calibration, listing.node);
  if (!config) return config.error();
  if (!config->is_usable) return Error{listing.node + ": no stick"};

  CalibratedCopy copy((*node)->layout(), *config->layout);
  VirtualPadShape shape = shape_of(XboxKind::xbox_360);
  if (options_.look == Look::own)
    shape = {info.name,   info.bus,    info.vendor, info.product, info.version, info.physical_path,
             copy.axes(), copy.keys(), {}};
  shape.effects = (*node)->effect_codes();

  // Grab the real pad before the virtual one is there, so that programs never see two.
  if (const int problem = (*node)->grab()) return grab_error(listing.node, problem);
  if (!pad_ || shape != shape_) {
    pad_.reset();
    auto pad = options_.create(shape);
    if (!pad) return pad.error();
    pad_ = std::move(*pad);
    shape_ = std::move(shape);
    effects_ = {};
    sent_ = {};
    copy_ = std::move(copy);
  }
  config_ = std::move(*config);
  node_ = std::move(*node);
  state_ = {};
  filter_ = {};
  effects_.set_target(node_.get());
  for (std::string& remark : node_->take_remarks()) remarks_.push_back(std::move(remark));
  return std::nullopt;
}

std::vector<pollfd> StandIn::poll_fds() const {
  std::vector<pollfd> fds;
  if (node_) fds.assign(node_->poll_fds().begin(), node_->poll_fds().end());
  if (pad_) fds.push_back(pad_->fd());
  if (node_ && filters_jumps(config_.calibration)) fds.push_back({settling_.fd(), POLLIN, 0});
  return fds;
}

void StandIn::serve() noexcept {
  Report report;
  Device::Status status = node_ ? node_->read(report) : Device::Status::nothing;
  for (; status == Device::Status::report; status = node_->read(report)) {
    if (!decode(*config_.layout, report, state_)) continue;
    filter_.take(state_);
    send();
  }
  if (status == Device::Status::gone) unplug();
  if (node_ && filters_jumps(config_.calibration) && settling_.take()) settle();
  if (pad_) pad_->serve_effects(effects_);
}

// An event that the kernel refuses is lost; the next change of the control corrects it.
void StandIn::send() noexcept {
  const Calibration& calibration = config_.calibration;
  const VirtualPadState now = calibrated(calibration, filter_.filtered(calibration, state_));
  if (options_.look == Look::own) {
    static_cast<void>(pad_->write(copy_->events(node_->state(), now)));
  } else {
    static_cast<void>(pad_->write(events_between(sent_, now, XboxKind::xbox_360)));
    sent_ = now;
  }
  if (filters_jumps(calibration))
    settling_.set(now_ns() + static_cast<std::int64_t>(JumpFilter::kSettled_s * 1e9));
}

// Ends the filter's delay if no report has followed the last one.
void StandIn::settle() noexcept {
  filter_.settle();
  send();
  settling_.set(0);
}

void StandIn::unplug() noexcept {
  remarks_.push_back(node_->info().name + ": was unplugged; waiting for it");
  effects_.set_target(nullptr);
  node_.reset();
  const bool is_copy = options_.look == Look::own;
  static_cast<void>(
      pad_->write(is_copy ? copy_->rest() : events_between(sent_, {}, XboxKind::xbox_360)));
  sent_ = {};
}

}  // namespace gaitpad
