// LAMMPS' velocity Verlet over harmonic bonds, in a process of its own for each point, on one core.
// Its time is that of its loop over the steps, without start, reading and writing. LAMMPS reports
// the seconds of the loop and the processor's share of them. The share has a resolution of some
// milliseconds. So a shorter loop is followed by longer ones, which give the time of its steps.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "experiments/bench/external_program.hpp"
#include "experiments/bench/peers.hpp"
#include "experiments/kit/program.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::bench {
namespace {

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

// About how long LAMMPS takes to a step of the scene [s], to choose how many are timed.
double lammps_step_guess(const Scene& scene) {
  constexpr double of_none = 3e-7, of_one = 8e-9;
  return of_none + of_one * static_cast<double>(scene.nodes.size() + scene.springs.size());
}

// The scene as LAMMPS' data file: nodes are atoms in their order, and springs with a free end are
// harmonic bonds. Atoms of one mass are a type; pinned ones are the last.
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

// The input script: velocity Verlet over the atoms that are not pinned.
// Units lj have no factors between force, mass and time. `once yes` rebuilds no list, as bonds
// never change and nobody looks for neighbours. Atoms need no ghosts, may leave the box and are not
// sorted anew. Sorted once, with bonds kept at both ends (newton off) or another map they take
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

// Its start and its reading of the scene [s], beyond what the steps may take.
constexpr double lammps_start_limit = 30;
// A loop of so many seconds is long enough to be timed.
constexpr double long_loop = 0.25;
constexpr int short_loops = 3;

// A loop over steps, as LAMMPS reports it.
struct Loop {
  double seconds = 0;  // the processor's
  std::int64_t steps = 0;

  double step() const { return seconds / static_cast<double>(steps); }
};

struct Answer {
  std::vector<Loop> loops;
  std::vector<Node> end;  // as many as the scene has, or none
  std::string complaint;  // its first line of an error
  bool was_timed_out = false;
};

void read_report(const std::string& text, Answer& answer) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    Loop loop;
    double percent = 0;
    if (std::sscanf(line.c_str(), "Loop time of %lf on 1 procs for %ld steps", &loop.seconds,
                    &loop.steps) == 2) {
      answer.loops.push_back(loop);
    } else if (std::sscanf(line.c_str(), "%lf%% CPU use", &percent) == 1) {
      if (!answer.loops.empty()) answer.loops.back().seconds *= std::min(percent, 100.0) / 100;
    } else if (line.starts_with("ERROR") && answer.complaint.empty()) {
      answer.complaint = line;
    }
  }
}

// A line for each atom behind the last header: id x y z vx vy vz.
void read_end(const std::string& path, const Scene& scene, Answer& answer) {
  std::ifstream file(path);
  std::string word;
  while (std::getline(file, word) && !word.starts_with("ITEM: ATOMS")) {
  }
  std::vector<Node> nodes = scene.nodes;
  for (Node& node : nodes) {
    file >> word;
    for (Eigen::Vector3d* vector : {&node.position, &node.velocity}) {
      for (double& x : *vector) {
        if (!(file >> word)) return;
        x = std::strtod(word.c_str(), nullptr);  // which knows "nan"
      }
    }
  }
  answer.end = std::move(nodes);
}

Answer ask(const std::string& program, const Scene& scene, const LammpsWork& work) {
  const ScratchFolder folder;
  folder.write(lammps_data_file, lammps_data(scene));
  folder.write("script", lammps_script(scene, work));
  const std::string command = fmt::format(
      "cd {} && OMP_NUM_THREADS=1 timeout {:.0f} {} -in script -log none -nocite "
      "</dev/null 2>&1",
      kit::shell_word(folder.path("")), work.limit + lammps_start_limit, kit::shell_word(program));
  const auto [text, status] = output_of(command);
  Answer answer;
  answer.was_timed_out = status == timed_out;
  read_report(text, answer);
  if (status == 0) read_end(folder.path(lammps_end_file), scene, answer);
  return answer;
}

class Lammps final : public Peer {
 public:
  explicit Lammps(std::string program)
      : Peer("LAMMPS", Knob::step_size), program_(std::move(program)) {}

  std::vector<ForceKind> forces() const override { return {ForceKind::its_own}; }
  std::string twin() const override { return "verlet"; }
  std::string misfit(const Scene& scene) const override {
    if (has_loads(scene)) return "its input has no loads of single nodes";
    return has_quartic(scene) ? "its harmonic bonds have no quartic stiffness" : "";
  }
  std::vector<double> values(const Problem& problem) const override {
    return step_sizes(problem, 10, 4);
  }

  Run run(const Problem& problem, ForceKind, double h, double limit) override {
    const Scene& scene = problem.start;
    // Its own limit is one of the clock, on which others may have as much of the processor.
    LammpsWork work{.step_size = h, .steps = std::llround(problem.until / h), .limit = 2 * limit};
    const double guess = lammps_step_guess(scene);
    if (static_cast<double>(work.steps) * guess < long_loop) {
      work.loops = short_loops;
      work.loop_steps = std::llround(std::ceil(long_loop / guess));
    }
    const Answer answer = ask(program_, scene, work);
    Run run;
    if (answer.was_timed_out) return {.outcome = Outcome::over_budget, .seconds = limit};
    if (answer.loops.empty() || answer.end.empty()) return run;
    const Loop& whole = answer.loops.front();
    run.steps = run.force_evaluations = whole.steps;
    run.seconds = whole.seconds;
    if (whole.steps < work.steps || whole.seconds > limit) {
      run.outcome = Outcome::over_budget;
      return run;
    }
    if (answer.loops.size() > 1) {
      std::vector<double> times;
      for (const Loop& loop : answer.loops) times.push_back(loop.step());
      times.erase(times.begin());
      run.seconds = median(times) * static_cast<double>(work.steps);
      run.timed = static_cast<int>(times.size());
    }
    run.end = state_of(answer.end, scene.dimension, problem.until);
    const bool is_finite = run.end.q.allFinite() && run.end.v.allFinite();
    run.outcome = is_finite ? Outcome::reached_end : Outcome::not_finite;
    return run;
  }

 private:
  std::string program_;
};

}  // namespace

std::string why_no_lammps(const std::string& program) {
  if (output_of(fmt::format("command -v {}", kit::shell_word(program))).second != 0) {
    return "LAMMPS is not there: apt-get install lammps";
  }
  Scene scene;
  scene.nodes = {{.pinned = true}, {.position = {1, 0, 0}, .mass = 1}};
  scene.springs = {{{0, 1}, {.stiffness = 1, .rest_length = 1}}};
  const Answer answer = ask(program, scene, {.step_size = 0.1, .steps = 1, .limit = 1});
  if (!answer.end.empty()) return "";
  const std::string complaint = answer.was_timed_out       ? "it does not end"
                                : answer.complaint.empty() ? "it says nothing of why"
                                                           : answer.complaint;
  return fmt::format("LAMMPS is left out, as {} fails on two atoms and a bond: {}", program,
                     complaint);
}

std::unique_ptr<Peer> lammps(const std::string& program) {
  return std::make_unique<Lammps>(program);
}

}  // namespace qddot::bench
