#include <boost/test/unit_test.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(solvers)

using namespace qddot;

namespace {

Exit run_solvers(const Folder& folder, std::vector<std::string> words) {
  words.insert(words.end(), {"--scene", "cloth", "--repeats", "1", "--out", folder / "out"});
  return run("solvers", words);
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_solver_solves_and_is_held_against_the_machine) {
  const Folder folder;
  const Exit result = run_solvers(folder, {});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table table = read_csv(folder / "out/solvers.csv");
  BOOST_TEST(table.header ==
             "scene,unknowns,solver,analysis_s,factorization_s,solve_s,gflops,"
             "gigabytes_per_second,bytes,residual");
  BOOST_TEST_REQUIRE(table.rows.size() == 5u);
  for (std::size_t i = 0; i < 4; ++i) {
    BOOST_TEST(table.value(i, "factorization_s") > 0);
    BOOST_TEST(table.value(i, "solve_s") > 0);
    // |b| is 2 and M - h^2 K of condition 10: rounding, with room for a thousand such errors.
    BOOST_TEST(table.value(i, "residual") < 1e-11);
  }
  // The machine's row.
  BOOST_TEST(table.value(4, "gflops") > 0);
  BOOST_TEST(table.value(4, "gigabytes_per_second") > 0);
}

BOOST_AUTO_TEST_SUITE_END()
