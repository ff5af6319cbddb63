#include "experiments/motion_files/deflate.hpp"

#include <isa-l/igzip_lib.h>
#include <stdexcept>

namespace qddot::motion_files {
namespace {

// What a stream may be longer than its bytes: headers of stored blocks, five bytes for each 65535
// and for one more, and the six of the stream itself.
std::size_t room_for(std::size_t bytes) { return bytes + 5 * (bytes / 65535 + 2) + 6; }

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
  if (isal_deflate_stateless(&stream) != COMP_OK)
    throw std::logic_error("deflate found no room for a chunk");
  return {room.data(), room.data() + stream.total_out};
}

}  // namespace qddot::motion_files
