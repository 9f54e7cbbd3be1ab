// gaitpad map [PAD]: "push the left stick forward". Finds which field of a pad is which control,
// and keeps that for this pad as a line of SDL's, which games read too.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "gaitpad/decode.h"
#include "gaitpad/pad_setup.h"
#include "gaitpad/pad_stream.h"
#include "hid/sdl_mapping.h"
#include "hid/usage_names.h"
#include "pads/newest_reports.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

constexpr const char* kCommand = "map";
constexpr std::chrono::milliseconds kWait{20};
constexpr std::int64_t kSettled_ns = 300'000'000;  // without a move, before a step begins
// Of half the logical range, from where the field was when the step began.
constexpr double kPushed = 0.6, kReleased = 0.25;

enum class Kind { stick, trigger, button };
struct Step {
  const char* prompt;
  Kind kind;
  int control;   // PadAxis or PadButton
  bool is_down;  // of a stick: HID counts down in this direction
};
constexpr Step kSteps[] = {
    {"push the left stick forward", Kind::stick, kLeftY, true},
    {"push the left stick to the right", Kind::stick, kLeftX, false},
    {"push the right stick forward", Kind::stick, kRightY, true},
    {"push the right stick to the right", Kind::stick, kRightX, false},
    {"pull the left trigger", Kind::trigger, kLeftTrigger, false},
    {"pull the right trigger", Kind::trigger, kRightTrigger, false},
    {"press the bottom button of the four", Kind::button, kButtonA, false},
    {"press the right one", Kind::button, kButtonB, false},
    {"press the left one", Kind::button, kButtonX, false},
    {"press the top one", Kind::button, kButtonY, false},
    {"press the left shoulder button", Kind::button, kButtonLeftShoulder, false},
    {"press the right shoulder button", Kind::button, kButtonRightShoulder, false},
    {"press Back (Select, Share)", Kind::button, kButtonBack, false},
    {"press Start (Options)", Kind::button, kButtonStart, false},
    {"press the left stick down", Kind::button, kButtonLeftStick, false},
    {"press the right stick down", Kind::button, kButtonRightStick, false},
};

// The input fields of a pad, as they are and as they were when the step began.
struct PadField {
  const Field* field;
  std::uint32_t occurrence;  // among the fields of its report with its usage
  double value = 0.0, rest = 0.0;
  bool is_known = false, is_taken = false;

  bool is_button() const { return field->logical_max - field->logical_min == 1; }
  double moved() const { return is_known ? value - rest : 0.0; }
};

std::vector<PadField> fields_of(const ReportDescriptor& descriptor) {
  std::vector<PadField> fields;
  for (const Field& f : descriptor.fields) {
    if (f.kind != FieldKind::input || f.is_array || f.is_relative || f.bit_size > 32) continue;
    if (f.usage == usage::kHatSwitch || f.logical_max <= f.logical_min) continue;
    std::uint32_t occurrence = 1;
    for (const PadField& other : fields) {
      occurrence += other.field->usage == f.usage && other.field->report_id == f.report_id;
    }
    fields.push_back({&f, occurrence});
  }
  return fields;
}

void take_values(const PadLayout& layout, const Report& report, std::vector<PadField>& fields) {
  const std::size_t skip = layout.descriptor.numbered ? 1 : 0;
  if (report.size < skip) return;
  const std::span<const std::uint8_t> data(report.bytes.data() + skip, report.size - skip);
  const std::uint8_t id = report_id_of(layout, report);
  for (PadField& f : fields) {
    if (f.field->report_id != id || data.size() * 8 < f.field->bit_offset + f.field->bit_size)
      continue;
    const auto half = static_cast<double>(f.field->logical_max - f.field->logical_min) / 2.0;
    const auto middle = static_cast<double>(f.field->logical_min) + half;
    f.value = (static_cast<double>(field_value(*f.field, data)) - middle) / half;
    if (!std::exchange(f.is_known, true)) f.rest = f.value;
  }
}

bool is_fit(const PadField& f, Kind kind) {
  if (f.is_taken) return false;
  return kind == Kind::trigger || f.is_button() == (kind == Kind::button);
}

// The field that the person moves; null: none yet. Of a trigger the axis counts before a button
// that is pressed with it.
PadField* moved_field(std::vector<PadField>& fields, Kind kind) {
  PadField* moved = nullptr;
  for (PadField& f : fields) {
    if (!is_fit(f, kind) || std::abs(f.moved()) < kPushed) continue;
    const bool is_better =
        moved == nullptr || (moved->is_button() && !f.is_button()) ||
        (moved->is_button() == f.is_button() && std::abs(f.moved()) > std::abs(moved->moved()));
    if (is_better) moved = &f;
  }
  return moved;
}

bool is_at_rest(const std::vector<PadField>& fields) {
  return std::ranges::all_of(fields,
                             [](const PadField& f) { return std::abs(f.moved()) < kReleased; });
}

// What has been found of a pad.
struct Mapped {
  std::uint16_t device = kNoDevice;
  std::vector<PadField> fields;
  PadOverride found;
  std::size_t steps = 0, controls = 0;
};

