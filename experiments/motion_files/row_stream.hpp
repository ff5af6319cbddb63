#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "experiments/motion_files/hdf5.hpp"

namespace qddot::motion_files {

// Part of one column of a dataset, as HDF5 keeps it: as it is, or compressed as HDF5's filters
// shuffle and deflate do, so that any reader of HDF5 has it back.
struct Chunk {
  hsize_t row = 0, column = 0;
  bool is_packed = true;
  std::vector<float> values;
  std::vector<unsigned char> packed;
};

// A dataset of 32-bit floats, rows x columns, that grows by the rows of frame after frame. Each
// column is in chunks of its own: numbers beside each other are then alike, and smaller together.
class RowStream {
 public:
  // One column makes it a dataset of one dimension. `is_packed`: whether it is compressed.
  RowStream(const hdf5::Handle& parent, const std::string& name, std::size_t rows_a_frame,
            std::size_t columns, bool is_packed = true);

  // Takes the rows of a frame, row after row; they wait for their chunk to be full.
  void append(const std::vector<float>& rows);
  // The chunks that are full, to be packed and written.
  std::vector<Chunk>& full() { return full_; }
  // Calls what is left full, in a chunk whose other rows are zero and beyond the last.
  void complete();
  // Writes the packed chunks.
  void write();
  // A dataset that is the rows of that frame here, without a copy of them.
  void show_frame(const hdf5::Handle& parent, const std::string& name, std::size_t frame) const;

 private:
  std::vector<hsize_t> size(hsize_t rows) const;

  std::string name_;  // its path in the file
  hsize_t rows_a_frame_, columns_, rows_a_chunk_;
  hsize_t rows_ = 0;  // appended so far
  hdf5::Handle set_;
  std::vector<Chunk> open_;  // one a column
  std::vector<Chunk> full_;
};

// Packs the full chunks of all streams, on all cores, then writes them; whether there were any.
bool write_full(const std::vector<RowStream*>& streams);

}  // namespace qddot::motion_files
