#include "qddot/model/kernels/level.hpp"

#include <cstdlib>
#include <string>

namespace qddot::kernels {
namespace {

#define QDDOT_NAME(level) #level,
constexpr std::string_view names[] = {QDDOT_LEVELS(QDDOT_NAME)};
#undef QDDOT_NAME

// Whether this processor runs the instructions of the version.
bool is_run([[maybe_unused]] std::string_view name) {
#ifdef __x86_64__
  const bool v2 = __builtin_cpu_supports("ssse3") && __builtin_cpu_supports("sse4.2") &&
                  __builtin_cpu_supports("popcnt");
  const bool v3 = v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                  __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return name == "v2" ? v2 : name == "v3" ? v3 : v4;
#else
  return true;
#endif
}

int chosen() {
  const char* wanted = std::getenv("QDDOT_KERNELS");
  int widest = -1;
  std::string run;
  for (int i = 0; i < static_cast<int>(std::size(names)); ++i) {
    if (!is_run(names[i])) continue;
    if (!wanted || names[i] == wanted) widest = i;
    run += (run.empty() ? "" : ", ") + std::string(names[i]);
  }
  if (widest >= 0) return widest;
  if (run.empty()) throw std::runtime_error("this processor runs no version of the kernels");
  throw NoSuchKernels("QDDOT_KERNELS=" + std::string(wanted) +
                      ": this processor does not run such kernels; allowed are " + run);
}

}  // namespace

int level() {
  static const int number = chosen();
  return number;
}

std::span<const std::string_view> levels() { return names; }

}  // namespace qddot::kernels
