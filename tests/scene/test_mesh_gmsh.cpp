#include <regex>
#include <tuple>

#include <boost/test/unit_test.hpp>

#include "tests/scene/edges.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(mesh_gmsh)

using namespace qddot;
using namespace qddot::mesh;

namespace {

Mesh gmsh(const std::string& text) { return parse_mesh(text, "a.msh"); }
std::string refusal(const std::string& text) {
  return refusal_of([&] { gmsh(text); });
}

// A triangle beside a quadrangle, with nodes numbered with gaps and in no order. The file has
// sections that are ignored, and an element of each kind of part without edges and of boundary
// parts.
const std::string old_format =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n1\n2 7 \"a $Nodes # b\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n40 1 0 0\n7 0 0 0\n1000000000000 1 1 0\n8 0 1 0.5\n2 2 0.1 -1e-3\n$EndNodes\n"
    "$Elements\n4\n"
    "1 15 2 0 1 7\n"
    "2 1 0 7 8\n"
    "9 3 2 7 1 7 40 1000000000000 8\n"
    "4 2 3 -7 1 0 40 2 1000000000000\n"
    "$EndElements\n"
    "$NodeData\n1\n\"u\"\n$EndNodeData\n";

// The same in blocks, the last three nodes with parameters on their surface or curve.
const std::string new_format =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 1 7 0\n$EndEntities\n"
    "$Nodes\n3 5 2 1000000000000\n"
    "0 1 0 2\n40\n7\n1 0 0\n0 0 0\n"
    "2 1 1 2\n1000000000000\n8\n1 1 0 0.25 0.75\n0 1 0.5 0.5 0.5\n"
    "1 3 1 1\n2\n2 0.1 -1e-3 0.125\n"
    "$EndNodes\n"
    "$Elements\n4 4 1 9\n"
    "0 1 15 1\n1 7\n"
    "1 3 1 1\n2 7 8\n"
    "2 1 3 1\n9 7 40 1000000000000 8\n"
    "2 1 2 1\n4 40 2 1000000000000\n"
    "$EndElements\n";

// One element of a type on nodes 1, 2, ... at (1, 0, 0), (2, 0, 0), ...
std::string one_element(int type, int corners) {
  std::string text = fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", corners);
  for (int i = 1; i <= corners; ++i) text += fmt::format("{0} {0} 0 0\n", i);
  text += fmt::format("$EndNodes\n$Elements\n1\n1 {} 0", type);
  for (int i = 1; i <= corners; ++i) text += fmt::format(" {}", i);
  return text + "\n$EndElements\n";
}

}  // namespace

BOOST_AUTO_TEST_CASE(both_versions_give_the_same_mesh_with_line_ends_of_every_system) {
  std::vector<std::string> texts;
  for (const char* line_end : {"\n", "\r", "\r\n"}) {
    for (const std::string& text : {old_format, new_format})
      texts.push_back(std::regex_replace(text, std::regex("\n"), line_end));
  }
  for (const std::string& text : texts) {
    const Mesh mesh = gmsh(text);
    BOOST_TEST_REQUIRE(mesh.vertices.size() == 5u);
    BOOST_TEST((mesh.vertices[0] == Eigen::Vector3d(1, 0, 0)));
    BOOST_TEST((mesh.vertices[3] == Eigen::Vector3d(0, 1, 0.5)));
    BOOST_TEST((mesh.vertices[4] == Eigen::Vector3d(2, 0.1, -1e-3)));
    // The line from 7 to 8 is a side of the quadrangle.
    BOOST_TEST(edges_of(mesh) == "01 02 04 13 23 24");
    BOOST_TEST((mesh.triangles == std::vector<std::array<std::size_t, 3>>{{0, 4, 2}}));
  }
}

