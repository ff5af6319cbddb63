#include "experiments/motion_files/row_stream.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstdint>
#include <future>
#include <libdeflate.h>
#include <memory>
#include <new>
#include <span>
#include <system_error>
#include <thread>

namespace qddot::motion_files {
namespace {

using namespace hdf5;

static_assert(std::endian::native == std::endian::little, "floats are written as they are");

// Rows of a chunk: enough to make it worth its place in the index, few enough for the caches.
constexpr hsize_t least_rows = 1 << 12, most_rows = 1 << 16;
// Level of deflate: the next ones save no 5 % and take half as long again.
constexpr int fastest = 1;

// Whole frames where they are small, equal parts of a frame where it is large.
hsize_t chunk_rows(hsize_t rows_a_frame) {
  const hsize_t rows = std::max<hsize_t>(rows_a_frame, 1);
  if (rows < least_rows) return rows * ((least_rows + rows - 1) / rows);
  const hsize_t parts = (rows + most_rows - 1) / most_rows;
  return (rows + parts - 1) / parts;
}

Handle stream_properties(hsize_t rows, std::size_t dimensions, bool is_packed) {
  Handle properties = new_properties(H5P_DATASET_CREATE);
  std::vector<hsize_t> chunk(dimensions, 1);
  chunk[0] = rows;
  checked(H5Pset_chunk(properties.id(), static_cast<int>(dimensions), chunk.data()));
  if (!is_packed) return properties;
  checked(H5Pset_shuffle(properties.id()));
  checked(H5Pset_deflate(properties.id(), fastest));
  return properties;
}

// Compresses chunks, one after another. Does not call HDF5, so that several threads may have one.
class Packer {
 public:
  Packer() : deflate_(libdeflate_alloc_compressor(fastest), libdeflate_free_compressor) {
    if (!deflate_) throw std::bad_alloc();
  }

  void pack(Chunk& chunk) {
    if (!chunk.is_packed) {
      const auto bytes = std::as_bytes(std::span(chunk.values));
      const auto* first = reinterpret_cast<const unsigned char*>(bytes.data());
      chunk.packed.assign(first, first + bytes.size());
      return;
    }
    const std::size_t count = chunk.values.size();
    shuffled_.resize(4 * count);
    const float* from = chunk.values.data();
    unsigned char* const to = shuffled_.data();
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t i = 0; i < count; ++i)
        to[k * count + i] =
            static_cast<unsigned char>(std::bit_cast<std::uint32_t>(from[i]) >> (8 * k));
    }
    room_.resize(libdeflate_zlib_compress_bound(deflate_.get(), shuffled_.size()));
    const std::size_t size =
        libdeflate_zlib_compress(deflate_.get(), to, shuffled_.size(), room_.data(), room_.size());
    chunk.packed.assign(room_.begin(), room_.begin() + std::ptrdiff_t(size));
  }

 private:
  std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> deflate_;
  std::vector<unsigned char> shuffled_, room_;
};

std::string path_in_file(const Handle& parent, const std::string& name) {
  std::string path(static_cast<std::size_t>(checked(H5Iget_name(parent.id(), nullptr, 0))), '\0');
  checked(H5Iget_name(parent.id(), path.data(), path.size() + 1));
  return path + "/" + name;
}

}  // namespace

RowStream::RowStream(const Handle& parent, const std::string& name, std::size_t rows_a_frame,
                     std::size_t columns, bool is_packed)
    : name_(path_in_file(parent, name)),
      rows_a_frame_(rows_a_frame),
      columns_(columns),
      rows_a_chunk_(chunk_rows(rows_a_frame)),
      open_(columns) {
  const auto none = size(0);
  set_ = new_dataset(parent, name, H5T_IEEE_F32LE, new_space(none, true),
                     stream_properties(rows_a_chunk_, none.size(), is_packed));
  for (std::size_t k = 0; k < columns; ++k) {
    open_[k].column = k;
    open_[k].is_packed = is_packed;
  }
}

std::vector<hsize_t> RowStream::size(hsize_t rows) const {
  return columns_ == 1 ? std::vector{rows} : std::vector{rows, columns_};
}

void RowStream::append(const std::vector<float>& rows) {
  const std::size_t count = rows.size() / columns_;
  for (Chunk& chunk : open_) {
    for (std::size_t i = 0; i < count;) {
      const std::size_t end =
          std::min(count, i + static_cast<std::size_t>(rows_a_chunk_) - chunk.values.size());
      std::size_t at = chunk.values.size();
      chunk.values.resize(at + end - i);
      float* const to = chunk.values.data();
      for (; i < end; ++i) to[at++] = rows[i * columns_ + chunk.column];
      if (chunk.values.size() < rows_a_chunk_) continue;
      full_.push_back(std::move(chunk));
      chunk = Chunk{
          full_.back().row + rows_a_chunk_, full_.back().column, full_.back().is_packed, {}, {}};
    }
  }
  rows_ += count;
}

void RowStream::complete() {
  for (Chunk& chunk : open_) {
    if (chunk.values.empty()) continue;
    chunk.values.resize(rows_a_chunk_, 0);
    full_.push_back(std::move(chunk));
  }
  open_.clear();
}

void RowStream::write() {
  if (full_.empty()) return;
  checked(H5Dset_extent(set_.id(), size(rows_).data()));
  for (const Chunk& chunk : full_) {
    const hsize_t place[] = {chunk.row, chunk.column};
    checked(
        H5Dwrite_chunk(set_.id(), H5P_DEFAULT, 0, place, chunk.packed.size(), chunk.packed.data()));
  }
  full_.clear();
}

void RowStream::show_frame(const Handle& parent, const std::string& name, std::size_t frame) const {
  const Handle all = new_space(size(rows_)), shown = new_space(size(rows_a_frame_));
  const std::vector<hsize_t> start = {frame * rows_a_frame_, 0}, count = size(rows_a_frame_);
  checked(
      H5Sselect_hyperslab(all.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr));
  const Handle properties = new_properties(H5P_DATASET_CREATE);
  checked(H5Pset_virtual(properties.id(), shown.id(), ".", name_.c_str(), all.id()));
  new_dataset(parent, name, H5T_IEEE_F32LE, shown, properties);
}

bool write_full(const std::vector<RowStream*>& streams) {
  std::vector<Chunk*> chunks;
  for (RowStream* stream : streams) {
    for (Chunk& chunk : stream->full()) chunks.push_back(&chunk);
  }
  if (chunks.empty()) return false;
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    Packer packer;
    for (std::size_t k = next++; k < chunks.size(); k = next++) packer.pack(*chunks[k]);
  };
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  {
    std::vector<std::future<void>> others;
    try {
      while (others.size() + 1 < std::min(cores, chunks.size()))
        others.push_back(std::async(std::launch::async, work));
    } catch (const std::system_error&) {  // no more threads: those there are do it
    }
    work();
    for (auto& other : others) other.get();
  }
  for (RowStream* stream : streams) stream->write();
  return true;
}

}  // namespace qddot::motion_files
