// Binary meshes, against the same in ASCII: Gmsh 2.2 and 4.1, PLY, STL.
#include <array>

#include <boost/test/unit_test.hpp>

#include "tests/scene/binary_text.hpp"
#include "tests/scene/edges.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(mesh_binary)

using namespace qddot;
using namespace qddot::mesh;
using std::endian;

namespace {

constexpr std::array orders = {endian::little, endian::big};

// The same vertices, edges, faces and groups.
void check_same(const Mesh& a, const Mesh& b) {
  BOOST_TEST((a.vertices == b.vertices));
  BOOST_TEST(edges_of(a) == edges_of(b));
  BOOST_TEST((a.faces == b.faces));
  BOOST_TEST(a.cells.size() == b.cells.size());
  BOOST_TEST_REQUIRE(a.groups.size() == b.groups.size());
  for (std::size_t g = 0; g < a.groups.size(); ++g) {
    BOOST_TEST(a.groups[g].name == b.groups[g].name);
    BOOST_TEST(a.groups[g].tag == b.groups[g].tag);
    BOOST_TEST((a.groups[g].vertices == b.groups[g].vertices));
  }
}

// Every beginning of the file is refused in one sentence with its name, but for `loaded` ones. So
// is the file with other bytes anywhere, unless it is read.
void check_spoiled(const std::string& content, const std::string& file, int loaded = 0) {
  for (std::size_t size = 0; size + 1 < content.size(); ++size) {
    const std::string said = refusal_of([&] { parse_mesh(content.substr(0, size), file); });
    if (said.empty())
      --loaded;
    else
      BOOST_TEST(names_all(said, {file + ":", "allowed"}), size << ": " << said);
  }
  BOOST_TEST(loaded == 0);
  for (std::size_t at = 0; at < content.size(); ++at) {
    for (const char byte : {'\0', '\x7f', '\xff'}) {
      std::string other = content;
      other[at] = byte;
      const std::string said = refusal_of([&] { parse_mesh(other, file); });
      BOOST_TEST((said.empty() || names_all(said, {file + ":", "allowed"})), said);
    }
  }
}

// A triangle in group 7, a quadrangle of order 2 in none, and a point.
const std::string names = "$PhysicalNames\n1\n2 7 \"a b\"\n$EndPhysicalNames\n";
const std::string old_ascii =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + names +
    "$Nodes\n5\n40 1 0 0\n7 0 0 0\n3 1 1 0\n8 0 1 0.5\n2 2 0.1 -1e-3\n$EndNodes\n"
    "$Elements\n4\n1 2 2 7 1 40 2 3\n2 2 2 7 1 7 40 8\n3 16 2 0 1 7 40 3 8 2 2 2 2\n"
    "4 15 0 7\n$EndElements\n";

std::string old_binary(endian order) {
  BinaryText out(order, "$MeshFormat\n2.2 1 8\n");
  out.put<std::int32_t>(1).text("\n$EndMeshFormat\n" + names + "$Nodes\n5\n");
  const auto node = [&](int tag, double x, double y, double z) {
    out.put<std::int32_t>(tag).put<double>(x, y, z);
  };
  node(40, 1, 0, 0), node(7, 0, 0, 0), node(3, 1, 1, 0), node(8, 0, 1, 0.5), node(2, 2, 0.1, -1e-3);
  out.text("\n$EndNodes\n$Elements\n4\n");
  out.put<std::int32_t>(2, 2, 2, 1, 7, 1, 40, 2, 3, 2, 7, 1, 7, 40, 8);
  out.put<std::int32_t>(16, 1, 2, 3, 0, 1, 7, 40, 3, 8, 2, 2, 2, 2);
  out.put<std::int32_t>(15, 1, 0, 4, 7);
  // The rest is left out in ASCII, too.
  return out.text("\n$EndElements\n$NodeData\n").put<double>(1, 2).text("\n$EndNodeData\n").str();
}

std::string new_binary(endian order) {
  BinaryText out(order, "$MeshFormat\n4.1 1 8\n");
  out.put<std::int32_t>(1).text("\n$EndMeshFormat\n" + names + "$Entities\n");
  out.put<std::uint64_t>(1, 0, 2, 0);
  out.put<std::int32_t>(1).put<double>(0, 0, 0).put<std::uint64_t>(0);
  out.put<std::int32_t>(1).put<double>(0, 0, 0, 2, 1, 1).put<std::uint64_t>(1);
  out.put<std::int32_t>(7).put<std::uint64_t>(2).put<std::int32_t>(5, -6);
  out.put<std::int32_t>(2).put<double>(0, 0, 0, 2, 1, 1).put<std::uint64_t>(0, 0);
  out.text("\n$EndEntities\n$Nodes\n").put<std::uint64_t>(2, 5, 2, 40);
  out.put<std::int32_t>(2, 1, 0).put<std::uint64_t>(3, 40, 7, 3);
  out.put<double>(1, 0, 0, 0, 0, 0, 1, 1, 0);
  out.put<std::int32_t>(2, 2, 1).put<std::uint64_t>(2, 8, 2);  // with parameters
  out.put<double>(0, 1, 0.5, 0.1, 0.2, 2, 0.1, -1e-3, 0.3, 0.4);
  out.text("\n$EndNodes\n$Elements\n").put<std::uint64_t>(3, 4, 1, 4);
  out.put<std::int32_t>(2, 1, 2).put<std::uint64_t>(2, 1, 40, 2, 3, 2, 7, 40, 8);
  out.put<std::int32_t>(2, 2, 16).put<std::uint64_t>(1, 3, 7, 40, 3, 8, 2, 2, 2, 2);
  out.put<std::int32_t>(0, 1, 15).put<std::uint64_t>(1, 4, 7);
  return out.text("\n$EndElements\n").str();
}

// A triangle and a quadrangle with an edge beside them, and properties that say nothing of places.
const std::string ply_elements =
    "comment by hand\nelement vertex 5\nproperty float x\nproperty uchar red\nproperty float y\n"
    "property double z\nelement face 2\nproperty list uchar int vertex_indices\n"
    "property short material\nelement edge 1\nproperty ushort vertex1\nproperty ushort vertex2\n"
    "end_header\n";
const std::string ply_ascii = "ply\nformat ascii 1.0\n" + ply_elements +
                              "0 255 0 0\n1 0 0 0\n1 0 1 0.1\n0 0 1 0\n-2 0 0.5 3\n"
                              "3 0 1 2 -1\n4 0 1 2 3 -1\n3 4\n";
std::string ply_binary(endian order) {
  BinaryText out(order, "ply\nformat binary_" +
                            std::string(order == endian::big ? "big" : "little") + "_endian 1.0\n" +
                            ply_elements);
  const auto vertex = [&](float x, int red, float y, double z) {
    out.put<float>(x).put<std::uint8_t>(red).put<float>(y).put<double>(z);
  };
  vertex(0, 255, 0, 0), vertex(1, 0, 0, 0), vertex(1, 0, 1, 0.1), vertex(0, 0, 1, 0);
  vertex(-2, 0, 0.5, 3);
  out.put<std::uint8_t>(3).put<std::int32_t>(0, 1, 2).put<std::int16_t>(-1);
  out.put<std::uint8_t>(4).put<std::int32_t>(0, 1, 2, 3).put<std::int16_t>(-1);
  return out.put<std::uint16_t>(3, 4).str();
}

const std::string stl_ascii =
    "solid two triangles # 1\n"
    "  facet normal 0 0 1\n    outer loop\n      vertex 0 0 0\n      vertex 1 0 0\n"
    "      vertex 1 1 0.5\n    endloop\n  endfacet\n"
    "  facet normal nan nan nan\n    outer loop\n      vertex -0 0 0\n      vertex 1 1 0.5\n"
    "      vertex 0 1 0\n    endloop\n  endfacet\n"
    "endsolid two triangles # 1\n";
std::string stl_binary(const std::string& title) {
  BinaryText out(endian::little, title + std::string(80 - title.size(), ' '));
  out.put<std::uint32_t>(2);
  out.put<float>(0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 1, 0.5).put<std::uint16_t>(0);
  out.put<float>(NAN, NAN, NAN, -0.0, 0, 0, 1, 1, 0.5, 0, 1, 0).put<std::uint16_t>(7);
  return out.str();
}

}  // namespace

