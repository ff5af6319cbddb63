// The processor whose code OpenBLAS should take.
#include <boost/test/unit_test.hpp>

#include "experiments/kit/blas.hpp"

BOOST_AUTO_TEST_SUITE(blas)

using namespace qddot;

BOOST_AUTO_TEST_CASE(code_with_the_processors_vectors_is_left_alone) {
  for (const auto* core : {"SkylakeX", "Cooperlake", "Sapphirerapids"})
    BOOST_TEST(wider_core(core, 512) == "");
  for (const auto* core : {"Haswell", "Zen"}) BOOST_TEST(wider_core(core, 256) == "");
  BOOST_TEST(wider_core("Prescott", 128) == "");
}

BOOST_AUTO_TEST_CASE(code_with_narrower_vectors_is_not) {
  for (const auto* core : {"Prescott", "Nehalem", "Haswell", "Zen"})
    BOOST_TEST(wider_core(core, 512) == "SkylakeX");
  for (const auto* core : {"Prescott", "Sandybridge", "Piledriver"})
    BOOST_TEST(wider_core(core, 256) == "Haswell");
}

BOOST_AUTO_TEST_CASE(nothing_is_said_of_names_that_are_not_known) {
  for (const auto* core : {"", "Unknown", "Zen9", "armv8"}) BOOST_TEST(wider_core(core, 512) == "");
}

BOOST_AUTO_TEST_SUITE_END()
