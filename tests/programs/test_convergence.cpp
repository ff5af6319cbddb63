#include <boost/test/unit_test.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(convergence)

using namespace qddot;

BOOST_AUTO_TEST_CASE(every_order_that_is_told_is_the_method_s) {
  const Folder folder;
  const Exit result =
      run("convergence", {"--scene", "pendulum", "--until", "1", "--methods",
                          "verlet,blanes_moan6,kahan_li8", "--out", folder / "out"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"divided by the largest displacement", "-: no order"}));
  const Table table = read_csv(folder / "out/order.csv");
  int told = 0;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    BOOST_TEST(table.value(row, "error_position") > 0);
    if (table.text(row, "observed_order").empty()) continue;
    const std::string& method = table.text(row, "method");
    const double order = method == "verlet" ? 2 : method == "blanes_moan6" ? 6 : 8;
    // The next term of the error has two powers of h more and, at the coarsest, is some tenths.
    BOOST_TEST(std::abs(table.value(row, "observed_order") - order) < 0.75, method);
    ++told;
  }
  BOOST_TEST(told >= 8);
}

BOOST_AUTO_TEST_CASE(beyond_the_horizon_there_are_no_errors_and_no_orders) {
  const Folder folder;
  const std::string scene = folder.write(
      "chain.toml", "until = 12\n[generator]\nkind = \"chain\"\nnodes = 4\nstiffness = 1000\n");
  const Exit result = run(
      "convergence", {"--scene", scene, "--methods", "verlet,kahan_li8", "--out", folder / "out"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"chaotic", "nobody knows the positions"}));
  const Table table = read_csv(folder / "out/order.csv");
  BOOST_TEST_REQUIRE(table.rows.size() == 2u);
  for (std::size_t row = 0; row < 2; ++row) {
    BOOST_TEST(table.text(row, "method") == (row == 0 ? "verlet" : "kahan_li8"));
    for (const char* column : {"error_position", "error_velocity", "observed_order"})
      BOOST_TEST(table.text(row, column) == "");
  }
}

BOOST_AUTO_TEST_SUITE_END()
