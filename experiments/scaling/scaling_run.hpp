#pragma once

#include <string>
#include <vector>

#include "experiments/kit/study.hpp"
#include "experiments/scaling/phase_table.hpp"
#include "qddot/algebra/solver.hpp"
#include "qddot/integrators/method.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::scaling {

// How far a measurement of scaling goes, and how it steps.
struct ScalingLimits {
  double seconds;    // that a step and its analysis may take
  double bytes;      // that the process may allocate
  double step_size;  // h of implicit methods [s]
  Reductions reductions;
};

// A method and who solves its implicit steps.
struct SolvedMethod {
  const Method* method;
  Solver solver;

  // As tables name it: the method's name, and behind a colon the solver's if that is not the
  // multifrontal one.
  std::string name() const {
    return solver == Solver::multifrontal ? method->name
                                          : method->name + ":" + std::string(qddot::name(solver));
  }
};

// The methods of those names, each with all solvers if it uses one. Throws InvalidInput unless all
// can run the scenes with fixed steps, and for unknown and repeated names.
std::vector<SolvedMethod> solved_methods(const SizedScenes& scenes, const Reductions& reductions,
                                         const std::vector<std::string>& methods,
                                         const std::vector<std::string>& solvers);

// The rate at which f(q) is evaluated, and the traffic and work of one evaluation.
struct ForceRate {
  double seconds = 0;  // of one evaluation
  // The bytes that one evaluation must move, each array once, and its operations (a root and a
  // division are one each). The bytes are also the working set.
  double bytes = 0, flops = 0;
};

// One scene at one size: the origin of its numbers, and the rate of its f.
struct ScalingSize {
  std::string scene, hash;
  double nodes, springs;
  Index unknowns = 0;
  ForceRate force{};
  double triad = 0;  // [bytes/s], over arrays of as many bytes as the force's
};

// A scene that was not measured from that many nodes on, with that method or with any.
struct LeftOut {
  std::string scene, method;  // no method: any
  double nodes;
  std::string why;
};
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(LeftOut, scene, method, nodes, why)

// The results of a scene at one size, or of all.
struct ScalingResults {
  std::vector<ScalingSize> sizes{};    // without scenes that do not fit the limits
  std::vector<std::string> methods{};  // those that fit the limits, of one size
  std::vector<PhaseCost> costs{};
  std::vector<LeftOut> left_out{};
  bool has_failed = false;  // some run did not reach its end; it is among what is left out

  void leave_out(const std::string& method, const std::string& why) {
    left_out.push_back({sizes.back().scene, method, sizes.back().nodes, why});
  }
  void add(const std::string& method, const std::string& phase, double seconds, double bytes) {
    const ScalingSize& size = sizes.back();
    costs.push_back({size.scene, size.nodes, size.springs, method, phase, seconds, bytes});
  }
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

  const ScalingResults& results() const { return all_; }

 private:
  ScalingResults measured_size(const SizedScenes& scenes, double size,
                               std::vector<SolvedMethod> methods) const;
  void measure_method(const SolvedMethod& solved, const Model& scene, double step_size,
                      ScalingResults& result) const;
  bool fits(const SizedScenes& scenes, const std::string& method,
            const std::vector<std::string>& phases, double nodes, double memory,
            ScalingResults& result) const;

  ScalingLimits limits_;
  ScalingResults all_{};
};

}  // namespace qddot::scaling
