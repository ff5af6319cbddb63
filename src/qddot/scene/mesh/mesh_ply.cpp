// PLY, ASCII or binary of either order of bytes: a header says which elements follow, and which
// properties each has. Vertices, faces and edges are read.
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "qddot/scene/mesh/mesh_bytes.hpp"
#include "qddot/scene/mesh/mesh_elements.hpp"
#include "qddot/scene/mesh/mesh_formats.hpp"

namespace qddot::mesh {
namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::optional<PlyType> ply_type(std::string_view name) {
  using enum PlyType;
  constexpr std::pair<std::string_view, PlyType> types[] = {
      {"char", int8},   {"uchar", uint8},   {"short", int16},     {"ushort", uint16},
      {"int", int32},   {"uint", uint32},   {"float", float32},   {"double", float64},
      {"int8", int8},   {"uint8", uint8},   {"int16", int16},     {"uint16", uint16},
      {"int32", int32}, {"uint32", uint32}, {"float32", float32}, {"float64", float64}};
  const auto found = std::ranges::find(types, name, [](const auto& one) { return one.first; });
  return found == std::end(types) ? std::nullopt : std::optional(found->second);
}

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> count_type;  // of a list
};

struct PlyElement {
  std::string name;
  std::size_t count;
  std::vector<PlyProperty> properties{};
};

class PlyReader {
 public:
  PlyReader(std::string_view content, const std::string& file)
      : words_(content, file), bytes_(content, file) {}

