#include "experiments/motion_files/deflate.hpp"

#include <isa-l/igzip_lib.h>
#include <stdexcept>

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

}  // namespace

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

}  // namespace qddot::motion_files
