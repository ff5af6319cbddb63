// Masses by density: shares of length, area and volume.
#include <numeric>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/mesh/lumped_mass.hpp"
#include "qddot/scene/mesh/mesh_elements.hpp"
#include "qddot/scene/scene_file.hpp"
#include "tests/measure.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(lumped_mass)

using namespace qddot;
using namespace qddot::mesh;
using Eigen::Vector3d;

namespace {

Scene scene_of(const std::string& file, const std::string& text, const std::string& keys) {
  return parse_scene("[mesh]\nfile = '" + file + "'\nstiffness = 1\n" + keys, "a.toml", "", {},
                     [&](const std::string&) { return text; });
}

double total_mass(const Scene& scene) {
  return std::accumulate(scene.nodes.begin(), scene.nodes.end(), 0.0,
                         [](double sum, const Node& node) { return sum + node.mass; });
}

// The corners of the reference element that Gmsh and MEDIT number so.
std::vector<Vector3d> reference_corners(std::size_t corners) {
  const std::vector<Vector3d> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  switch (corners) {
    case 4:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case 5:
      return {square[0], square[1], square[2], square[3], {0.3, 0.4, 1}};
    case 6:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    default: {
      std::vector<Vector3d> cube = square;
      for (const Vector3d& x : square) cube.push_back(x + Vector3d::UnitZ());
      return cube;
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(sizes_of_elements_are_those_of_geometry) {
  for (const auto& [corners, volume] : {std::pair(4u, 1. / 6), {5u, 1. / 3}, {6u, 0.5}, {8u, 1.}}) {
    auto points = reference_corners(corners);
    BOOST_TEST(std::abs(element_size(3, points) - volume) < 8 * eps);
    // An affine map changes volumes by its determinant, whichever way it turns space over.
    const Eigen::Matrix3d map{{1, 2, 0.5}, {-3, 1, 0}, {0.2, 0, -2}};
    for (Vector3d& x : points) x = map * x + Vector3d(5, -7, 3);
    // Coordinates of up to 12 m round.
    BOOST_TEST(std::abs(element_size(3, points) - volume * std::abs(map.determinant())) <
               100 * 12 * eps * map.norm() * map.norm());
  }
  // A hexahedron whose top is raised at one corner: the mean of the four heights.
  auto raised = reference_corners(8);
  raised[6].z() = 3;
  BOOST_TEST(std::abs(element_size(3, raised) - 1.5) < 8 * eps);
  // A pentagon with a notch, and a line.
  const std::vector<Vector3d> notched = {{0, 0, 1}, {2, 0, 1}, {2, 2, 1}, {1, 0.5, 1}, {0, 2, 1}};
  BOOST_TEST(std::abs(element_size(2, notched) - 2.5) < 8 * eps);
  BOOST_TEST(element_size(1, std::vector<Vector3d>{{1, 2, 3}, {1, 5, 7}}) == 5);
}

BOOST_AUTO_TEST_CASE(a_surface_has_its_area_and_a_solid_its_volume) {
  // The unit cube's surface, scaled by 2: 24 m^2.
  const std::string cube =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5\nf 4 5 8\n";
  const Scene surface =
      scene_of("a.obj", cube, "density = 0.5\nscale = 2\nrotation = [10, 20, 30]\n");
  BOOST_TEST(std::abs(total_mass(surface) - 12) < 100 * eps);
  // Vertex 4 has two squares and two triangles of 4 m^2 and 2 m^2: 0.5 (4/4 + 4/4 + 2/3 + 2/3).
  BOOST_TEST(std::abs(surface.nodes[3].mass - 0.5 * (2 + 4. / 3)) < 20 * eps);

  // One cube as six tetrahedra around a diagonal, with a triangle of its surface and an edge, which
  // have no volume.
  const std::string solid =
      "MeshVersionFormatted 1\nDimension 3\nVertices\n8\n"
      "0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n0 0 1 0\n1 0 1 0\n1 1 1 0\n0 1 1 0\n"
      "Tetrahedra\n6\n1 2 3 7 0\n1 3 4 7 0\n1 4 8 7 0\n1 8 5 7 0\n1 5 6 7 0\n1 6 2 7 0\n"
      "Triangles\n1\n1 2 3 0\nEdges\n1\n1 2 0\nEnd\n";
  const Scene volume = scene_of("a.mesh", solid, "density = 7\nscale = 2\n");
  BOOST_TEST(std::abs(total_mass(volume) - 7 * 8) < 100 * eps);
  // The diagonal's ends have a quarter of all six, and vertex 2 of two.
  BOOST_TEST(std::abs(volume.nodes[0].mass - 14) < 20 * eps);
  BOOST_TEST(std::abs(volume.nodes[1].mass - 7 * 8 * 2. / 6 / 4) < 20 * eps);
}

BOOST_AUTO_TEST_CASE(lines_have_length_and_elements_count_once) {
  const Scene rope = scene_of("a.obj", "v 0 0 0\nv 3 4 0\nv 3 4 2\nl 1 2 3\n", "density = 0.1\n");
  BOOST_TEST(std::abs(rope.nodes[0].mass - 0.25) < eps);
  BOOST_TEST(std::abs(rope.nodes[1].mass - 0.35) < eps);
  BOOST_TEST(std::abs(rope.nodes[2].mass - 0.1) < eps);
  // Twice, as a triangle in two groups is.
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  const Scene once = scene_of("a.obj", triangle, "density = 6\n");
  const Scene twice = scene_of("a.obj", triangle + "f 2 3 1\n", "density = 6\n");
  for (std::size_t i = 0; i < 3; ++i) {
    BOOST_TEST(once.nodes[i].mass == 1);
    BOOST_TEST(twice.nodes[i].mass == 1);
  }
}

BOOST_AUTO_TEST_CASE(vertices_that_are_left_out_have_no_share) {
  const Scene scene =
      scene_of("a.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 9 9 9\nv 0 1 0\nf 2 3 5\n", "density = 6\n");
  BOOST_TEST(scene.nodes.size() == 3u);
  for (const Node& node : scene.nodes) BOOST_TEST(node.mass == 1);
  // The shares of both triangles are one node's if vertices are welded.
  const Scene welded =
      scene_of("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 5 6\n",
               "density = 6\nweld = 0\n");
  BOOST_TEST_REQUIRE(welded.nodes.size() == 4u);
  for (const std::size_t i : {0u, 2u}) BOOST_TEST(welded.nodes[i].mass == 2);
}

BOOST_AUTO_TEST_CASE(a_density_that_cannot_be_is_refused) {
  const auto refusal = [](const std::string& text, const std::string& keys) {
    return refusal_of([&] { scene_of("a.obj", text, keys); });
  };
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  BOOST_TEST(names_all(refusal(triangle, "density = 1\ntotal_mass = 1\n"),
                       {"a.toml", "exactly one of node_mass, total_mass and density"}));
  BOOST_TEST(
      names_all(refusal(triangle, ""), {"exactly one of node_mass, total_mass and density"}));
  BOOST_TEST(names_all(refusal(triangle, "density = 0\n"), {"mesh.density", "0", "above 0"}));
  // A line that sticks out of a surface.
  BOOST_TEST(names_all(refusal(triangle + "v 2 2 2\nl 1 4\n", "density = 2\n"),
                       {"mesh.density", "2 is not allowed",
                        "1 vertex belongs to no element with area", "node_mass and total_mass"}));
}

BOOST_AUTO_TEST_SUITE_END()
