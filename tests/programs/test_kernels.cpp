#include <cstdlib>

#include <boost/test/unit_test.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(kernels)

using namespace qddot;

namespace {

// The file of all nodes that a run of simulate ends with, by kernels and roots of these names;
// empty where the processor has none.
std::string end_of(const char* level, const char* roots, const std::vector<std::string>& run_of) {
  const Folder folder;
  setenv("QDDOT_KERNELS", level, 1);
  setenv("QDDOT_ROOTS", roots, 1);
  std::vector<std::string> arguments = run_of;
  arguments.insert(arguments.end(), {"--final", folder / "end.csv"});
  const Exit exit = run("simulate", arguments);
  unsetenv("QDDOT_KERNELS");
  unsetenv("QDDOT_ROOTS");
  if (exit.status != 0) {
    BOOST_TEST(exit.err.find("this processor") != std::string::npos, exit.err);
    return {};
  }
  return read_all(folder / "end.csv");
}

}  // namespace

// Springs are added in the same order at every width, all operations are the same, and so are roots
// and quotients. The lowest level has no fused products and rounds otherwise.
BOOST_AUTO_TEST_CASE(runs_are_the_same_to_the_bit_at_every_width_and_with_all_kinds_of_roots) {
  const std::vector<std::vector<std::string>> runs = {
      {"--scene", "cloth", "--method", "verlet", "--step-size", "2e-4"},
      {"--scene", "cloth", "--method", "blanes_moan4", "--step-size", "1e-3", "--no-reduce",
       "dimension,mirror"},
      {"--scene", "cloth", "--method", "symmetric8", "--step-size", "2e-4"},
      {"--scene", "cloth", "--method", "implicit_midpoint", "--step-size", "2e-3"},
      {"--scene", "cloth", "--method", "dprkn8", "--rtol", "1e-5"},
      {"--scene", "lattice", "--method", "verlet", "--step-size", "2e-5", "--until", "0.02"},
      {"--scene", "lattice", "--method", "linear_midpoint", "--step-size", "1e-3", "--until",
       "0.02"},
      {"--scene", "chain", "--method", "symmetric6", "--step-size", "1e-5", "--until", "0.02"},
      {"--scene", "framed_cloth", "--method", "linear_midpoint", "--step-size", "1e-3", "--until",
       "0.02"},
      {"--scene", "fpu", "--method", "verlet", "--step-size", "1e-2", "--until", "10"}};
  for (const auto& arguments : runs) {
    BOOST_TEST_CONTEXT(fmt::format("{}", fmt::join(arguments, " "))) {
      const std::string expected = end_of("v3", "processor", arguments);
      for (const char* level : {"v3", "v4"}) {
        for (const char* roots : {"processor", "estimated_root", "estimated"}) {
          const std::string end = end_of(level, roots, arguments);
          BOOST_TEST((end.empty() || end == expected), level << " " << roots);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
