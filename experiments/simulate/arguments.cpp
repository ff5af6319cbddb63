#include "experiments/simulate/arguments.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "experiments/motion_files/motion_file.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::simulate {

Every every_of(const Arguments& a) {
  const std::vector<double>& values = a.every;
  Every every;
  double* owner = nullptr;
  std::size_t next = 0;
  for (const std::string& name : a.p.order()) {
    if (name == "--trajectory") owner = &every.trajectory;
    if (name == "--energy") owner = &every.energy;
    if (name == "--motion") owner = &every.motion;
    if (name == "--every") {
      require_positive(values[next], "--every", "the time between samples in s");
      if (values.size() > 1 && (!owner || *owner != 0)) {
        throw InvalidInput(
            fmt::format("--every {}: if there are several, each comes after the --trajectory, "
                        "--energy or --motion that it is for, one for each",
                        values[next]));
      }
      if (owner) *owner = values[next];
      ++next;
    }
  }
  if (values.size() == 1) every = {values[0], values[0], values[0]};
  bool is_for_some = false;
  for (const auto& [path, own, option] :
       {std::tuple(a.trajectory_path, every.trajectory, "--trajectory"),
        std::tuple(a.energy_path, every.energy, "--energy"),
        std::tuple(a.motion_path, every.motion, "--motion")}) {
    if (path->empty()) continue;
    is_for_some = true;
    if (own > 0) continue;
    throw InvalidInput(fmt::format(
        "--every is missing after {}; it is the time between samples in s, greater than 0",
        option));
  }
  if (!values.empty() && !is_for_some) {
    throw InvalidInput(
        "--every is given without --trajectory, --energy or --motion, which it belongs to");
  }
  return every;
}

void require_distinct_outputs(const Arguments& a) {
  std::set<std::filesystem::path> taken;
  const auto take = [&](const char* option, const std::string& path,
                        const std::vector<std::string>& files) {
    for (const std::string& file : files) {
      if (taken.insert(std::filesystem::absolute(file).lexically_normal()).second) continue;
      throw InvalidInput(
          fmt::format("{} {}: another output or its sidecar goes to {}; allowed is a file for each",
                      option, path, file));
    }
  };
  for (const auto& [option, path] :
       {std::pair("--final", a.final_path), std::pair("--trajectory", a.trajectory_path),
        std::pair("--energy", a.energy_path), std::pair("--breaks", a.breaks_path),
        std::pair("--strain", a.strain_path)}) {
    if (!path.is_given()) continue;
    require_given(path, option, "the name of a CSV file");
    take(option, path, {path, sidecar_of(path)});
  }
  if (a.motion_fields.is_given() && !a.motion_path.is_given())
    throw InvalidInput("--motion-fields is given without --motion, which it belongs to");
  if (a.motion_path.is_given()) {
    require_given(a.motion_path, "--motion", "the name of a .vtkhdf or .pc2 file");
    take("--motion", a.motion_path, motion_files::files_of_motion(a.motion_path, "--motion"));
  }
  if (!a.written_scene_path.is_given()) return;
  require_given(a.written_scene_path, "--write-scene", "the name of a TOML file");
  if (taken.contains(std::filesystem::absolute(*a.written_scene_path).lexically_normal())) {
    throw InvalidInput(fmt::format(
        "--write-scene {}: another output or its sidecar goes there; allowed is a file for each",
        *a.written_scene_path));
  }
}

bool only_writes_scene(const Program& program) {
  const auto given = [&](const char* option) { return program.has(option); };
  constexpr std::array of_a_run = {"--method", "--accuracy", "--step-size",     "--rtol",
                                   "--atol",   "--until",    "--final",         "--trajectory",
                                   "--energy", "--motion",   "--motion-fields", "--every",
                                   "--breaks", "--strain"};
  return given("--write-scene") && std::ranges::none_of(of_a_run, given);
}

const Method& require_method(const std::string& name) {
  require_given(name, "--method", "a method's name (simulate --list-methods prints them)");
  return method_named(name, "--method");
}

Options checked_options(const Arguments& a, const Method& method) {
  const bool fixed = method.knob == Knob::step_size;
  const char* wanted = fixed ? "--step-size" : "--rtol";
  for (const OptionRow& row : option_rows()) {
    const bool is_of_other_knob = std::holds_alternative<Knob>(row.takers) && !takes(method, row);
    if (is_of_other_knob && a.p.has(row.program_name())) {
      throw InvalidInput(
          fmt::format("{} is not for {}, which takes {}", row.program_name(), method.name, wanted));
    }
  }
  if (!a.p.has(wanted)) {
    throw InvalidInput(
        fmt::format("{} is missing; {} needs it, greater than 0", wanted, method.name));
  }
  if (fixed) require_step_size(a.step_size, "--step-size");
  if (!fixed) require_rtol(a.rtol, "--rtol");
  if (a.atol.is_given()) require_positive(a.atol, "--atol", "an absolute tolerance");
  require_options(a.p, a.options, method);
  Options options = a.options;
  options.step_size = a.step_size;
  options.rtol = a.rtol;
  options.atol = a.atol;
  return options;
}

}  // namespace qddot::simulate
