// The study that docs/developing.md shows as an example.
#include <boost/test/unit_test.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(reversal)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

Words words(const std::string& out, const Words& more = {}) {
  Words all = {"--scene", "pendulum", "--until", "1", "--steps", "0.01,0.005", "--out", out};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(symmetric_methods_return_and_others_as_near_as_their_order_says) {
  const Folder folder;
  const Exit result =
      run("reversal", words(folder / "out", {"--methods", "verlet,rk4,implicit_euler"}));
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table table = read_csv(folder / "out/reversal.csv");
  BOOST_TEST_REQUIRE(table.rows.size() == 6u);
  for (std::size_t row = 0; row < 6; row += 2) {
    const std::string& method = table.text(row, "method");
    const double coarse = table.value(row, "distance"), fine = table.value(row + 1, "distance");
    if (method == "verlet") {  // rounding of some hundred steps
      BOOST_TEST(coarse < 1e-12);
    } else {
      const double order = std::log2(coarse / fine);
      // The error of rk4 on the way there is undone on the way back, but for its next term.
      BOOST_TEST(std::abs(order - (method == "rk4" ? 5 : 1)) < 0.3, method << " " << order);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_does_not_reach_its_end_has_no_distance) {
  const Folder folder;
  const Exit result = run("reversal", {"--scene", "cloth", "--until", "0.05", "--methods", "verlet",
                                       "--steps", "1e-3", "--out", folder / "out"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(read_csv(folder / "out/reversal.csv").text(0, "distance") == "");
}

BOOST_AUTO_TEST_CASE(an_interrupted_study_goes_on) {
  const Folder folder;
  // Two million steps take longer than the limit on any machine.
  const Words all = {"--scene", "pendulum",    "--until",   "1",
                     "--steps", "1e-6",        "--methods", "verlet,position_verlet",
                     "--out",   folder / "out"};
  Words limited = all, resumed = all;
  limited.insert(limited.end(), {"--time-limit", "0.02"});
  resumed.emplace_back("--resume");
  BOOST_TEST(run("reversal", limited).status == 3);
  BOOST_TEST(run("reversal", resumed).status == 0);
  BOOST_TEST(read_csv(folder / "out/reversal.csv").rows.size() == 2u);
  BOOST_TEST(contains(run("reversal", resumed).err, {"nothing is missing"}));
}

BOOST_AUTO_TEST_CASE(wrong_options_are_refused) {
  const Folder folder;
  for (const auto& [more, fragment] :
       {std::pair(Words{"--steps", "-1"}, "--steps -1 is not allowed"),
        std::pair(Words{"--methods", "ida"}, "ida chooses its steps by itself"),
        std::pair(Words{"--methods", "leap"}, "leap is not a method")}) {
    const Exit result =
        run("reversal", {"--scene", "pendulum", "--out", folder / "out", more[0], more[1]});
    BOOST_TEST(complains(result, 2, "reversal", {fragment}), exit_in_words(result, more));
  }
  BOOST_TEST(folder.listing() == "");
}

BOOST_AUTO_TEST_SUITE_END()
