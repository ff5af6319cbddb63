#include <algorithm>

#include <fmt/format.h>

#include "src/scene/mesh_formats.hpp"

namespace qddot {
namespace {

// A section of elements: the edges of each, by the places of their two corners.
struct Element {
  std::string_view keyword;
  std::size_t corners;
  std::string_view edges;
};
constexpr std::array<Element, 5> elements{{
    {"Edges", 2, "01"},
    {"Triangles", 3, "01 12 20"},
    {"Quadrilaterals", 4, "01 12 23 30"},
    {"Tetrahedra", 4, "01 02 03 12 13 23"},
    {"Hexahedra", 8, "01 12 23 30 45 56 67 74 04 15 26 37"},
}};

class MeditReader {
 public:
  MeditReader(const std::string& text, const std::string& file) : words_(text, file) {}

  Mesh read() {
    if (const auto word = words_.next(); word != "MeshVersionFormatted")
      words_.refuse("first word", word, "is MeshVersionFormatted");
    for (auto word = words_.next(); !word.empty() && word != "End"; word = words_.next()) {
      const auto element =
          std::find_if(elements.begin(), elements.end(),
                       [&](const Element& candidate) { return candidate.keyword == word; });
      if (word == "Dimension")
        dimension_ = whole(word, 2, 3);
      else if (word == "Vertices")
        read_vertices();
      else if (element != elements.end())
        read_elements(*element);
      // Any other word is the keyword or content of a section that has no edges: passed over.
    }
    // Elements may come before the vertices, so what they name is known only now.
    if (largest_ > mesh_.vertices.size())
      words_.refuse("element", std::to_string(largest_),
                    fmt::format("are the vertices 1 to {}", mesh_.vertices.size()), largest_line_);
    return std::move(mesh_);
  }

 private:
  std::size_t whole(std::string_view field, std::size_t low, std::size_t high) {
    const auto word = words_.next();
    const auto value = number_in<std::size_t>(word);
    if (!value || *value < low || *value > high)
      words_.refuse(field, word, fmt::format("are whole numbers from {} to {}", low, high));
    return *value;
  }
  // The number of entries in a section. Nothing is reserved for them before they are seen.
  std::size_t count(std::string_view field) { return whole(field, 0, 1'000'000'000); }
  void skip_reference(std::string_view field) { words_.number(field, words_.next()); }

  void read_vertices() {
    constexpr std::string_view field = "Vertices";
    for (std::size_t left = count(field); left > 0; --left) {
      Eigen::Vector3d x = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < dimension_; ++k) x[k] = words_.number(field, words_.next());
      skip_reference(field);
      mesh_.vertices.push_back(x);
    }
  }

  void read_elements(const Element& element) {
    std::array<std::size_t, 8> corners;
    for (std::size_t left = count(element.keyword); left > 0; --left) {
      for (std::size_t k = 0; k < element.corners; ++k) corners[k] = corner(element.keyword);
      skip_reference(element.keyword);
      const auto corner_at = [&](std::size_t k) {
        return corners[std::size_t(element.edges[k] - '0')];
      };
      for (std::size_t k = 0; k < element.edges.size(); k += 3)
        mesh_.edges.push_back({corner_at(k), corner_at(k + 1)});
      if (element.corners == 3) mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
    }
  }

  std::size_t corner(std::string_view field) {
    const std::size_t index = whole(field, 1, 1'000'000'000);
    if (index > largest_) {
      largest_ = index;
      largest_line_ = words_.line();
    }
    return index - 1;
  }

  Words words_;
  Mesh mesh_;
  std::size_t dimension_ = 3;
  std::size_t largest_ = 0;  // of all indices, counted from 1
  int largest_line_ = 0;
};

}  // namespace

Mesh read_medit(const std::string& text, const std::string& file) {
  return MeditReader(text, file).read();
}

}  // namespace qddot
