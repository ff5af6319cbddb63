#include <cmath>

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "qddot/analysis/natural_modes.hpp"
#include "qddot/scene/scene_file.hpp"
#include "qddot/scene/settle.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(modes)

using namespace qddot;

namespace {

// n masses of 1 kg on springs of 100 N/m between two walls in 1D, at rest:
// w_j = 20 sin(j pi / (2 (n + 1))) rad/s.
std::string row(int n) {
  std::string nodes, springs;
  for (int i = 0; i <= n + 1; ++i) {
    nodes += fmt::format("{{position = [{}], {}}},", i, i % (n + 1) ? "mass = 1" : "pinned = true");
    if (i <= n) springs += fmt::format("{{nodes = [{}, {}], stiffness = 100}},", i, i + 1);
  }
  return fmt::format("dimension = 1\nnodes = [{}]\nsprings = [{}]\n", nodes, springs);
}

// A mass on a spring that its weight compresses: it stands, and would fall to any side.
const char* const upright =
    "dimension = 2\ngravity = [0, -10]\n"
    "nodes = [{position = [0, 0], pinned = true}, {position = [0, 0.9], mass = 1}]\n"
    "springs = [{nodes = [0, 1], stiffness = 100, rest_length = 1}]\n";

std::string file_in(const Folder& folder, const char* name) {
  return folder / (std::string("out/") + name);
}

Exit run_modes(const Folder& folder, std::vector<std::string> words) {
  words.insert(words.end(), {"--out", folder / "out"});
  return run("modes", words);
}

}  // namespace

