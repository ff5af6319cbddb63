#pragma once

#include <string>
#include <vector>

#include "experiments/kit/study.hpp"
#include "experiments/scaling/force_rate.hpp"
#include "experiments/scaling/phase_table.hpp"
#include "qddot/algebra/solver.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/scene/reduce/reduced_scene.hpp"

namespace qddot::scaling {

// The limits of a measurement of scaling, and the steps.
struct ScalingLimits {
  double seconds;    // of a step and its analysis
  double bytes;      // allocated by the process
  double step_size;  // h of implicit methods [s]
  Reductions reductions;
};

// A method and the solver of its implicit steps.
struct SolvedMethod {
  const Method* method;
  Solver solver;

  // The name in tables: the method's name, with a colon and the solver's if that is not the
  // multifrontal one.
  std::string name() const;
};

// One scene at one size: the origin of its numbers, and the rate of its f.
struct ScalingSize {
  std::string scene, hash;
  double nodes, springs;
  Index unknowns = 0;
  ForceRate force{};
  double triad = 0;  // [bytes/s], over arrays of the force's size
};

// Sizes that were not measured: the scene from this number of nodes on, with this method or with
// any.
struct LeftOut {
  std::string scene, method;  // empty method: any
  double nodes;
  std::string why;
};

// Costs of steps by scene, size, method and phase, from small scenes to large ones. A size with
// expected costs beyond the limits is left out, with all larger ones. The expectation follows from
// theory and the size before.
class ScalingRun {
 public:
  explicit ScalingRun(const ScalingLimits& limits) : limits_(limits) {}

  // The scene at about each of these numbers of nodes, ascending, with the methods. Each size is a
  // piece of the study.
  void measure(Study& study, const SizedScenes& scenes, const std::vector<double>& sizes,
               std::vector<SolvedMethod> methods);

  const std::vector<PhaseCost>& costs() const { return costs_; }
  const std::vector<ScalingSize>& sizes() const { return sizes_; }
  const std::vector<LeftOut>& left_out() const { return left_out_; }
  // Whether some run did not reach its end; it is among what is left out.
  bool has_failed() const { return has_failed_; }

 private:
  // Measures the scene at one size with all methods that fit, and erases those that do not. False
  // if the scene itself does not fit.
  bool measure_size(const SizedScenes& scenes, double size, std::vector<SolvedMethod>& methods);
  void measure_methods(const SizedScenes& scenes, const ReducedScene& scene,
                       std::vector<SolvedMethod>& methods);
  void measure_method(const SolvedMethod& solved, const ReducedScene& scene, double step_size);
  bool fits(const SizedScenes& scenes, const std::string& method,
            const std::vector<std::string>& phases, double nodes, double memory);
  void leave_out(const std::string& method, double nodes, std::string why);
  void add(const std::string& method, const std::string& phase, double seconds, double bytes);

  ScalingLimits limits_;
  std::vector<PhaseCost> costs_;
  std::vector<ScalingSize> sizes_;  // the last one is being measured
  std::vector<LeftOut> left_out_;
  bool has_failed_ = false;
};

}  // namespace qddot::scaling
