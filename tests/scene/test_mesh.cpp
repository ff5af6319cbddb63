#include <array>

#include <Eigen/Geometry>
#include <boost/test/unit_test.hpp>

#include "tests/folder.hpp"
#include "tests/scene/edges.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(mesh)

using namespace qddot;
using namespace qddot::mesh;
using namespace std::string_literals;

namespace {

using Triples = std::vector<std::array<std::size_t, 3>>;
using Pairs = std::vector<std::array<std::size_t, 2>>;

// The sentence by which parse_mesh refuses the text; empty if it accepts it.
std::string refusal(const std::string& name, const std::string& text) {
  return refusal_of([&] { parse_mesh(text, name); });
}

Mesh obj(const std::string& text) { return parse_mesh(text, "a.obj"); }
Mesh medit(const std::string& text) { return parse_mesh(text, "a.mesh"); }

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

// Two tetrahedra that share the triangle 1 2 3.
const std::string glued =
    "MeshVersionFormatted 2\n"
    "# a comment\n"
    "Dimension 3\n"
    "Vertices\n5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 -1.5e0 0\n"
    "Corners\n2\n1\n2\n"
    "Triangles 1\n1 2 3 7\n"
    "Tetrahedra\n2\n1 2 3 4 0\n1 3 2 5 0\n"
    "End\n";

}  // namespace

BOOST_AUTO_TEST_CASE(all_forms_of_a_face_give_the_same_edges) {
  for (const std::string face :
       {"f 1 2 3", "f 1/1 2/2 3/3", "f 1//1 2//2 3//3", "f 1/4/1 2/5/1 3/6/1", "f -4 -3 -2",
        "f -4/1/-1 -3//2 3", "f 3 1 2 # turned", "\tf  1 2\t3 \r", "f 1 2 3\nf 3 2 1", "l 1 2 3 1",
        "f 1 1 2 3"}) {
    const Mesh mesh = obj("vt 0 0\nvn 0 0 1\n" + square + face + "\n");
    BOOST_TEST(edges_of(mesh) == "01 02 12", face);
    BOOST_TEST(mesh.vertices.size() == 4);  // the fourth in no face
  }
}

BOOST_AUTO_TEST_CASE(edges_are_those_of_polygons_and_elements) {
  const std::string solid =
      "MeshVersionFormatted 1\nDimension 3\nVertices 8\n0 0 0 0\n1 0 0 0\n1 1 0 0\n0 1 0 0\n"
      "0 0 1 0\n1 0 1 0\n1 1 1 0\n0 1 1 0\n";
  for (const auto& [file, text, edges] : std::vector<std::array<std::string, 3>>{
           {"a.obj", square + "f 1 2 3 4", "01 03 12 23"},
           // Negative numbers count from the last vertex so far.
           {"a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf -1 -2 -3\n" + square + "f -1 -2 -3 -4\n",
            "01 02 12 34 36 45 56"},
           {"a.mesh", with(glued, "2\n1 2 3 4 0\n1 3 2 5 0", "1\n1 2 3 4 0"), "01 02 03 12 13 23"},
           {"a.mesh", glued, "01 02 03 04 12 13 14 23 24"},
           // Sections in any order.
           {"a.mesh",
            "MeshVersionFormatted 1 Quadrilaterals 1 1 2 3 4 0 Edges 1\n"
            "1 3 0 Dimension 2 Vertices 4 0 0 0 1 0 0 1 1 0 0 1 0",
            "01 02 03 12 23"},
           {"a.mesh", solid + "Hexahedra 1\n1 2 3 4 5 6 7 8 0\nEnd\n",
            "01 03 04 12 15 23 26 37 45 47 56 67"},
           {"a.mesh", solid + "Prisms 1 1 2 3 4 5 6 0 Pyramids 1 2 3 6 5 7 0 End",
            "01 02 03 12 14 16 25 26 34 35 45 46 56"}})
    BOOST_TEST(edges_of(parse_mesh(text, file)) == edges, text);
}

BOOST_AUTO_TEST_CASE(line_ends_of_every_system_give_the_same_mesh) {
  const std::string faces = square + "# a comment\nf 1 2 3\n\nf 1 3 4\n";
  for (const auto& [name, text] : {std::pair("a.obj"s, faces), std::pair("a.mesh"s, glued)}) {
    const Mesh plain = parse_mesh(text, name);
    BOOST_TEST(plain.edges.size() > 4);
    for (const char* line_end : {"\r", "\r\n"}) {
      std::string other;
      for (const char c : text) other += c == '\n' ? line_end : std::string(1, c);
      const Mesh mesh = parse_mesh(other, name);
      BOOST_TEST((mesh.vertices == plain.vertices));
      BOOST_TEST((mesh.edges == plain.edges));
      BOOST_TEST((mesh.triangles == plain.triangles));
    }
  }
  // Lines count alike.
  for (const std::string line_end : {"\n", "\r", "\r\n"}) {
    BOOST_TEST(names_all(refusal("a.obj", "v 0 0 0" + line_end + line_end + "v 1 x 0"),
                         {"a.obj:3:", "vertex", "x", "finite"}));
  }
}

