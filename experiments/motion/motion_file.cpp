#include "experiments/motion/motion_file.hpp"

#include <fmt/format.h>

#include "experiments/command/csv.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::motion {

std::vector<std::string> files_of_motion(const std::string& path, const std::string& option) {
  const auto with = [&](std::size_t ending, const char* other) {
    return path.substr(0, path.size() - ending) + other;
  };
  if (path.ends_with(".vtkhdf")) return {path, with(7, ".xdmf"), with(7, ".json")};
  if (path.ends_with(".pc2")) return {path, with(4, ".obj"), with(4, ".json")};
  throw InvalidInput(
      fmt::format("{} {}: the ending names no format; allowed are .vtkhdf and .pc2", option, path));
}

std::unique_ptr<MotionFile> open_motion(const std::string& path, const Scene&, const ReducedScene&,
                                        bool, const Fields&) {
  files_of_motion(path, "--motion");
  throw InvalidInput(fmt::format("--motion {}: motions cannot be written yet", path));
}

}  // namespace qddot::motion
