// The log of a pad: one line per event, `WORD NS REST`, NS by CLOCK_MONOTONIC.
#pragma once
#include <stddef.h>
#include <stdint.h>

int64_t now_ns(void);
_Noreturn void die(const char* what);
void open_log(const char* path);
// Adds a line: `rest`, then the bytes in hex. The next flush_log writes it to the file.
void log_line(const char* word, int64_t ns, const char* rest, const uint8_t* bytes, size_t size);
// Adds a line with the present time, and writes all lines to the file.
void note(const char* word, const char* rest);
void flush_log(void);
