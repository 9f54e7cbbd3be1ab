// What the sanitizers are to know of libraries that draw. Included once by every program that loads
// them: the hooks are its own.
#pragma once

// Fontconfig and D-Bus (through SDL) keep what they looked up until the process ends, where the
// leak checker cannot see it. Renderers keep some allocations, too: SDL unloads them with the
// display, and the checker then no longer finds the pointers, so nothing is unloaded.
#ifdef GAITPAD_SANITIZED
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libdbus-1\n"
         "leak:libfontconfig";
}
extern "C" int dlclose(void*) { return 0; }
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
// glibc allocates a 16-byte thread-local block for Mesa on the heap. The libasan of GCC 12 takes it
// for a block of glibc 2.19, which stores its size in front, and the leak checker then reads a
// wrong address and crashes. Without this interception the checker finds such blocks by itself, as
// memory that the dynamic linker allocated.
extern "C" const char* __asan_default_options() { return "intercept_tls_get_addr=0"; }
#endif
