// |x| = m 2^e with whole m < 2^53. Its 17 digits are those of the whole number
//   N = |x| 10^k = m 5^k 2^(e + k),  10^16 <= N < 10^17,
// rounded, and |x| = N/10^16 10^p with p = 16 - k. For 0 <= k <= 27, 5^k has less than 64 bits: the
// product is exact in 128 and one shift rounds it, halves to even.
#include "experiments/digits.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>

#include <fmt/compile.h>
#include <fmt/format.h>

namespace qddot {
namespace {

__extension__ using Wide = unsigned __int128;

constexpr int digits = 17, most_k = 27;
constexpr std::uint64_t too_large = 100'000'000'000'000'000;  // 10^17

constexpr auto powers_of_five = [] {
  std::array<std::uint64_t, most_k + 1> power{1};
  for (int k = 1; k <= most_k; ++k) power[k] = 5 * power[k - 1];
  return power;
}();

// m 5^k 2^(e + k), rounded.
std::uint64_t scaled(std::uint64_t m, int e, int k) {
  const Wide product = Wide{m} * powers_of_five[k];
  const int shift = -(e + k);
  if (shift <= 0) return static_cast<std::uint64_t>(product << -shift);
  const auto whole = static_cast<std::uint64_t>(product >> shift);
  const Wide rest = product - (Wide{whole} << shift), half = Wide{1} << (shift - 1);
  return whole + (rest > half || (rest == half && whole % 2 == 1));
}

// The digits with their decimal point, as "%g" places it.
char* place(const char* digit, int count, int p, char* to) {
  if (p < -4) {
    *to++ = digit[0];
    if (count > 1) *to++ = '.';
    to = std::copy(digit + 1, digit + count, to);
    *to++ = 'e';
    *to++ = '-';
    *to++ = static_cast<char>('0' + -p / 10);
    *to++ = static_cast<char>('0' + -p % 10);
    return to;
  }
  if (p < 0) {
    *to++ = '0';
    *to++ = '.';
    to = std::fill_n(to, -p - 1, '0');
    return std::copy_n(digit, count, to);
  }
  const int whole = std::min(count, p + 1);
  to = std::copy_n(digit, whole, to);
  to = std::fill_n(to, p + 1 - whole, '0');
  if (count == whole) return to;
  *to++ = '.';
  return std::copy(digit + whole, digit + count, to);
}

}  // namespace

char* write_digits(double x, char* to) {
  const auto bits = std::bit_cast<std::uint64_t>(x);
  const int exponent = static_cast<int>(bits >> 52 & 0x7ff) - 1023;  // 2^exponent <= |x|
  // floor(exponent log10 2), for exponents up to 1650: p, or one less.
  int p = exponent * 78913 >> 18;
  if (p < digits - 1 - most_k || p >= digits - 1) {
    return fmt::format_to(to, FMT_COMPILE("{:.17g}"), x);
  }
  const std::uint64_t m = (bits & 0xf'ffff'ffff'ffff) | std::uint64_t{1} << 52;
  std::uint64_t n = scaled(m, exponent - 52, digits - 1 - p);
  if (n >= too_large) n = scaled(m, exponent - 52, digits - 1 - ++p);
  if (bits >> 63) *to++ = '-';
  std::array<char, digits> digit;
  std::to_chars(digit.data(), digit.data() + digits, n);
  int count = digits;
  while (digit[count - 1] == '0') --count;
  return place(digit.data(), count, p, to);
}

}  // namespace qddot
