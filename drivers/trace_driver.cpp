// A recording as a device: hands on a trace's events in their order, stamped with the trace's own
// time. It waits for nothing, so whoever wants real time waits by the stamps.
#include "drivers/trace_driver.h"

#include "hid/trace.h"

namespace gaitpad {

namespace {

class TraceDriver final : public Driver {
 public:
  explicit TraceDriver(Trace trace) : trace_(std::move(trace)) {}

  std::size_t device_count() const noexcept override { return trace_.devices.size(); }
  const DeviceInfo& device(std::size_t index) const noexcept override {
    return trace_.devices[index].info;
  }
  Status read(Report& report, std::chrono::nanoseconds) noexcept override {
    if (next_ >= trace_.events.size()) return Status::ended;
    copy_report(trace_, trace_.events[next_++], report);
    return Status::report;
  }

 private:
  Trace trace_;
  std::size_t next_ = 0;
};

}  // namespace

Result<std::unique_ptr<Driver>> make_trace_driver(const std::string& path) {
  auto trace = read_trace(path);
  if (!trace) return trace.error();
  return std::unique_ptr<Driver>(std::make_unique<TraceDriver>(std::move(*trace)));
}

}  // namespace gaitpad
