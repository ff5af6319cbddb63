#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "experiments/kit/whole_file.hpp"
#include "experiments/motion_files/frame.hpp"
#include "experiments/motion_files/hdf5.hpp"
#include "experiments/motion_files/row_stream.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::motion_files {
namespace {

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

// The first lines of every .xdmf file.
const std::string xdmf_beginning = "<?xml version=\"1.0\"?>\n<!-- Written by qddot -->\n";

// The name of a frame's group.
std::string frame_name(std::size_t frame) { return fmt::format("{:06}", frame); }

// The text of an XDMF 3 file of frames at these times [s]. Geometry and each field are one whole
// dataset; ParaView 5.11's own reader would show a part of a dataset as empty.
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

// Whether XML and XDMF can name that file: UTF-8 without control characters and colons.
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

using hdf5::Handle;
using kit::CannotWrite;
using kit::WholeFile;
using Numbers = std::vector<std::int64_t>;

constexpr std::size_t kinds = 4;  // of cells: vertices, lines, polygons and strips

// One kind of cells, each of `corners` nodes.
void write_cells(const Handle& root, const std::string& kind, const Numbers& nodes,
                 std::size_t corners) {
  const Handle group = hdf5::new_group(root, kind);
  Numbers offsets;
  for (std::size_t k = 0; k <= nodes.size(); k += corners) offsets.push_back(std::int64_t(k));
  hdf5::write(group, "NumberOfCells", Numbers{std::int64_t(nodes.size() / corners)});
  hdf5::write(group, "NumberOfConnectivityIds", Numbers{std::int64_t(nodes.size())});
  hdf5::write(group, "Connectivity", nodes);
  hdf5::write(group, "Offsets", offsets);
}

template <class Lists>
Numbers joined(const Lists& lists) {
  Numbers all;
  for (const auto& nodes : lists) all.insert(all.end(), nodes.begin(), nodes.end());
  return all;
}

// The cells in XDMF's mixed form: the kind of each, with the number of nodes if the kind leaves it
// open.
Numbers mixed(const Cells& cells) {
  constexpr std::int64_t point = 1, line = 2, triangle = 4;
  Numbers all;
  for (const std::size_t node : cells.points) all.insert(all.end(), {point, 1, std::int64_t(node)});
  for (const auto& [a, b] : cells.lines)
    all.insert(all.end(), {line, 2, std::int64_t(a), std::int64_t(b)});
  for (const auto& [a, b, c] : cells.triangles)
    all.insert(all.end(), {triangle, std::int64_t(a), std::int64_t(b), std::int64_t(c)});
  return all;
}

// A field of the frames and its datasets.
struct Stream {
  std::string name;
  const std::vector<float> Frame::*numbers;
  bool is_of_cells;
  std::size_t rows, columns;  // of a frame
  RowStream out;
};

class VtkhdfFile final : public MotionFile {
 public:
  VtkhdfFile(const std::vector<std::string>& files, const Scene& start, Framing framing,
             bool has_reference, Readers readers)
      : framing_(std::move(framing)),
        file_(files[0], {}, files[2]),
        sidecar_(files[2]),
        has_reference_(has_reference) {
    if (readers == Readers::all) xdmf_.emplace(files[1], xdmf_beginning);
    trying([&] {
      const Cells cells = cells_of(start);
      hdf5_ = hdf5::new_file(file_.unfinished_path());
      root_ = hdf5::new_group(hdf5_, "VTKHDF");
      if (xdmf_) frames_ = hdf5::new_group(hdf5_, "Frames");
      write_topology(cells, start.nodes.size());
      open_streams(start.nodes.size(), cells.count(), framing_.wanted());
    });
  }

  bool add(const State& state, const State* reference) override {
    const Frame* frame = framing_.of(state, has_reference_ ? reference : nullptr);
    if (!frame) return false;
    trying([&] {
      std::vector<std::pair<RowStream*, const std::vector<float>*>> rows;
      for (Stream& stream : streams_) rows.emplace_back(&stream.out, &(frame->*stream.numbers));
      append(rows);
      times_.push_back(frame->time);
      if (write_full()) hdf5::checked(H5Fflush(hdf5_.id(), H5F_SCOPE_LOCAL));
    });
    return true;
  }

  void complete(const nlohmann::json& origin) override {
    trying([&] {
      for (Stream& stream : streams_) stream.out.complete();
      write_full();
      write_steps();
      for (std::size_t k = 0; xdmf_ && k < times_.size(); ++k) {
        const Handle frame = hdf5::new_group(frames_, frame_name(k));
        for (const Stream& stream : streams_) stream.out.show_frame(frame, stream.name, k);
      }
      streams_.clear();
      for (Handle* handle : {&fields_of_cells_, &fields_of_nodes_, &frames_, &root_, &hdf5_})
        handle->close();
    });
    if (xdmf_) xdmf_->write(xdmf_text(about_, times_));
    sidecar_.write(kit::text_of_sidecar(origin));
    for (WholeFile* file : files()) file->complete();
  }

  void commit() override {
    for (WholeFile* file : files()) file->commit();
  }

 private:
  std::vector<WholeFile*> files() {
    if (!xdmf_) return {&file_, &sidecar_};
    return {&file_, &*xdmf_, &sidecar_};
  }

