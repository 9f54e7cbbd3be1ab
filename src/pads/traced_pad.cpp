#include "pads/traced_pad.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <iterator>
#include <utility>

#include "drivers/pads/recorded_packets.h"
#include "gaitpad/limbs.h"
#include "stick/statistics.h"

namespace gaitpad {
namespace {

bool is_same_kind(const DeviceInfo& a, const DeviceInfo& b) noexcept {
  return a.vendor == b.vendor && a.product == b.product && a.driver == b.driver &&
         a.descriptor == b.descriptor && a.mapping == b.mapping;
}

// The first device of a recording that has a stick, with its layout.
struct FoundPad {
  std::uint16_t device = kNoDevice;
  PadLayout layout;
  int others = 0;  // number of further pads in the recording
};
Result<FoundPad> first_pad(const Trace& trace, const PadOverrides& overrides) {
  FoundPad found;
  for (std::size_t i = 0; i < trace.devices.size(); ++i) {
    auto layout = pad_layout(trace.devices[i].info, overrides);
    if (!layout) {
      return Error{fmt::format("{}: device {}: {}", trace.path, trace.devices[i].index,
                               layout.error().message)};
    }
    if (!layout->is_pad || (!has_stick(*layout, 0) && !has_stick(*layout, 1))) continue;
    if (found.device != kNoDevice) {
      ++found.others;
    } else {
      found.device = static_cast<std::uint16_t>(i);
      found.layout = std::move(*layout);
    }
  }
  if (found.device != kNoDevice) return found;
  return Error{trace.path + ": none of its devices is a pad with a stick"};
}

// Tracks the reports of the device. Returns the number of those that could not be decoded.
std::int64_t take_reports(const Trace& trace, std::uint16_t device, PadTracker& tracker,
                          GyroMeter& gyro) {
  std::int64_t bad = 0;
  Report report;
  for (const TraceEvent& event : trace.events) {
    if (event.device != device) continue;
    if (event.kind == ReportKind::removed) {
      tracker.cut();
      gyro.cut();
    }
    if (event.kind != ReportKind::input) continue;
    copy_report(trace, event, report);
    gyro.take(report);
    if (!tracker.add_report(report)) ++bad;
  }
  return bad;
}

}  // namespace

Result<GuidedPad> traced_pad(const std::vector<std::string>& paths, Damage damage,
                             const PadFiles& files, std::vector<std::string>& remarks) {
  GuidedPad pad;
  std::optional<PadTracker> tracker;
  GyroMeter gyro;
  for (const std::string& path : paths) {
    auto trace = read_trace(path, damage);
    if (!trace) return trace.error();
    if (const auto remark = damage_remark(*trace)) remarks.push_back(*remark);
    accept_packets(*trace);
    auto found = first_pad(*trace, files.overrides);
    if (!found) return found.error();
    const DeviceInfo& info = trace->devices[found->device].info;
    if (!tracker) {
      pad.info = info;
      pad.layout = std::move(found->layout);
      tracker.emplace(pad.layout);
      gyro = {info, std::nullopt};
    } else if (!is_same_kind(info, pad.info)) {
      return Error{fmt::format("{}: {} ({:04x}:{:04x}) is not the pad of {}, {} ({:04x}:{:04x})",
                               path, info.name, info.vendor, info.product, paths.front(),
                               pad.info.name, pad.info.vendor, pad.info.product)};
    }
    if (found->others > 0)
      remarks.push_back(fmt::format("{}: further pads, left out: {}", path, found->others));
    tracker->cut();
    if (const std::int64_t bad = take_reports(*trace, found->device, *tracker, gyro); bad > 0) {
      remarks.push_back(
          fmt::format("{}: reports that are too short or have an unknown id: {}", path, bad));
    }
  }
  pad.tracks = tracker->tracks();
  if (gyro.rest()) pad.gyro_bias_rad_s = gyro.rest()->bias_rad_s;
  return pad;
}

std::optional<Error> learn_frames(const std::vector<std::string>& order, GuidedPad& pad,
                                  std::vector<std::string>& remarks) {
  if (order.empty()) return std::nullopt;
  constexpr std::pair<const char*, vec2> kDirections[] = {
      {"forward", {0.0, 1.0}}, {"right", {1.0, 0.0}}, {"back", {0.0, -1.0}}, {"left", {-1.0, 0.0}}};
  std::vector<vec2> asked;
  for (const std::string& word : order) {
    const auto known =
        std::ranges::find_if(kDirections, [&word](const auto& d) { return word == d.first; });
    assert(known != std::end(kDirections));
    asked.push_back(known->second);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    if (!has_stick(pad.layout, static_cast<int>(side))) continue;
    const Stills found = stills(pad.tracks.stick[side]);
    if (found.pushes.size() < asked.size() || found.rests.empty()) {
      remarks.push_back(
          fmt::format("the {} stick was pushed and held {} of {} times: its axes are taken as the "
                      "pad states them",
                      kSideNames[side], found.pushes.size(), asked.size()));
      continue;
    }
    std::vector<vec2> pushes;
    for (auto push = found.pushes.end() - static_cast<std::ptrdiff_t>(asked.size());
         push != found.pushes.end(); ++push) {
      pushes.push_back(push->mean - found.rests.front().mean);
    }
    const auto frame = frame_of_pushes(pushes, asked);
    if (!frame) {
      return Error{
          fmt::format("--pushes {} does not fit the last ones of the {} stick, or does not "
                      "tell both of its axes",
                      fmt::join(order, ","), kSideNames[side])};
    }
    pad.frame[side] = *frame;
  }
  return std::nullopt;
}

}  // namespace gaitpad