BOOST_AUTO_TEST_CASE(vertices_are_read_exactly) {
  const Mesh mesh = obj("v 0.1 -2.5e-3 +3\nv 1 2 3 1.0\nv 1 2 3 .5 .5 .5");
  BOOST_TEST((mesh.vertices[0] == Eigen::Vector3d(0.1, -2.5e-3, 3)));
  BOOST_TEST((mesh.vertices[2] == Eigen::Vector3d(1, 2, 3)));
  BOOST_TEST((medit(glued).vertices[4] == Eigen::Vector3d(0, 0, -1.5)));
  const Mesh plane = medit("MeshVersionFormatted 1 Dimension 2 Vertices 1 0.5 2 0");
  BOOST_TEST((plane.vertices[0] == Eigen::Vector3d(0.5, 2, 0)));
}

BOOST_AUTO_TEST_CASE(faces_are_triangles_and_polygons_cut_up) {
  const Triples two = {{0, 1, 2}, {0, 2, 3}};
  BOOST_TEST((obj(square + "f 1 2 3 4\n").faces == two));
  BOOST_TEST((obj(square + "f 1 2 3\nf 1 3 4\n").faces == two));
  // The same corners again, in another order, are the same face; two corners are none.
  BOOST_TEST((obj(square + "f 1 2 3\nf 3 2 1\nf 1 3 4\nf 1 1 2\nl 1 2\n").faces == two));
  BOOST_TEST(obj(square + "l 1 2 3\n").faces.empty());
}

BOOST_AUTO_TEST_CASE(tetrahedra_have_their_boundary_for_faces) {
  // The first triangle is given; the other six are sides of one tetrahedron alone.
  const Mesh mesh = medit(glued);
  BOOST_REQUIRE(mesh.faces.size() == 7);
  BOOST_TEST((mesh.faces[0] == std::array<std::size_t, 3>{0, 1, 2}));
  for (std::size_t k = 1; k < mesh.faces.size(); ++k) {
    const auto [a, b, c] = mesh.faces[k];
    const Eigen::Vector3d& x = mesh.vertices[a];
    const Eigen::Vector3d normal = (mesh.vertices[b] - x).cross(mesh.vertices[c] - x);
    const Eigen::Vector3d inside(0.2, 0.2, 0);
    BOOST_TEST(normal.dot(x - inside) > 0);  // they face outwards
  }
}

BOOST_AUTO_TEST_CASE(bending_pairs_lie_opposite_to_shared_edges) {
  BOOST_TEST((opposite_vertices(obj(square + "f 1 2 3\nf 1 3 4")) == Pairs{{1, 3}}));
  // A boundary and an edge of three triangles bend nothing; a triangle given twice is one.
  BOOST_TEST(opposite_vertices(obj(square + "f 1 2 3\nf 3 2 1")).empty());
  BOOST_TEST(opposite_vertices(obj(square + "v 5 5 5\nf 1 2 3\nf 1 2 4\nf 1 2 5")).empty());
  BOOST_TEST(opposite_vertices(obj(square + "f 1 2 3 4")).empty());
  BOOST_TEST((opposite_vertices(obj(square + "f 1 2 3\nf 3 2 1\nf 1 3 4")) == Pairs{{1, 3}}));
}

BOOST_AUTO_TEST_CASE(malformed_files_are_named) {
  const std::string medit = "MeshVersionFormatted 1\nDimension 3\n";
  const std::vector<std::array<std::string, 2>> cases = {
      {"a.obj", ""},
      {"a.obj", "f 1 2 3\n"},
      {"a.obj", "v 1 2\n"},
      {"a.obj", "v 1 2 nan\n"},
      {"a.obj", "v 1 inf 3\n"},
      {"a.obj", "v 1 1e999 3\n"},
      {"a.obj", "v 1 2 3x\n"},
      {"a.obj", square + "f 1 2\n"},
      {"a.obj", square + "f 0 1 2\n"},
      {"a.obj", square + "f 1 2 -5\n"},
      {"a.obj", square + "f 1 2 99999999999999999999\n"},
      {"a.obj", square + "f 1 2 3/x\n"},
      {"a.obj", square + "f 1 2 1.5\n"},
      {"a.obj", square + "f /1 /2 /3\n"},
      {"a.obj", std::string(10'000'000, 'v')},
      {"a.obj", std::string("v ").append(10'000'000, '1')},
      {"a.obj", std::string("\0\x01\xff v\n\x80", 7)},
      {"a.mesh", ""},
      {"a.mesh", std::string(10'000'000, '1')},
      {"a.mesh", std::string("\0\x01\xff v\n\x80", 7)},
      {"a.mesh", "Vertices 1\n0 0 0 0\n"},
      {"a.mesh", medit},
      {"a.mesh", medit + "Vertices -1\n"},
      {"a.mesh", medit + "Vertices 999999999\n0 0 0 0\n"},
      {"a.mesh", medit + "Vertices 99999999999999999999\n"},
      {"a.mesh", medit + "Vertices 1\n0 nan 0 0\n"},
      {"a.mesh", medit + "Vertices 1\n0 0 0\nEnd\n"},
      {"a.mesh", "MeshVersionFormatted 1\nDimension 4\n"},
      {"a.mesh", with(glued, "1 3 2 5 0", "0 3 2 5 0")},
      {"a.mesh", with(glued, "1 3 2 5 0", "-1 3 2 5 0")},
      {"a.mesh", with(glued, "1 3 2 5 0\nEnd\n", "1 3")},
      {"a.msh", square},
      {"a.off", square},
      {"a", square}};
  for (const auto& [name, text] : cases) {
    const std::string message = refusal(name, text);
    BOOST_CHECK_MESSAGE(names_all(message, {name, "allowed"}) && message.size() < 400,
                        text.substr(0, 80) << " gives: " << message);
  }
  BOOST_TEST(names_all(refusal("a.obj", square + "f 1 2 5\n"),
                       {"a.obj:5:", "face", "5", "from 1 to 4", "-4"}));
}

