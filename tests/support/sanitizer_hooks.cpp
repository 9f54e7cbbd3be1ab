// Settings of the sanitizers for programs that load libraries that draw. CMakeLists.txt adds this
// source to each of them, in a build with sanitizers alone.

// Fontconfig and D-Bus (through SDL) keep allocations until the process ends, where the leak
// checker cannot see them. Renderers also keep some: SDL unloads them with the display, after which
// the checker no longer finds the pointers, so nothing is unloaded.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libdbus-1\n"
         "leak:libfontconfig";
}
extern "C" int dlclose(void*) { return 0; }
extern "C" const char* __lsan_default_options() { return "print_suppressions=0"; }
// glibc allocates a 16-byte thread-local block for Mesa on the heap. GCC 12's libasan mistakes it
// for a block of glibc 2.19, which stores its size in front; the leak checker then reads a wrong
// address and crashes. Without this interception the checker still finds such blocks, as memory
// that the dynamic linker allocated.
extern "C" const char* __asan_default_options() { return "intercept_tls_get_addr=0"; }
