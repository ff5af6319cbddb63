#include "experiments/motion_files/xdmf.hpp"

#include <algorithm>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace qddot::motion_files {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string item(const std::string& dimensions, const char* type, int bytes,
                 const std::string& place) {
  return fmt::format(
      R"(<DataItem Format="HDF" Dimensions="{}" NumberType="{}" Precision="{}">{}</DataItem>)",
      dimensions, type, bytes, place);
}

}  // namespace

const std::string xdmf_beginning = "<?xml version=\"1.0\"?>\n<!-- Written by qddot -->\n";

std::string frame_name(std::size_t frame) { return fmt::format("{:06}", frame); }

std::string xdmf_text(const XdmfFields& about, const std::vector<double>& times) {
  const std::string frames = escaped(about.file) + ":/Frames/";
  fmt::memory_buffer text;
  const auto add = [&](const char* format, const auto&... values) {
    fmt::format_to(std::back_inserter(text), fmt::runtime(format), values...);
  };
  add("{}", xdmf_beginning);
  add("<Xdmf Version=\"3.0\">\n<Domain>\n"
      "<Grid Name=\"motion\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  for (std::size_t k = 0; k < times.size(); ++k) {
    const std::string here = frames + frame_name(k) + "/";
    const std::string points = item(fmt::format("{} 3", about.nodes), "Float", 4, here + "Points");
    add("<Grid Name=\"frame\" GridType=\"Uniform\">\n<Time Value=\"{}\"/>\n", times[k]);
    add("<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">{}</Topology>\n", about.cells,
        item(fmt::format("{}", about.cell_numbers), "Int", 8, frames + "cells"));
    add("<Geometry GeometryType=\"XYZ\">{}</Geometry>\n", points);
    // Readers that use one geometry for all frames need it.
    add("<Attribute Name=\"position\" AttributeType=\"Vector\" Center=\"Node\">{}</Attribute>\n",
        points);
    for (const auto& field : about.fields) {
      const bool is_vector = field.columns == 3;
      add("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n", field.name,
          is_vector ? "Vector" : "Scalar", field.is_of_cells ? "Cell" : "Node",
          item(fmt::format("{}{}", field.rows, is_vector ? " 3" : ""), "Float", 4,
               here + field.name));
    }
    add("</Grid>\n");
  }
  add("</Grid>\n</Domain>\n</Xdmf>\n");
  return fmt::to_string(text);
}

bool can_be_named(const std::string& file) {
  // Some readers take blanks away from both ends.
  if (file.starts_with(' ') || file.ends_with(' ')) return false;
  if (std::ranges::any_of(file, [](char c) {
        return static_cast<unsigned char>(c) < ' ' || c == '\x7f' || c == ':';
      }))
    return false;
  try {
    static_cast<void>(nlohmann::json(file).dump());
    return true;
  } catch (const nlohmann::json::type_error&) {  // not UTF-8
    return false;
  }
}

}  // namespace qddot::motion_files
