#include "experiments/kit/memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include <fmt/format.h>

namespace qddot::inline kit {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

// The number that a file of the system begins with; nothing said is `otherwise`.
double number_in(const char* file, double otherwise) {
  std::ifstream stream(file);
  double value = 0;
  return stream >> value ? value : otherwise;
}

double left_in_machine() {
  std::ifstream info("/proc/meminfo");
  std::string word;
  while (info >> word) {
    double kilobytes = 0;
    if (word == "MemAvailable:" && info >> kilobytes) return 1024 * kilobytes;
  }
  return unlimited;
}

double left_in_address_space() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const double used = number_in("/proc/self/statm", 0) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - used);
}

double left_in_control_group() {
  const double most = number_in("/sys/fs/cgroup/memory.max", unlimited);
  return std::max(0.0, most - number_in("/sys/fs/cgroup/memory.current", 0));
}

}  // namespace

void keep_freed_memory() {
  constexpr int most = std::numeric_limits<int>::max();  // [bytes]
  mallopt(M_MMAP_THRESHOLD, most);
  mallopt(M_TRIM_THRESHOLD, most);
}

double allocated_memory() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

double free_memory() {
  const auto kept = static_cast<double>(mallinfo2().fordblks);
  return kept + std::min({left_in_machine(), left_in_address_space(), left_in_control_group()});
}

std::string out_of_memory() {
  return fmt::format(
      "memory ran out with {:.3g} GB in use: a scene of fewer nodes takes less, and so does a "
      "method "
      "or a solver that factorises nothing (verlet; --solver conjugate_gradients)",
      1e-9 * allocated_memory());
}

}  // namespace qddot::inline kit