  Mesh read() {
    const std::vector<PlyElement> elements = read_header();
    for (const PlyElement& element : elements) {
      if (element.name == "vertex") vertices_ = element.count;
    }
    for (const PlyElement& element : elements) {
      const bool is_read =
          element.name == "vertex" || element.name == "face" || element.name == "edge";
      if (!is_read) mesh_.leave_out(element.name);
      if (element.name == "vertex") require(element, {"x", "y", "z"});
      if (element.name == "edge") require(element, {"vertex1", "vertex2"});
      for (std::size_t left = element.count; left > 0; --left) read_element(element);
    }
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void refuse(std::string_view field, std::string_view value,
                           std::string_view allowed) const {
    if (is_binary_) bytes_.refuse(field, value, allowed);
    words_.refuse(field, value, allowed);
  }

  PlyType type_in_header() {
    const auto word = words_.in_line();
    const auto type = ply_type(word);
    if (!type)
      words_.refuse("type", word,
                    "are char, uchar, short, ushort, int, uint, float, double, and int8 to "
                    "float64");
    return *type;
  }

  void read_format() {
    const auto format = words_.in_line(), version = words_.in_line();
    is_binary_ = format != "ascii";
    if (format == "binary_big_endian")
      bytes_.order = std::endian::big;
    else if (is_binary_ && format != "binary_little_endian")
      words_.refuse("format", format, "are ascii, binary_little_endian and binary_big_endian");
    if (version != "1.0") words_.refuse("version of the format", version, "is 1.0");
  }

  std::vector<PlyElement> read_header() {
    if (const auto word = words_.in_line(); word != "ply")
      words_.refuse("first word", word, "is ply");
    std::vector<PlyElement> elements;
    while (true) {
      if (!words_.next_line()) words_.refuse("header", "", "is one that ends with end_header");
      const auto word = words_.in_line();
      if (word == "format") {
        read_format();
      } else if (word == "element") {
        const std::string name(words_.in_line());
        const auto count = words_.in_line();
        const auto number = number_in<std::size_t>(count);
        if (!number || *number > 1'000'000'000)
          words_.refuse("number of elements", count, "are whole numbers from 0 to 1000000000");
        elements.push_back({name, *number});
      } else if (word == "property") {
        if (elements.empty()) words_.refuse("line", word, "are properties of an element");
        elements.back().properties.push_back(read_property());
      } else if (word == "end_header") {
        break;
      } else if (!word.empty() && word != "comment" && word != "obj_info") {
        words_.refuse("line", word,
                      "are format, element, property, comment, obj_info and end_header");
      }
    }
    words_.next_line();
    bytes_.at = words_.at();
    return elements;
  }

  PlyProperty read_property() {
    const std::size_t at = words_.at();
    std::optional<PlyType> count_type;
    if (words_.in_line() == "list")
      count_type = type_in_header();
    else
      words_.go_to(at);
    const PlyType type = type_in_header();
    return {std::string(words_.in_line()), type, count_type};
  }

  void require(const PlyElement& element, std::initializer_list<const char*> names) {
    for (const char* name : names) {
      const auto found = std::ranges::find(element.properties, name, &PlyProperty::name);
      if (found == element.properties.end() || found->count_type)
        refuse(element.name, "a list of its properties", fmt::format("are lists with {}", name));
    }
  }

  double value(PlyType type, std::string_view field) {
    if (!is_binary_) {
      const auto word = words_.next();
      return words_.number(field, word);
    }
    switch (type) {
      case PlyType::int8:
        return bytes_.take<std::int8_t>(field);
      case PlyType::uint8:
        return bytes_.take<std::uint8_t>(field);
      case PlyType::int16:
        return bytes_.take<std::int16_t>(field);
      case PlyType::uint16:
        return bytes_.take<std::uint16_t>(field);
      case PlyType::int32:
        return bytes_.take<std::int32_t>(field);
      case PlyType::uint32:
        return bytes_.take<std::uint32_t>(field);
      case PlyType::float32:
        return bytes_.take<float>(field);
      default:
        return bytes_.take<double>(field);
    }
  }

  // A whole number from 0, below `end`.
  std::size_t whole(double value, std::string_view field, std::size_t end) const {
    if (!(value >= 0 && value < static_cast<double>(end)) || value != std::floor(value))
      refuse(field, fmt::format("{}", value),
             fmt::format("are whole numbers from 0, below {}", end));
    return static_cast<std::size_t>(value);
  }

  void read_element(const PlyElement& element) {
    const bool is_vertex = element.name == "vertex", is_edge = element.name == "edge";
    Eigen::Vector3d x = Eigen::Vector3d::Zero();
    std::array<std::size_t, 2> ends{};
    for (const PlyProperty& property : element.properties) {
      if (property.count_type) {
        read_list(element, property);
        continue;
      }
      const double number = value(property.type, element.name);
      for (std::size_t c = 0; is_vertex && c < 3; ++c) {
        if (property.name != std::string_view("xyz").substr(c, 1)) continue;
        if (!std::isfinite(number))
          refuse("vertex", fmt::format("{}", number), "are finite numbers");
        x[static_cast<Eigen::Index>(c)] = number;
      }
      if (is_edge && property.name == "vertex1") ends[0] = whole(number, "edge", vertices_);
      if (is_edge && property.name == "vertex2") ends[1] = whole(number, "edge", vertices_);
    }
    if (is_vertex) mesh_.vertices.push_back(x);
    if (is_edge) {
      mesh_.edges.push_back(ends);
      mesh_.cells.add(1, ends);
    }
  }

  void read_list(const PlyElement& element, const PlyProperty& property) {
    const std::size_t count =
        whole(value(*property.count_type, element.name), element.name, 1'000'000'000);
    const bool is_face = element.name == "face" &&
                         (property.name == "vertex_indices" || property.name == "vertex_index");
    std::vector<std::size_t> corners;
    for (std::size_t k = 0; k < count; ++k) {
      const double number = value(property.type, element.name);
      if (is_face) corners.push_back(whole(number, "face", vertices_));
    }
    if (!is_face) return;
    if (count < 3) refuse("face", fmt::format("{} corners", count), "are three corners or more");
    add_face(corners, mesh_);
  }

  Words words_;
  Bytes bytes_;
  bool is_binary_ = false;
  std::size_t vertices_ = 0;
  Mesh mesh_;
};

}  // namespace

Mesh read_ply(std::string_view text, const std::string& file) {
  return PlyReader(text, file).read();
}

}  // namespace qddot::mesh
