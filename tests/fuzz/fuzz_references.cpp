// Does the certified error of a reference bound its true error?
//
//   fuzz_references --count 200 --seed 1
//   fuzz_references --count 400 --seed 30000000 --hard
//
// The reference of each random scene is compared with the motion of the scene as drawn. That motion
// is computed in quadruple precision by an independent model (tests/independent). The program
// prints the scenes whose error is larger than certified, the fraction of scenes whose error is
// not, and quantiles of the certified over the true error. Status 1 if less than 99 % are covered.
// With --hard the motions are the hard cases of the study `advice`, own forces among them. These
// are longer, so that their truth is computed in extended precision. Where a scene's error seems
// larger than certified, it is computed again in quadruple precision.
//
// A motion that was reduced by symmetry is the drawn one only while the rounding of the start,
// which breaks the symmetry, does not grow. If this rounding is known to move the end by more than
// the certified error, the error may be ten times that, and the scene counts as out of symmetry.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "experiments/advice/hard_case.hpp"
#include "experiments/kit/plain_motion.hpp"
#include "qddot/measure/reference/reference.hpp"
#include "tests/independent/random_scene.hpp"

namespace qddot {
namespace {

// Far below what a double resolves, and far above what quadruple precision does.
constexpr double plain_tolerance = 1e-24;
constexpr long double hard_tolerance = 1e-17L;
// The truth is given up if a kink of f or a spring that turns over holds the steps down.
constexpr int most_plain_steps = 1000, most_hard_steps = 20000;
// Kinks that a truth may cross. The error of the shortest step is below what doubles resolve, and
// above what quadruple precision does.
constexpr int most_plain_kinks = 0, most_hard_kinks = 1000;

struct Tally {
  int made = 0, out_of_symmetry = 0, chaotic = 0, without_reference = 0, without_truth = 0,
      skipped = 0;
  std::vector<double> position, velocity, energy;  // certified over true errors
};

template <class Real>
double magnitude(Real x) {
  return std::abs(static_cast<double>(x));
}

// An error is absolute where nothing moves (see Errors).
double divided(double error, double scale) { return scale > 0 ? error / scale : error; }

// The reference's true errors in the units of what it certifies, over the nodes with mass.
template <class Real, class Plain>
Errors true_errors(const Model& scene, const Scene& drawn, const Reference& reference,
                   const PlainMotion<Real, Plain>& motion, Real energy) {
  const auto nodes = scene.expand(reference.end);
  const auto truth = motion.state();
  Errors errors = no_error;
  const auto distance = [](const Eigen::Vector3d& a, const std::vector<Real>& b, std::size_t i) {
    double squares = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = magnitude(Real(a[static_cast<Eigen::Index>(c)]) - b[3 * i + c]);
      squares += d * d;
    }
    return std::sqrt(squares);
  };
  for (const PartScale& part : reference.scales.parts) {
    for (const std::size_t i : part.nodes) {
      if (drawn.nodes[i].mass == 0) continue;
      errors.position = std::max(errors.position, divided(distance(nodes[i].position, truth.x, i),
                                                          reference.scales.displacement_of(part)));
      errors.velocity = std::max(errors.velocity, divided(distance(nodes[i].velocity, truth.v, i),
                                                          reference.scales.speed_of(part)));
    }
  }
  // Errors of E(0) as the reference gives it, and of E as it is computed from the end.
  for (const double computed : {reference.energy, scene.energy(reference.end)}) {
    const double error = magnitude(Real(computed) - energy);
    if (reference.scales.kinetic > 0)
      errors.energy = std::max(errors.energy, error / reference.scales.kinetic);
  }
  return errors;
}

// Whether none of the errors is larger than certified.
bool covers(const Errors& certified, const Errors& errors) {
  return certified.position >= errors.position && certified.velocity >= errors.velocity &&
         certified.energy >= errors.energy;
}

// The errors by a truth in quadruple precision; empty if that takes too long.
std::optional<Errors> errors_by_quadruple(const Model& scene, const Scene& drawn,
                                          const Reference& reference) {
  PlainMotion<Quadruple> motion(drawn, plain_tolerance);
  const auto start = motion.state();
  const Quadruple energy = motion.model().energy(start.x, start.v);
  if (!motion.advance(*drawn.until, most_hard_steps) || motion.forced_steps() > most_hard_kinks)
    return {};
  return true_errors(scene, drawn, reference, motion, energy);
}

// The motion whose reference is tried, the model of it, and its truth, not yet advanced.
template <class Motion>
void try_one(std::uint64_t seed, const std::string& kind, const Scene& drawn, bool is_scene,
             const Model& scene, Motion motion, int most_steps, int most_kinks, double seconds,
             bool shows_all, Tally& tally) {
  if (!scene.massless_nodes().empty() || scene.system().size() == 0) {
    ++tally.skipped;
    return;
  }
  const double until = *drawn.until;
  std::optional<Reference> made;
  try {
    made = make_reference(scene, until, seconds, is_scene ? &drawn : nullptr);
  } catch (const NoReference&) {
    fmt::print("seed {:<5} {:<16} has no reference\n", seed, kind);
    ++tally.without_reference;
    return;
  }
  const Reference& reference = *made;
  const auto start = motion.state();
  const auto energy = motion.model().energy(start.x, start.v);
  if (!motion.advance(until, most_steps) || motion.forced_steps() > most_kinks) {
    ++tally.without_truth;
    return;
  }
  ++tally.made;
  Errors certified = reference.certified;
  if (reference.is_beyond_horizon()) {
    ++tally.chaotic;
    return;
  }
  Errors errors = true_errors(scene, drawn, reference, motion, energy);
  if (is_scene && !covers(certified, errors))
    errors = errors_by_quadruple(scene, drawn, reference).value_or(errors);
  const auto& out = reference.out_of_symmetry;
  const bool is_out = out && out->effect > certified.position;
  if (is_out) {
    // One push by chance stands for all of them.
    ++tally.out_of_symmetry;
    certified.position = std::max(certified.position, 10 * out->effect);
    // Nodes that part at a rate r have velocities r times as large.
    const double seconds_of_motion =
        reference.scales.speed > 0 ? reference.scales.displacement / reference.scales.speed : 1;
    certified.velocity = std::max(
        certified.velocity, 10 * out->effect * std::max(1.0, out->lyapunov * seconds_of_motion));
  }
  const auto compare = [&](const char* what, double bound, double error, std::vector<double>& all) {
    all.push_back(bound / error);
    if (bound >= error && !shows_all) return;
    fmt::print(
        "seed {:<5} {:<16} {:<9} certified {:.2e}  error {:.2e}  ratio {:<8.3g} {:.2g} s, {}{}\n",
        seed, kind, what, bound, error, bound / error, reference.seconds, reference.made_by,
        is_out ? " (out of symmetry)" : "");
  };
  compare("position", certified.position, errors.position, tally.position);
  compare("velocity", certified.velocity, errors.velocity, tally.velocity);
  compare("energy", certified.energy, errors.energy, tally.energy);
}

// Prints coverage and quantiles of the ratios; the part covered.
double tell(const char* what, std::vector<double> ratios) {
  if (ratios.empty()) return 1;
  std::ranges::sort(ratios);
  const auto missed = std::ranges::count_if(ratios, [](double ratio) { return !(ratio >= 1); });
  const double covered = 1 - static_cast<double>(missed) / static_cast<double>(ratios.size());
  fmt::print("{:<9} {} of {} covered ({:.1f} %); certified over true error:", what,
             std::ssize(ratios) - missed, ratios.size(), 100 * covered);
  for (const double part : {0.01, 0.1, 0.5, 0.9}) {
    const auto i = static_cast<std::size_t>(part * static_cast<double>(ratios.size() - 1));
    fmt::print("  {:g} %: {:.3g}", 100 * part, ratios[i]);
  }
  fmt::print("\n");
  return covered;
}

void try_random(std::uint64_t seed, double seconds, bool shows_all, Tally& tally) {
  const RandomScene random = random_scene(seed);
  try_one(seed, random.kind, random.scene, true, Model(random.scene),
          PlainMotion<Quadruple>(random.scene, plain_tolerance), most_plain_steps, most_plain_kinks,
          seconds, shows_all, tally);
}

void try_hard(std::uint64_t number, double seconds, bool shows_all, Tally& tally) {
  using namespace judged_advice;
  const HardCase hard = hard_case(number);
  const auto try_model = [&](const auto& model) {
    try_one(number, hard.kind, hard.scene, hard.pairs.empty(), hard.model(),
            PlainMotion(model, hard_tolerance), most_hard_steps, most_hard_kinks, seconds,
            shows_all, tally);
  };
  if (hard.pairs.empty())
    try_model(PlainModel<long double>(hard.scene));
  else
    try_model(PlainPairs<long double>(hard.scene, hard.pairs));
}

int fuzz(std::uint64_t count, std::uint64_t seed, double seconds, bool are_hard, bool shows_all) {
  Tally tally;
  for (std::uint64_t i = 0; i < count; ++i)
    (are_hard ? try_hard : try_random)(seed + i, seconds, shows_all, tally);
  fmt::print(
      "{} scenes: {} references held against the truth, {} of them where a rounding out of the "
      "symmetry does more, {} beyond their horizon and left out; {} without a reference, {} "
      "without a truth, {} without unknowns or with massless ones\n",
      count, tally.made, tally.out_of_symmetry, tally.chaotic, tally.without_reference,
      tally.without_truth, tally.skipped);
  const double least = std::min({tell("position", tally.position), tell("velocity", tally.velocity),
                                 tell("energy", tally.energy)});
  return least >= 0.99 ? 0 : 1;
}

}  // namespace
}  // namespace qddot

int main(int argc, char** argv) {
  CLI::App app("Holds references against the true motion.", "fuzz_references");
  std::uint64_t count = 200, seed = 1;
  double seconds = 2;
  bool are_hard = false, shows_all = false;
  app.add_option("--count", count, "number of scenes")->capture_default_str();
  app.add_option("--seed", seed, "the seed of the first scene; each later one has the next number")
      ->capture_default_str();
  app.add_option("--seconds", seconds, "seconds that a reference may take")->capture_default_str();
  app.add_flag("--hard", are_hard, "hard cases of the study `advice`, by their numbers");
  app.add_flag("--all", shows_all, "print each scene, not only those not covered");
  CLI11_PARSE(app, argc, argv);
  return qddot::fuzz(count, seed, seconds, are_hard, shows_all);
}
