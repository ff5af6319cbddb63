#pragma once

#include <memory>

#include "experiments/motion_files/frame.hpp"

namespace qddot::motion_files {

// A motion as a point cache of version 1, with positions alone. An .obj beside it has the nodes at
// the start, the faces and all springs (see open_motion). `framing` has framed the start.
std::unique_ptr<MotionFile> open_pc2(const std::string& path, const Scene& start, Framing framing);

}  // namespace qddot::motion_files
