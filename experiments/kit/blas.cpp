#include "experiments/kit/blas.hpp"

#include <algorithm>
#include <array>
#include <dlfcn.h>

namespace qddot::inline kit {
namespace {

// The text that a function of OpenBLAS without arguments returns; empty if it is not there.
std::string say(const char* function) {
  using Say = char*();
  auto* const found = reinterpret_cast<Say*>(::dlsym(RTLD_DEFAULT, function));
  return found ? found() : "";
}

// The names of OpenBLAS for processors without AVX2, and for those with it and without AVX-512.
constexpr std::array<std::string_view, 15> of_128 = {
    "Prescott",    "Core2",     "Penryn",  "Dunnington",   "Nehalem",
    "Sandybridge", "Atom",      "Opteron", "Opteron_SSE3", "Barcelona",
    "Bobcat",      "Bulldozer", "Nano",    "Piledriver",   "Steamroller"};
constexpr std::array<std::string_view, 3> of_256 = {"Haswell", "Zen", "Excavator"};

}  // namespace

std::string blas() {
  const std::string config = say("openblas_get_config");
  return config.empty() ? "unknown" : config;
}

std::string blas_core() { return say("openblas_get_corename"); }

int vector_bits() {
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512vl"))
    return 512;
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return 256;
#endif
  return 128;
}

std::string_view wider_core(std::string_view core, int bits) {
  const bool has_128 = std::ranges::find(of_128, core) != of_128.end(),
             has_256 = std::ranges::find(of_256, core) != of_256.end();
  if (bits == 512 && (has_128 || has_256)) return "SkylakeX";
  if (bits == 256 && has_128) return "Haswell";
  return "";
}

}  // namespace qddot::inline kit
