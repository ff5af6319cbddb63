#pragma once

#include <string>
#include <vector>

#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/program.hpp"
#include "qddot/integrators/option_table.hpp"
#include "qddot/integrators/registry.hpp"

namespace qddot::simulate {

// The options of simulate, as a program declares them.
struct Arguments {
  Program& p;
  Argument<SceneChoice> scene = p.scene();
  Argument<std::string> method = p.word("--method", "the method's name (see --list-methods)");
  Argument<double> accuracy =
      p.number("--accuracy",
               "a relative error, in place of --method: the fastest method for it is found and "
               "run, and another run bounds its error");
  Argument<std::string> accuracy_of = accuracy_of_option(p);
  Argument<double> step_size = p.number("--step-size", option_row("step_size").words);
  Argument<double> rtol = p.number("--rtol", option_row("rtol").words);
  Argument<double> atol = p.number("--atol", option_row("atol").words);
  Argument<Options> options = p.method_options();
  Argument<double> until = p.until();
  Argument<std::string> final_path =
      p.word("--final", "CSV of all nodes at the end: node,x,y,z,vx,vy,vz");
  Argument<std::string> trajectory_path =
      p.word("--trajectory", "CSV of all nodes over time: t,node,x,...");
  Argument<std::string> energy_path = p.word("--energy",
                                             "CSV of t,kinetic,potential,total, of damped scenes "
                                             "dissipated, of driven ones driven, of ones "
                                             "that may break released, and of all these "
                                             "balance");
  Argument<std::string> breaks_path =
      p.word("--breaks",
             "CSV of the springs that broke: t,spring,node,other_node,strain,energy, "
             "and with --accuracy t_error, a bound of the time's error");
  Argument<std::string> strain_path =
      p.word("--strain",
             "CSV of the extreme strains and tensions of each spring on the way, and "
             "when they were");
  Argument<std::string> motion_path =
      p.word("--motion",
             "all nodes over time in 32-bit floats, with springs and faces: .vtkhdf for "
             "ParaView, h5py and MATLAB (with an .xdmf), .pc2 for Blender (with an .obj)");
  Argument<std::vector<std::string>> motion_fields =
      p.words("--motion-fields",
              "a,b,...: fields of a .vtkhdf beside positions, of velocity, kinetic_energy, "
              "strain, or none (default: all)");
  Argument<std::string> written_scene_path =
      p.word("--write-scene",
             "TOML file of the scene as nodes and springs, exact to the last bit; without "
             "--method the program does only this");
  Argument<std::vector<double>> every = p.repeated_number(
      "--every",
      "the time between samples in s; samples do not change steps of fixed size. Give "
      "it after the output that it is for, or once for all outputs");
  Argument<bool> explain =
      p.flag("--explain", "print the reductions of the scene with their reasons, and run nothing");
  Argument<bool> list_methods = p.flag("--list-methods", "print all methods");
  Argument<bool> newer =
      p.flag("--newer", "list also the methods that a newer SUNDIALS would bring");
  Argument<bool> list_scenes =
      p.flag("--list-scenes", "print the scene generators and their parameters");
  Argument<bool> csv = p.flag("--csv", "print lists as CSV");
};

// These throw InvalidInput if options do not go together.

// The times between samples [s] of each output; 0 if it is not asked for.
struct Every {
  double trajectory = 0, energy = 0, motion = 0;
};
// Gives each --every to the output option before it; a single one belongs to all outputs.
Every every_of(const Arguments& a);

// Requires a file of its own for each output.
void require_distinct_outputs(const Arguments& a);

// Whether the command line only writes the scene as a file, without any option for a run.
bool only_writes_scene(const Program& program);

// The method of that name.
const Method& require_method(const std::string& name);

// The options of a run, with the step size or the tolerances that the method takes.
Options checked_options(const Arguments& a, const Method& method);

}  // namespace qddot::simulate
