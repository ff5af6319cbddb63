#include "experiments/motion_files/row_stream.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <isa-l/igzip_lib.h>
#include <stdexcept>

#include "experiments/motion_files/on_all_cores.hpp"

#ifdef __x86_64__
#include <immintrin.h>
#endif

namespace qddot::motion_files {
namespace {

// The largest size of a stream. It may exceed its bytes by headers of stored blocks, five bytes for
// each 65535 and for one more, and by six bytes of the stream itself.
std::size_t room_for(std::size_t bytes) { return bytes + 5 * (bytes / 65535 + 2) + 6; }

// ISA-L leaves numbers in the upper halves of the vector registers. All of SSE then takes up to
// three times as long (measured on Zen 4).
#ifdef __x86_64__
__attribute__((target("avx"))) void clear_avx() { _mm256_zeroupper(); }
void clear_upper_halves() {
  if (__builtin_cpu_supports("avx")) clear_avx();
}
#else
void clear_upper_halves() {}
#endif

using namespace hdf5;

// The numbers of rows of a chunk: enough for its entry in the index, few enough for the caches.
constexpr std::size_t least_rows = 1 << 12, most_rows = 1 << 16;

// Small frames are kept whole; a large frame is divided into equal parts.
std::size_t rows_of_chunk(std::size_t rows_a_frame) {
  const std::size_t rows = std::max<std::size_t>(rows_a_frame, 1);
  if (rows < least_rows) return rows * ((least_rows + rows - 1) / rows);
  const std::size_t parts = (rows + most_rows - 1) / most_rows;
  return (rows + parts - 1) / parts;
}

Handle stream_properties(hsize_t rows, std::size_t dimensions, bool is_packed) {
  Handle properties = new_properties(H5P_DATASET_CREATE);
  std::vector<hsize_t> chunk(dimensions, 1);
  chunk[0] = rows;
  checked(H5Pset_chunk(properties.id(), static_cast<int>(dimensions), chunk.data()));
  if (is_packed) pass_filters(properties);
  return properties;
}

std::string path_in_file(const Handle& parent, const std::string& name) {
  std::string path(static_cast<std::size_t>(checked(H5Iget_name(parent.id(), nullptr, 0))), '\0');
  checked(H5Iget_name(parent.id(), path.data(), path.size() + 1));
  return path + "/" + name;
}

}  // namespace

void shuffle(std::span<const float> from, unsigned char* to, std::size_t stride) {
  static_assert(std::endian::native == std::endian::little, "numbers are written as they are");
  std::uint32_t any = 0;
  for (const float number : from) any |= std::bit_cast<std::uint32_t>(number);
  for (std::size_t k = 0; k < sizeof(float); ++k) {
    if ((any >> (8 * k) & 0xff) == 0) continue;
    for (std::size_t i = 0; i < from.size(); ++i)
      to[k * stride + i] =
          static_cast<unsigned char>(std::bit_cast<std::uint32_t>(from[i]) >> (8 * k));
  }
}

Bytes deflated(std::span<const unsigned char> bytes) {
  thread_local Bytes room, level_room(ISAL_DEF_LVL1_DEFAULT);
  room.resize(room_for(bytes.size()));
  isal_zstream stream;
  isal_deflate_stateless_init(&stream);
  stream.gzip_flag = IGZIP_ZLIB;
  // Level 0 makes files a sixth larger; level 2 makes them no smaller.
  stream.level = 1;
  stream.level_buf = level_room.data();
  stream.level_buf_size = static_cast<std::uint32_t>(level_room.size());
  stream.next_in = const_cast<unsigned char*>(bytes.data());  // is only read
  stream.avail_in = static_cast<std::uint32_t>(bytes.size());
  stream.next_out = room.data();
  stream.avail_out = static_cast<std::uint32_t>(room.size());
  stream.end_of_stream = 1;
  const int status = isal_deflate_stateless(&stream);
  clear_upper_halves();
  if (status != COMP_OK) throw std::logic_error("deflate found no room for a chunk");
  return {room.data(), room.data() + stream.total_out};
}

RowStream::RowStream(const Handle& parent, const std::string& name, std::size_t rows_a_frame,
                     std::size_t columns, bool is_packed)
    : name_(path_in_file(parent, name)),
      rows_a_frame_(rows_a_frame),
      columns_(columns),
      rows_a_chunk_(rows_of_chunk(rows_a_frame)),
      is_packed_(is_packed) {
  const auto none = size(0);
  set_ = new_dataset(parent, name, H5T_IEEE_F32LE, new_space(none, true),
                     stream_properties(rows_a_chunk_, none.size(), is_packed));
}

std::vector<hsize_t> RowStream::size(hsize_t rows) const {
  return columns_ == 1 ? std::vector{rows} : std::vector{rows, hsize_t(columns_)};
}

std::vector<RowStream::Piece> RowStream::append(const std::vector<float>& rows) {
  std::vector<Piece> pieces;
  const std::size_t count = rows.size() / columns_;
  for (std::size_t i = 0; i < count;) {
    const std::size_t start = rows_ % rows_a_chunk_;
    const std::size_t end = std::min(count, i + rows_a_chunk_ - start);
    for (std::size_t k = 0; k < columns_; ++k) {
      if (start == 0) chunks_.push_back({rows_, k, 0, Bytes(4 * rows_a_chunk_), {}});
    }
    for (std::size_t k = 0; k < columns_; ++k)
      pieces.push_back({&chunks_[chunks_.size() - columns_ + k], &rows[i * columns_ + k], end - i});
    rows_ += end - i;
    i = end;
  }
  return pieces;
}

void RowStream::put(const Piece& piece) const {
  Chunk& chunk = *piece.chunk;
  std::array<float, 1024> numbers;  // stay in the first cache
  for (std::size_t i = 0; i < piece.count; i += numbers.size()) {
    const std::size_t count = std::min(numbers.size(), piece.count - i);
    const float* const from = piece.from + i * columns_;
    for (std::size_t k = 0; k < count; ++k) numbers[k] = from[k * columns_];
    if (is_packed_)
      shuffle({numbers.data(), count}, &chunk.bytes[chunk.count], rows_a_chunk_);
    else
      std::memcpy(&chunk.bytes[4 * chunk.count], numbers.data(), 4 * count);
    chunk.count += count;
  }
  if (chunk.count == rows_a_chunk_) pack(chunk);
}

void RowStream::pack(Chunk& chunk) const {
  chunk.packed = is_packed_ ? deflated(chunk.bytes) : std::move(chunk.bytes);
  chunk.bytes = {};
}

void RowStream::complete() {
  for (Chunk& chunk : chunks_) pack(chunk);
}

bool RowStream::write() {
  if (chunks_.empty() || chunks_.front().packed.empty()) return false;
  checked(H5Dset_extent(set_.id(), size(rows_).data()));
  for (; !chunks_.empty() && !chunks_.front().packed.empty(); chunks_.pop_front()) {
    const Chunk& chunk = chunks_.front();
    const hsize_t place[] = {chunk.row, chunk.column};
    checked(
        H5Dwrite_chunk(set_.id(), H5P_DEFAULT, 0, place, chunk.packed.size(), chunk.packed.data()));
  }
  return true;
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

void append(const std::vector<std::pair<RowStream*, const std::vector<float>*>>& rows) {
  std::vector<std::pair<RowStream*, RowStream::Piece>> pieces;
  std::size_t all_numbers = 0;
  for (const auto& [stream, numbers] : rows) {
    for (const auto& piece : stream->append(*numbers)) pieces.emplace_back(stream, piece);
    all_numbers += numbers->size();
  }
  on_all_cores(pieces.size(), all_numbers,
               [&](std::size_t k) { pieces[k].first->put(pieces[k].second); });
}

}  // namespace qddot::motion_files
