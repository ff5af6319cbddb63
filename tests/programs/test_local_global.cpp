#include <cmath>
#include <set>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(local_global)

using namespace qddot;

namespace {

using Words = std::vector<std::string>;

const std::set<std::string> solvers = {"local_global",          "local_global_chebyshev",
                                       "local_global_anderson", "local_global_lbfgs",
                                       "newton_exact",          "newton_clamped"};

// A cloth of 8 x 8 nodes.
struct Small {
  Folder folder{};
  Exit result = run("local_global",
                    {"--nodes", "8", "--iterations", "30", "--repeats", "1", "--swing", "0.1",
                     "--stiffnesses", "100,200", "--resolutions", "4,6", "--out", folder / "out"});
  std::string file(const std::string& name) const { return folder / ("out/" + name); }
};

const Small& small() {
  static const Small run;
  BOOST_TEST_REQUIRE(run.result.status == 0, run.result.err);
  return run;
}

}  // namespace

BOOST_AUTO_TEST_CASE(one_step_is_tabulated_by_solver_and_iteration) {
  const Table table = read_csv(small().file("convergence.csv"));
  BOOST_TEST(table.header == "solver,iteration,seconds,relative_error");
  std::set<std::string> seen;
  double least = 1;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    const std::string solver = table.text(row, "solver");
    const double error = table.value(row, "relative_error");
    if (seen.insert(solver).second) {  // its first row is the start of all
      BOOST_TEST(table.value(row, "iteration") == 0);
      BOOST_TEST(table.value(row, "seconds") == 0);
      BOOST_TEST(error == 1);
    } else {
      BOOST_TEST(table.value(row, "iteration") > table.value(row - 1, "iteration"));
      BOOST_TEST(table.value(row, "seconds") > 0);
      // Chebyshev's polynomials may rise for a while.
      if (solver != "local_global_chebyshev") {
        BOOST_TEST(error <= table.value(row - 1, "relative_error") + 1e-12);
      }
    }
    BOOST_TEST(error >= 0);
    least = std::min(least, error);
  }
  BOOST_TEST((seen == solvers));
  BOOST_TEST(least == 0);  // of whoever came lowest
}

BOOST_AUTO_TEST_CASE(positions_come_to_those_of_the_converged_step_which_has_an_error_of_its_own) {
  const Table table = read_csv(small().file("positions.csv"));
  BOOST_TEST(table.header == "solver,iteration,seconds,distance_to_converged,step_error");
  const auto origin = nlohmann::json::parse(read_all(small().file("positions.json")));
  const double own = origin["step_error"];
  BOOST_TEST(own > 1e-5);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    BOOST_TEST(table.value(row, "step_error") == own);
    const bool is_last =
        row + 1 == table.rows.size() || table.text(row, "solver") != table.text(row + 1, "solver");
    // Thirty iterations, or as many of Newton's, solve this step far beyond its own error.
    if (is_last) BOOST_TEST(table.value(row, "distance_to_converged") < own);
  }
  for (const std::string& solver : solvers) {
    BOOST_TEST(double(origin["setup"][solver]["analysis_s"]) > 0);
    const bool is_newton = solver.starts_with("newton");
    BOOST_TEST((double(origin["setup"][solver]["factorization_s"]) > 0) != is_newton);
  }
}

BOOST_AUTO_TEST_CASE(the_error_of_the_step_is_of_second_order) {
  const auto own = [](const std::string& h) {
    const Folder folder;
    const Exit result =
        run("local_global",
            {"--nodes",       "5",           "--iterations", "1",     "--repeats",     "1",
             "--swing",       "0.05",        "--until",      "0.001", "--stiffnesses", "100",
             "--resolutions", "4",           "--stiffness",  "100",   "--step-size",   h,
             "--out",         folder / "out"});
    BOOST_TEST_REQUIRE(result.status == 0, result.err);
    return double(nlohmann::json::parse(read_all(folder / "out/positions.json"))["step_error"]);
  };
  // One step errs by h^2/2 of what is left of the acceleration.
  BOOST_TEST(std::abs(std::log2(own("1e-4") / own("5e-5")) - 2) < 0.1);
}

BOOST_AUTO_TEST_CASE(other_stiffnesses_and_resolutions_have_tables_of_the_same_kind) {
  for (const auto& [file, column, values] :
       {std::tuple("stiffness.csv", "stiffness", std::set{100., 200.}),
        std::tuple("resolution.csv", "nodes", std::set{4., 6.})}) {
    const Table table = read_csv(small().file(file));
    BOOST_TEST(table.header == std::string(column) + ",solver,iteration,seconds,relative_error");
    std::set<double> seen;
    for (std::size_t row = 0; row < table.rows.size(); ++row) {
      seen.insert(table.value(row, column));
    }
    BOOST_TEST((seen == values));
  }
}

BOOST_AUTO_TEST_CASE(runs_say_what_is_lost) {
  const Table table = read_csv(small().file("run.csv"));
  BOOST_TEST(table.header == "solver,iterations,seconds,position_error,energy_change");
  const std::size_t last = table.rows.size() - 1;
  BOOST_TEST(table.text(last, "solver") == "newton_exact");
  BOOST_TEST(table.value(last, "position_error") > 1e-4);
  BOOST_TEST(table.value(last, "energy_change") < 0);  // implicit Euler damps
}

BOOST_AUTO_TEST_CASE(simulate_takes_iterations_for_methods_that_have_them) {
  const Words good = {"--scene",     "cloth", "--method", "local_global",
                      "--step-size", "0.01",  "--until",  "0.02"};
  const auto with = [&](Words words) {
    words.insert(words.begin(), good.begin(), good.end());
    return run("simulate", words);
  };
  BOOST_TEST(contains(with({"--iterations", "3"}).out, {"6 force and 0 stiffness evaluations"}));
  BOOST_TEST(contains(with({}).out, {"20 force"}));
  BOOST_TEST(complains(with({"--iterations", "0"}), 2, "simulate",
                       {"--iterations 0", "from 1 to 100000"}));
  BOOST_TEST(complains(run("simulate", {"--scene", "cloth", "--method", "verlet", "--step-size",
                                        "1e-4", "--iterations", "3"}),
                       2, "simulate", {"--iterations is not for verlet", "local_global_lbfgs"}));
}

BOOST_AUTO_TEST_SUITE_END()
