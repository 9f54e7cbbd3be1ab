#include "pad_log.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "pad_kinds.h"

static FILE* log_file;

int64_t now_ns(void) {
  struct timespec t;
  clock_gettime(CLOCK_MONOTONIC, &t);
  return t.tv_sec * INT64_C(1000000000) + t.tv_nsec;
}

_Noreturn void die(const char* what) {
  fprintf(stderr, "pad_gadget: %s: %s\n", what, strerror(errno));
  exit(1);
}

void log_line(const char* word, int64_t ns, const char* rest, const uint8_t* bytes, size_t size) {
  char text[2 * kMaxPacket + 1];
  static const char digits[] = "0123456789abcdef";
  for (size_t i = 0; i < size; ++i) {
    text[2 * i] = digits[bytes[i] >> 4];
    text[2 * i + 1] = digits[bytes[i] & 15];
  }
  text[2 * size] = 0;
  fprintf(log_file, "%s %lld %s%s\n", word, (long long)ns, rest, text);
}

void note(const char* word, const char* rest) {
  log_line(word, now_ns(), rest, NULL, 0);
  fflush(log_file);
}

void flush_log(void) { fflush(log_file); }

void open_log(const char* path) {
  log_file = fopen(path, "w");
  if (!log_file) die(path);
}
