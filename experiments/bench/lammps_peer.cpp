// LAMMPS' velocity Verlet over harmonic bonds, in a process of its own for each point, on one core;
// lammps_input.cpp writes its input. Its time is that of its loop over the steps, without start,
// reading and writing. LAMMPS reports the seconds of the loop and the processor's share of them.
// The share has a resolution of some milliseconds. So a shorter loop is followed by longer ones,
// which give the time of its steps.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <fmt/format.h>

#include "experiments/bench/external_program.hpp"
#include "experiments/bench/lammps_input.hpp"
#include "experiments/bench/peers.hpp"
#include "experiments/kit/program.hpp"
#include "qddot/measure/motion/timing.hpp"

namespace qddot::bench {
namespace {

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
