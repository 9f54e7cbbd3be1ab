#include "paper/made_pad.h"

#include "paper/walk_run.h"

namespace gaitpad {
namespace {

constexpr double kFull = 32767.0;

DeviceInfo device() {
  DeviceInfo info;
  info.bus = BusType::virtual_bus;
  info.vendor = 0x1209;
  info.product = 0x0001;
  info.name = "figures";
  // Game Pad: X and Y, 16 bits each, -32767..32767.
  info.descriptor = {0x05, 0x01, 0x09, 0x05, 0xa1, 0x01, 0x09, 0x30, 0x09, 0x31, 0x16, 0x01,
                     0x80, 0x26, 0xff, 0x7f, 0x75, 0x10, 0x95, 0x02, 0x81, 0x02, 0xc0};
  return info;
}

}  // namespace

PadConfig paper_pad() {
  PadConfig config;
  auto layout = pad_layout(device(), {});
  if (layout) config.layout = std::make_shared<const PadLayout>(std::move(*layout));
  config.is_usable = config.layout && config.layout->is_pad;
  return config;
}

Report paper_report(const vec2& raw) {
  Report report;
  report.device = 0;
  report.size = 4;
  const std::array<double, 2> axes = {raw.x, -raw.y};  // HID's Y grows backwards
  for (std::size_t i = 0; i < 2; ++i) {
    const int count = static_cast<int>(std::floor(std::clamp(axes[i], -1.0, 1.0) * kFull + 0.5));
    report.bytes[2 * i] = static_cast<std::uint8_t>(count & 0xff);
    report.bytes[2 * i + 1] = static_cast<std::uint8_t>((count >> 8) & 0xff);
  }
  return report;
}

Report paper_unplug() {
  Report report;
  report.device = 0;
  report.kind = ReportKind::removed;
  return report;
}

SimulationConfig paper_session(const GaitCycle& cycle, const std::vector<Style>& styles,
                               IkMode ik) {
  SimulationConfig config;
  config.rate_hz = kPaperRate_hz;
  config.ik = ik;
  config.pads = {paper_pad()};
  config.styles = styles;
  config.cycle = cycle;
  for (std::size_t i = 0; i < styles.size(); ++i) {
    config.walkers.emplace_back().style = static_cast<int>(i);
  }
  return config;
}

}  // namespace gaitpad
