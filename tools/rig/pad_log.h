// The log of a pad: one line per event, `WORD NS REST`, NS by CLOCK_MONOTONIC.
#pragma once
#include <stddef.h>
#include <stdint.h>

int64_t now_ns(void);
_Noreturn void die(const char* what);
void open_log(const char* path);
// `rest`, then the bytes in hex. Written to the file by the next flush_log.
void log_line(const char* word, int64_t ns, const char* rest, const uint8_t* bytes, size_t size);
void note(const char* word, const char* rest);  // the same for now, flushed
void flush_log(void);
