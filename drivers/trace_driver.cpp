// A recording as a device: hands on a trace's events at their own times.
#include "drivers/driver_entries.h"
#include "hid/trace.h"
namespace gaitpad {
std::vector<DeviceListing> find_trace_devices() { return {}; }
Result<std::vector<DeviceListing>> trace_listings(const std::string& path) { return Error{path}; }
Result<std::unique_ptr<Device>> open_trace_device(const DeviceListing& listing, Detach) { return Error{listing.node}; }
}  // namespace gaitpad
