// Which methods can be run backwards? Each runs to the end, turns its velocities round and runs for
// the same time. reversal.csv has the distance to the start, by method and step size.
//
//   reversal --scene cloth --until 0.05 --steps 5e-4,2.5e-4 --out results/reversal
#include "experiments/kit/program.hpp"
#include "qddot/integrators/registry.hpp"

using namespace qddot;

namespace {

struct Row {
  std::string method;
  double step_size, distance;  // [s], [m]; NaN if a run does not reach its end
};

Row there_and_back(const Method& method, double step_size, const Subject& subject) {
  const Options options = options_for(method, step_size, subject.model);
  State state = subject.model.initial();
  for (int i = 0; i < 2; ++i) {
    const auto run = make_integrator(method, subject.system(), options);
    const Summary end = run->advance(state, subject.until, {}, interruption());
    if (end.outcome != Outcome::reached_end) return {method.name, step_size, NAN};
    state = {.t = 0, .q = state.q, .v = -state.v};
  }
  return {method.name, step_size, (state.q - subject.model.initial().q).lpNorm<Eigen::Infinity>()};
}

}  // namespace

int main(int argc, char** argv) {
  Program p("reversal", "Runs forward and back: how far from the start?", {has_resume, has_shares});
  auto scene = p.scene();
  auto until = p.until();
  auto methods = p.methods();
  auto steps = p.steps({1e-3, 1e-4});
  auto& table = p.table<Row>(
      "reversal.csv",
      {{"method", &Row::method}, {"h", &Row::step_size}, {"distance", &Row::distance}});
  return p.run(argc, argv, [&] {
    const Subject subject = subject_of(scene, until);
    require_kept_energy(subject.drawn, subject.source, "its motion cannot be run back");
    return p.each(subject, select_fixed_step(methods, subject), steps, table,
                  [&](auto& method, double h) { return there_and_back(method, h, subject); });
  });
}
