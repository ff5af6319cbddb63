#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "experiments/motion_files/deflate.hpp"
#include "experiments/motion_files/hdf5.hpp"

namespace qddot::motion_files {

// Consecutive rows of one column of a dataset.
struct Chunk {
  hsize_t row = 0, column = 0;  // of the first row
  std::size_t count = 0;        // of the present rows
  Bytes bytes;                  // the rows, shuffled if they are to be compressed
  Bytes packed;                 // the rows as HDF5 stores them, when all are present
};

// A dataset of 32-bit floats, rows x columns, that grows by the rows of each frame. Each column has
// chunks of its own: neighbouring numbers are then alike and compress well.
class RowStream {
 public:
  // One column makes it a dataset of one dimension. `is_packed`: whether it is compressed.
  RowStream(const hdf5::Handle& parent, const std::string& name, std::size_t rows_a_frame,
            std::size_t columns, bool is_packed = true);

  // The numbers of a frame that belong into one chunk: from[0], from[stride], ...
  struct Piece {
    Chunk* chunk;
    const float* from;
    std::size_t count;
  };
  // Appends the rows of a frame and returns the pieces to be put into chunks. The rows must exist
  // until that is done.
  std::vector<Piece> append(const std::vector<float>& rows);
  // Puts a piece in its chunk and compresses that if it is full. Different pieces of a frame may be
  // put by different threads.
  void put(const Piece& piece) const;
  // Compresses chunks that are not full, whose other rows are zero and beyond the last.
  void complete();
  // Writes the compressed chunks; returns whether there were any.
  bool write();
  // Adds a dataset that shows the rows of the frame without copying them.
  void show_frame(const hdf5::Handle& parent, const std::string& name, std::size_t frame) const;

 private:
  std::vector<hsize_t> size(hsize_t rows) const;
  void pack(Chunk& chunk) const;

  std::string name_;  // its path in the file
  std::size_t rows_a_frame_, columns_, rows_a_chunk_;
  bool is_packed_;
  std::size_t rows_ = 0;  // appended so far
  hdf5::Handle set_;
  std::deque<Chunk> chunks_;  // from the first unwritten one, row by row
};

// Appends rows to streams, on all cores.
void append(const std::vector<std::pair<RowStream*, const std::vector<float>*>>& rows);

}  // namespace qddot::motion_files
