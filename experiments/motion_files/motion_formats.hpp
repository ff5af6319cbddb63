#pragma once

#include <memory>

#include "experiments/motion_files/frame.hpp"

// The formats of motions (see open_motion). `framing` has framed the start.
namespace qddot::motion_files {

// A motion as a point cache of version 1, with positions alone. An .obj beside it has the nodes at
// the start, the faces and all springs.
std::unique_ptr<MotionFile> open_pc2(const std::string& path, const Scene& start, Framing framing);

// A motion in the VTKHDF 2.0 layout of PolyData over time, and an .xdmf beside it. HDF5 is not made
// for several threads: one at a time may work on files of this kind.
std::unique_ptr<MotionFile> open_vtkhdf(const std::string& path, const Scene& start,
                                        Framing framing, bool has_reference);

}  // namespace qddot::motion_files
