#include "experiments/simulate/arguments.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "experiments/kit/accuracy_choice.hpp"
#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/catalogue.hpp"
#include "experiments/kit/csv.hpp"
#include "experiments/kit/method_options.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/motion_files/motion_file.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::simulate {

void declare(CommandLine& line, Arguments& a) {
  add_scene_options(line, a.scene);
  line.add_option("--method", a.method, "the method's name (see --list-methods)");
  line.add_option("--accuracy", a.accuracy,
                  "a relative error, in place of --method: the fastest method for it is found and "
                  "run, and another run bounds its error");
  add_accuracy_of_option(line, a.accuracy_of);
  line.add_option("--step-size", a.step_size, "the step size h in s, for methods of fixed steps");
  line.add_option("--rtol", a.rtol, "relative tolerance, for adaptive methods");
  line.add_option("--atol", a.atol,
                  "absolute tolerance in m and m/s, for adaptive methods (default: --rtol times "
                  "the scene's extent, and times its typical speed)");
  add_method_options(line, a.options);
  line.add_option("--until", a.until, "the time to run to in s (default: the scene's own)");
  line.add_option("--final", a.final_path, "CSV of all nodes at the end: node,x,y,z,vx,vy,vz");
  line.add_option("--trajectory", a.trajectory_path, "CSV of all nodes over time: t,node,x,...");
  line.add_option("--energy", a.energy_path, "CSV of t,kinetic,potential,total");
  line.add_option("--motion", a.motion_path,
                  "all nodes over time in 32-bit floats, with springs and faces: .vtkhdf for "
                  "ParaView, h5py and MATLAB (with an .xdmf), .pc2 for Blender (with an .obj)");
  line.add_option("--motion-fields", a.motion_fields,
                  "a,b,...: fields of a .vtkhdf beside positions, of velocity, kinetic_energy, "
                  "strain, or none (default: all)")
      .delimiter(',');
  line.add_option("--write-scene", a.written_scene_path,
                  "TOML file of the scene as nodes and springs, exact to the last bit; without "
                  "--method the program does only this");
  line.add_option("--every", a.every,
                  "the time between samples in s; samples do not change steps of fixed size. Give "
                  "it after the output that it is for, or once for all outputs")
      .take_each();
  line.add_flag("--explain", a.explain,
                "print the reductions of the scene with their reasons, and run nothing");
  line.add_flag("--list-methods", a.list_methods, "print all methods");
  line.add_flag("--list-scenes", a.list_scenes, "print the scene generators and their parameters");
  line.add_flag("--csv", a.csv, "print lists as CSV");
}

void assign_every(const CommandLine& line, Arguments& a) {
  double* owner = nullptr;
  std::size_t next = 0;
  for (const std::string& name : line.order()) {
    if (name == "--trajectory") owner = &a.trajectory_every;
    if (name == "--energy") owner = &a.energy_every;
    if (name == "--motion") owner = &a.motion_every;
    if (name == "--every") {
      require_positive(a.every[next], "--every", "the time between samples in s");
      if (a.every.size() > 1 && (!owner || *owner != 0)) {
        throw InvalidInput(
            fmt::format("--every {}: if there are several, each comes after the --trajectory, "
                        "--energy or --motion that it is for, one for each",
                        a.every[next]));
      }
      if (owner) *owner = a.every[next];
      ++next;
    }
  }
  if (a.every.size() == 1) a.trajectory_every = a.energy_every = a.motion_every = a.every[0];
  const auto require = [](const std::string& path, double every, const char* option) {
    if (!path.empty() && every == 0) {
      throw InvalidInput(fmt::format(
          "--every is missing after {}; it is the time between samples in s, greater than 0",
          option));
    }
  };
  require(a.trajectory_path, a.trajectory_every, "--trajectory");
  require(a.energy_path, a.energy_every, "--energy");
  require(a.motion_path, a.motion_every, "--motion");
  if (!a.every.empty() && a.trajectory_path.empty() && a.energy_path.empty() &&
      a.motion_path.empty()) {
    throw InvalidInput(
        "--every is given without --trajectory, --energy or --motion, which it belongs to");
  }
}

void require_distinct_outputs(const CommandLine& line, const Arguments& a) {
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
        std::pair("--energy", a.energy_path)}) {
    if (!line.has(option)) continue;
    require_given(path, option, "the name of a CSV file");
    take(option, path, {path, sidecar_of(path)});
  }
  if (line.has("--motion-fields") && !line.has("--motion"))
    throw InvalidInput("--motion-fields is given without --motion, which it belongs to");
  if (line.has("--motion")) {
    require_given(a.motion_path, "--motion", "the name of a .vtkhdf or .pc2 file");
    take("--motion", a.motion_path, motion_files::files_of_motion(a.motion_path, "--motion"));
  }
  if (!line.has("--write-scene")) return;
  require_given(a.written_scene_path, "--write-scene", "the name of a TOML file");
  if (taken.contains(std::filesystem::absolute(a.written_scene_path).lexically_normal())) {
    throw InvalidInput(fmt::format(
        "--write-scene {}: another output or its sidecar goes there; allowed is a file for each",
        a.written_scene_path));
  }
}

bool only_writes_scene(const CommandLine& line) {
  const auto given = [&](const char* option) { return line.has(option); };
  constexpr std::array of_a_run = {"--method", "--accuracy", "--step-size",     "--rtol",
                                   "--atol",   "--until",    "--final",         "--trajectory",
                                   "--energy", "--motion",   "--motion-fields", "--every"};
  return given("--write-scene") && std::ranges::none_of(of_a_run, given);
}

const Method& require_method(const std::string& name) {
  require_given(name, "--method", "a method's name (simulate --list-methods prints them)");
  if (const Method* method = find_method(name)) return *method;
  throw InvalidInput(
      fmt::format("--method: {} is not a method; allowed are {}", name, method_names()));
}

Options checked_options(const CommandLine& line, const Arguments& a, const Method& method) {
  const bool fixed = method.knob == Knob::step_size;
  const char* wanted = fixed ? "--step-size" : "--rtol";
  for (const char* other : {"--step-size", "--rtol", "--atol"}) {
    const bool allowed =
        fixed ? other == std::string("--step-size") : other != std::string("--step-size");
    if (line.has(other) && !allowed) {
      throw InvalidInput(
          fmt::format("{} is not for {}, which takes {}", other, method.name, wanted));
    }
  }
  if (!line.has(wanted)) {
    throw InvalidInput(
        fmt::format("{} is missing; {} needs it, greater than 0", wanted, method.name));
  }
  if (fixed) require_step_size(a.step_size, "--step-size");
  if (!fixed) require_rtol(a.rtol, "--rtol");
  if (line.has("--atol")) require_positive(a.atol, "--atol", "an absolute tolerance");
  require_options(line, a.options, method);
  Options options = a.options;
  options.step_size = a.step_size;
  options.rtol = a.rtol;
  options.atol = a.atol;
  return options;
}

}  // namespace qddot::simulate
