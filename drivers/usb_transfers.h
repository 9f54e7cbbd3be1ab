// The packets of a claimed USB interface, on libusb's asynchronous transfers. Several reads always
// wait at the IN endpoint, so that no packet is missed; OUT packets leave one by one from a short
// queue. Nothing waits except the destructor, clearing a stall (one request to the pad) and calls
// with a time-out.
#pragma once
#include <libusb.h>
#include <poll.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "drivers/pads/pad_quirks.h"
#include "gaitpad/report.h"
#include "gaitpad/result.h"
#include "system/descriptors.h"

namespace gaitpad {

// The endpoints that the interface's descriptor states.
struct UsbEndpoints {
  std::uint8_t interface_number = 0;
  std::uint8_t in = 0;
  std::uint16_t in_packet_bytes = 0;  // the endpoint's wMaxPacketSize
  std::size_t in_bytes = 0;           // size of an IN transfer: room for the longest report
  // Address of the OUT endpoint; 0: there is none, and HID packets are sent as SET_REPORT.
  std::uint8_t out = 0;
  bool is_hid = false;
  bool is_numbered = false;  // HID packets begin with their report id
};

class UsbTransfers {
 public:
  // The handle is open and the interface claimed; context and handle must outlive the transfers.
  static Result<std::unique_ptr<UsbTransfers>> start(libusb_context* context,
                                                     libusb_device_handle* handle,
                                                     const UsbEndpoints& endpoints);
  ~UsbTransfers();  // Cancels all transfers.
  UsbTransfers(const UsbTransfers&) = delete;
  UsbTransfers& operator=(const UsbTransfers&) = delete;

  // The descriptors to poll; they do not change while the device is there.
  std::span<const pollfd> poll_fds() const noexcept { return poll_fds_; }
  // Receives and sends packets; waits at most `timeout`.
  void handle_events(std::chrono::milliseconds timeout) noexcept;
  // Takes the oldest packet that has arrived: bytes, size, time. False: none has arrived.
  bool take_packet(Report& packet) noexcept;
  // Queues a packet. False: the pad cannot be written to.
  bool send(const OutPacket& packet) noexcept;
  // Waits until all queued packets have been sent. False: one was not.
  bool flush(std::chrono::milliseconds timeout) noexcept;

  bool is_gone() const noexcept { return is_gone_; }
  // Number of stalls, overflows and errors on the wire.
  std::int64_t lost() const noexcept { return lost_; }

 private:
  struct InSlot {
    UsbTransfers* owner = nullptr;
    libusb_transfer* transfer = nullptr;
    std::vector<std::uint8_t> buffer;
    std::int64_t time_ns = 0;
    enum class State { idle, waiting, filled } state = State::idle;
  };
  static constexpr std::size_t kInSlots = 8;
  static constexpr std::size_t kOutPackets = 16;

  UsbTransfers(libusb_context* context, libusb_device_handle* handle, const UsbEndpoints& endpoints)
      : context_(context), handle_(handle), endpoints_(endpoints) {}
  Result<bool> allocate();
  static void LIBUSB_CALL on_in(libusb_transfer* transfer);
  static void LIBUSB_CALL on_out(libusb_transfer* transfer);
  void finish_in(InSlot& slot) noexcept;
  void finish_out() noexcept;
  void submit(InSlot& slot) noexcept;
  void submit_all() noexcept;
  void submit_out() noexcept;
  void fill_out(const OutPacket& packet) noexcept;
  void begin_recovery() noexcept;
  bool has_hung_up() noexcept;
  void recover() noexcept;
  void repeat_out() noexcept;
  void set_timer() noexcept;
  void cancel_all() noexcept;

  libusb_context* context_;
  libusb_device_handle* handle_;
  UsbEndpoints endpoints_;
  std::vector<pollfd> poll_fds_;
  Timer timer_;                // wakes the reader for recovering from a stall and for repeating a
                               // packet
  std::int64_t timer_ns_ = 0;  // the time for which timer_ is set; 0: it is not set
  std::int64_t now_ns_ = 0;    // time of the last handle_events()
  // Arrival time of the packets while handle_events() runs; otherwise 0.
  std::int64_t arrival_ns_ = 0;

  std::array<InSlot, kInSlots> in_;
  std::array<InSlot*, kInSlots> filled_{};  // slots with a packet, oldest first
  std::size_t filled_count_ = 0, waiting_count_ = 0;

  std::array<OutPacket, kOutPackets> queue_;  // packets to send; the first one is being sent
  std::size_t queued_ = 0;
  libusb_transfer* out_ = nullptr;
  std::vector<std::uint8_t> out_buffer_;
  bool is_out_waiting_ = false, has_out_failed_ = false;
  OutPacket repeated_;
  std::int64_t repeat_ns_ = 0;  // time of the next repetition; 0: nothing is repeated

  bool is_gone_ = false, is_closing_ = false;
  bool is_recovering_ = false, is_out_halted_ = false;
  std::int64_t recover_ns_ = 0;  // time before which there is no attempt to recover
  std::int64_t lost_ = 0;
};

}  // namespace gaitpad
