#pragma once

#include <memory>

#include "experiments/motion_files/motion_file.hpp"

namespace qddot::motion_files {

// A motion as a point cache of version 1, positions alone, and an .obj beside it of the nodes at
// the start, with the faces and all springs (see open_motion).
std::unique_ptr<MotionFile> open_pc2(const std::string& path, const Scene& start,
                                     const ReducedScene& scene);

}  // namespace qddot::motion_files
