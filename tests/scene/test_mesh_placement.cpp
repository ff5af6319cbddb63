// A mesh in its scene: moved, welded, pinned and told of.
#include <cmath>
#include <numbers>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/scene_file.hpp"
#include "tests/folder.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(mesh_placement)

using namespace qddot;

namespace {

// A square of two triangles that share no vertex, so that two vertices are doubled.
const std::string cut = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";

Scene scene_of(const std::string& keys, const std::string& mesh = cut) {
  const Folder folder;
  folder.write("a.obj", mesh);
  folder.write("a.toml", "[mesh]\nfile = \"a.obj\"\nstiffness = 10.0\ntotal_mass = 6.0\n" + keys);
  return read_scene(folder / "a.toml");
}

}  // namespace

BOOST_AUTO_TEST_CASE(vertices_are_scaled_turned_and_shifted_in_this_order) {
  const Scene scene = scene_of(
      "scale = 2\nrotation = [90, 0, 0]\nshift = [0, 0, 1]\nvelocity = [0, 3, 0]\n"
      "[[mesh.pin]]\nmin = [-1, -1, 2.9]\nmax = [9, 1, 3.1]\n");
  // y becomes z, exactly.
  BOOST_TEST((scene.nodes[2].position == Eigen::Vector3d(2, 0, 3)));
  BOOST_TEST((scene.nodes[1].position == Eigen::Vector3d(2, 0, 1)));
  for (const Node& node : scene.nodes) {
    BOOST_TEST((node.velocity == Eigen::Vector3d(0, 3, 0)));
    BOOST_TEST(node.pinned == (node.position[2] == 3));  // the box is in the scene's coordinates
  }
  // Lengths stay, and a turn about any axis keeps them up to rounding.
  const Scene turned = scene_of("rotation = [10, -20, 30]\n"), drawn = scene_of("");
  for (std::size_t e = 0; e < drawn.springs.size(); ++e)
    BOOST_TEST(std::abs(turned.springs[e].law.rest_length - drawn.springs[e].law.rest_length) <
               4e-16);
  const double c = std::cos(std::numbers::pi / 6);
  BOOST_TEST(
      (scene_of("rotation = [0, 0, 30]\n").nodes[1].position - Eigen::Vector3d(c, 0.5, 0)).norm() <
      1e-15);
}

BOOST_AUTO_TEST_CASE(seams_are_told_and_welded) {
  const Scene apart = scene_of("");
  BOOST_TEST(apart.nodes.size() == 6);
  BOOST_TEST_REQUIRE(apart.warnings.size() == 1);
  BOOST_TEST(contains(apart.warnings[0], {"a.obj", "2 parts", "2 vertices", "weld = 1e-9"}),
             apart.warnings[0]);
  for (const char* keys : {"weld = 1e-9\n", "weld = 0\n", "weld = 0.9e-3\nscale = 1e-3\n"}) {
    const Scene joined = scene_of(keys);
    BOOST_TEST(joined.nodes.size() == 4);
    BOOST_TEST(joined.springs.size() == 5);
    BOOST_TEST(joined.nodes[0].mass == 1.5);  // a share of the total for each that is left
    BOOST_TEST(joined.warnings.empty());
  }
  // Two triangles that do not touch: nothing to weld.
  const Scene two = scene_of("", cut + "v 5 5 5\nv 6 5 5\nl 7 8\n");
  BOOST_TEST(contains(two.warnings.at(0), {"3 parts"}));
  const Scene far = scene_of("", "v 0 0 0\nv 1 0 0\nv 5 0 0\nv 6 0 0\nl 1 2\nl 3 4\n");
  BOOST_TEST(far.warnings.at(0).find("weld") == std::string::npos, far.warnings[0]);
}

BOOST_AUTO_TEST_CASE(pins_may_name_nodes) {
  const Scene scene =
      scene_of("weld = 0\npin = [{nodes = [0, 3]}, {min = [1, 1, 0], max = [1, 1, 0]}]\n");
  for (std::size_t i = 0; i < 4; ++i) BOOST_TEST(scene.nodes[i].pinned == (i != 1));
  for (const auto& [keys, fragments] :
       std::vector<std::pair<std::string, std::vector<std::string>>>{
           {"pin = [{nodes = [6]}]\n", {"mesh.pin[0].nodes", "6 is not a node", "0 to 5"}},
           {"pin = [{nodes = [-1]}]\n", {"-1 is not a node"}},
           {"pin = [{nodes = 1}]\n", {"mesh.pin[0].nodes", "arrays of nodes"}},
           {"pin = [{nodes = [1.5]}]\n", {"arrays of nodes"}},
           {"pin = [{nodes = []}]\n", {"arrays of nodes"}},
           {"pin = [{nodes = [1], min = [0, 0, 0]}]\n", {"one of nodes, group, and a box"}},
           {"weld = -1\n", {"mesh.weld", "from 0"}},
           {"rotation = 90\n", {"mesh.rotation", "3 finite numbers"}}}) {
    const std::string message = refusal_of([&, mesh = keys] { scene_of(mesh); });
    BOOST_TEST(names_all(message, fragments), keys << " gives: " << message);
  }
}

BOOST_AUTO_TEST_CASE(what_a_mesh_file_loses_is_told) {
  const Scene scene = scene_of("weld = 0\n", cut + "surf 0 1 0 1\n");
  BOOST_TEST_REQUIRE(scene.warnings.size() == 1);
  BOOST_TEST(contains(scene.warnings[0], {"a.obj", "1 line", "surf"}), scene.warnings[0]);
}

BOOST_AUTO_TEST_CASE(a_mesh_is_no_scene) {
  for (const char* name : {"a.obj", "a.OBJ", "a.mesh", "a.msh"}) {
    const Folder folder;
    const auto path = folder.write(name, cut);
    BOOST_TEST(names_all(refusal_of([&] { read_scene(path); }),
                         {name, "a mesh, not a scene", "[mesh]", std::string("file = \"") + name}));
  }
}

BOOST_AUTO_TEST_SUITE_END()
