#pragma once

#include <memory>

#include "experiments/motion_files/frame.hpp"

namespace qddot::motion_files {

// A motion in the VTKHDF 2.0 layout of PolyData over time, and an .xdmf beside it (see
// open_motion). `framing` has framed the start. HDF5 is not made for several threads: one at a time
// may work on files of this kind.
std::unique_ptr<MotionFile> open_vtkhdf(const std::string& path, const Scene& start,
                                        Framing framing, bool has_reference);

}  // namespace qddot::motion_files
