#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string_view>

#include "qddot/scene/mesh/mesh.hpp"

namespace qddot::mesh {

// A kind of element, as MEDIT and Gmsh call it, its edges by the places of their two corners, and
// the sides of a solid, all seen from outside or all from inside. Both number the corners alike.
struct Element {
  std::string_view name;
  std::string_view medit_section;  // empty: not read from MEDIT files
  int gmsh_type;
  int dimension;
  std::size_t corners;
  std::string_view edges;
  std::string_view sides{};
};
// All kinds of elements that are read.
inline constexpr std::array<Element, 8> elements{{
    {"line", "Edges", 1, 1, 2, "01"},
    {"triangle", "Triangles", 2, 2, 3, "01 12 20"},
    {"quadrangle", "Quadrilaterals", 3, 2, 4, "01 12 23 30"},
    {"tetrahedron", "Tetrahedra", 4, 3, 4, "01 02 03 12 13 23", "021 013 032 123"},
    {"hexahedron", "Hexahedra", 5, 3, 8, "01 12 23 30 45 56 67 74 04 15 26 37",
     "0321 4567 0154 1265 2376 3047"},
    {"prism", "Prisms", 6, 3, 6, "01 12 20 34 45 53 03 14 25", "021 345 0143 1254 2035"},
    {"pyramid", "Pyramids", 7, 3, 5, "01 12 23 30 04 14 24 34", "0321 014 124 234 304"},
    {"point", "", 15, 0, 1, ""},
}};
// A kind of element of order 2 or 3. Its first nodes are the corners of the element of that name,
// and the others lie between them.
struct CurvedElement {
  std::string_view name;
  std::string_view medit_section;  // empty: not read from MEDIT files
  int gmsh_type;
  std::size_t nodes;
};
inline constexpr std::array<CurvedElement, 20> curved_elements{{
    {"line", "EdgesP2", 8, 3},
    {"triangle", "TrianglesP2", 9, 6},
    {"quadrangle", "QuadrilateralsQ2", 10, 9},
    {"tetrahedron", "TetrahedraP2", 11, 10},
    {"hexahedron", "HexahedraQ2", 12, 27},
    {"prism", "PrismsP2", 13, 18},
    {"pyramid", "PyramidsP2", 14, 14},
    {"quadrangle", "", 16, 8},
    {"hexahedron", "", 17, 20},
    {"prism", "", 18, 15},
    {"pyramid", "", 19, 13},
    {"line", "EdgesP3", 26, 4},
    {"triangle", "", 20, 9},
    {"triangle", "TrianglesP3", 21, 10},
    {"tetrahedron", "TetrahedraP3", 29, 20},
    {"quadrangle", "QuadrilateralsQ3", 36, 16},
    {"quadrangle", "", 39, 12},
    {"prism", "PrismsP3", 90, 40},
    {"hexahedron", "HexahedraQ3", 92, 64},
    {"pyramid", "PyramidsP3", 118, 30},
}};
// The most corners that an element has.
inline constexpr std::size_t most_corners = 8;

// An element as a file lists it: its corners come first of its nodes.
struct ListedElement {
  const Element* element = nullptr;
  std::size_t nodes = 0;
  int gmsh_type = 0;
};
// The kind that has `key` as its MEDIT section or its Gmsh type; without an element if none has.
template <class Key>
ListedElement listed_element(const Key& key, Key Element::*of_element,
                             Key CurvedElement::*of_curved) {
  if (const auto found = std::ranges::find(elements, key, of_element); found != elements.end())
    return {&*found, found->corners, found->gmsh_type};
  const auto curved = std::ranges::find(curved_elements, key, of_curved);
  if (curved == curved_elements.end()) return {};
  return {&*std::ranges::find(elements, curved->name, &Element::name), curved->nodes,
          curved->gmsh_type};
}

// Appends the triangles between the first corner of a polygon and each edge opposite to it.
inline void add_polygon(std::span<const std::size_t> corners, Mesh& mesh) {
  for (std::size_t k = 2; k < corners.size(); ++k)
    mesh.faces.push_back({corners[0], corners[k - 1], corners[k]});
}

// Appends a face with these corners.
inline void add_face(std::span<const std::size_t> corners, Mesh& mesh) {
  for (std::size_t k = 1; k < corners.size(); ++k)
    mesh.edges.push_back({corners[k - 1], corners[k]});
  mesh.edges.push_back({corners.back(), corners.front()});
  mesh.cells.add(2, corners);
  add_polygon(corners, mesh);
  if (corners.size() == 3) mesh.triangles.push_back({corners[0], corners[1], corners[2]});
}

// Appends an element with these vertices: its edges, its faces if it is a polygon, and the triangle
// or the tetrahedron if it is one.
inline void add_element(const Element& element, std::span<const std::size_t> corners, Mesh& mesh) {
  const auto corner_at = [&](std::size_t k) {
    return corners[std::size_t(element.edges[k] - '0')];
  };
  for (std::size_t k = 0; k < element.edges.size(); k += 3)
    mesh.edges.push_back({corner_at(k), corner_at(k + 1)});
  if (element.dimension > 0) mesh.cells.add(element.dimension, corners.first(element.corners));
  if (element.corners == 3) mesh.triangles.push_back({corners[0], corners[1], corners[2]});
  if (element.dimension == 2) add_polygon(corners.first(element.corners), mesh);
  if (element.name == "tetrahedron")
    mesh.tetrahedra.push_back({corners[0], corners[1], corners[2], corners[3]});
}

}  // namespace qddot::mesh
