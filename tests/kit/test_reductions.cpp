// The programs name the reductions, and each can be left out.
#include <cmath>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "qddot/integrators/registry.hpp"
#include "qddot/scene/reduce/reductions.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(reductions)

using namespace qddot;

namespace {

nlohmann::json json_of(const std::string& path) { return nlohmann::json::parse(read_all(path)); }

// The unknowns that a run of verlet on a scene had, and where its nodes ended.
struct Ended {
  int unknowns;
  Table nodes;
};
Ended run_without(const std::string& scene, const std::string& reductions) {
  const Folder folder;
  std::vector<std::string> words = {"--scene", scene,     "--method", "verlet",  "--step-size",
                                    "1e-5",    "--until", "0.01",     "--final", folder / "f.csv"};
  if (!reductions.empty()) words.insert(words.end(), {"--no-reduce", reductions});
  const Exit result = run("simulate", words);
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  return {json_of(folder / "f.json").at("reduced").at("unknowns"), read_csv(folder / "f.csv")};
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_reduction_can_be_left_out_with_the_same_result) {
  struct Case {
    const char *scene, *without;
    int unknowns;
  };
  // The chain: 100 nodes, one pinned, in a plane. The cloth: 900, two pinned, one half; its lower
  // half without the mirror.
  for (const auto& [scene, without, unknowns] :
       {Case{"chain", "", 198}, Case{"chain", "dimension", 297}, Case{"chain", "pins", 200},
        Case{"chain", "pins,dimension", 300}, Case{"cloth", "", 1347},
        Case{"cloth", "mirror", 2694}, Case{"cloth", "mirror,pins", 2700},
        Case{"oscillator", "constant_stiffness", 1}}) {
    BOOST_TEST_CONTEXT(scene << " without " << without) {
      const Ended end = run_without(scene, without), all = run_without(scene, "");
      BOOST_TEST(end.unknowns == unknowns);
      BOOST_TEST(end.nodes.header == all.nodes.header);
      BOOST_TEST_REQUIRE(end.nodes.rows.size() == all.nodes.rows.size());
      for (std::size_t i = 0; i < all.nodes.rows.size(); ++i) {
        for (const std::string& column : all.nodes.names) {
          // A thousand steps' rounding of coordinates of 1 m, at frequencies of 2e4 rad/s.
          BOOST_TEST(std::abs(end.nodes.value(i, column) - all.nodes.value(i, column)) < 1e-9);
        }
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(unknown_names_are_answered_with_the_known_ones) {
  std::vector<std::string> names = {"--no-reduce", "gravity"};
  for (const auto& name : reduction_names) names.emplace_back(name);
  const Exit result = run("simulate", {"--scene", "chain", "--explain", "--no-reduce", "gravity"});
  BOOST_TEST(complains(result, 2, "simulate", names), result.err);
  for (const char* program : {"work_precision", "convergence"}) {
    const Folder folder;
    const Exit refused =
        run(program, {"--scene", "chain", "--out", folder / "out", "--no-reduce", "gravity"});
    BOOST_TEST(complains(refused, 2, program, names), refused.err);
    BOOST_TEST(folder.listing() == "");
  }
}

BOOST_AUTO_TEST_CASE(explain_prints_what_is_left_and_runs_nothing) {
  const Exit result = run("simulate", {"--scene", "cloth", "--explain"});
  BOOST_TEST(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"1347 unknowns of 2700", "pins", "mirror", "x = 0.5",
                                   "449 of 898", "w_max", "2/w_max", "no direction grows"}));
  const Exit without = run("simulate", {"--scene", "cloth", "--explain", "--no-reduce", "mirror"});
  BOOST_TEST(contains(without.out, {"2694 unknowns of 2700"}));
  BOOST_TEST(!contains(without.out, {"mirror"}));
}

BOOST_AUTO_TEST_CASE(every_sidecar_records_it) {
  const Folder folder;
  BOOST_TEST(run("work_precision", {"--scene", "chain", "--until", "1e-3", "--methods", "verlet",
                                    "--repeats", "1", "--out", folder.path()})
                 .status == 0);
  BOOST_TEST(run("convergence", {"--scene", "chain", "--until", "1e-3", "--methods", "verlet",
                                 "--out", folder.path()})
                 .status == 0);
  for (const char* file : {"points.json", "front.json", "order.json"}) {
    const auto reduced = json_of(folder / file).at("reduced");
    BOOST_TEST(reduced.at("unknowns") == 198, file);
    BOOST_TEST(reduced.at("unknowns_drawn") == 300, file);
    BOOST_TEST(reduced.at("parts") == 1, file);
    BOOST_TEST(reduced.at("reductions").size() == 2u, file);
    BOOST_TEST(reduced.at("reductions")[1].at("name") == "dimension", file);
    BOOST_TEST(!reduced.at("stiffness_is_constant").get<bool>(), file);
    // A chain of 99 equal springs, free at one end: w_max just below 2 sqrt(k/m).
    BOOST_TEST(std::abs(reduced.at("omega_max").get<double>() - 2e4) < 10, file);
    BOOST_TEST(reduced.at("unstable_directions") == 0, file);
  }
}

BOOST_AUTO_TEST_CASE(a_step_beyond_the_stable_one_is_warned_of_with_both_numbers) {
  // w = 10 rad/s: verlet to 0.2 s, kahan_li8 to 0.3096 s.
  const auto simulate = [](const char* method, const char* h, const char* until) {
    return run("simulate",
               {"--scene", "oscillator", "--method", method, "--step-size", h, "--until", until});
  };
  const Exit above = simulate("verlet", "0.201", "1");
  BOOST_TEST(above.status == 0);
  BOOST_TEST(complains(above, 0, "simulate", {"warning", "h = 0.201 s", "2/w_max = 0.2 s"}),
             above.err);
  BOOST_TEST(simulate("verlet", "0.199", "1").err == "");
  BOOST_TEST(simulate("kahan_li8", "0.308", "1").err == "");
  BOOST_TEST(contains(simulate("kahan_li8", "0.312", "1").err, {"3.0964/w_max = 0.3096 s"}));
  BOOST_TEST(simulate("implicit_euler", "0.5", "1").err == "");
  BOOST_TEST(simulate("exact", "0.5", "1").err == "");
  // If it blows up, one sentence says both.
  const Exit blown = simulate("verlet", "1", "200");
  BOOST_TEST(complains(blown, 3, "simulate", {"grew without bound", "2/w_max = 0.2 s"}), blown.err);
}

BOOST_AUTO_TEST_CASE(exact_is_offered_where_k_is_constant_only) {
  const Folder folder;
  const Exit refused =
      run("simulate", {"--scene", "orbit", "--method", "exact", "--step-size", "1"});
  BOOST_TEST(complains(refused, 2, "simulate", {"orbit", "exact", "verlet"}), refused.err);
  const auto names_in = [&](const char* scene) {
    const Exit result = run("work_precision", {"--scene", scene, "--until", "0.1", "--repeats", "1",
                                               "--point-limit", "0.02", "--out", folder.path()});
    BOOST_TEST(result.status == 0, result.err);
    return read_all(folder / "points.csv");
  };
  BOOST_TEST(contains(names_in("oscillator"), {",exact,"}));
  BOOST_TEST(!contains(names_in("orbit"), {",exact,"}));
  const Exit named = run("work_precision", {"--scene", "orbit", "--until", "0.1", "--methods",
                                            "exact", "--out", folder / "none"});
  BOOST_TEST(complains(named, 2, "work_precision", {"orbit", "exact"}), named.err);
}

BOOST_AUTO_TEST_CASE(a_scene_that_starts_at_equilibrium_does) {
  const Folder folder;
  const std::string scene = folder.write("s.toml",
                                         "dimension = 2\ngravity = [0, -10]\nuntil = 0.5\n"
                                         "start = \"equilibrium\"\n"
                                         "nodes = [{position = [0, 0], pinned = true},"
                                         " {position = [0.6, 0.8], mass = 1}]\n"
                                         "springs = [{nodes = [0, 1], stiffness = 100}]\n");
  const Exit result = run("simulate", {"--scene", scene, "--method", "verlet", "--step-size",
                                       "1e-3", "--final", folder / "f.csv"});
  BOOST_TEST(result.status == 0, result.err);
  const Table end = read_csv(folder / "f.csv");
  // Hanging, 0.1 m longer, to what rounding leaves of the residual.
  BOOST_TEST(std::abs(end.value(1, "x")) < 1e-9);
  BOOST_TEST(std::abs(end.value(1, "y") + 1.1) < 1e-9);
  BOOST_TEST(std::abs(end.value(1, "vy")) < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