BOOST_AUTO_TEST_CASE(every_element_has_the_edges_of_its_kind) {
  for (const auto& [type, corners, edges] : {std::tuple(15, 1, ""),
                                             {1, 2, "01"},
                                             {2, 3, "01 02 12"},
                                             {3, 4, "01 03 12 23"},
                                             {4, 4, "01 02 03 12 13 23"},
                                             {5, 8, "01 03 04 12 15 23 26 37 45 47 56 67"},
                                             {6, 6, "01 02 03 12 14 25 34 35 45"},
                                             {7, 5, "01 03 04 12 14 23 24 34"}}) {
    const Mesh mesh = gmsh(one_element(type, corners));
    BOOST_TEST(edges_of(mesh) == edges, "type " << type);
    BOOST_TEST(mesh.triangles.size() == (type == 2 ? 1u : 0u));
  }
}

BOOST_AUTO_TEST_CASE(other_elements_are_refused) {
  for (const int type : {0, -1, 22, 30, 34, 99, 140}) {
    const std::string message = refusal(one_element(type, 3));
    BOOST_TEST(names_all(message, {"a.msh:12:", "element type", std::to_string(type),
                                   "2 (triangle)", "15 (point)", "7 (pyramid)", "allowed"}),
               message);
  }
}

BOOST_AUTO_TEST_CASE(sections_may_be_repeated) {
  const std::string more =
      "$Nodes\n1\n3 9 9 9\n$EndNodes\n$Elements\n1\n10 1 0 3 40\n$EndElements\n";
  const Mesh mesh = gmsh(old_format + more);
  BOOST_TEST(mesh.vertices.size() == 6u);
  BOOST_TEST((mesh.edges[3] == std::array<std::size_t, 2>{0, 5}));
}

