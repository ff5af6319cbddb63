#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace qddot::motion_files {

// The names that an .xdmf uses for the file beside it and its datasets: /Frames/cells and, for each
// frame, /Frames/NUMBER/NAME with Points and the fields.
struct XdmfFields {
  struct Field {
    std::string name;
    std::size_t rows, columns;
    bool is_of_cells;
  };
  std::string file;  // without its folder
  std::size_t nodes, cells, cell_numbers;
  std::vector<Field> fields;
};

// The first lines of every .xdmf file.
extern const std::string xdmf_beginning;

// The name of a frame's group.
std::string frame_name(std::size_t frame);

// The text of an XDMF 3 file of frames at these times [s]. Geometry and each field are one whole
// dataset; ParaView 5.11's own reader would show a part of a dataset as empty.
std::string xdmf_text(const XdmfFields& about, const std::vector<double>& times);

// Whether XML and XDMF can name that file: UTF-8 without control characters and colons.
bool can_be_named(const std::string& file);

}  // namespace qddot::motion_files
