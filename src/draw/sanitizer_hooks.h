// What the sanitizers are to know of libraries that draw. Included once by every program that loads
// them: the hooks are its own.
#pragma once

// Fontconfig and D-Bus (through SDL) keep what they looked up until the process ends, where the
// leak checker cannot see it; so do libraries that SDL and OpenGL have unloaded by then. None of
// gaitpad's own code is ever unloaded.
#ifdef GAITPAD_SANITIZED
extern "C" const char* __lsan_default_suppressions() {
  return "leak:<unknown module>\n"
         "leak:libdbus-1\n"
         "leak:libfontconfig";
}
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
// glibc allocates a 16-byte thread-local block for Mesa on the heap. The libasan of GCC 12 takes it
// for a block of glibc 2.19, which stores its size in front, and the leak checker then reads a
// wrong address and crashes. Without this interception the checker finds such blocks by itself, as
// memory that the dynamic linker allocated.
extern "C" const char* __asan_default_options() { return "intercept_tls_get_addr=0"; }
#endif
