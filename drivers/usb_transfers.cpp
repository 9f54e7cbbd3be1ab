#include "drivers/usb_transfers.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "system/clock.h"

namespace gaitpad {

namespace {

using std::chrono::milliseconds;

constexpr std::uint8_t kSetReport = 0x09, kToInterface = 0x21, kOutputReport = 2,
                       kFeatureReport = 3;
// Time limit of an OUT transfer, so that a pad that takes no packet does not block the queue.
constexpr unsigned int kOutTimeoutMs = 1000;
constexpr std::int64_t kRecoverPauseNs = 100'000'000;

bool is_device_lost(int error) noexcept { return error == LIBUSB_ERROR_NO_DEVICE; }

}  // namespace

Result<std::unique_ptr<UsbTransfers>> UsbTransfers::start(libusb_context* context,
                                                          libusb_device_handle* handle,
                                                          const UsbEndpoints& endpoints) {
  std::unique_ptr<UsbTransfers> transfers(new UsbTransfers(context, handle, endpoints));
  if (auto allocated = transfers->allocate(); !allocated) return allocated.error();
  transfers->submit_all();
  if (transfers->is_gone_) return Error{"the pad is gone"};
  if (transfers->waiting_count_ == 0) return Error{"no reads can be started"};
  return transfers;
}

Result<bool> UsbTransfers::allocate() {
  for (InSlot& slot : in_) {
    slot.owner = this;
    slot.buffer.resize(endpoints_.in_bytes);
    slot.transfer = libusb_alloc_transfer(0);
    if (!slot.transfer) return Error{"out of memory"};
    libusb_fill_interrupt_transfer(slot.transfer, handle_, endpoints_.in, slot.buffer.data(),
                                   static_cast<int>(slot.buffer.size()), &on_in, &slot, 0);
  }
  out_buffer_.resize(LIBUSB_CONTROL_SETUP_SIZE + OutPacket{}.bytes.size());
  out_ = libusb_alloc_transfer(0);
  if (!out_) return Error{"out of memory"};
  if (timer_.fd() < 0) return Error{"no timer: too many open files"};
  poll_fds_.push_back({timer_.fd(), POLLIN, 0});
  const libusb_pollfd** fds = libusb_get_pollfds(context_);
  if (!fds) return Error{"out of memory"};
  for (const libusb_pollfd** fd = fds; *fd; ++fd) {
    poll_fds_.push_back({(*fd)->fd, (*fd)->events, 0});
  }
  libusb_free_pollfds(fds);
  return true;
}

UsbTransfers::~UsbTransfers() {
  is_closing_ = true;
  cancel_all();
  const std::int64_t end_ns = now_ns() + 1'000'000'000;
  while ((waiting_count_ > 0 || is_out_waiting_) && now_ns() < end_ns) {
    handle_events(milliseconds(20));
  }
  // A transfer that the kernel still has after a second is not freed.
  for (InSlot& slot : in_) {
    if (slot.transfer && slot.state != InSlot::State::waiting) libusb_free_transfer(slot.transfer);
  }
  if (out_ && !is_out_waiting_) libusb_free_transfer(out_);
}

void UsbTransfers::handle_events(milliseconds timeout) noexcept {
  if (timeout.count() > 0) {
    ::poll(poll_fds_.data(), poll_fds_.size(), static_cast<int>(timeout.count()));
  }
  timeval no_wait = {0, 0};
  now_ns_ = arrival_ns_ = now_ns();
  libusb_handle_events_timeout_completed(context_, &no_wait, nullptr);
  arrival_ns_ = 0;
  if (is_closing_) return;
  if (timer_ns_ != 0 && timer_.take()) timer_ns_ = 0;
  recover();
  repeat_out();
  set_timer();
}

// ---- IN

void UsbTransfers::submit(InSlot& slot) noexcept {
  if (is_gone_ || is_recovering_ || slot.state != InSlot::State::idle) return;
  const int error = libusb_submit_transfer(slot.transfer);
  if (error == LIBUSB_SUCCESS) {
    slot.state = InSlot::State::waiting;
    ++waiting_count_;
  } else if (is_device_lost(error)) {
    is_gone_ = true;
  } else {
    begin_recovery();
  }
}

void UsbTransfers::submit_all() noexcept {
  for (InSlot& slot : in_) submit(slot);
}

void UsbTransfers::on_in(libusb_transfer* transfer) {
  InSlot& slot = *static_cast<InSlot*>(transfer->user_data);
  slot.owner->finish_in(slot);
}

void UsbTransfers::finish_in(InSlot& slot) noexcept {
  slot.state = InSlot::State::idle;
  --waiting_count_;
  const libusb_transfer_status status = slot.transfer->status;
  const bool is_done = status == LIBUSB_TRANSFER_COMPLETED || status == LIBUSB_TRANSFER_CANCELLED;
  if (is_closing_) return;
  if (is_done && slot.transfer->actual_length > 0) {
    slot.state = InSlot::State::filled;
    // arrival_ns_ is 0 outside of handle_events(): while libusb waits for the answer to a control
    // request.
    slot.time_ns = arrival_ns_ != 0 ? arrival_ns_ : now_ns();
    filled_[filled_count_++] = &slot;
  } else if (status == LIBUSB_TRANSFER_COMPLETED) {
    submit(slot);
  } else if (status == LIBUSB_TRANSFER_NO_DEVICE) {
    is_gone_ = true;
  } else if (status != LIBUSB_TRANSFER_CANCELLED) {
    begin_recovery();
  }
}

bool UsbTransfers::take_packet(Report& packet) noexcept {
  if (filled_count_ == 0) return false;
  InSlot& slot = *filled_[0];
  std::move(filled_.begin() + 1, filled_.begin() + static_cast<std::ptrdiff_t>(filled_count_),
            filled_.begin());
  --filled_count_;
  const auto length = static_cast<std::size_t>(slot.transfer->actual_length);
  packet.size = static_cast<std::uint16_t>(std::min(length, packet.bytes.size()));
  std::copy_n(slot.buffer.begin(), packet.size, packet.bytes.begin());
  packet.kind = ReportKind::input;
  packet.time_ns = slot.time_ns;
  slot.state = InSlot::State::idle;
  submit(slot);
  return true;
}

// ---- A halted endpoint: all reads are cancelled, the halt is cleared, the reads start again. A
// pad that halts again at once is tried every 100 ms only.

void UsbTransfers::begin_recovery() noexcept {
  if (is_recovering_ || is_gone_) return;
  is_recovering_ = true;
  for (InSlot& slot : in_) {
    if (slot.state == InSlot::State::waiting) libusb_cancel_transfer(slot.transfer);
  }
}

// True if the node reports a hang-up. Without a waiting transfer only the node itself shows the
// unplugging.
bool UsbTransfers::has_hung_up() noexcept {
  ::poll(poll_fds_.data(), poll_fds_.size(), 0);
  return std::any_of(poll_fds_.begin(), poll_fds_.end(),
                     [](const pollfd& fd) { return (fd.revents & (POLLERR | POLLHUP)) != 0; });
}

void UsbTransfers::recover() noexcept {
  if ((!is_recovering_ && !is_out_halted_) || is_gone_) return;
  if (is_recovering_ && waiting_count_ > 0) return;
  if (has_hung_up()) is_gone_ = true;
  if (is_gone_ || now_ns_ < recover_ns_) return;
  recover_ns_ = now_ns_ + kRecoverPauseNs;
  int error = LIBUSB_SUCCESS;
  if (is_out_halted_) {
    error = libusb_clear_halt(handle_, endpoints_.out);
    is_out_halted_ = false;
  }
  if (is_recovering_ && !is_device_lost(error)) {
    error = libusb_clear_halt(handle_, endpoints_.in);
    is_recovering_ = error != LIBUSB_SUCCESS;
    if (!is_recovering_) {
      ++lost_;  // counted only now: the errors of a pad that is being unplugged are no loss
      submit_all();
    }
  }
  if (is_device_lost(error)) is_gone_ = true;
}

// ---- OUT

bool UsbTransfers::send(const OutPacket& packet) noexcept {
  const bool has_way = endpoints_.out != 0 || endpoints_.is_hid;
  if (is_gone_ || !has_way || packet.size == 0 || packet.size > packet.bytes.size()) return false;
  // If the queue is full the newest packet replaces the last one: of packets for motors the newest
  // may be the stop.
  if (queued_ == kOutPackets) --queued_;
  if (queued_ == 0) has_out_failed_ = false;
  queue_[queued_++] = packet;
  repeated_ = packet;
  const std::int64_t pause_ns = std::chrono::nanoseconds(packet.repeat).count();
  repeat_ns_ = pause_ns > 0 ? now_ns() + pause_ns : 0;
  submit_out();
  set_timer();
  return !is_gone_;
}

void UsbTransfers::fill_out(const OutPacket& packet) noexcept {
  const auto size = static_cast<std::uint16_t>(packet.size);
  if (endpoints_.out != 0 && !packet.is_feature) {
    std::copy_n(packet.bytes.begin(), size, out_buffer_.begin());
    libusb_fill_interrupt_transfer(out_, handle_, endpoints_.out, out_buffer_.data(), size, &on_out,
                                   this, kOutTimeoutMs);
    return;
  }
  const std::uint8_t id = endpoints_.is_numbered ? packet.bytes[0] : 0;
  const std::uint8_t kind = packet.is_feature ? kFeatureReport : kOutputReport;
  // The id 0 is not sent to the pad.
  const std::uint16_t skip = packet.is_feature && id == 0 ? 1 : 0;
  libusb_fill_control_setup(out_buffer_.data(), kToInterface, kSetReport,
                            static_cast<std::uint16_t>(kind << 8 | id), endpoints_.interface_number,
                            static_cast<std::uint16_t>(size - skip));
  std::copy(packet.bytes.begin() + skip, packet.bytes.begin() + size,
            out_buffer_.begin() + LIBUSB_CONTROL_SETUP_SIZE);
  libusb_fill_control_transfer(out_, handle_, out_buffer_.data(), &on_out, this, kOutTimeoutMs);
}

void UsbTransfers::submit_out() noexcept {
  while (queued_ > 0 && !is_out_waiting_ && !is_gone_) {
    fill_out(queue_[0]);
    const int error = libusb_submit_transfer(out_);
    is_out_waiting_ = error == LIBUSB_SUCCESS;
    if (is_out_waiting_) return;
    if (is_device_lost(error)) is_gone_ = true;
    has_out_failed_ = true;
    std::move(queue_.begin() + 1, queue_.begin() + static_cast<std::ptrdiff_t>(queued_),
              queue_.begin());
    --queued_;
  }
}

void UsbTransfers::on_out(libusb_transfer* transfer) {
  static_cast<UsbTransfers*>(transfer->user_data)->finish_out();
}

void UsbTransfers::finish_out() noexcept {
  is_out_waiting_ = false;
  const libusb_transfer_status status = out_->status;
  if (status == LIBUSB_TRANSFER_NO_DEVICE) is_gone_ = true;
  if (status == LIBUSB_TRANSFER_STALL && endpoints_.out != 0) is_out_halted_ = true;
  if (status != LIBUSB_TRANSFER_COMPLETED) has_out_failed_ = true;
  std::move(queue_.begin() + 1, queue_.begin() + static_cast<std::ptrdiff_t>(queued_),
            queue_.begin());
  --queued_;
  if (!is_closing_) submit_out();
}

bool UsbTransfers::flush(milliseconds timeout) noexcept {
  const std::int64_t end_ns = now_ns() + std::chrono::nanoseconds(timeout).count();
  while (queued_ > 0 && !is_gone_ && now_ns() < end_ns) handle_events(milliseconds(5));
  return queued_ == 0 && !has_out_failed_;
}

void UsbTransfers::repeat_out() noexcept {
  if (repeat_ns_ == 0 || now_ns_ < repeat_ns_ || is_gone_) return;
  repeat_ns_ = 0;
  if (queued_ == 0) {
    send(repeated_);
  } else {
    repeat_ns_ = now_ns_ + std::chrono::nanoseconds(repeated_.repeat).count();
  }
}

void UsbTransfers::set_timer() noexcept {
  const bool must_recover = (is_recovering_ && waiting_count_ == 0) || is_out_halted_;
  std::int64_t next_ns = must_recover && !is_gone_ ? std::max<std::int64_t>(recover_ns_, 1) : 0;
  if (repeat_ns_ != 0 && !is_gone_) next_ns = next_ns ? std::min(next_ns, repeat_ns_) : repeat_ns_;
  // True for nearly every report, which then costs no further system call.
  if (next_ns == timer_ns_) return;
  timer_ns_ = next_ns;
  timer_.set(next_ns);
}

void UsbTransfers::cancel_all() noexcept {
  for (InSlot& slot : in_) {
    if (slot.state == InSlot::State::waiting) libusb_cancel_transfer(slot.transfer);
  }
  if (is_out_waiting_) libusb_cancel_transfer(out_);
}

}  // namespace gaitpad
