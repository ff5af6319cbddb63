#pragma once

#include <string>
#include <vector>

#include "experiments/kit/command_line.hpp"
#include "experiments/kit/scene_choice.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::simulate {

// The options of the command line of simulate.
struct Arguments {
  SceneChoice scene;
  std::string method, accuracy_of, final_path, trajectory_path, energy_path, written_scene_path,
      motion_path;
  double accuracy = 0, step_size = 0, rtol = 0, atol = 0, until = 0, trajectory_every = 0,
         energy_every = 0, motion_every = 0;
  Options options;
  std::vector<double> every;
  std::vector<std::string> motion_fields;
  bool list_methods = false, list_scenes = false, csv = false, explain = false;
};

void declare(CommandLine& line, Arguments& a);

// These throw InvalidInput if options do not go together.

// Gives each --every to the output option before it; a single one belongs to all outputs.
void assign_every(const CommandLine& line, Arguments& a);

// Requires a file of its own for each output.
void require_distinct_outputs(const CommandLine& line, const Arguments& a);

// Whether the command line only writes the scene as a file, without any option for a run.
bool only_writes_scene(const CommandLine& line);

// The method of that name.
const Method& require_method(const std::string& name);

// The options of a run, with the step size or the tolerances that the method takes.
Options checked_options(const CommandLine& line, const Arguments& a, const Method& method);

}  // namespace qddot::simulate
