// Reads what a pad needs of a `.hid` recording: the first device's ids and descriptor, its reports
// in time.
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "pad_kinds.h"

struct trace_event {
  int64_t time_ns;
  size_t first_byte, size;
};

struct trace {
  char path[256], name[128];
  uint16_t vendor, product;
  uint8_t descriptor[kMaxDescriptor];
  size_t descriptor_size;
  struct trace_event* events;
  uint8_t* bytes;
  size_t event_count, byte_count;
};

// False where the file cannot be read; other lines than R, N, I and E are passed over.
bool read_trace(const char* path, struct trace* trace);
