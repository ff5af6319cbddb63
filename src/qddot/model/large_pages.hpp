#pragma once

#include <cstddef>
#include <cstdint>
#include <sys/mman.h>
#include <vector>

namespace qddot {

// Asks for pages of 2 MB for memory that is not written to yet; a hint, which may be refused. First
// writes to pages of 4 KB cost half of the time in which a million nodes are set up.
inline void ask_for_large_pages(const void* memory, std::size_t bytes) {
  constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
  const auto from = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page,
             end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
  if (from < end) madvise(reinterpret_cast<void*>(from), end - from, MADV_HUGEPAGE);
}

// Makes room for `size` elements of an empty vector, in such pages where they are many.
template <class T>
void reserve_in_large_pages(std::vector<T>& vector, std::size_t size) {
  vector.reserve(size);
  ask_for_large_pages(vector.data(), vector.capacity() * sizeof(T));
}

// A vector of so many equal elements, likewise.
template <class T>
std::vector<T> filled_in_large_pages(std::size_t size, const T& value) {
  std::vector<T> vector;
  reserve_in_large_pages(vector, size);
  vector.resize(size, value);
  return vector;
}

}  // namespace qddot
