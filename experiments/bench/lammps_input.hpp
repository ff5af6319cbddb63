#pragma once

#include <cstdint>
#include <string>

#include "qddot/scene/scene.hpp"

namespace qddot::bench {

// The work of LAMMPS: `steps` steps of `step_size` [s], for at most `limit` seconds on the clock.
// It then writes the positions of the atoms and goes on for `loops` times `loop_steps` steps, which
// are timed alone.
struct LammpsWork {
  double step_size = 0;
  std::int64_t steps = 0;
  double limit = 0;
  int loops = 0;
  std::int64_t loop_steps = 0;
};

// Names of the files that the script reads and writes in its folder.
constexpr const char* lammps_data_file = "scene.data";
constexpr const char* lammps_end_file = "end.dump";

// About how long LAMMPS takes to a step of the scene [s], to choose how many are timed.
double lammps_step_guess(const Scene& scene);

// The scene as LAMMPS' data file: nodes are atoms in their order, and springs with a free end are
// harmonic bonds. Atoms of one mass are a type; pinned ones are the last.
std::string lammps_data(const Scene& scene);

// The input script: velocity Verlet over the atoms that are not pinned.
std::string lammps_script(const Scene& scene, const LammpsWork& work);

}  // namespace qddot::bench
