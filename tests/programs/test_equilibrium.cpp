#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "qddot/scene/scene_file.hpp"
#include "qddot/scene/settle.hpp"
#include "tests/programs/process.hpp"

BOOST_AUTO_TEST_SUITE(equilibrium)

using namespace qddot;

namespace {

const char* const falling = "dimension = 1\ngravity = [-1]\nnodes = [{position = [0], mass = 1}]\n";

}  // namespace

BOOST_AUTO_TEST_CASE(nodes_at_rest_are_written_as_simulate_writes_them) {
  const Folder folder;
  for (const char* scene : {"cloth", "oscillator", "pendulum"}) {
    const Exit result = run("equilibrium", {"--scene", scene, "--final", folder / "e.csv"});
    BOOST_TEST_REQUIRE(result.status == 0, result.err);
    BOOST_TEST(result.err == "");
    BOOST_TEST(contains(result.out, {scene, "largest force", "energy", "smallest eigenvalue of -K",
                                     "isolated minimum"}));
    const Scene drawn = load_scene(scene), rest = settled(drawn, scene);
    const Table table = read_csv(folder / "e.csv");
    BOOST_TEST(table.header == (drawn.dimension == 1 ? "node,x,vx" : "node,x,y,z,vx,vy,vz"));
    BOOST_TEST_REQUIRE(table.rows.size() == rest.nodes.size());
    for (std::size_t i = 0; i < rest.nodes.size(); ++i) {
      BOOST_TEST(table.value(i, "node") == static_cast<double>(i));
      BOOST_TEST(table.value(i, "x") == rest.nodes[i].position.x());
      BOOST_TEST(table.value(i, "vx") == 0);
      if (drawn.dimension == 1) continue;
      BOOST_TEST(table.value(i, "y") == rest.nodes[i].position.y());
      BOOST_TEST(table.value(i, "z") == rest.nodes[i].position.z());
      BOOST_TEST(table.value(i, "vz") == 0);
    }
  }
}

BOOST_AUTO_TEST_CASE(sidecar_says_how_well_it_rests) {
  const Folder folder;
  const Exit result = run("equilibrium", {"--scene", "lattice", "--final", folder / "e.csv"});
  BOOST_TEST_REQUIRE(result.status == 0, result.err);
  const ReducedScene scene(load_scene("lattice"), Reductions::all_directions());
  const Equilibrium e = equilibrium_of(scene);
  const auto origin = nlohmann::json::parse(read_all(folder / "e.json"));
  BOOST_TEST(origin.at("outcome").get<std::string>() == "reached");
  BOOST_TEST(origin.at("residual").get<double>() == e.residual);
  BOOST_TEST(origin.at("smallest_eigenvalue").get<double>() == e.smallest_eigenvalue);
  BOOST_TEST(origin.at("iterations").get<int>() == e.iterations);
  BOOST_TEST(origin.at("isolated").get<bool>());
  BOOST_TEST(origin.at("scene").at("name").get<std::string>() == "lattice");
  BOOST_TEST(contains(result.out, {fmt::format("{:.6g} N/m", e.smallest_eigenvalue)}));
}

BOOST_AUTO_TEST_CASE(loose_scene_is_told_to_be_loose) {
  const Exit result = run("equilibrium", {"--scene", "pair"});
  BOOST_TEST(result.status == 0);
  BOOST_TEST(contains(result.out, {"not known to be isolated"}));
}

BOOST_AUTO_TEST_CASE(scene_without_rest_ends_with_status_3_and_one_sentence) {
  const Folder folder;
  const std::string path = folder.write("falling.toml", falling);
  const Exit result = run("equilibrium", {"--scene", path, "--final", folder / "e.csv"});
  BOOST_TEST(complains(result, 3, "equilibrium", {"no equilibrium", "falls for ever"}), result.err);
  const auto origin = nlohmann::json::parse(read_all(folder / "e.json"));
  BOOST_TEST(origin.at("outcome").get<std::string>() == "unbounded");
  BOOST_TEST(origin.at("residual").get<double>() == 1);  // its weight
}

BOOST_AUTO_TEST_SUITE_END()
