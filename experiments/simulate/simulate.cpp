// One run of one method on one scene: its end, its motion and its energy. If an accuracy is given
// in place of a method, the fastest run that reaches it.
//
//   simulate --scene cloth --method verlet --step-size 5e-4 --until 0.1 --final end.csv
//   simulate --scene cloth --method arkode_dirk4 --rtol 1e-5 --trajectory path.csv --every 0.01
//   simulate --scene cloth --accuracy 1e-4 --final end.csv
//   simulate --scene cloth --accuracy 1e-4 --motion cloth.vtkhdf --every 0.001
//   simulate --scene cloth --write-scene cloth.toml
//   simulate --scene cloth --explain
//   simulate --list-methods
//   simulate --list-scenes
#include <algorithm>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/simulate/outputs.hpp"
#include "experiments/simulate/run.hpp"
#include "qddot/scene/explain.hpp"
#include "qddot/scene/generators.hpp"

namespace qddot::simulate {
namespace {

const char* yes(bool holds) { return holds ? "yes" : "no"; }

// The damping that a method takes.
const char* damping_word(Damped damped) {
  return damped == Damped::by_any ? "any" : damped == Damped::by_air ? "air" : "none";
}

// Print the methods, or the scene generators with their parameters, as a table or as CSV.
void print_methods(bool as_csv, bool with_newer) {
  std::vector<Method> listed = methods();
  if (with_newer) std::ranges::copy(newer_methods(), std::back_inserter(listed));
  if (as_csv) {
    Csv csv(columns_in(
        "name order family knob implicit symplectic needs_stiffness accepts_massless "
        "needs_constant_stiffness needs_split needs_laplacian takes_iterations summary source "
        "stock_of needs_sundials damping why_not_damped driving needs_rods"));
    for (const Method& m : listed) {
      csv.row(m.name, m.order, family_name(m.family), knob_name(m.knob), yes(m.is(Trait::implicit)),
              yes(m.is(Trait::symplectic)),
              yes(m.asks(Need::stiffness) || m.is(Trait::bounds_steps)),
              yes(m.is(Trait::accepts_massless)), yes(m.asks(Need::constant_stiffness)),
              yes(m.asks(Need::split_forces)), yes(m.asks(Need::laplacian)),
              yes(m.listens_to(Option::iterations)), m.summary, m.source, m.stock_of,
              sundials_needed(m), damping_word(m.takes_damping()), m.why_not_damped,
              m.asks(Need::autonomous) ? "refuses" : "keeps order", yes(m.asks(Need::constraints)));
    }
    fmt::print("{}", csv.text());
    return;
  }
  fmt::print("{:<24} {:>5}  {:<12} {:<9}  {}\n", "name", "order", "family", "knob", "what it is");
  for (const Method& m : listed) {
    fmt::print("{:<24} {:>5}  {:<12} {:<9}  {}\n", m.name, m.order, family_name(m.family),
               knob_name(m.knob), m.summary);
  }
}

void print_generators(bool as_csv) {
  if (as_csv) {
    Csv csv({"scene", "parameter", "standard", "low", "high", "meaning", "summary"});
    for (const Generator& g : generators()) {
      for (const GeneratorParameter& p : g.parameters) {
        csv.row(g.name, p.name, p.standard, p.low, p.high, p.meaning, g.summary);
      }
    }
    fmt::print("{}", csv.text());
    return;
  }
  for (const Generator& g : generators()) {
    fmt::print("{:<12} {}\n", g.name, g.summary);
    for (const GeneratorParameter& p : g.parameters) {
      fmt::print("  {:<22} {:>8}  {}\n", p.name, p.standard, p.meaning);
    }
  }
}

int simulate(const Arguments& a) {
  if (a.list_methods) {
    print_methods(a.csv, a.newer);
    return done;
  }
  if (a.list_scenes) {
    print_generators(a.csv);
    return done;
  }
  require_given(a.scene->name, "--scene", "a generator's name or a scene file");
  if (only_writes_scene(a.p)) {
    require_distinct_outputs(a);
    WholeFile file(a.written_scene_path);  // may be the scene's own, which is read after this
    write_scene(file, load(a.scene));
    return done;
  }
  if (a.explain) {
    const Subject subject = subject_of(a.scene);
    fmt::print("{}",
               explanation_in_words(explain(subject.start(), subject.model), subject.start()));
    return done;
  }
  return a.accuracy.is_given() ? answer(a) : run_method(a);
}

}  // namespace
}  // namespace qddot::simulate

int main(int argc, char** argv) {
  using namespace qddot;
  Program p("simulate", "Runs one integrator on one scene.", {has_threads});
  const simulate::Arguments arguments{p};
  return p.run(argc, argv, [&] { return simulate::simulate(arguments); });
}