void keep(const Step& step, PadField& field, Mapped& mapped) {
  field.is_taken = true;
  ControlSource source{.usage = field.field->usage, .occurrence = field.occurrence};
  if (!field.is_button()) source.reversed = (field.moved() < 0.0) != step.is_down;
  if (step.kind == Kind::button)
    mapped.found.controls.buttons[static_cast<std::size_t>(step.control)] = {source};
  else
    mapped.found.controls.axes[static_cast<std::size_t>(step.control)] = {source};
  ++mapped.controls;
  print_remarks(kCommand,
                {fmt::format("  {} ({}){}", usage_name(source.usage), usage_text(source.usage),
                             source.reversed ? ", reversed" : "")});
}

// Asks for one control after the other. False: the user gave up, or the pad is gone too soon.
bool ask(PadStream& stream, const PadWish& wish, RunEnd& end, Mapped& mapped) {
  InputLines input;
  StatusLine line(2);
  MissingPad missing(kCommand, wish);
  bool is_prompted = false, is_held = false;
  std::int64_t still_since_ns = now_ns();
  while (mapped.steps < std::size(kSteps) && !end.is_reached()) {
    stream.wait(kWait);
    print_remarks(kCommand, stream.take_remarks(), &line);
    missing.look(stream.counts().plugged, line);
    for (const std::string& word : input.take_lines()) {
      if (word == "q") return false;
      if (word == "s" && is_prompted) ++mapped.steps, is_prompted = false;
    }
    for (const Report* report = stream.front(); report != nullptr; report = stream.front()) {
      if (mapped.device == kNoDevice && report->kind == ReportKind::added) {
        mapped.device = report->device;
        mapped.fields = fields_of(stream.layout(report->device).descriptor);
        print_remarks(kCommand,
                      {stream.device(report->device).info.name +
                       ": let everything go; s and Enter skips a step, q and Enter ends"});
      }
      const bool is_mine = report->kind == ReportKind::input && report->device == mapped.device;
      if (is_mine) take_values(stream.layout(report->device), *report, mapped.fields);
      stream.pop();
      if (!is_mine || mapped.steps == std::size(kSteps)) continue;
      const Step& step = kSteps[mapped.steps];
      if (!is_at_rest(mapped.fields)) still_since_ns = now_ns();
      PadField* moved = is_prompted && !is_held ? moved_field(mapped.fields, step.kind) : nullptr;
      if (moved != nullptr) {
        keep(step, *moved, mapped);
        is_held = true;
      } else if (is_held && is_at_rest(mapped.fields)) {
        is_held = is_prompted = false;
        ++mapped.steps;
      }
    }
    if (!is_prompted && mapped.device != kNoDevice && mapped.steps < std::size(kSteps) &&
        now_ns() - still_since_ns > kSettled_ns) {
      is_prompted = true;
      for (PadField& f : mapped.fields) f.rest = f.value;
      print_remarks(kCommand, {fmt::format("{} of {}: {}", mapped.steps + 1, std::size(kSteps),
                                           kSteps[mapped.steps].prompt)});
    }
    if (stream.has_ended() && stream.front() == nullptr) break;
  }
  missing.finish(stream.counts().plugged, line);
  const auto& axes = mapped.found.controls.axes;
  return axes[kLeftX] && axes[kLeftY] && end.cut_off_status() == 0;
}

int run(const PadWish& wish, const std::string& out) {
  RunEnd end;
  auto files = pad_files("", "");
  if (!files) return fail(kCommand, files.error().message);
  const auto stream = PadStream::start({std::move(*files), wish});
  if (!stream) return fail(kCommand, stream.error().message);
  Mapped mapped;
  if (!ask(**stream, wish, end, mapped)) {
    const int status = fail(kCommand, "ended before the left stick was known; nothing is kept");
    return end.cut_off_status() != 0 ? end.cut_off_status() : status;
  }
  DeviceInfo info = (*stream)->device(mapped.device).info;
  info.mapping.clear();  // what was known before
  const auto layout = pad_layout(info, {mapped.found});
  if (!layout) return fail(kCommand, layout.error().message);
  const auto text = sdl_mapping_text(info, *layout);
  if (!text) return fail(kCommand, text.error().message);
  const std::string target = out.empty() ? user_mapping_file() : out;
  if (const auto saved = save_mappings(target, {*text}); !saved)
    return fail(kCommand, saved.error().message);
  fmt::print("{}\n", printable(*text));
  print_remarks(kCommand, {fmt::format("{} controls of {} are kept in {}", mapped.controls,
                                       info.name, target)});
  return 0;
}

}  // namespace

void add_map(CLI::App& app, int& status) {
  struct Arguments {
    PadWish wish;
    std::string out;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "map", "asks for each stick, trigger and button of a pad whose controls are wrong");
  command->footer(
      "Keeps the answers for this pad in gamecontrollerdb.txt in the user's folder, which every\n"
      "driver reads first, and prints the line: games that use SDL read it too.");
  add_pad_options(*command, arguments->wish);
  command->add_option("--out", arguments->out, "another file of SDL's lines to keep it in");
  command->callback([arguments, &status] { status = run(arguments->wish, arguments->out); });
}

}  // namespace gaitpad