BOOST_AUTO_TEST_CASE(both_ends_of_the_spectrum_are_tabulated_by_rank) {
  const Folder folder;
  const int n = 30;
  const Exit result =
      run_modes(folder, {"--scene", folder.write("row.toml", row(n)), "--count", "4"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table table = read_csv(file_in(folder, "modes.csv"));
  BOOST_TEST(table.header == "mode,omega,frequency_hz");
  const std::vector<int> ranks = {1, 2, 3, 4, 27, 28, 29, 30};
  BOOST_TEST_REQUIRE(table.rows.size() == ranks.size());
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    BOOST_TEST(table.value(i, "mode") == ranks[i]);
    const double w = 20 * std::sin(ranks[i] * M_PI / (2 * (n + 1)));
    // w^2 is right to 1e-13 of 400 / s^2.
    BOOST_TEST(std::abs(table.value(i, "omega") - w) < 4e-11 / w);
    BOOST_TEST(std::abs(table.value(i, "frequency_hz") - w / (2 * M_PI)) < 4e-11 / w);
  }
  BOOST_TEST(contains(
      result.out, {"row as drawn", "unstable: 0", "w_max", "Lanczos", "Gershgorin", "2/w_max"}));
  const auto origin = nlohmann::json::parse(read_all(file_in(folder, "modes.json")));
  BOOST_TEST(origin.at("at").get<std::string>() == "drawn");
  BOOST_TEST(origin.at("finite_modes").get<int>() == n);
  BOOST_TEST(folder.listing() == "out row.toml ");
  BOOST_TEST(listing(folder / "out") ==
             "modes.csv modes.json shapes.csv shapes.json springs.csv springs.json ");
}

BOOST_AUTO_TEST_CASE(few_modes_are_all_tabulated) {
  for (const int count : {2, 3, 4, 10}) {
    const Folder folder;
    const Exit result = run_modes(
        folder, {"--scene", folder.write("row.toml", row(5)), "--count", std::to_string(count)});
    BOOST_TEST_REQUIRE(result.status == 0, result.err);
    const Table table = read_csv(file_in(folder, "modes.csv"));
    const int expected = count == 2 ? 4 : 5;
    BOOST_TEST(std::ssize(table.rows) == expected);
    BOOST_TEST(table.value(table.rows.size() - 1, "mode") == 5);
    // Shapes of the lowest only: 7 nodes each.
    BOOST_TEST(std::ssize(read_csv(file_in(folder, "shapes.csv")).rows) == 7 * std::min(count, 5));
  }
}

BOOST_AUTO_TEST_CASE(shapes_have_every_node_and_the_springs_join_them) {
  const Folder folder;
  const Exit result =
      run_modes(folder, {"--scene", "cloth", "--count", "3", "--at", "equilibrium"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  BOOST_TEST(contains(result.out, {"at equilibrium"}));
  const Scene rest = settled(load_scene("cloth"), "");
  const ReducedScene reduced(rest, Reductions::all_directions());
  const Vec& q = reduced.initial().q;
  const NaturalModes expected = lowest_modes(reduced.system(), q, 3);
  const Table table = read_csv(file_in(folder, "shapes.csv"));
  BOOST_TEST(table.header == "mode,node,x,y,z,dx,dy,dz");
  BOOST_TEST_REQUIRE(table.rows.size() == 3 * rest.nodes.size());
  std::size_t row = 0;
  for (Index mode = 0; mode < 3; ++mode) {
    const auto moved = reduced.expand({0, q, expected.shapes.col(mode)});
    for (std::size_t i = 0; i < moved.size(); ++i, ++row) {
      BOOST_TEST(table.value(row, "mode") == static_cast<double>(mode + 1));
      BOOST_TEST(table.value(row, "node") == static_cast<double>(i));
      BOOST_TEST(table.value(row, "z") == rest.nodes[i].position.z());
      BOOST_TEST(table.value(row, "dx") == moved[i].velocity.x());
      BOOST_TEST(table.value(row, "dz") == moved[i].velocity.z());
    }
  }
  const Table springs = read_csv(file_in(folder, "springs.csv"));
  BOOST_TEST(springs.header == "i,j");
  BOOST_TEST_REQUIRE(springs.rows.size() == rest.springs.size());
  BOOST_TEST(springs.value(7, "j") == static_cast<double>(rest.springs[7].nodes[1]));
}

BOOST_AUTO_TEST_CASE(growth_is_written_as_a_negative_omega) {
  const Folder folder;
  const std::string path = folder.write("upright.toml", upright);
  const Exit result = run_modes(folder, {"--scene", path});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const Table table = read_csv(file_in(folder, "modes.csv"));
  // w^2 = -m g / (l m) sideways and k / m along.
  BOOST_TEST(std::abs(table.value(0, "omega") + std::sqrt(10 / 0.9)) < 1e-12);
  BOOST_TEST(std::abs(table.value(0, "frequency_hz") + std::sqrt(10 / 0.9) / (2 * M_PI)) < 1e-12);
  BOOST_TEST(std::abs(table.value(1, "omega") - 10) < 1e-12);
  BOOST_TEST(contains(result.out, {"unstable: 1", "grows"}));
  // Hanging, it is a stable pendulum.
  const Exit hanging = run_modes(folder, {"--scene", path, "--at", "equilibrium"});
  BOOST_TEST(contains(hanging.out, {"unstable: 0"}));
  const Table stable = read_csv(file_in(folder, "modes.csv"));
  BOOST_TEST(std::abs(stable.value(0, "omega") - std::sqrt(10 / 1.1)) < 1e-12);
}

BOOST_AUTO_TEST_CASE(growth_and_soft_modes_are_told_beside_stiff_springs) {
  const Folder folder;
  const std::string stands = folder.write(
      "stands.toml",
      "dimension = 2\ngravity = [0, -10]\n"
      "nodes = [{position = [0, 0], pinned = true}, {position = [0, 1], mass = 0.01}]\n"
      "springs = [{nodes = [0, 1], stiffness = 1e9, rest_length = 1.0000000001}]\n");
  const Exit upright_one = run_modes(folder, {"--scene", stands});
  BOOST_TEST_REQUIRE(upright_one.status == 0, upright_one.err);
  BOOST_TEST(contains(upright_one.out, {"unstable: 1", "zero within rounding: 0", "grows"}));
  // w^2 = -g / l to the rounding of k: 1e-15 of 1e11 / s^2.
  BOOST_TEST(std::abs(read_csv(file_in(folder, "modes.csv")).value(0, "omega") + std::sqrt(10)) <
             1e-4);
  const std::string soft = folder.write(
      "soft.toml",
      "dimension = 1\nnodes = [{position = [0], pinned = true}, {position = [1], mass = 1}, "
      "{position = [2], mass = 1}]\nsprings = [{nodes = [0, 1], stiffness = 1e9}, "
      "{nodes = [1, 2], stiffness = 0.001}]\n");
  const Exit slow = run_modes(folder, {"--scene", soft});
  BOOST_TEST(contains(slow.out, {"unstable: 0", "zero within rounding: 0"}));
  // The second mass on its spring of 0.001 N/m, whose other end gives way by 1e-12 of it.
  BOOST_TEST(std::abs(read_csv(file_in(folder, "modes.csv")).value(0, "omega") / std::sqrt(0.001) -
                      1) < 1e-11);
  const Exit rest = run("equilibrium", {"--scene", soft});
  BOOST_TEST(contains(rest.out, {"0.001 N/m", "an isolated minimum"}), rest.out);
}

BOOST_AUTO_TEST_CASE(zeros_are_written_as_zeros) {
  const Folder folder;
  BOOST_TEST(run_modes(folder, {"--scene", "pair"}).status == 0);
  const Table table = read_csv(file_in(folder, "modes.csv"));
  for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(table.value(i, "omega") == 0);  // translations
}

BOOST_AUTO_TEST_CASE(scene_without_modes_or_rest_is_refused) {
  const Folder folder;
  const std::string loose = folder.write(
      "loose.toml",
      "dimension = 2\nnodes = [{position = [0, 0], pinned = true}, {position = [1, 0], mass = 0}, "
      "{position = [2, 0], mass = 1}]\nsprings = [{nodes = [0, 1], stiffness = 100}, "
      "{nodes = [1, 2], stiffness = 100}]\n");
  const Exit massless = run_modes(folder, {"--scene", loose});
  BOOST_TEST(complains(massless, 3, "modes", {"massless"}), massless.err);
  const std::string falling = folder.write(
      "falling.toml", "dimension = 1\ngravity = [-1]\nnodes = [{position = [0], mass = 1}]\n");
  const Exit fall = run_modes(folder, {"--scene", falling, "--at", "equilibrium"});
  BOOST_TEST(complains(fall, 2, "modes", {falling, "falls for ever"}), fall.err);
  BOOST_TEST(run_modes(folder, {"--scene", falling}).status == 0);
}

BOOST_AUTO_TEST_SUITE_END()
