#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <system_error>
#include <thread>
#include <vector>

namespace qddot::motion_files {

// Calls work(0) ... work(count - 1) on all cores; rethrows an exception of one of them. `numbers`:
// the amount of work; a small one is done before another thread has started. OpenMP's threads
// belong to a run, are bounded by --threads and OMP_NUM_THREADS, and may not throw.
template <class Work>
void on_all_cores(std::size_t count, std::size_t numbers, const Work& work) {
  constexpr std::size_t worth_a_thread = 1 << 15;
  std::atomic<std::size_t> next = 0;
  const auto some = [&] {
    for (std::size_t k = next++; k < count; k = next++) work(k);
  };
  const std::size_t cores =
      numbers < worth_a_thread ? 1 : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::future<void>> others;
  try {
    while (others.size() + 1 < std::min(cores, count))
      others.push_back(std::async(std::launch::async, some));
  } catch (const std::system_error&) {  // no more threads: the existing ones do all work
  }
  some();
  for (auto& other : others) other.get();
}

}  // namespace qddot::motion_files