BOOST_AUTO_TEST_CASE(binary_gmsh_files_are_the_ascii_ones) {
  const Mesh ascii = parse_mesh(old_ascii, "a.msh");
  BOOST_TEST_REQUIRE(ascii.groups.size() == 1u);
  BOOST_TEST((ascii.groups[0].vertices == std::vector<std::size_t>{0, 1, 2, 3, 4}));
  for (const endian order : orders) {
    check_same(parse_mesh(old_binary(order), "a.msh"), ascii);
    check_same(parse_mesh(new_binary(order), "a.msh"), ascii);
  }
}

BOOST_AUTO_TEST_CASE(spoiled_binary_gmsh_files_are_refused_at_their_byte) {
  for (const endian order : orders) {
    // Files that end behind their nodes or elements, before or after the line end there.
    check_spoiled(old_binary(order), "a.msh", 4);
    check_spoiled(new_binary(order), "a.msh", 2);
  }
  const auto refusal = [](const std::string& content) {
    return refusal_of([&] { parse_mesh(content, "a.msh"); });
  };
  const std::string good = new_binary(endian::little);
  // The node tag 40 of the first triangle becomes 41.
  const std::string triangle = BinaryText(endian::little).put<std::uint64_t>(1, 40, 2, 3).str();
  const std::size_t at = good.find(triangle) + 16;
  std::string wrong = good;
  wrong[at - 8] = 41;
  BOOST_TEST(names_all(refusal(wrong), {"a.msh: before byte " + std::to_string(at) + ": triangle",
                                        "41 is not allowed", "tags of nodes"}));
  BOOST_TEST(names_all(refusal(good.substr(0, at - 3)),
                       {"before byte " + std::to_string(at - 8), "triangle", "ends too early",
                        "allowed are 3 bytes more"}));
  BOOST_TEST(
      names_all(refusal(with(good, "4.1 1 8", "4.1 1 4")), {"a.msh:2", "data size", "4", "8"}));
  BOOST_TEST(names_all(refusal(with(good, "4.1 1 8", "4.1 2 8")), {"file type", "2", "binary"}));
}

