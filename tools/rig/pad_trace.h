// Reads a `.hid` recording for a pad: the first device's ids and descriptor, and its reports with
// times.
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

// False if the file cannot be read; lines other than R, N, I and E are skipped.
bool read_trace(const char* path, struct trace* trace);
