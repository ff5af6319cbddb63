#pragma once

#include <memory>

#include "experiments/motion_files/motion_file.hpp"

namespace qddot::motion_files {

// A motion in the VTKHDF 2.0 layout of PolyData over time, and an .xdmf beside it (see
// open_motion). HDF5 is not made for several threads: one at a time may work on files of this kind.
std::unique_ptr<MotionFile> open_vtkhdf(const std::string& path, const Scene& start,
                                        const ReducedScene& scene, bool has_reference,
                                        const Fields& fields);

}  // namespace qddot::motion_files