  template <class Call>
  void trying(const Call& call) {
    try {
      hdf5::be_quiet();
      call();
    } catch (const hdf5::Failure& failure) {
      throw CannotWrite(fmt::format("{}: cannot be written: {}", file_.path(), failure.what()));
    }
  }

  // Writes the full chunks; returns whether there were any.
  bool write_full() {
    bool is_any = false;
    for (Stream& stream : streams_) is_any |= stream.out.write();
    return is_any;
  }

  // Writes the parts that all frames share.
  void write_topology(const Cells& cells, std::size_t nodes) {
    hdf5::write_attribute(root_, "Version", Numbers{2, 0});
    hdf5::write_attribute(root_, "Type", std::string("PolyData"));
    hdf5::write(root_, "NumberOfPoints", Numbers{std::int64_t(nodes)});
    write_cells(root_, "Vertices", {cells.points.begin(), cells.points.end()}, 1);
    write_cells(root_, "Lines", joined(cells.lines), 2);
    write_cells(root_, "Polygons", joined(cells.triangles), 3);
    write_cells(root_, "Strips", {}, 1);
    if (!xdmf_) return;
    const Numbers numbers = mixed(cells);
    hdf5::write(frames_, "cells", numbers);
    about_ = {.file = std::filesystem::path(file_.path()).filename().string(),
              .nodes = nodes,
              .cells = cells.count(),
              .cell_numbers = numbers.size(),
              .fields = {}};
  }

  void open_streams(std::size_t nodes, std::size_t cells, const Fields& fields) {
    fields_of_nodes_ = hdf5::new_group(root_, "PointData");
    fields_of_cells_ = hdf5::new_group(root_, "CellData");
    // Positions alone are small, and compressing them takes most of the time.
    const bool is_packed =
        fields.velocity || fields.kinetic_energy || fields.strain || has_reference_;
    const auto open = [&](bool is_wanted, const Handle& group, const char* name,
                          const std::vector<float> Frame::*numbers, std::size_t rows,
                          std::size_t columns) {
      if (!is_wanted) return;
      const bool is_of_cells = &group == &fields_of_cells_;
      streams_.push_back({name, numbers, is_of_cells, rows, columns,
                          RowStream(group, name, rows, columns, is_packed)});
      if (&group != &root_) about_.fields.push_back({name, rows, columns, is_of_cells});
    };
    open(true, root_, "Points", &Frame::positions, nodes, 3);
    open(fields.velocity, fields_of_nodes_, "velocity", &Frame::velocities, nodes, 3);
    open(fields.kinetic_energy, fields_of_nodes_, "kinetic_energy", &Frame::kinetic_energies, nodes,
         1);
    open(has_reference_, fields_of_nodes_, "distance_to_reference", &Frame::distances, nodes, 1);
    open(fields.strain, fields_of_cells_, "strain", &Frame::strains, cells, 1);
  }

  // Writes the start of each frame in the datasets: the topology exists once, all else frame after
  // frame.
  void write_steps() {
    const std::size_t count = times_.size();
    const Handle steps = hdf5::new_group(root_, "Steps");
    hdf5::write_attribute(steps, "NSteps", std::int64_t(count));
    hdf5::write(steps, "Values", times_);
    hdf5::write(steps, "PartOffsets", Numbers(count, 0));
    hdf5::write(steps, "NumberOfParts", Numbers(count, 1));
    hdf5::write(steps, "CellOffsets", Numbers(count * kinds, 0), kinds);
    hdf5::write(steps, "ConnectivityIdOffsets", Numbers(count * kinds, 0), kinds);
    const Handle of_nodes = hdf5::new_group(steps, "PointDataOffsets");
    const Handle of_cells = hdf5::new_group(steps, "CellDataOffsets");
    for (const Stream& stream : streams_) {
      Numbers starts;
      for (std::size_t k = 0; k < count; ++k) starts.push_back(std::int64_t(k * stream.rows));
      if (stream.name == "Points")
        hdf5::write(steps, "PointOffsets", starts);
      else
        hdf5::write(stream.is_of_cells ? of_cells : of_nodes, stream.name, starts);
    }
  }

  Framing framing_;
  WholeFile file_, sidecar_;
  std::optional<WholeFile> xdmf_;  // goes with single frames in frames_, for all readers
  bool has_reference_;
  Handle hdf5_, root_, frames_, fields_of_nodes_, fields_of_cells_;
  std::vector<Stream> streams_;  // closed before the file, as it is declared after it
  std::vector<double> times_;    // [s]
  XdmfFields about_{};
};

}  // namespace

std::unique_ptr<MotionFile> open_vtkhdf(const std::string& path, const Scene& start,
                                        Framing framing, bool has_reference, Readers readers) {
  if (!can_be_named(std::filesystem::path(path).filename().string()))
    throw InvalidInput(
        fmt::format("{}: the .xdmf beside it cannot name that file; allowed are names in UTF-8 "
                    "without control characters, colons and blanks at their ends",
                    path));
  return std::make_unique<VtkhdfFile>(files_of_motion(path, "motion"), start, std::move(framing),
                                      has_reference, readers);
}

}  // namespace qddot::motion_files
