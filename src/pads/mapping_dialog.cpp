#include "pads/mapping_dialog.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "hid/sdl_lines.h"
#include "hid/usage_names.h"
#include "pads/newest_reports.h"
#include "system/clock.h"

namespace gaitpad {
namespace {

// A step begins when no field has moved for this time.
constexpr std::int64_t kSettled_ns = 300'000'000;
// Distances of a field from its place when the step began, in half logical ranges, at which it
// counts as pushed and as released.
constexpr double kPushed = 0.6, kReleased = 0.25;

enum class Kind { stick, trigger, button };

}  // namespace

struct MappingDialog::Step {
  const char* prompt;
  Kind kind;
  std::size_t control;   // a PadAxis or a PadButton
  bool is_down = false;  // direction of a stick in which HID's numbers fall
};

const std::vector<MappingDialog::Step>& MappingDialog::steps() noexcept {
  static const std::vector<Step> all = {
      {"push the left stick forward", Kind::stick, kLeftY, true},
      {"push the left stick to the right", Kind::stick, kLeftX},
      {"push the right stick forward", Kind::stick, kRightY, true},
      {"push the right stick to the right", Kind::stick, kRightX},
      {"pull the left trigger", Kind::trigger, kLeftTrigger},
      {"pull the right trigger", Kind::trigger, kRightTrigger},
      {"press the bottom button of the four", Kind::button, kButtonA},
      {"press the right one", Kind::button, kButtonB},
      {"press the left one", Kind::button, kButtonX},
      {"press the top one", Kind::button, kButtonY},
      {"press the left shoulder button", Kind::button, kButtonLeftShoulder},
      {"press the right shoulder button", Kind::button, kButtonRightShoulder},
      {"press Back (Select, Share)", Kind::button, kButtonBack},
      {"press Start (Options)", Kind::button, kButtonStart},
      {"press the left stick down", Kind::button, kButtonLeftStick},
      {"press the right stick down", Kind::button, kButtonRightStick},
  };
  return all;
}

std::size_t MappingDialog::step_count() noexcept { return steps().size(); }

Result<std::unique_ptr<MappingDialog>> MappingDialog::start(const PadFiles& files,
                                                            const PadSelector& selector) {
  if (selector.driver == "sdl")
    return Error{"the driver sdl has named the controls already: take evdev or hidraw"};
  auto stream = PadStream::start({files, selector});
  if (!stream) return stream.error();
  std::unique_ptr<MappingDialog> mapping(new MappingDialog());
  mapping->stream_ = std::move(*stream);
  mapping->still_since_ns_ = now_ns();
  return mapping;
}

void MappingDialog::take_values(const Report& report) {
  const PadLayout& layout = stream_->layout(report.device);
  const std::size_t skip = layout.descriptor.numbered ? 1 : 0;
  if (report.size < skip) return;
  const std::span<const std::uint8_t> data(report.bytes.data() + skip, report.size - skip);
  const std::uint8_t id = report_id_of(layout, report);
  for (PadField& f : fields_) {
    if (f.field->report_id != id || data.size() * 8 < f.field->bit_offset + f.field->bit_size)
      continue;
    const auto half = static_cast<double>(f.field->logical_max - f.field->logical_min) / 2.0;
    const auto middle = static_cast<double>(f.field->logical_min) + half;
    f.value = (static_cast<double>(field_value(*f.field, data)) - middle) / half;
    if (!std::exchange(f.is_known, true)) f.rest = f.value;
  }
}

// The field that the user moves; null: none yet. The axis of a trigger counts before a button that
// is pressed with it.
MappingDialog::PadField* MappingDialog::moved_field(const Step& step) {
  PadField* moved = nullptr;
  for (PadField& f : fields_) {
    const bool is_fit = step.kind == Kind::trigger || f.is_button() == (step.kind == Kind::button);
    if (f.is_taken || !is_fit || std::abs(f.moved()) < kPushed) continue;
    const bool is_better =
        moved == nullptr || (moved->is_button() && !f.is_button()) ||
        (moved->is_button() == f.is_button() && std::abs(f.moved()) > std::abs(moved->moved()));
    if (is_better) moved = &f;
  }
  return moved;
}

bool MappingDialog::is_at_rest() const {
  return std::ranges::all_of(fields_,
                             [](const PadField& f) { return std::abs(f.moved()) < kReleased; });
}

void MappingDialog::take(const Step& step, PadField& field) {
  field.is_taken = true;
  ControlSource source{.usage = field.field->usage, .occurrence = field.occurrence};
  if (!field.is_button()) source.reversed = (field.moved() < 0.0) != step.is_down;
  if (step.kind == Kind::button)
    found_.controls.buttons[step.control] = {source};
  else
    found_.controls.axes[step.control] = {source};
  ++found_count_;
  last_found_ = fmt::format("{} ({}){}", usage_name(source.usage), usage_text(source.usage),
                            source.reversed ? ", reversed" : "");
}

void MappingDialog::take_report(const Report& report) {
  if (device_ == kNoDevice && report.kind == ReportKind::added) {
    device_ = report.device;
    for (const Field& f : stream_->layout(device_).descriptor.fields) {
      if (f.kind != FieldKind::input || f.is_array || f.is_relative || f.bit_size > 32) continue;
      if (f.usage == usage::kHatSwitch || f.logical_max <= f.logical_min) continue;
      std::uint32_t occurrence = 1;
      for (const PadField& other : fields_) {
        occurrence += other.field->usage == f.usage && other.field->report_id == f.report_id;
      }
      fields_.push_back({&f, occurrence});
    }
  }
  if (report.kind != ReportKind::input || report.device != device_) return;
  take_values(report);
  if (is_done()) return;
  if (!is_at_rest()) still_since_ns_ = now_ns();
  const Step& step = steps()[step_];
  PadField* moved = is_prompted_ && !is_held_ ? moved_field(step) : nullptr;
  if (moved != nullptr) {
    take(step, *moved);
    is_held_ = true;
  } else if (is_held_ && is_at_rest()) {
    is_held_ = is_prompted_ = false;
    ++step_;
  }
}

void MappingDialog::prompt_when_still() {
  if (is_prompted_ || !has_pad() || is_done() || now_ns() - still_since_ns_ <= kSettled_ns) return;
  is_prompted_ = true;
  for (PadField& f : fields_) f.rest = f.value;
}

void MappingDialog::look(std::chrono::milliseconds timeout) {
  if (timeout.count() > 0) stream_->wait(timeout);
  // Asked before the reports are read, so that the last ones are not missed.
  const bool has_ended = stream_->has_ended();
  for (; const Report* report = stream_->front(); stream_->pop()) take_report(*report);
  prompt_when_still();
  has_ended_ = has_ended;
}

const char* MappingDialog::prompt() const noexcept {
  return is_prompted_ && !is_held_ && !is_done() ? steps()[step_].prompt : nullptr;
}

void MappingDialog::skip() noexcept {
  if (!is_prompted_ || is_held_ || is_done()) return;
  is_prompted_ = false;
  ++step_;
}

bool MappingDialog::has_left_stick() const noexcept {
  return found_.controls.axes[kLeftX] && found_.controls.axes[kLeftY];
}

Result<std::string> MappingDialog::keep(const std::string& file) const {
  DeviceInfo info = pad();
  info.mapping.clear();  // the layout follows from the new mapping alone
  const auto layout = pad_layout(info, {found_});
  if (!layout) return layout.error();
  auto line = sdl_mapping_text(info, *layout);
  if (!line) return line.error();
  if (const auto saved = save_mappings(file.empty() ? user_mapping_file() : file, {*line}); !saved)
    return saved.error();
  return line;
}

}  // namespace gaitpad
