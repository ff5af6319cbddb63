#include <regex>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(diagnosis)

using namespace qddot;

namespace {

// w = sqrt(k/m) = 10 rad/s.
Exit simulate(std::vector<std::string> words) { return run("simulate", words); }

// The number behind `words` in the text.
double number_behind(const std::string& text, const std::string& words) {
  std::smatch found;
  BOOST_TEST_REQUIRE(std::regex_search(text, found, std::regex(words + R"(([0-9.e+-]*[0-9]))")),
                     text);
  return number(found[1]);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_above_the_limit_is_named_with_what_holds) {
  const Exit result = simulate(
      {"--scene", "oscillator", "--method", "verlet", "--step-size", "0.25", "--until", "100"});
  BOOST_TEST(complains(result, 3, "simulate",
                       {"it failed in step", "h w_max is 2.5 at the start", "verlet's limit of 2",
                        "stable when tried: h = "}),
             result.err);
  const double h = number_behind(result.err, "stable when tried: h = ");
  BOOST_TEST(h == 0.125);  // half of it; and it does hold, as another method does at this h:
  BOOST_TEST(simulate({"--scene", "oscillator", "--method", "verlet", "--step-size",
                       fmt::format("{}", h), "--until", "100"})
                 .status == 0);
  BOOST_TEST(contains(result.err, {"at this h ", "implicit_euler"}), result.err);
}

BOOST_AUTO_TEST_CASE(of_a_large_scene_w_max_is_told_from_below) {
  const Folder folder;
  const std::string scene =
      folder.write("large.toml", "[generator]\nkind = 'cloth'\nnodes = 80\n");  // 9597 unknowns
  const Exit result =
      simulate({"--scene", scene, "--method", "verlet", "--step-size", "0.01", "--until", "1"});
  BOOST_TEST(complains(result, 3, "simulate", {"h w_max is at least ", "verlet's limit of 2"}),
             result.err);
}

BOOST_AUTO_TEST_CASE(the_step_it_failed_in_is_the_one_after_the_last_that_was_taken) {
  const Exit result = simulate(
      {"--scene", "oscillator", "--method", "verlet", "--step-size", "0.4", "--until", "100"});
  // rho = 7 + sqrt(48) at h w = 4, and |v| = 10 sinh-like growth to 1e30: 30 ln 10 / ln rho = 26.
  const double failed = number_behind(result.err, "it failed in step ");
  BOOST_TEST(failed > 24);
  BOOST_TEST(failed < 29);
  BOOST_TEST(contains(result.out, {fmt::format("after {} steps", failed - 1)}), result.out);
}

BOOST_AUTO_TEST_CASE(of_several_parts_the_step_is_that_of_the_one_that_failed) {
  // The oscillator of h w = 4, beside one that takes as many steps to nobody's harm.
  const Folder folder;
  const std::string scene = folder.write(
      "two.toml",
      "dimension = 1\nuntil = 100\n"
      "nodes = [{position = [0], pinned = true}, "
      "{position = [1], velocity = [1], mass = 1}, "
      "{position = [10], pinned = true}, "
      "{position = [11], velocity = [1], mass = 1}]\n"
      "springs = [{nodes = [0, 1], stiffness = 1}, {nodes = [2, 3], stiffness = 100}]\n");
  const Exit result = simulate({"--scene", scene, "--method", "verlet", "--step-size", "0.4"});
  BOOST_TEST(result.status == 3);
  const double failed = number_behind(result.err, "it failed in step ");
  BOOST_TEST(failed > 24);
  BOOST_TEST(failed < 29);
}

BOOST_AUTO_TEST_CASE(a_run_whose_energy_grew_by_orders_is_warned_of_whatever_the_method) {
  const Folder folder;
  for (const char* method : {"cvode_bdf", "cvode_adams"}) {
    const Exit coarse = simulate({"--scene", "oscillator", "--method", method, "--rtol", "1e-2",
                                  "--until", "30", "--final", folder / "f.csv"});
    BOOST_TEST(coarse.status == 0);
    BOOST_TEST(contains(coarse.err, {"warning", "the energy grew to", "lower --rtol"}), coarse.err);
    const auto sidecar = nlohmann::json::parse(read_all(folder / "f.json"));
    BOOST_TEST(static_cast<double>(sidecar.at("energy_growth")) > 10);
    const Exit fine =
        simulate({"--scene", "oscillator", "--method", method, "--rtol", "1e-6", "--until", "30"});
    BOOST_TEST(fine.err == "");
  }
}

BOOST_AUTO_TEST_CASE(numbers_beyond_all_measure_are_named_and_no_instability) {
  const Folder folder;
  for (const char* rest_length : {"1e30", "1e200"}) {
    const std::string scene = folder.write(
        "long.toml",
        fmt::format(
            "dimension = 2\nuntil = 1\n"
            "nodes = [{{position = [0, 0], pinned = true}}, {{position = [1, 0], mass = 1}}]\n"
            "springs = [{{nodes = [0, 1], stiffness = 100, rest_length = {}}}]\n",
            rest_length));
    const Exit result = simulate({"--scene", scene, "--method", "verlet", "--step-size", "0.01"});
    BOOST_TEST(complains(result, 3, "simulate", {"extreme rest lengths"}), result.err);
    BOOST_TEST(!contains(result.err, {"instability"}), result.err);
  }
}

BOOST_AUTO_TEST_CASE(explicit_euler_is_told_apart_since_no_step_holds) {
  const Exit result = simulate({"--scene", "oscillator", "--method", "explicit_euler",
                                "--step-size", "0.1", "--until", "100"});
  // A step multiplies the amplitude by sqrt(1 + h^2 w^2), with w = 10 rad/s.
  const std::string rate = fmt::format("{:.3g}/s", std::log(2.) / (2 * 0.1));
  BOOST_TEST(complains(result, 3, "simulate", {"lets vibrations grow at every h", rate.c_str()}),
             result.err);
  BOOST_TEST(!contains(result.err, {"tried: h = "}), result.err);
}

BOOST_AUTO_TEST_CASE(a_spring_that_stiffens_as_it_stretches_crosses_the_limit_on_the_way) {
  // The motion goes from rest length at 3 m/s to the stretch s where c/4 s^4 is nearly 9/2. w^2 =
  // 100 + 3 c s^2 grows from 10^2 to 66^2, so that h w_max = 0.4 at the start and 2.6 at most.
  const Folder folder;
  const std::string scene = folder.write(
      "stiffening.toml",
      "dimension = 1\nuntil = 50\n"
      "nodes = [{position = [0], pinned = true}, {position = [1], velocity = [3], mass = 1}]\n"
      "springs = [{nodes = [0, 1], stiffness = 100, quartic = 100000}]\n");
  const Exit result = simulate({"--scene", scene, "--method", "verlet", "--step-size", "0.04"});
  BOOST_TEST(complains(result, 3, "simulate", {"at t = ", "above verlet's limit of 2"}),
             result.err);
  const double h_omega = number_behind(result.err, "h w_max is ");
  BOOST_TEST(h_omega > 2);
}

BOOST_AUTO_TEST_CASE(newton_that_fails_names_a_step_at_which_it_does_not) {
  const Exit result =
      simulate({"--scene", "pendulum", "--method", "discrete_gradient", "--step-size", "0.5"});
  BOOST_TEST(complains(result, 3, "simulate", {"it failed in step 2", "stable when tried: h = "}),
             result.err);
  const double h = number_behind(result.err, "stable when tried: h = ");
  BOOST_TEST(simulate({"--scene", "pendulum", "--method", "discrete_gradient", "--step-size",
                       fmt::format("{}", h)})
                 .status == 0);
}

BOOST_AUTO_TEST_CASE(a_run_that_reaches_its_end_above_the_limit_is_warned_of) {
  const Exit above = simulate({"--scene", "oscillator", "--method", "rk4", "--step-size", "0.3"});
  BOOST_TEST(above.status == 0);
  BOOST_TEST(contains(above.err, {"warning", "2.8284/w_max"}), above.err);
  const Exit below = simulate({"--scene", "oscillator", "--method", "rk4", "--step-size", "0.28"});
  BOOST_TEST(below.err == "");
  const Exit euler =
      simulate({"--scene", "oscillator", "--method", "explicit_euler", "--step-size", "0.01"});
  BOOST_TEST(contains(euler.err, {"warning", "grow at every h", "0.5/s"}), euler.err);
}

BOOST_AUTO_TEST_SUITE_END()
