#include <bit>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <boost/test/unit_test.hpp>

#include "qddot/model/kernels/level.hpp"
#include "qddot/model/kernels/roots.hpp"
#include "qddot/model/kernels/spring_kernels.hpp"
#include "qddot/model/mass_spring.hpp"
#include "tests/measure.hpp"

namespace qddot::kernels {

#define QDDOT_DECLARE(level)                                                                       \
  namespace level {                                                                                \
  bool roots_and_quotients(Roots, const double*, const double*, double*, double*, std::ptrdiff_t); \
  }
#define QDDOT_ENTRY(level) &level::roots_and_quotients,
QDDOT_LEVELS(QDDOT_DECLARE)

// root = sqrt(a) and quotient = t/root by one kind of roots, n numbers of each, n a multiple of 8.
// False where the version in use has no such roots.
static bool roots_and_quotients(Roots roots, const double* a, const double* t, double* root,
                                double* quotient, std::ptrdiff_t n) {
  static constexpr decltype(&roots_and_quotients) versions[] = {QDDOT_LEVELS(QDDOT_ENTRY)};
  return versions[level()](roots, a, t, root, quotient, n);
}

}  // namespace qddot::kernels

BOOST_AUTO_TEST_SUITE(roots)

using namespace qddot;
using namespace qddot::kernels;

namespace {

using Bits = std::uint64_t;
__extension__ using Wide = unsigned __int128;

// Squared lengths and tensions, by turns of eight.
class Arguments {
 public:
  void add(double a, double t) {
    a_.push_back(a);
    t_.push_back(t);
  }

  // The number of roots and quotients that differ in a bit from the processor's own. `is_there` is
  // false if the version in use makes no estimates.
  Index differences(Roots roots, bool& is_there) {
    while (a_.size() % slice_rows) add(1, 1);
    const auto n = std::ssize(a_);
    std::vector<double> root(a_.size()), quotient(a_.size());
    is_there = roots_and_quotients(roots, a_.data(), t_.data(), root.data(), quotient.data(), n);
    if (!is_there) return 0;
    Index count = 0;
    for (std::size_t i = 0; i < a_.size(); ++i) {
      const double l = std::sqrt(a_[i]), q = t_[i] / l;
      count += std::bit_cast<Bits>(l) != std::bit_cast<Bits>(root[i]) ||
               std::bit_cast<Bits>(q) != std::bit_cast<Bits>(quotient[i]);
    }
    return count;
  }
  void clear() {
    a_.clear();
    t_.clear();
  }