BOOST_AUTO_TEST_CASE(ply_files_are_read_in_all_their_forms) {
  const Mesh ascii = parse_mesh(ply_ascii, "a.ply");
  BOOST_TEST(edges_of(ascii) == "01 02 03 12 23 34");
  BOOST_TEST((ascii.vertices[2] == Eigen::Vector3d(1, 1, 0.1)));
  BOOST_TEST(ascii.triangles.size() == 1u);
  BOOST_TEST(ascii.cells.size() == 3u);
  for (const endian order : orders) check_same(parse_mesh(ply_binary(order), "a.ply"), ascii);
  // Faces may come first, as vertices of which the header says how many.
  const Mesh early = parse_mesh(
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uint8 uint32 vertex_index\n"
      "element vertex 3\nproperty float64 x\nproperty float64 y\nproperty float64 z\n"
      "element strip 1\nproperty list int int at\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n2 5 "
      "5\n",
      "a.ply");
  BOOST_TEST(edges_of(early) == "01 02 12");
  BOOST_TEST((early.warnings == std::vector<std::string>{"the section strip is left out"}));
}

BOOST_AUTO_TEST_CASE(malformed_ply_files_are_named) {
  for (const endian order : orders) check_spoiled(ply_binary(order), "a.ply");
  const auto refusal = [](const std::string& old_part, const std::string& new_part) {
    return refusal_of([&] { parse_mesh(with(ply_ascii, old_part, new_part), "a.ply"); });
  };
  BOOST_TEST(names_all(refusal("ply\n", "plx\n"), {"a.ply:1: first word", "plx", "is ply"}));
  BOOST_TEST(names_all(refusal("ascii", "text"), {"a.ply:2: format", "text", "binary_big_endian"}));
  BOOST_TEST(names_all(refusal("1.0", "2.0"), {"a.ply:2: version", "2.0", "is 1.0"}));
  BOOST_TEST(names_all(refusal("property float y", "property float up"),
                       {"a.ply", "vertex", "lists with y"}));
  BOOST_TEST(names_all(refusal("uchar red", "byte red"), {"a.ply:6: type", "byte", "uchar"}));
  BOOST_TEST(names_all(refusal("vertex 5", "vertex five"), {"a.ply:4", "five", "whole numbers"}));
  BOOST_TEST(names_all(refusal("3 0 1 2 -1", "3 0 1 5 -1"), {"a.ply:21: face", "5", "below 5"}));
  BOOST_TEST(
      names_all(refusal("3 0 1 2 -1", "2 0 1 -1"), {"a.ply:21: face", "2 corners", "three"}));
  BOOST_TEST(names_all(refusal("3 4\n", "3\n"), {"a.ply:24", "edge", "ends too early"}));
}

BOOST_AUTO_TEST_CASE(stl_files_become_one_surface) {
  const Mesh ascii = parse_mesh(stl_ascii, "a.stl");
  BOOST_TEST(ascii.vertices.size() == 4u);
  BOOST_TEST(edges_of(ascii) == "01 02 03 12 23");
  BOOST_TEST(opposite_vertices(ascii).size() == 1u);
  check_same(parse_mesh(stl_binary("made by hand"), "a.stl"), ascii);
  // Some binary files begin as those in ASCII do.
  check_same(parse_mesh(stl_binary("solid"), "a.stl"), ascii);
}

BOOST_AUTO_TEST_CASE(malformed_stl_files_are_named) {
  check_spoiled(stl_binary("made by hand"), "a.stl");
  const auto refusal = [](const std::string& content) {
    return refusal_of([&] { parse_mesh(content, "a.stl"); });
  };
  const std::string binary = stl_binary("made by hand");
  BOOST_TEST(
      names_all(refusal(binary.substr(0, 100)),
                {"a.stl: before byte 84: number of triangles", "2 is not allowed", "16 bytes"}));
  BOOST_TEST(names_all(refusal(binary + "x"), {"number of triangles", "101 bytes"}));
  BOOST_TEST(
      names_all(refusal(with(stl_ascii, "outer", "inner")), {"a.stl:3: word", "inner", "outer"}));
  BOOST_TEST(names_all(refusal(with(stl_ascii, "vertex 1 0 0", "vertex 1 0")),
                       {"a.stl:6: vertex", "vertex is not allowed", "finite"}));
  BOOST_TEST(names_all(refusal(stl_ascii.substr(0, stl_ascii.find("endloop"))),
                       {"a.stl", "ends too early"}));
}

BOOST_AUTO_TEST_SUITE_END()
