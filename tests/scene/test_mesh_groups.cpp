// Pins and loads by the groups of a mesh: physical groups of Gmsh, references of MEDIT.
#include <boost/test/unit_test.hpp>

#include "qddot/scene/scene_file.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(mesh_groups)

using namespace qddot;
using Eigen::Vector3d;

namespace {

// A square of two triangles. Its left edge is in group 3, "left side", the right one in group 4,
// both triangles in group 3, "plate", and a corner in 5.
const std::string names =
    "$PhysicalNames\n3\n1 3 \"left side\"\n1 4 \"right # \"\n2 3 \"plate\"\n$EndPhysicalNames\n";
const std::string nodes = "11 0 0 0\n12 1 0 0\n13 1 1 0\n14 0 1 0\n";
const std::string old_format = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names + "$Nodes\n4\n" +
                               nodes +
                               "$EndNodes\n$Elements\n6\n"
                               "1 1 2 3 1 14 11\n"
                               "2 1 2 4 2 12 13\n"
                               "3 1 2 0 3 11 12\n"
                               "4 2 2 3 1 11 12 13\n"
                               "5 2 2 3 1 11 13 14\n"
                               "6 15 2 5 1 13\n"
                               "$EndElements\n";
// The same by entities, of which curve 1 is in the group as it runs the other way.
const std::string new_format =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + names +
    "$Entities\n1 3 1 0\n"
    "1 1 1 0 1 5\n"
    "1 0 0 0 0 1 0 1 -3 2 11 -14\n2 1 0 0 1 1 0 1 4 0\n3 0 0 0 1 0 0 0 0\n"
    "1 0 0 0 1 1 0 1 3 0\n$EndEntities\n"
    "$Nodes\n1 4 11 14\n2 1 0 4\n11\n12\n13\n14\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n$EndNodes\n"
    "$Elements\n5 6 1 6\n1 1 1 1\n1 14 11\n1 2 1 1\n2 12 13\n1 3 1 1\n3 11 12\n"
    "2 1 2 2\n4 11 12 13\n5 11 13 14\n0 1 15 1\n6 13\n$EndElements\n";

Scene scene_of(const std::string& keys, const std::string& mesh,
               const std::string& file = "a.msh") {
  return parse_scene("[mesh]\nfile = '" + file + "'\nstiffness = 1\nnode_mass = 1\n" + keys,
                     "a.toml", "", {}, [&](const std::string&) { return mesh; });
}
std::string pinned_by(const std::string& keys, const std::string& mesh,
                      const std::string& file = "a.msh") {
  std::string pinned;
  const Scene scene = scene_of("[[mesh.pin]]\n" + keys + "\n", mesh, file);
  for (const Node& node : scene.nodes) pinned += node.pinned ? '1' : '0';
  return pinned;
}
std::string refusal(const std::string& keys, const std::string& mesh = old_format) {
  return refusal_of([&] { pinned_by(keys, mesh); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(groups_are_chosen_by_name_and_tag) {
  for (const std::string& mesh : {old_format, new_format}) {
    BOOST_TEST(pinned_by("group = 'left side'", mesh) == "1001");
    BOOST_TEST(pinned_by("group = 'right # '", mesh) == "0110");
    BOOST_TEST(pinned_by("group = 4", mesh) == "0110");
    BOOST_TEST(pinned_by("group = 5", mesh) == "0010");
    BOOST_TEST(pinned_by("group = 'plate'", mesh) == "1111");
    BOOST_TEST(pinned_by("group = 3\ndimension = 1", mesh) == "1001");
    const Scene loaded =
        scene_of("[[mesh.load]]\ngroup = 'right # '\ntotal_force = [4, 0, 0]\n", mesh);
    for (std::size_t i = 0; i < 4; ++i)
      BOOST_TEST((loaded.nodes[i].load == Vector3d(i == 1 || i == 2 ? 2 : 0, 0, 0)));
  }
}

BOOST_AUTO_TEST_CASE(unknown_and_unclear_groups_are_told_what_there_is) {
  BOOST_TEST(names_all(refusal("group = 'left'"),
                       {"a.toml:6: mesh.pin[0].group", "'left' is not allowed", "5 of dimension 0",
                        "\"left side\" of dimension 1", "\"plate\" of dimension 2"}));
  BOOST_TEST(names_all(refusal("group = 3"),
                       {"mesh.pin[0].group", "not clear", "\"left side\" of dimension 1",
                        "\"plate\" of dimension 2", "dimension = 1"}));
  BOOST_TEST(names_all(refusal("group = 3\ndimension = 3"), {"mesh.pin[0].group", "allowed are"}));
  BOOST_TEST(names_all(refusal("group = 3\ndimension = 4"), {"mesh.pin[0].dimension", "0 to 3"}));
  BOOST_TEST(names_all(refusal("group = 1.5"), {"mesh.pin[0].group", "1.5", "integers"}));
  BOOST_TEST(names_all(refusal("group = 3\nnodes = [0]"),
                       {"mesh.pin[0].nodes", "one of nodes, group, and a box"}));
  const std::string ungrouped = with(old_format, names, "");
  BOOST_TEST(names_all(refusal("group = 'plate'", ungrouped), {"plate", "3 of dimension 2"}));
}

BOOST_AUTO_TEST_CASE(malformed_groups_are_named) {
  BOOST_TEST(names_all(refusal("group = 4", with(old_format, "\"plate\"", "plate")),
                       {"a.msh:8: name of the group", "plate", "quotation marks"}));
  BOOST_TEST(names_all(refusal("group = 4", with(old_format, "2 3 \"plate\"", "7 3 \"plate\"")),
                       {"a.msh:8: dimension of the group", "7", "0 to 3"}));
  BOOST_TEST(names_all(refusal("group = 4", with(new_format, "1 3 1 0\n1 1", "1 3 2 0\n1 1")),
                       {"tag of the entity", "$EndEntities"}));
}

BOOST_AUTO_TEST_CASE(references_of_medit_are_groups) {
  const std::string medit =
      "MeshVersionFormatted 1\nDimension 2\nEdges\n1\n1 4 -7\n"
      "Vertices\n4\n0 0 0\n1 0 2\n1 1 2\n0 1 0\nTriangles\n2\n1 2 3 5\n1 3 4 0\nEnd\n";
  BOOST_TEST(pinned_by("group = -7", medit, "a.mesh") == "1001");
  BOOST_TEST(pinned_by("group = 2", medit, "a.mesh") == "0110");
  BOOST_TEST(pinned_by("group = 5", medit, "a.mesh") == "1110");
  // Zero marks nothing.
  BOOST_TEST(names_all(refusal_of([&] { pinned_by("group = 0", medit, "a.mesh"); }),
                       {"group", "0 is not allowed", "2 of dimension 0, -7 of dimension 1"}));
}

BOOST_AUTO_TEST_CASE(groups_follow_vertices_that_are_welded_or_left_out) {
  const std::string unused = with(with(old_format, "$Nodes\n4\n", "$Nodes\n6\n1 9 9 9\n"),
                                  "12 1 0 0\n", "12 1 0 0\n2 1 0 0\n");
  BOOST_TEST(pinned_by("group = 'left side'", unused) == "1001");
  // Node 2 lies in the place of 12, and takes its part in the right edge.
  const std::string doubled = with(unused, "2 4 2 12 13", "2 4 2 2 13");
  const Scene welded = scene_of("weld = 0\n[[mesh.pin]]\ngroup = 4\n", doubled);
  std::size_t pins = 0;
  for (const Node& node : welded.nodes) pins += node.pinned && node.position.x() == 1;
  BOOST_TEST(welded.nodes.size() == 4u);
  BOOST_TEST(pins == 2u);
}

BOOST_AUTO_TEST_SUITE_END()
