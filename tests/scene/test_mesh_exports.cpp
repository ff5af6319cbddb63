// Meshes as programs export them: marks, continued lines, other numbers, elements of higher order.
#include <numeric>
#include <random>

#include <boost/test/unit_test.hpp>

#include "qddot/scene/mesh/mesh_elements.hpp"
#include "qddot/scene/mesh/weld.hpp"
#include "tests/scene/edges.hpp"
#include "tests/scene/refusal.hpp"

BOOST_AUTO_TEST_SUITE(mesh_exports)

using namespace qddot;
using namespace qddot::mesh;

namespace {

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
const std::string square_edges = "01 03 12 23";

Mesh obj(const std::string& text) { return parse_mesh(text, "a.obj"); }

// Nodes 1, 2, ... of different places, and one element on all of them, as each format lists it.
std::string as_medit(const CurvedElement& element) {
  std::string text =
      fmt::format("MeshVersionFormatted 2\nDimension 3\nVertices\n{}\n", element.nodes);
  for (std::size_t i = 0; i < element.nodes; ++i) text += fmt::format("{} {} 0 0\n", i, i * i);
  text += fmt::format("{}\n1\n", element.medit_section);
  for (std::size_t i = 1; i <= element.nodes; ++i) text += fmt::format("{} ", i);
  return text + "0\nEnd\n";
}
std::string as_gmsh(const CurvedElement& element, const std::string& version) {
  std::string text =
      fmt::format("$MeshFormat\n{} 0 8\n$EndMeshFormat\n$Nodes\n{}\n", version, element.nodes);
  for (std::size_t i = 0; i < element.nodes; ++i)
    text += fmt::format("{} {} {} 0\n", i + 1, i, i * i);
  text += fmt::format("$EndNodes\n$Elements\n1\n1 {} 2 0 0", element.gmsh_type);
  for (std::size_t i = 1; i <= element.nodes; ++i) text += fmt::format(" {}", i);
  return text + "\n$EndElements\n";
}
std::string as_new_gmsh(const CurvedElement& element, int dimension) {
  std::string text =
      fmt::format("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {0} 1 {0}\n{1} 1 0 {0}\n",
                  element.nodes, dimension);
  for (std::size_t i = 1; i <= element.nodes; ++i) text += fmt::format("{}\n", i);
  for (std::size_t i = 0; i < element.nodes; ++i) text += fmt::format("{} {} 0\n", i, i * i);
  text += fmt::format("$EndNodes\n$Elements\n1 1 1 1\n{} 1 {} 1\n1", dimension, element.gmsh_type);
  for (std::size_t i = 1; i <= element.nodes; ++i) text += fmt::format(" {}", i);
  return text + "\n$EndElements\n";
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_byte_order_mark_is_no_word) {
  const std::string mark = "\xEF\xBB\xBF";
  const Mesh plain = obj(square + "f 1 2 3 4\n"), marked = obj(mark + square + "f 1 2 3 4\n");
  BOOST_TEST((marked.vertices == plain.vertices));
  BOOST_TEST(edges_of(marked) == square_edges);
  const std::string medit = "MeshVersionFormatted 1 Dimension 2 Vertices 1 0.5 2 0";
  BOOST_TEST(parse_mesh(mark + medit, "a.mesh").vertices.size() == 1);
  // Within a file it is none either: the line would be lost.
  BOOST_TEST(
      names_all(refusal_of([&] { obj(square + mark + "v 1 1 1\n"); }), {"a.obj:5:", "line"}));
}

BOOST_AUTO_TEST_CASE(backslashes_continue_lines) {
  for (const std::string face :
       {"f 1 2 \\\n3 4\n", "f 1 2\\\r\n 3 4\r\n", "f \\\n1 \\\n2 \\\n3 \\\n4", "f 1 2 3\\\r4\r",
        "g name\\\nof a group\nf 1 2 3 4 # a comment \\\n"}) {
    BOOST_TEST(edges_of(obj(square + face)) == square_edges, face);
  }
  BOOST_TEST((obj("v 1 \\\n2 \\\n3\n").vertices[0] == Eigen::Vector3d(1, 2, 3)));
  // Lines are counted as an editor counts them.
  BOOST_TEST(names_all(refusal_of([&] { obj("v 1 \\\n2 3\n\nv 1 x 3\n"); }), {"a.obj:4:", "x"}));
}

BOOST_AUTO_TEST_CASE(endings_may_be_in_capitals) {
  for (const char* name : {"a.OBJ", "a.Obj"})
    BOOST_TEST(edges_of(parse_mesh(square + "f 1 2 3 4\n", name)) == square_edges);
  BOOST_TEST(parse_mesh("MeshVersionFormatted 1 Vertices 1 0 0 0 0", "A.MESH").vertices.size() ==
             1);
}

BOOST_AUTO_TEST_CASE(lines_that_are_not_read_are_known_or_counted) {
  const std::string known =
      "mtllib a.mtl\no box\ng a b\ns off\nmg 1 0.5\nusemtl red\nvt 0 0\nvn 0 0 1\nvp 0 1\np 1\n"
      "lod 3\nbevel on\nshadow_obj a.obj\n";
  BOOST_TEST(obj(known + square + "f 1 2 3 4\n").warnings.empty());
  const Mesh mesh = obj(square + "fo 1 2 3 4\ncstype bezier\ncurv 0 1 1 2\n\nend\nf 1 2 3 4\n");
  BOOST_TEST(edges_of(mesh) == square_edges);
  BOOST_TEST_REQUIRE(mesh.warnings.size() == 1);
  BOOST_TEST(contains(mesh.warnings[0], {"3 lines", "line 6", "cstype"}), mesh.warnings[0]);
  BOOST_TEST(contains(obj(square + "f 1 2 3 4\nsurf 0 1\n").warnings.at(0), {"1 line is"}));
  for (const std::string line : {"1 2 3", "v1.0 2 3", "v 1 2 3 red", "<html>"}) {
    const std::string message = refusal_of([&] { obj(square + line + "\n"); });
    BOOST_TEST(names_all(message, {"a.obj:5:", "allowed"}), line + ": " + message);
  }
}

BOOST_AUTO_TEST_CASE(exponents_may_be_those_of_fortran) {
  const auto first = [](const std::string& numbers) {
    return obj("v " + numbers + "\n").vertices[0];
  };
  BOOST_TEST((first("1.D+00 1.0d0 -2.5D-3") == Eigen::Vector3d(1, 1, -2.5e-3)));
  BOOST_TEST((first("+.5D1 1d2 0.D+00") == Eigen::Vector3d(5, 100, 0)));
  for (const std::string number : {"d", "1d", "1dd0", "1d0d0", "1e0d0", "1.0D999", "0x1d"}) {
    BOOST_TEST(names_all(refusal_of([&] { obj("v 0 0 " + number + "\n"); }), {"finite numbers"}),
               number);
  }
}

BOOST_AUTO_TEST_CASE(elements_of_higher_order_have_the_edges_of_their_corners) {
  int read = 0;
  for (const CurvedElement& element : curved_elements) {
    const Element& straight = *std::ranges::find(elements, element.name, &Element::name);
    const std::string kind = fmt::format("{} of {} nodes", element.name, element.nodes);
    std::vector<Mesh> meshes;
    if (!element.medit_section.empty()) meshes.push_back(parse_mesh(as_medit(element), "a.mesh"));
    for (const char* version : {"2", "2.0", "2.1", "2.2"})
      meshes.push_back(parse_mesh(as_gmsh(element, version), "a.msh"));
    meshes.push_back(parse_mesh(as_new_gmsh(element, straight.dimension), "a.msh"));
    for (const Mesh& mesh : meshes) {
      ++read;
      BOOST_TEST(mesh.vertices.size() == element.nodes, kind);
      BOOST_TEST(mesh.edges.size() == (straight.edges.size() + 1) / 3, kind);
      for (const auto& [i, j] : mesh.edges) BOOST_TEST(std::max(i, j) < straight.corners, kind);
      BOOST_TEST(mesh.triangles.size() == (straight.name == "triangle" ? 1 : 0), kind);
      BOOST_TEST(mesh.tetrahedra.size() == (straight.name == "tetrahedron" ? 1 : 0), kind);
    }
  }
  BOOST_TEST(read == 20 * 5 + 14);
}

BOOST_AUTO_TEST_CASE(sections_that_are_not_read_are_known_or_told) {
  const std::string begin = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n",
                    rest = "$Elements\n1\n1 2 2 1 1 1 2 3\n$EndElements\n";
  const std::string nodes = "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 1 1 0\n$EndNodes\n",
                    parametric =
                        "$ParametricNodes\n3\n1 0 0 0 0 1\n2 1 0 0 1 1 0.5\n3 1 1 0 2 1 0.5 0.5\n"
                        "$EndParametricNodes\n";
  for (const std::string& list : {nodes, parametric}) {
    const Mesh mesh = parse_mesh(begin + list + rest, "a.msh");
    BOOST_TEST(edges_of(mesh) == "01 02 12");
    BOOST_TEST((mesh.vertices[2] == Eigen::Vector3d(1, 1, 0)));
    BOOST_TEST(mesh.warnings.empty());
  }
  const Mesh periodic = parse_mesh(begin + nodes + "$Periodic\n0\n$EndPeriodic\n" + rest +
                                       "$Marks\n$EndMarks\n$Marks\n$EndMarks\n",
                                   "a.msh");
  BOOST_TEST_REQUIRE(periodic.warnings.size() == 2);
  BOOST_TEST(contains(periodic.warnings[0], {"$Periodic", "stay apart"}));
  BOOST_TEST(contains(periodic.warnings[1], {"$Marks", "left out"}));
  const Mesh medit = parse_mesh(
      "MeshVersionFormatted 1\nIdentifier \"a Mesh of Mine\"\nVertices 1 0 0 0 0\n"
      "RequiredVertices 1 1\nVertexOnGeometricVertex 1 1 1\nMarks 2 1.D0 2\nEnd\n",
      "a.mesh");
  BOOST_TEST_REQUIRE(medit.warnings.size() == 1);
  BOOST_TEST(contains(medit.warnings[0], {"Marks", "left out"}), medit.warnings[0]);
}

BOOST_AUTO_TEST_CASE(vertices_are_welded_within_a_distance) {
  // A square of two triangles that share no vertex; two of them are 1e-3 apart.
  const std::string cut =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1 1 1e-3\nv 0 1 0\nf 1 2 3\nf 4 5 6\n";
  const auto edges = [&](double within) { return edges_of(parse_mesh(cut, "a.obj", within)); };
  BOOST_TEST(edges(-1) == "01 02 12 34 35 45");
  BOOST_TEST(edges(0) == "01 02 03 04 12 34");
  BOOST_TEST(edges(0.9e-3) == edges(0));
  BOOST_TEST(edges(1.1e-3) == "01 02 03 12 23");
  const Mesh mesh = parse_mesh(cut, "a.obj", 1.1e-3);
  BOOST_TEST(mesh.vertices.size() == 4);
  BOOST_TEST((mesh.vertices[3] == Eigen::Vector3d(0, 1, 0)));
  BOOST_TEST(opposite_vertices(mesh).size() == 1);
}

BOOST_AUTO_TEST_CASE(welding_joins_what_is_near_and_nothing_else) {
  // Against all pairs, on random points of a grid that are off by up to a tenth of its width.
  std::mt19937 random(3);
  std::uniform_int_distribution<int> place(0, 4);
  std::uniform_real_distribution<double> off(-0.05, 0.05);
  for (int draw = 0; draw < 50; ++draw) {
    std::vector<Eigen::Vector3d> x;
    for (int i = 0; i < 120; ++i)
      x.emplace_back(place(random) + off(random), place(random) + off(random), place(random));
    for (const double within : {0.0, 0.05, 0.15}) {
      std::vector<std::size_t> expected(x.size());
      std::iota(expected.begin(), expected.end(), 0);
      for (bool changes = true; changes;) {
        changes = false;
        for (std::size_t i = 0; i < x.size(); ++i) {
          for (std::size_t j = 0; j < x.size(); ++j) {
            if ((x[i] - x[j]).norm() > within || expected[j] <= expected[i]) continue;
            expected[j] = expected[i];
            changes = true;
          }
        }
      }
      BOOST_TEST((welded(x, within) == expected), "draw " << draw << ", within " << within);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
