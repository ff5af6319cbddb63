#pragma once

#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "qddot/scene/model.hpp"

namespace qddot::motion_files {

// The fields of a motion beside positions, for formats that hold them.
struct Fields {
  bool velocity = true;        // [m/s], of each node
  bool kinetic_energy = true;  // [J], of each node
  bool strain = true;  // of each spring: (l - l0) / l0, or NaN once it is broken; docs/motions.md
};
constexpr Fields no_fields{.velocity = false, .kinetic_energy = false, .strain = false};

// A motion in a file for other programs. It has all nodes of a scene, with pinned ones, frame after
// frame in 32-bit floats, and the cells that join them. Its files appear together on commit(), or
// not at all.
class MotionFile {
 public:
  virtual ~MotionFile() = default;
  // Adds the frame of this state at its time. `reference`: for files that were opened with a
  // reference, the state from which each node's distance [m] is measured. Returns false if a number
  // is not finite or beyond 32-bit floats: the motion ends before that frame and takes no more.
  // Throws CannotWrite.
  virtual bool add(const State& state, const State* reference = nullptr) = 0;
  // Writes the remaining data and the sidecar. `origin`: how the motion was made (see
  // provenance.hpp). Throws CannotWrite.
  virtual void complete(const nlohmann::json& origin) = 0;
  // Lets all files appear, after complete().
  virtual void commit() = 0;
};

// All files that a motion at this path consists of, the path first. Throws InvalidInput if its
// ending names no format; the message names the path by `option`.
std::vector<std::string> files_of_motion(const std::string& path, const std::string& option);

// The fields of these names, "none" for none; `path` is the motion's. Throws InvalidInput for
// another name and for a format that holds positions alone.
Fields fields_named(const std::vector<std::string>& names, const std::string& path,
                    const std::string& option);

// Who a .vtkhdf is for: all readers of HDF5 and XDMF, by single frames in /Frames and an .xdmf
// beside it; or those of VTKHDF over time alone. Single frames of few nodes are twenty times as
// large as their numbers.
enum class Readers { all, of_vtkhdf };

// Opens the files of a motion in the format that the path's ending names: .vtkhdf (with an .xdmf
// beside it) or .pc2 (with an .obj). `start`: the scene as its motion starts; `scene`: that scene
// reduced, which must outlive the file; `has_reference`: whether add gets one. Throws InvalidInput
// if the ending is another one, a file cannot be written, the format cannot count the scene's
// nodes, or the start exceeds 32-bit floats.
std::unique_ptr<MotionFile> open_motion(const std::string& path, const Scene& start,
                                        const Model& scene, bool has_reference = false,
                                        const Fields& fields = {}, Readers readers = Readers::all);

}  // namespace qddot::motion_files
