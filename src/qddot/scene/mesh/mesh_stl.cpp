// STL, ASCII or binary: triangles alone, each with its own corners. Equal corners become one
// vertex.
#include <bit>
#include <cmath>
#include <unordered_map>

#include <boost/functional/hash.hpp>
#include <fmt/format.h>

#include "qddot/scene/mesh/mesh_bytes.hpp"
#include "qddot/scene/mesh/mesh_elements.hpp"
#include "qddot/scene/mesh/mesh_formats.hpp"

namespace qddot::mesh {
namespace {

constexpr std::size_t stl_header_bytes = 80, stl_triangle_bytes = 50;

// Vertices by their coordinates.
class CornerVertices {
 public:
  std::size_t vertex_at(const Eigen::Vector3d& x, Mesh& mesh) {
    // Adding zero turns -0 into 0.
    const std::array<double, 3> key = {x[0] + 0.0, x[1] + 0.0, x[2] + 0.0};
    const auto [at, is_new] = vertex_of_.emplace(key, mesh.vertices.size());
    if (is_new) mesh.vertices.push_back(x);
    return at->second;
  }

 private:
  std::unordered_map<std::array<double, 3>, std::size_t, boost::hash<std::array<double, 3>>>
      vertex_of_;
};

Mesh read_ascii_stl(std::string_view text, const std::string& file) {
  Mesh mesh;
  CornerVertices corners;
  Words words(text, file);
  const auto is = [](std::string_view word, std::string_view lower) {
    return std::ranges::equal(word, lower, [](char a, char b) {
      return a == b || (a >= 'A' && a <= 'Z' && a + ('a' - 'A') == b);
    });
  };
  const auto expect = [&](std::string_view wanted, std::string_view word) {
    if (!is(word, wanted)) words.refuse("word", word, fmt::format("is {}", wanted));
  };
  const auto point = [&](std::string_view field) {
    Eigen::Vector3d x;
    for (double& coordinate : x) coordinate = words.number(field, words.next());
    return x;
  };
  for (auto word = words.next(); !word.empty(); word = words.next()) {
    expect("solid", word);
    words.rest_of_line();  // its name
    for (word = words.next(); !is(word, "endsolid"); word = words.next()) {
      expect("facet", word);
      expect("normal", words.next());
      // Some programs write normals of triangles without area as NaN.
      for (int c = 0; c < 3; ++c) words.next();
      expect("outer", words.next());
      expect("loop", words.next());
      std::array<std::size_t, 3> triangle;
      for (std::size_t& corner : triangle) {
        expect("vertex", words.next());
        corner = corners.vertex_at(point("vertex"), mesh);
      }
      expect("endloop", words.next());
      expect("endfacet", words.next());
      add_face(triangle, mesh);
    }
    words.rest_of_line();
  }
  return mesh;
}

Mesh read_binary_stl(std::string_view content, const std::string& file) {
  Mesh mesh;
  CornerVertices corners;
  Bytes bytes(content, file);
  bytes.at = std::min(stl_header_bytes, content.size());
  const auto count = bytes.take<std::uint32_t>("number of triangles");
  const std::size_t there = bytes.left() / stl_triangle_bytes;
  if (bytes.left() != count * stl_triangle_bytes)
    bytes.refuse(
        "number of triangles", std::to_string(count),
        fmt::format("are files of 84 + 50 bytes a triangle, and {} bytes follow, which are "
                    "{} triangles",
                    bytes.left(), there));
  for (std::uint32_t t = 0; t < count; ++t) {
    for (int c = 0; c < 3; ++c) bytes.take<float>("normal");
    std::array<std::size_t, 3> triangle;
    for (std::size_t& corner : triangle) {
      Eigen::Vector3d x;
      for (double& coordinate : x) {
        coordinate = bytes.take<float>("vertex");
        if (!std::isfinite(coordinate))
          bytes.refuse("vertex", fmt::format("{}", coordinate), "are finite numbers");
      }
      corner = corners.vertex_at(x, mesh);
    }
    bytes.take<std::uint16_t>("attribute");
    add_face(triangle, mesh);
  }
  return mesh;
}

// Binary files may begin with "solid", too, but hold what their count of triangles says.
bool is_ascii_stl(std::string_view content) {
  if (!content.starts_with("solid") && !content.starts_with("SOLID")) return false;
  if (content.size() < stl_header_bytes + 4) return true;
  const auto byte = [&](std::size_t k) {
    return std::size_t{static_cast<unsigned char>(content[stl_header_bytes + k])};
  };
  const std::size_t count = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
  return content.size() != stl_header_bytes + 4 + count * stl_triangle_bytes;
}

}  // namespace

Mesh read_stl(std::string_view text, const std::string& file) {
  return is_ascii_stl(text) ? read_ascii_stl(text, file) : read_binary_stl(text, file);
}

}  // namespace qddot::mesh
