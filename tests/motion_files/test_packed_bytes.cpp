#include <random>
#include <vector>
#include <zlib.h>

#include <boost/test/unit_test.hpp>

#include "experiments/motion_files/deflate.hpp"

#ifdef __x86_64__
#include <cpuid.h>
#include <immintrin.h>
#endif

using namespace qddot::motion_files;

namespace {

// Unpacks by zlib, as HDF5 does.
Bytes inflated(const Bytes& packed, std::size_t size) {
  Bytes bytes(size + 1);  // one more, so that a longer stream is seen
  uLongf count = bytes.size();
  BOOST_REQUIRE(uncompress(bytes.data(), &count, packed.data(), packed.size()) == Z_OK);
  bytes.resize(count);
  return bytes;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(packed_bytes)

BOOST_AUTO_TEST_CASE(bytes_come_back) {
  std::mt19937 random(1);
  // Around the ends of stored blocks, 65535, and of the format's window, 32768.
  for (const std::size_t size : {0, 1, 2, 3, 100, 32767, 32768, 32769, 65534, 65535, 65536, 131069,
                                 131070, 131071, 240000, 1000003}) {
    for (const unsigned kinds : {1U, 2U, 7U, 40U, 200U, 255U, 256U}) {  // of bytes; 256: noise
      Bytes bytes(size);
      for (auto& byte : bytes) byte = static_cast<unsigned char>(random() % kinds);
      const Bytes packed = deflated(bytes);
      BOOST_TEST_CONTEXT(size << " bytes of " << kinds << " kinds") {
        BOOST_TEST((inflated(packed, size) == bytes));
        // Forty kinds take six bits each, and a block's codes some hundred bytes.
        if (kinds <= 40) BOOST_TEST(packed.size() < 0.8 * static_cast<double>(size) + 400);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(zeros_are_small) {
  // A match of deflate's is 258 bytes long at most and takes two bits at least: 1/1032; and the
  // table of the codes comes to it.
  const Bytes zeros(1 << 20, 0);
  BOOST_TEST(deflated(zeros).size() < zeros.size() / 500);
}

BOOST_AUTO_TEST_CASE(shuffled_bytes_stand_by_their_place) {
  const std::vector<float> numbers = {1.5F, -2.0F, 0.0F, 1e-30F, 3.4e38F};
  const std::size_t stride = 7;
  Bytes to(4 * stride, 0);
  shuffle({numbers.data(), numbers.size()}, to.data(), stride);
  const auto* bytes = reinterpret_cast<const unsigned char*>(numbers.data());
  for (std::size_t i = 0; i < stride; ++i) {
    for (std::size_t k = 0; k < 4; ++k)
      BOOST_TEST(to[k * stride + i] == (i < numbers.size() ? bytes[4 * i + k] : 0));
  }
}

#ifdef __x86_64__
// The processor's state in use (XINUSE): bit 2 is the upper halves of the vectors.
__attribute__((target("xsave"))) bool are_upper_halves_in_use() { return _xgetbv(1) >> 2 & 1; }

BOOST_AUTO_TEST_CASE(upper_halves_of_vectors_are_clear_after_it) {
  unsigned a = 0, b = 0, c = 0, d = 0;
  const bool tells = __get_cpuid_count(0xd, 1, &a, &b, &c, &d) && (a >> 2 & 1);
  if (!tells || !__builtin_cpu_supports("avx")) {
    BOOST_TEST_MESSAGE("this processor does not tell");
    return;
  }
  Bytes bytes(100000);
  std::mt19937 random(1);
  for (auto& byte : bytes) byte = static_cast<unsigned char>(random() % 40);
  const Bytes packed = deflated(bytes);
  BOOST_TEST(!are_upper_halves_in_use());
}
#endif

BOOST_AUTO_TEST_SUITE_END()