 private:
  std::vector<double> a_, t_;
};

void check(Arguments& arguments) {
  for (const Roots roots : {Roots::estimated_root, Roots::estimated}) {
    bool is_there = false;
    BOOST_TEST(arguments.differences(roots, is_there) == 0);
  }
  arguments.clear();
}

// The inverse of an odd number mod 2^64: each turn doubles the bits that are right.
Bits inverse(Bits odd) {
  Bits x = odd;
  for (int turn = 0; turn < 6; ++turn) x *= 2 - odd * x;
  return x;
}

// The odd m in (0, 2^(bits - 1)) whose square is d mod 2^bits, for d = 1 mod 8. It is found bit by
// bit from the lowest. The other three roots are the complements of it and of these to 2^(bits -
// 1).
Bits root_mod(Bits d, int bits) {
  Bits m = 1;
  for (int i = 3; i < bits; ++i) {
    if (((m * m - d) >> i) & 1) m += Bits{1} << (i - 1);
  }
  return m & ((Bits{1} << (bits - 1)) - 1);
}

// A number of the window of both kinds of estimates, [2^-64, 2^64).
double any(std::mt19937_64& random) {
  const Bits mantissa = random() >> 12, exponent = 1023 - 64 + random() % 128;
  return std::bit_cast<double>(exponent << 52 | mantissa);
}

// A number whose root is rounded to l, of [1, 2).
double square_of(double l) {
  double a = l * l;
  while (std::sqrt(a) < l) a = std::nextafter(a, 8);
  while (std::sqrt(a) > l) a = std::nextafter(a, 0);
  BOOST_REQUIRE(std::sqrt(a) == l);
  return a;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_hundred_million_random_roots_and_quotients_have_the_processors_bits) {
  std::mt19937_64 random(11);
  Arguments arguments;
  for (int block = 0; block < 1000; ++block) {
    for (int i = 0; i < 50'000; ++i) {
      const double t = any(random);
      arguments.add(any(random), random() % 2 ? t : -t);
    }
    check(arguments);
  }
}

// Next to powers of two, and with mantissas of few bits.
BOOST_AUTO_TEST_CASE(so_have_those_next_to_powers_of_two) {
  Arguments arguments;
  const auto near_one = [](int k) { return k < 0 ? 1 + k * 0x1p-53 : 1 + k * 0x1p-52; };
  for (int exponent = -64; exponent < 63; ++exponent) {
    for (int k = -40; k <= 40; ++k) {
      for (int j = -40; j <= 40; ++j) {
        arguments.add(std::ldexp(near_one(k), exponent + 1), std::ldexp(near_one(j), k));
      }
      arguments.add(std::ldexp(near_one(k), exponent + 1), 0);
    }
  }
  check(arguments);
}

// The numbers a whose roots are nearest to the middle of two numbers, m = M 2^-53 with M odd. a -
// m^2 = d 2^-106 gives M^2 = -d mod 2^54 (a in [1, 2)) or mod 2^55 (a in [2, 4)). Any other d is so
// large that a rounding error below 7 2^-106 sqrt(a) does no harm.
BOOST_AUTO_TEST_CASE(so_have_all_roots_that_are_hard_to_round) {
  Arguments arguments;
  Index found = 0;
  for (const int bits : {54, 55}) {
    for (int d = -401; d <= 401; d += 2) {
      const Bits rest = static_cast<Bits>(-static_cast<std::int64_t>(d));
      if (rest % 8 != 1) continue;
      const Bits root = root_mod(rest, bits), half = Bits{1} << (bits - 1);
      for (const Bits m0 : {root, half - root, half + root, 2 * half - root}) {
        for (Bits m = m0; m < Bits{1} << 54; m += 2 * half) {
          const Wide square = static_cast<Wide>(m) * m + static_cast<Wide>(__int128{d});
          BOOST_REQUIRE(static_cast<Bits>(square) % (Bits{1} << bits) == 0);
          const double a = static_cast<double>(static_cast<Bits>(square >> 54)) * 0x1p-52;
          const bool is_of_these = bits == 54 ? a >= 1 && a < 2 : a >= 2 && a < 4;
          if (!is_of_these) continue;
          ++found;
          arguments.add(a, 1);
          arguments.add(a * 0x1p-60, a);
        }
      }
    }
  }
  BOOST_TEST(found > 100);
  check(arguments);
}

// Quotients t/l next to the middle of two numbers. l = L 2^-52, M has 54 bits and is odd, and t
// 2^54 - M L = k, k odd. The last number below 2 is the hardest divisor: its inverse is the hardest
// to round. Other hard ones have an inverse near the middle of two numbers, M L = 2^106 - k.
BOOST_AUTO_TEST_CASE(so_have_quotients_that_are_hard_to_round) {
  std::vector<Bits> numbers = {0x1fffffffffffff, 0x1ffffff8000001, 0x1e20adbc4078a2,
                               0x1c36899addce3c, 0x15555555555554, 0x1ffb8a8b628dbc,
                               0x1fa01f23c0c510, 0x113deff6b41e35, 0x12bf5907e316d2};
  std::mt19937_64 random(12);
  // Anywhere, and nearer and nearer to 2.
  for (int i = 0; i < 400'000; ++i) {
    numbers.push_back((Bits{1} << 53) - 1 - (random() >> (12 + i % 10 * 5)));
  }
  Arguments arguments;
  for (const Bits number : numbers) {
    const double l = static_cast<double>(number) * 0x1p-52, a = square_of(l);
    const Bits odd = number >> std::countr_zero(number);
    for (const int k : {-5, -3, -1, 1, 3, 5}) {
      const Bits signed_k = static_cast<Bits>(std::int64_t{k});
      const Bits m = (0 - signed_k) * inverse(odd) & ((Bits{1} << 54) - 1);
      const Wide product = static_cast<Wide>(m) * odd + static_cast<Wide>(__int128{k});
      arguments.add(a, static_cast<double>(static_cast<Bits>(product >> 54)));
    }
    for (int j = 0; j < 4; ++j) arguments.add(a, 1 + j * 0x1p-52);
  }
  check(arguments);
}

// The processor's own operations are used beyond the range of estimates. These are lengths whose
// squares are denormal, overflow, or lie at the ends of the window, and laws beyond theirs.
// Products are fused here if they are in the kernels.
BOOST_AUTO_TEST_CASE(forces_of_springs_of_any_length_are_those_of_the_plain_law) {
  const bool fuses = levels()[static_cast<std::size_t>(level())] != "v2";
  for (const double quartic : {0.0, 3.0, 1e-250}) {
    for (const double stiffness : {1e3, 1e-80, 1e90}) {
      for (const double rest : {0.1, 1e-70, 1e70}) {
        const SpringLaw law{stiffness, rest, quartic};
        Network network{.dimension = 3, .node_mass = Vec::Ones(2)};
        network.links = {{0, 1, law}};
        const auto system = make_mass_spring(network, Forces::by_vectors);
        for (int exponent = -540; exponent <= 540; exponent += 1) {
          for (const double x : {1.0, 1 - 0x1p-53, 1 + 0x1p-52, 1.37}) {
            Vec q = Vec::Zero(6);
            q[3] = std::ldexp(x, exponent);
            const double l = std::sqrt(q[3] * q[3]), s = l - rest;
            const double stiffer =
                fuses ? std::fma(quartic, s * s, stiffness) : stiffness + quartic * (s * s);
            const double tension = s * (quartic > 0 ? stiffer : stiffness);
            const double pull = l > 0 ? tension / l * q[3] : 0.0;
            const double force = force_at(*system, q)[0];
            if (!(force == pull || (std::isnan(force) && std::isnan(pull)))) {
              BOOST_TEST_ERROR("a spring of " << q[3] << " m pulls with " << force << " N, not "
                                              << pull);
            }
          }
        }
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