BOOST_AUTO_TEST_CASE(medit_files_that_contradict_themselves_are_refused) {
  struct Spoiled {
    std::string old_part, new_part;
    std::vector<std::string> fragments;
  };
  for (const auto& [old_part, new_part, fragments] : std::vector<Spoiled>{
           {"Vertices\n5", "Vertices\n4", {":10:", "Vertices", "0", "count"}},
           {"Vertices\n5", "Vertices\n6", {":11:", "Vertices", "Corners", "finite"}},
           {"Triangles 1", "Triangles 0", {":16:", "Triangles", "1", "count"}},
           {"Triangles 1", "Triangles 2", {":17:", "Triangles", "Tetrahedra", "whole"}},
           {"Tetrahedra\n2", "Tetrahedra\n1", {":20:", "Tetrahedra", "1", "count"}},
           {"Tetrahedra\n2", "Tetrahedra\n3", {":21:", "Tetrahedra", "End", "whole"}},
           {"1 2 3 7", "1 2 3 4 7", {":16:", "Triangles", "7", "count"}},
           {"Dimension 3", "Dimension 2", {"Vertices", "count"}},
           {"Dimension 3", "Dimension 3 3", {":3:", "Dimension", "3", "count"}},
           {"Formatted 2", "Formatted two", {":1:", "MeshVersionFormatted", "two", "whole"}},
           {"Formatted 2", "Formatted", {":3:", "MeshVersionFormatted", "Dimension", "whole"}},
           {"1 3 2 5 0", "1 3 2 6 0", {":20:", "6", "1 to 5"}},
           {"0 0 1 0", "0 0 y 0", {":9:", "Vertices", "y", "finite"}},
           {"End\n", "Vertices 0\nEnd\n", {":21:", "Vertices", "once"}},
           {"End\n", "Triangles 1\n1 2 3 0\n", {":21:", "Triangles", "once"}},
           {"End\n", "Dimension 3\n", {":21:", "Dimension", "once"}}}) {
    const std::string message = refusal("a.mesh", with(glued, old_part, new_part));
    BOOST_CHECK_MESSAGE(names_all(message, fragments) && names_all(message, {"a.mesh:", "allowed"}),
                        new_part << " gives: " << message);
  }
  BOOST_TEST(names_all(refusal("a.mesh", "MeshVersionFormatted 1 Vertices 1 0 0 0 0 Dimension 2"),
                       {"Dimension", "before Vertices"}));
}

// A grid of n x n vertices in triangles has 3 n^2 - 4 n + 1 edges.
BOOST_AUTO_TEST_CASE(a_large_mesh) {
  const std::size_t n = 317;  // 100,489 vertices
  std::string text;
  for (std::size_t i = 0; i < n * n; ++i)
    text += fmt::format("v {} {} {}\n", 0.1 * double(i / n), 0.1 * double(i % n), 1.0 / 3);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    for (std::size_t j = 1; j < n; ++j) {
      const std::size_t a = i * n + j;
      text += fmt::format("f {0} {1} {2}\nf {0} {2} {3}\n", a, a + 1, a + n + 1, a + n);
    }
  }
  const Folder folder;
  const Mesh mesh = read_mesh(folder.write("large.obj", text));
  BOOST_TEST(mesh.vertices.size() == n * n);
  BOOST_TEST(mesh.edges.size() == 3 * n * n - 4 * n + 1);
  BOOST_TEST(opposite_vertices(mesh).size() == mesh.edges.size() - 4 * (n - 1));
}

BOOST_AUTO_TEST_SUITE_END()
