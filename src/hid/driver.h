// The driver contract. A driver finds devices and hands on their reports as bytes; it never
// interprets them. What its source does not describe it states as a report descriptor that it
// builds.
//
// Threads  Every call comes from the I/O thread, and a driver starts none that calls back.
// Blocking `read` waits at most `timeout`; everything else returns at once. Set-up (making the
//          driver, `device`) may allocate; `read` may, too: it is not the loop thread.
// Owning   The caller owns the driver and the reports that it passes in; the driver owns its
// handles
//          and closes them in its destructor.
// Unplug   A device that goes away gives one `removed` report and then nothing, and its index is
// not
//          used again for another device. The same device plugged in again gives `added` on its old
//          index. Only the end of everything that the driver can ever deliver is Status::ended.
// Time     A report carries the moment of its arrival, taken right after the wait, on a clock that
//          does not go back; zero is arbitrary but the same for all devices of a driver.
#pragma once
#include <chrono>
#include <cstddef>
#include <memory>
#include <span>
#include <string>

#include "base/result.h"
#include "hid/report.h"

namespace gaitpad {

class Driver {
 public:
  enum class Status {
    report,   // `report` is filled
    nothing,  // the time is over
    ended,    // there will never be another one
  };
  virtual ~Driver() = default;

  // Grows only; an `added` report announces an index that was not there before.
  virtual std::size_t device_count() const noexcept = 0;
  virtual const DeviceInfo& device(std::size_t index) const noexcept = 0;
  virtual Status read(Report& report, std::chrono::nanoseconds timeout) noexcept = 0;
};

struct DriverEntry {
  const char* name;
  // `where` is what the driver understands: a path, an address, empty for everything it finds.
  Result<std::unique_ptr<Driver>> (*make)(const std::string& where);
};

}  // namespace gaitpad
