#include "experiments/bench/lammps_input.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "experiments/bench/problem.hpp"

namespace qddot::bench {
namespace {

// Types in the order in which they are first seen, from 1.
template <class Key>
class Types {
 public:
  int of(const Key& key) {
    const auto [at, is_new] = numbers_.try_emplace(key, static_cast<int>(keys_.size()) + 1);
    if (is_new) keys_.push_back(key);
    return at->second;
  }
  const std::vector<Key>& keys() const { return keys_; }

 private:
  std::map<Key, int> numbers_;
  std::vector<Key> keys_;
};

Types<double> mass_types(const Scene& scene) {
  Types<double> types;
  for (const Node& node : scene.nodes) {
    if (!node.pinned) types.of(node.mass);
  }
  return types;
}

// Atoms must be inside when they are read; where they go later is not looked at.
std::string box_of(const Scene& scene) {
  std::string text;
  for (int d = 0; d < 3; ++d) {
    double low = 0, high = 0;
    for (const Node& node : scene.nodes) {
      low = std::min(low, node.position[d]);
      high = std::max(high, node.position[d]);
    }
    const double margin = 1 + (high - low);
    const char axis = "xyz"[d];
    text += fmt::format("{:.17g} {:.17g} {}lo {}hi\n", low - margin, high + margin, axis, axis);
  }
  return text;
}

}  // namespace

double lammps_step_guess(const Scene& scene) {
  constexpr double of_none = 3e-7, of_one = 8e-9;
  return of_none + of_one * static_cast<double>(scene.nodes.size() + scene.springs.size());
}

std::string lammps_data(const Scene& scene) {
  Types<double> masses = mass_types(scene);
  Types<std::pair<double, double>> laws;
  std::string atoms, velocities, bonds;
  const auto pinned_type = masses.keys().size() + 1;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    const Node& node = scene.nodes[i];
    const auto &x = node.position, &v = node.velocity;
    const auto type = node.pinned ? pinned_type : static_cast<std::size_t>(masses.of(node.mass));
    fmt::format_to(std::back_inserter(atoms), "{} 1 {} {:.17g} {:.17g} {:.17g}\n", i + 1, type,
                   x[0], x[1], x[2]);
    fmt::format_to(std::back_inserter(velocities), "{} {:.17g} {:.17g} {:.17g}\n", i + 1, v[0],
                   v[1], v[2]);
  }
  int count = 0;
  for (const Spring& spring : scene.springs) {
    if (!has_free_end(scene, spring)) continue;
    const int type = laws.of({spring.law.stiffness, spring.law.rest_length});
    fmt::format_to(std::back_inserter(bonds), "{} {} {} {}\n", ++count, type, spring.nodes[0] + 1,
                   spring.nodes[1] + 1);
  }
  std::string text =
      fmt::format("qddot\n\n{} atoms\n{} bonds\n{} atom types\n{} bond types\n\n{}\nMasses\n\n",
                  scene.nodes.size(), count, pinned_type, laws.keys().size(), box_of(scene));
  for (const double mass : masses.keys())
    text += fmt::format("{} {:.17g}\n", masses.of(mass), mass);
  text += fmt::format("{} 1\n", pinned_type);
  if (count > 0) {
    text += "\nBond Coeffs\n\n";
    for (const auto& law : laws.keys()) {
      // Its energy is K (r - r0)^2, without the half.
      text += fmt::format("{} {:.17g} {:.17g}\n", laws.of(law), law.first / 2, law.second);
    }
  }
  text += "\nAtoms # bond\n\n" + atoms + "\nVelocities\n\n" + velocities;
  if (count > 0) text += "\nBonds\n\n" + bonds;
  return text;
}

// Units lj have no factors between force, mass and time. `once yes` rebuilds no list, as bonds
// never change and nobody looks for neighbours; so atoms need no ghosts, may leave the box and are
// not sorted anew. Sorted once, with bonds kept at both ends (newton off) or another map they take
// as long, on cloth, lattice and meshes. Weights of 1 leave out lists that only pair forces read.
std::string lammps_script(const Scene& scene, const LammpsWork& work) {
  const Eigen::Vector3d& g = scene.gravity;
  std::string text = fmt::format(
      "units lj\n"
      "atom_style bond\n"
      "atom_modify map array sort 0 0\n"
      "newton on\n"
      "boundary f f f\n"
      "special_bonds lj/coul 1 1 1\n"
      "bond_style harmonic\n"
      "pair_style none\n"
      "read_data {}\n"
      "neigh_modify once yes\n",
      lammps_data_file);
  const auto masses = mass_types(scene).keys().size();
  text += fmt::format("group free type 1:{}\n", masses);
  if (g.norm() > 0) {
    text += fmt::format("fix weight free gravity {:.17g} vector {:.17g} {:.17g} {:.17g}\n",
                        g.norm(), g[0], g[1], g[2]);
  }
  // The clock is looked at every 50 ms or so.
  const double checked = std::max(1.0, 0.05 / lammps_step_guess(scene));
  const auto limit = static_cast<std::int64_t>(std::ceil(work.limit));
  text += fmt::format(
      "fix motion free nve\n"
      "run_style verlet\n"
      "thermo_style custom step\n"
      "thermo 0\n"
      "timestep {:.17g}\n"
      "timer loop timeout {}:{:02}:{:02} every {:.0f}\n"
      "run {}\n"
      "write_dump all custom {} id x y z vx vy vz modify sort id format float %.17g\n",
      work.step_size, limit / 3600, limit / 60 % 60, limit % 60, checked, work.steps,
      lammps_end_file);
  for (int i = 0; i < work.loops; ++i) text += fmt::format("run {} pre no\n", work.loop_steps);
  return text;
}

}  // namespace qddot::bench
