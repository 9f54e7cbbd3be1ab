#include "pad_trace.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t read_bytes(const char* text, uint8_t* bytes, size_t space) {
  size_t size = 0;
  char* end;
  for (; size < space; ++size, text = end) {
    const unsigned long value = strtoul(text, &end, 16);
    if (end == text) break;
    bytes[size] = (uint8_t)value;
  }
  return size;
}

static void read_event(const char* line, struct trace* trace) {
  unsigned long seconds, microseconds;
  int used = 0;
  if (sscanf(line, "E: %lu.%lu %*u %n", &seconds, &microseconds, &used) != 2 || used == 0) return;
  struct trace_event event = {(int64_t)(seconds * 1000000 + microseconds) * 1000, trace->byte_count,
                              0};
  trace->events = realloc(trace->events, (trace->event_count + 1) * sizeof event);
  trace->bytes = realloc(trace->bytes, trace->byte_count + kMaxPacket);
  if (!trace->events || !trace->bytes) abort();
  event.size = read_bytes(line + used, trace->bytes + event.first_byte, kMaxPacket);
  trace->byte_count += event.size;
  trace->events[trace->event_count++] = event;
}

bool read_trace(const char* path, struct trace* trace) {
  FILE* file = fopen(path, "r");
  if (!file) return false;
  free(trace->events);
  free(trace->bytes);
  memset(trace, 0, sizeof *trace);
  snprintf(trace->path, sizeof trace->path, "%s", path);
  static char line[4 * kMaxDescriptor];
  // The line's device, and the file's first one, whose reports are played.
  int device = -1, first = -1;
  while (fgets(line, sizeof line, file)) {
    unsigned vendor, product;
    int used = 0;
    if (sscanf(line, "D: %d", &device) == 1 && first < 0) first = device;
    if (device != first) continue;
    if (sscanf(line, "R: %*u %n", &used), used != 0)
      trace->descriptor_size = read_bytes(line + used, trace->descriptor, kMaxDescriptor);
    if (sscanf(line, "I: %*x %x %x", &vendor, &product) == 2)
      trace->vendor = (uint16_t)vendor, trace->product = (uint16_t)product;
    sscanf(line, "N: %127[^\n]", trace->name);
    if (line[0] == 'E') read_event(line, trace);
  }
  fclose(file);
  return true;
}