BOOST_AUTO_TEST_CASE(malformed_files_are_named) {
  struct Spoiled {
    const std::string &good, old_part, new_part;
    std::vector<std::string> fragments;
  };
  const std::vector<Spoiled> cases = {
      {old_format, "2.2 0 8", "1 0 8", {":2:", "version", "1", "2, 2.1, 2.2 and 4.1"}},
      {old_format, "2.2 0 8", "4 0 8", {":2:", "version", "4", "2.2 and 4.1"}},
      {old_format, "2.2 0 8", "2.2 2 8", {":2:", "file type", "2", "0", "ASCII", "binary"}},
      {old_format, "2.2 0 8", "2.2 1 8", {"before byte 24", "the number one", "is 1"}},
      {new_format, "4.1 0 8", "4.1 1 8", {"before byte 24", "the number one", "is 1"}},
      {old_format, "$MeshFormat", "$Nodes", {":1:", "$Nodes", "$MeshFormat"}},
      {old_format, "$EndMeshFormat", "1", {":3:", "$EndMeshFormat"}},
      {old_format, "$EndPhysicalNames", "$EndPhysical", {":7:", "$EndPhysicalNames"}},
      {old_format, "$EndNodes\n", "stray\n$EndNodes\n", {":15:", "stray", "$EndNodes"}},
      {old_format, "$Nodes\n5", "$Nodes\n4", {":14:", "section", "2", "$EndNodes"}},
      {old_format, "$Nodes\n5", "$Nodes\n6", {":15:", "node tag", "$EndNodes", "whole"}},
      {old_format, "$Nodes\n5", "$Nodes\n-5", {":9:", "number of nodes", "-5", "from 0"}},
      {old_format, "$Nodes\n5", "$Nodes\n5e9", {":9:", "number of nodes", "5e9", "from 0"}},
      {old_format, "8 0 1 0.5", "40 0 1 0.5", {":13:", "node tag", "40", "no other"}},
      {old_format, "8 0 1 0.5", "-8 0 1 0.5", {":13:", "node tag", "-8", "from 0"}},
      {old_format, "8 0 1 0.5", "8 0 nan 0.5", {":13:", "node", "nan", "finite"}},
      {old_format, "8 0 1 0.5", "8 0 1e999 0.5", {":13:", "node", "1e999", "finite"}},
      {old_format, "2 1 0 7 8", "2 1 0 7 9", {":19:", "line", "9", "tags of nodes"}},
      {old_format, "9 3 2 7 1 7 40", "9 3 1 7 1 7 40", {":20:", "quadrangle", "1", "tags"}},
      {old_format, "2 1 0 7 8", "2 1 0.5 7 8", {":19:", "number of tags", "0.5", "whole"}},
      {old_format, "2 1 0 7 8\n", "", {"element"}},
      {old_format, "$NodeData", "NodeData", {":23:", "NodeData", "start with $"}},
      {old_format, "$EndNodeData\n", "", {":23:", "$NodeData", "$EndNodeData"}},
      {new_format, "2 1 1 2\n", "2 1 2 2\n", {":15:", "parametric", "2", "0 to 1"}},
      {new_format, "2 1 1 2\n", "4 1 1 2\n", {":15:", "dimension", "4", "0 to 3"}},
      {new_format, "2 1 1 2\n", "2 1 0 2\n", {":19:", "tag of the entity", "0.5", "whole"}},
      {new_format, "0.25 0.75", "0.25 x", {":18:", "parameter", "x", "finite"}},
      {new_format, "8\n1 1 0", "7\n1 1 0", {":19:", "node tag", "7", "no other"}},
      {new_format, "3 5 2", "4 5 2", {"dimension", "$EndNodes"}},
      {new_format, "3 5 2", "2 5 2", {":20:", "section", "1", "$EndNodes"}},
      {new_format, "1 3 1 1\n2 7 8", "1 3 1 1\n2 7 9", {":29:", "line", "9", "tags"}},
      {new_format, "2 1 3 1\n", "2 1 30 1\n", {":30:", "element type", "30", "3 (quadrangle)"}},
      {new_format, "2 1 3 1\n", "2 1 3 1000000000\n", {"quadrangle"}},
      {new_format, "3 5 2", "3 6 2", {":9:", "number of nodes", "6", "5, as in the blocks"}},
      {new_format, "3 5 2", "3 5 1", {":9:", "least node tag", "1", "2, as in the blocks"}},
      {new_format, "2 1000000000000\n", "2 1000000000001\n", {":9:", "largest node tag"}},
      {new_format, "4 4 1 9", "4 3 1 9", {":25:", "number of elements", "3", "4, as in"}},
      {new_format, "4 4 1 9", "4 4 2 9", {":25:", "least element tag", "2", "1, as in"}},
      {new_format, "4 4 1 9", "4 4 1 8", {":25:", "largest element tag", "8", "9, as in"}},
      {new_format, "4 4 1 9", "3 4 1 9", {"section", "$EndElements"}},
      {new_format, "2 1 2 1\n", "3 1 2 1\n", {"element type", "2 (triangle)", "dimension, 3"}},
      {old_format, "$Elements\n4", "$Elements\n3", {":21:", "section", "4", "$EndElements"}},
      {old_format, "$Elements\n4", "$Elements\n5", {":22:", "element tag", "$EndElements"}},
      {old_format, "$EndNodes\n", "", {":15:", "section", "$Elements", "$EndNodes"}},
      {old_format, "$EndElements\n", "", {":22:", "section", "$NodeData", "$EndElements"}},
      {old_format, "$NodeData", "$MeshFormat", {":23:", "section", "first in the file"}}};
  for (const auto& [good, old_part, new_part, fragments] : cases) {
    const std::string message = refusal(with(good, old_part, new_part));
    BOOST_CHECK_MESSAGE(names_all(message, fragments) && names_all(message, {"a.msh:", "allowed"}),
                        new_part << " gives: " << message);
    BOOST_TEST(message.size() < 400u);
  }
  BOOST_TEST(names_all(refusal(""), {"a.msh:1:", "$MeshFormat"}));
  BOOST_TEST(names_all(refusal("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"), {"no vertices"}));
  // A file that is cut can be loaded behind its nodes, elements and data, before and after the line
  // end there.
  for (const auto& [good, sections] : {std::pair(old_format, 3), {new_format, 2}}) {
    int loaded = 0;
    for (std::size_t length = 0; length <= good.size(); ++length)
      loaded += refusal(good.substr(0, length)).empty();
    BOOST_TEST(loaded == 2 * sections);
  }
  // A vast count takes no memory.
  const std::string vast = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1000000000\n1 0 0 0\n";
  BOOST_TEST(names_all(refusal(vast), {"node tag", "ends too early"}));
}

BOOST_AUTO_TEST_SUITE_END()
