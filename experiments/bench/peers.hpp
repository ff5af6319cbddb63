#pragma once

#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "experiments/bench/problem.hpp"
#include "qddot/integrators/method.hpp"

namespace qddot::bench {

// How runs of a peer ended. The end and the counts mean something only where they reached it.
struct Run {
  Outcome outcome = Outcome::solver_failed;
  State end{};
  double seconds = 0;  // processor time of a run, set-up left out: median of `timed` runs
  int timed = 1;
  std::int64_t steps = 0, force_evaluations = 0;
};

// Somebody else's solver, set up as its users would, whose accuracy is set by one knob.
class Peer {
 public:
  Peer(std::string name, Knob knob) : name_(std::move(name)), knob_(knob) {}
  virtual ~Peer() = default;
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  const std::string& name() const { return name_; }
  Knob knob() const { return knob_; }

  // One run with the knob at `value` [s, or relative], over budget after `limit` seconds. A peer
  // that is slow to start may make and time several. Never throws what the solver throws.
  virtual Run run(const Problem& problem, ForceKind force, double value, double limit) = 0;
  // Values of the knob from coarse to fine.
  virtual std::vector<double> values(const Problem& problem) const = 0;
  // Whose f it can be given.
  virtual std::vector<ForceKind> forces() const { return {ForceKind::plain, ForceKind::ours}; }
  // Which of our methods takes the same steps, but for rounding; empty where none does.
  virtual std::string twin() const { return {}; }
  // The reason why the peer cannot run the scene, as a clause; empty if it can.
  virtual std::string misfit(const Scene&) const { return {}; }
  // Whether it is one of SUNDIALS' implicit methods.
  virtual bool is_stock_implicit() const { return false; }

 private:
  std::string name_;
  Knob knob_;
};

// 1e-2 to 1e-13, so many in a factor of ten.
std::vector<double> tolerances(int in_a_decade);
// Step sizes [s], `in_a_decade` in each factor of ten, each of which divides the run. The largest
// one has h w = 16 for the fastest vibration at the start, above the limit of methods of a dozen
// stages.
std::vector<double> step_sizes(const Problem& problem, int in_a_decade, int decades);

// Adds the processor time [s] of this thread from construction to destruction, also after an
// exception. It is the wall time if nothing else runs. Time of other processes does not count; else
// it would be added to long runs alone.
class ProcessorTime {
 public:
  explicit ProcessorTime(double& seconds) : seconds_(seconds), start_(now()) {}
  ~ProcessorTime() { seconds_ += now() - start_; }
  ProcessorTime(const ProcessorTime&) = delete;
  ProcessorTime& operator=(const ProcessorTime&) = delete;

 private:
  static double now() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }

  double& seconds_;
  double start_;
};

// boost::odeint's Dormand-Prince 5(4) with its step control.
std::unique_ptr<Peer> odeint_dopri5();
// boost::odeint's symplectic Runge-Kutta-Nystroem method of order 4 by McLachlan, fixed steps.
std::unique_ptr<Peer> odeint_mclachlan();
// SUNDIALS' ERKStep of order 4.
std::unique_ptr<Peer> arkode_erk4();
// One of our own methods, on the scene's smallest system or on the one with pins alone left out.
std::unique_ptr<Peer> our_method(const std::string& method, bool smallest);
// An implicit method of SUNDIALS with SUNDIALS' own matrix and solver: one of ours with a stock_of.
std::unique_ptr<Peer> stock_implicit(const std::string& method);
// A method of SciPy's solve_ivp: DOP853, Radau or BDF, in a process of its own. `force_library`:
// the path of force_library.cpp's library, through which Python calls our f; empty where there is
// none.
std::unique_ptr<Peer> scipy(const std::string& method, const std::string& force_library);
// Whether Debian's Python has SciPy.
bool has_scipy();
// Bullet's soft body; nullptr where the program was built without Bullet.
std::unique_ptr<Peer> bullet();
// LAMMPS' velocity Verlet over harmonic bonds, run by that program.
std::unique_ptr<Peer> lammps(const std::string& program = "lmp");
// Why there is no LAMMPS, in a sentence: the program is not found, or fails on the smallest scene.
// Empty where it works.
std::string why_no_lammps(const std::string& program = "lmp");

// The names of our explicit methods that any scene can have, those of high order first.
std::vector<std::string> explicit_methods();

// Which peers are missing, and why.
class LeftOut {
 public:
  // Keeps the sentence and prints it.
  void add(const std::string& sentence);
  const std::vector<std::string>& sentences() const { return sentences_; }

 private:
  std::vector<std::string> sentences_;
};

// The installed peers whose names begin with one of `beginnings`, or all installed ones if there is
// none. `force_library`: see scipy().
std::vector<std::unique_ptr<Peer>> selected_peers(const std::vector<std::string>& beginnings,
                                                  const std::string& force_library,
                                                  LeftOut& left_out);

// Those that can do all that is in the scene. Borrows them.
std::vector<Peer*> fitting(const std::vector<std::unique_ptr<Peer>>& peers, const Scene& scene,
                           LeftOut& left_out);

}  // namespace qddot::bench
