#include "experiments/memory.hpp"

#include <fstream>
#include <limits>
#include <malloc.h>
#include <string>

namespace qddot {

double allocated_memory() {
  const auto info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

double free_memory() {
  std::ifstream info("/proc/meminfo");
  std::string word;
  while (info >> word) {
    double kilobytes = 0;
    if (word == "MemAvailable:" && info >> kilobytes) return 1024 * kilobytes;
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace qddot
