// libFuzzer target: a trace. An accepted trace must survive writing and reading unchanged.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gaitpad/trace.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace gaitpad;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  auto strict = parse_trace(text, "fuzz.hid");
  auto lenient = parse_trace(text, "fuzz.hid", Damage::skip);
  if (strict && !lenient) std::abort();
  for (auto* trace : {&strict, &lenient}) {
    if (!*trace) continue;
    auto again = parse_trace(trace_text(**trace), "again.hid");
    if (!again) std::abort();
    if (again->devices != (*trace)->devices) std::abort();
    if (again->events.size() != (*trace)->events.size()) std::abort();
    if (again->end_ticks != (*trace)->end_ticks || again->rate_hz != (*trace)->rate_hz)
      std::abort();
    const int rate_hz = replay_rate_hz(**trace, {});
    const auto ticks = assign_ticks(**trace, rate_hz);
    const auto ticks_again = assign_ticks(*again, rate_hz);
    if (!ticks || !ticks_again || *ticks != *ticks_again) std::abort();
    for (std::size_t i = 0; i < again->events.size(); ++i) {
      const Report a = report_of(**trace, (*trace)->events[i]);
      const Report b = report_of(*again, again->events[i]);
      if (a.time_ns != b.time_ns || a.device != b.device || text_of(a) != text_of(b)) std::abort();
      if ((*trace)->events[i].tick != again->events[i].tick) std::abort();
    }
  }
  return 0;
}
