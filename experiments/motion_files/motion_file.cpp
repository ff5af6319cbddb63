#include "experiments/motion_files/motion_file.hpp"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "experiments/kit/csv.hpp"
#include "experiments/motion_files/frame.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::motion_files {
namespace {

bool is_pc2(const std::string& path) { return path.ends_with(".pc2"); }

}  // namespace

std::vector<std::string> files_of_motion(const std::string& path, const std::string& option) {
  const std::string_view ending = is_pc2(path) ? ".pc2" : ".vtkhdf";
  if (!path.ends_with(ending))
    throw InvalidInput(fmt::format(
        "{} {}: the ending names no format; allowed are .vtkhdf and .pc2", option, path));
  const std::string stem = path.substr(0, path.size() - ending.size());
  return {path, stem + (is_pc2(path) ? ".obj" : ".xdmf"), kit::sidecar_of(path)};
}

Fields fields_named(const std::vector<std::string>& names, const std::string& path,
                    const std::string& option) {
  if (is_pc2(path))
    throw InvalidInput(fmt::format("{} is not for {}: a .pc2 holds positions alone", option, path));
  Fields fields = no_fields;
  const std::array all = {std::pair("velocity", &Fields::velocity),
                          std::pair("kinetic_energy", &Fields::kinetic_energy),
                          std::pair("strain", &Fields::strain)};
  for (const std::string& name : names) {
    bool is_known = names.size() == 1 && name == "none";
    for (const auto& [known, field] : all) {
      if (name == known) is_known = fields.*field = true;
    }
    if (!is_known)
      throw InvalidInput(fmt::format(
          "{}: '{}' is not a field; allowed are velocity, kinetic_energy and strain, or none alone",
          option, name));
  }
  return fields;
}

std::unique_ptr<MotionFile> open_motion(const std::string& path, const Scene& start,
                                        const Model& scene, bool has_reference,
                                        const Fields& fields, Readers readers) {
  files_of_motion(path, "motion");
  Framing framing(start, scene, is_pc2(path) ? no_fields : fields);
  if (!framing.of(scene.initial(), nullptr))
    throw InvalidInput(fmt::format(
        "{}: the scene starts with numbers beyond 32-bit floats, which end at 3.4e38", path));
  if (is_pc2(path)) return open_pc2(path, start, std::move(framing));
  return open_vtkhdf(path, start, std::move(framing), has_reference, readers);
}

}  // namespace qddot::motion_files
