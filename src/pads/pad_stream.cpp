#include "gaitpad/pad_stream.h"

#include <cassert>
#include <utility>

#include "pads/pad_finder.h"
#include "pads/pad_io.h"
#include "pads/pad_queue.h"

namespace gaitpad {

namespace {

// What the keyboard says is what is meant: no zones.
std::string keyboard_calibration() {
  CalibrationFile file;
  file.name = "keyboard";
  for (StickCalibration* stick : {&file.calibration.left, &file.calibration.right}) {
    stick->shape = ZoneShape::radial;
    stick->inner = stick->sideways = 0.0;
    stick->outer = 1.0;
  }
  return calibration_text(file);
}

struct Keyboard {
  std::unique_ptr<Device> device;
  PadSlot slot;
};

Result<std::optional<Keyboard>> opened_keyboard(const PadStreamOptions& options) {
  if (!options.keyboard) return std::optional<Keyboard>();
  auto device = open_keyboard(options.keyboard);
  if (!device) return device.error();
  Keyboard keyboard;
  keyboard.device = std::move(*device);
  keyboard.slot.device.info = keyboard.device->info();
  keyboard.slot.device.calibration = keyboard_calibration();
  auto config = pad_config(options.files, keyboard.slot.device, "keyboard");
  if (!config) return config.error();
  config->is_present = false;  // until `added` is read
  keyboard.slot.config = std::move(*config);
  keyboard.slot.layout = keyboard.slot.config.layout;
  return std::optional<Keyboard>(std::move(keyboard));
}

}  // namespace

// Ended from below: first nobody opens any more, then what is open is closed.
struct PadStream::Impl {
  Impl(PadStreamOptions options, const std::optional<Keyboard>& keyboard)
      : queue(options.ring_reports),
        io(queue, counters, remarks,
           [this](std::uint64_t id, std::unique_ptr<Device> device) {
             finder.take_gone(id, std::move(device));
           }),
        finder(
            {std::move(options.files), std::move(options.wish), options.drivers, options.changes_fd,
             keyboard ? std::optional(keyboard->slot.device.info) : std::nullopt},
            slots, io, remarks) {}
  ~Impl();
  void take_over(Keyboard keyboard);

  PadSlots slots;
  PadQueue queue;
  PadCounters counters;
  Remarks remarks;
  PadIo io;
  PadFinder finder;
};

PadStream::Impl::~Impl() {
  finder.stop();
  io.stop();
}

// Before the threads run: it is the first to be announced.
void PadStream::Impl::take_over(Keyboard keyboard) {
  slots[0] = std::move(keyboard.slot);
  OpenedPad opened;
  opened.device = std::move(keyboard.device);
  opened.is_keyboard = true;
  opened.name = "keyboard";
  io.take_over(std::move(opened));
}

PadStream::PadStream() = default;
PadStream::~PadStream() = default;

Result<std::unique_ptr<PadStream>> PadStream::start(PadStreamOptions options) {
  auto keyboard = opened_keyboard(options);
  if (!keyboard) return keyboard.error();
  std::unique_ptr<PadStream> stream(new PadStream());
  stream->impl_ = std::make_unique<Impl>(std::move(options), *keyboard);
  Impl& impl = *stream->impl_;
  if (!impl.queue.is_open() || !impl.io.is_open())
    return Error{"no file descriptors are left for pads"};
  if (*keyboard) impl.take_over(std::move(**keyboard));
  impl.io.start();
  if (auto problem = impl.finder.start()) return *problem;
  return stream;
}

const Report* PadStream::front() noexcept { return impl_->queue.front(); }
void PadStream::pop() noexcept { impl_->queue.pop(); }
void PadStream::wait(std::chrono::milliseconds timeout) { impl_->queue.wait(timeout); }

const TraceDevice& PadStream::device(std::uint16_t index) const noexcept {
  assert(index < impl_->slots.size());
  return impl_->slots[index].device;
}
const PadLayout& PadStream::layout(std::uint16_t index) const noexcept {
  assert(index < impl_->slots.size());
  return *impl_->slots[index].layout;
}
PadConfig& PadStream::config(std::uint16_t index) noexcept {
  assert(index < impl_->slots.size());
  return impl_->slots[index].config;
}

void PadStream::rumble(std::uint16_t device, const Rumble& rumble,
                       std::chrono::milliseconds duration) noexcept {
  impl_->io.rumble(device, rumble, duration);
}
void PadStream::command(std::string_view text) { impl_->io.command(text); }

bool PadStream::has_ended() const noexcept { return impl_->finder.has_ended(); }

PadStreamCounts PadStream::counts() const noexcept {
  PadStreamCounts counts;
  counts.reports = impl_->queue.written();
  counts.lost = impl_->queue.lost() + impl_->counters.lost.load(std::memory_order_relaxed);
  counts.plugged = impl_->counters.plugged.load(std::memory_order_relaxed);
  counts.unplugged = impl_->counters.unplugged.load(std::memory_order_relaxed);
  return counts;
}

std::vector<std::string> PadStream::take_remarks() { return impl_->remarks.take(); }

}  // namespace gaitpad
