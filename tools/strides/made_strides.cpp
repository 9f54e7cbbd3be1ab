// made_strides FILE: solves the strides of the built-in walk and writes them as a C++ source, which
// is compiled into gaitpad::files (files/stride_cache.cpp). It runs while gaitpad is built, so the
// numbers are always those of the sources.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "gaitpad/clean_strides.h"
#include "strides/solver_input.h"

namespace gaitpad {
namespace {

int write_strides(const char* path) {
  const GaitCycle cycle = procedural_gait();
  const Result<StrideFamily> family = stride_family(cycle);
  if (!family) return std::fprintf(stderr, "made_strides: %s\n", family.error().message.c_str()), 1;
  std::vector<double> numbers = solver_input(cycle);
  for_each_number(*family, [&numbers](double number) { numbers.push_back(number); });
  std::FILE* file = std::fopen(path, "we");
  if (file == nullptr) return std::perror(path), 1;
  // Write floats as bits, because compilers may read a decimal number differently.
  std::fprintf(file,
               "#include \"files/made_strides.h\"\n"
               "namespace gaitpad {\n"
               "static constexpr std::uint64_t kNumbers[] = {\n");
  for (const double number : numbers)
    std::fprintf(file, "0x%llx,\n",
                 static_cast<unsigned long long>(std::bit_cast<std::uint64_t>(number)));
  std::fprintf(file,
               "};\n"
               "std::span<const std::uint64_t> made_strides() noexcept { return kNumbers; }\n"
               "}  // namespace gaitpad\n");
  return std::fclose(file) == 0 ? 0 : (std::perror(path), 1);
}

}  // namespace
}  // namespace gaitpad

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: made_strides FILE\n"), 2;
  return gaitpad::write_strides(argv[1]);
}
