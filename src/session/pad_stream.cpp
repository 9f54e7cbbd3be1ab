#include "session/pad_stream.h"

#include <cassert>
#include <utility>

#include "session/pad_finder.h"
#include "session/pad_io.h"
#include "session/pad_queue.h"
#include "session/remarks.h"

namespace gaitpad {

// Ended from below: first nobody opens any more, then what is open is closed.
struct PadStream::Impl {
  explicit Impl(PadStreamOptions options)
      : queue(options.ring_reports),
        io(queue, counters, remarks,
           [this](std::uint64_t id, std::unique_ptr<Device> device) {
             finder.take_gone(id, std::move(device));
           }),
        finder({std::move(options.files), std::move(options.wish), options.drivers,
                options.changes_fd},
               slots, io, remarks) {}
  ~Impl();

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

PadStream::PadStream() = default;
PadStream::~PadStream() = default;

Result<std::unique_ptr<PadStream>> PadStream::start(PadStreamOptions options) {
  std::unique_ptr<PadStream> stream(new PadStream());
  stream->impl_ = std::make_unique<Impl>(std::move(options));
  Impl& impl = *stream->impl_;
  if (!impl.queue.is_open() || !impl.io.is_open())
    return Error{"no file descriptors are left for pads"};
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
