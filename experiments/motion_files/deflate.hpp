#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace qddot::motion_files {

// Chunks of an HDF5 dataset go through its filters shuffle and deflate, which any reader undoes.
using Bytes = std::vector<unsigned char>;

// Shuffle: byte k of number i goes to `to`[k stride + i]. Bytes of one place are alike and are
// small together. `to` must be zero: places where all numbers have zero are left alone.
template <class Number>
void shuffle(std::span<const Number> from, unsigned char* to, std::size_t stride) {
  using Bits = std::conditional_t<sizeof(Number) == 8, std::uint64_t, std::uint32_t>;
  static_assert(std::endian::native == std::endian::little, "numbers are written as they are");
  Bits any = 0;
  for (const Number number : from) any |= std::bit_cast<Bits>(number);
  for (std::size_t k = 0; k < sizeof(Number); ++k) {
    if ((any >> (8 * k) & 0xff) == 0) continue;
    for (std::size_t i = 0; i < from.size(); ++i)
      to[k * stride + i] = static_cast<unsigned char>(std::bit_cast<Bits>(from[i]) >> (8 * k));
  }
}

// Deflate: the bytes as one zlib stream (RFC 1950). Does not call HDF5, so that several threads may
// each compress a chunk.
Bytes deflated(std::span<const unsigned char> bytes);

}  // namespace qddot::motion_files
