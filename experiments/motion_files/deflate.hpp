#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace qddot::motion_files {

// Chunks of an HDF5 dataset go through its filters shuffle and deflate, which any reader undoes.
using Bytes = std::vector<unsigned char>;

// Shuffle: byte k of number i goes to `to`[k stride + i]. Bytes of one place are alike and are
// small together. `to` must be zero: places where all numbers have zero are left alone.
void shuffle(std::span<const float> from, unsigned char* to, std::size_t stride);

// Deflate: the bytes as one zlib stream (RFC 1950). Does not call HDF5, so that several threads may
// each compress a chunk.
Bytes deflated(std::span<const unsigned char> bytes);

}  // namespace qddot::motion_files
