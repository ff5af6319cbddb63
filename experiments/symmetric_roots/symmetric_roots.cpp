// The trade of spurious roots in symmetric multistep formulas. The study compares how large
// steps may be, how large the phase error is, and how far the roots stay apart.
//
//   symmetric_roots --out results/symmetric_roots
//   symmetric_roots --samples 20000 --at 0.3 --out results/finer
//
// A formula of k steps has order k and is made from the cosines of its k/2 - 1 pairs of spurious
// roots (formula.cpp). roots.csv is for k = 4, 6, 8, 10 and 12. It has a row for each
// sampled set of cosines, and one for each of the registry's formulas, with its name:
//   limit         the least h w at which a vibration grows
//   phase_error   relative error of the phase of a vibration at h w = --at, in each period
//   gap           the smallest angle in rad between two roots, one of them spurious, at any of
//                 eight h w up to --at; the vibrations of a scene have all of these
//   energy_swing  the largest energy error over the largest kinetic energy on the scene orbit, in
//                 5000 steps at each of eight h w from half of --at to --at; 1: a run was ended
// The last three are empty if the limit is not above --at.
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/program.hpp"
#include "experiments/symmetric_roots/formula_points.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::spurious_roots {
namespace {

constexpr int least_k = 4, most_k = 12;
constexpr int steps_of_orbit = 5000;
constexpr double well_apart = 0.2;  // [rad]
constexpr double much = 0.1;        // of an energy swing

void require_h_omega(double at, const std::string& option) {
  constexpr double least = 0.01, most = 2;  // no formula of more than two steps has more
  if (at >= least && at <= most) return;
  throw InvalidInput(
      fmt::format("{} {} is not allowed; it is an h w from {} to {}", option, at, least, most));
}

void print(const std::string& who, const FormulaPoint& p) {
  if (std::isnan(p.gap)) {
    fmt::print("{:<28} {:>6.4f}  not stable at --at\n", who, p.limit);
  } else {
    fmt::print("{:<28} {:>6.4f} {:>11.1e} {:>6.3f} {:>12.1e}  {:.3g}\n", who, p.limit,
               p.phase_error, p.gap, p.energy_swing, fmt::join(p.cosines, " "));
  }
}

// The points of largest limit: of all, and of those whose roots are well apart.
void print_largest(int steps, const std::vector<FormulaPoint>& points) {
  const FormulaPoint *largest = nullptr, *apart = nullptr;
  for (const FormulaPoint& point : points) {
    if (!largest || point.limit > largest->limit) largest = &point;
    if (point.gap >= well_apart && (!apart || point.limit > apart->limit)) apart = &point;
  }
  print(fmt::format("k = {}: largest limit", steps), *largest);
  if (apart) print(fmt::format("k = {}: gap of {} or more", steps, well_apart), *apart);
}

// How many of those whose roots are, or are not, well apart are off by much on the orbit.
void print_share(const char* whose, const std::vector<FormulaPoint>& points, bool is_apart) {
  int all = 0, off = 0;
  for (const FormulaPoint& point : points) {
    if (std::isnan(point.gap) || (point.gap >= well_apart) != is_apart) continue;
    ++all;
    if (point.energy_swing >= much) ++off;
  }
  fmt::print("energy swing of {} or more: {} of {} formulas with a gap {} {}\n", much, off, all,
             whose, well_apart);
}

}  // namespace
}  // namespace qddot::spurious_roots

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::spurious_roots;
  Program p("symmetric_roots",
            "Charts what the spurious roots of symmetric multistep formulas trade.");
  auto samples =
      p.whole("--samples", 1500,
              "number of sampled sets of roots, for each pair of roots in a set, 1 to 100000")
          .within(1, 100'000);
  auto at =
      p.number("--at", 0.4,
               "the h w of phase errors, and the largest h w of gaps and energy errors, 0.01 to 2")
          .check(require_h_omega);
  auto& table = p.table<FormulaPoint>(
      "roots.csv",
      {{"steps", &FormulaPoint::steps},
       {"method", &FormulaPoint::method},
       {"cosines",
        [](const FormulaPoint& r) { return fmt::format("{:.17g}", fmt::join(r.cosines, " ")); }},
       {"limit", &FormulaPoint::limit},
       {"phase_error", &FormulaPoint::phase_error},
       {"gap", &FormulaPoint::gap},
       {"energy_swing", &FormulaPoint::energy_swing}});
  return p.run(argc, argv, [&] {
    return p.write([&] {
      const OrbitSwing orbit(at, steps_of_orbit, most_k);
      fmt::print("{:<28} {:>6} {:>11} {:>6} {:>12}  {}\n", "", "limit", "phase error", "gap",
                 "energy swing", "cosines");
      for (const FormulaPoint& point : registered_points(at, orbit)) {
        table.add(point);
        print(point.method, point);
      }
      std::vector<FormulaPoint> sampled;
      progress().begin((most_k - least_k) / 2 + 1);
      for (int steps = least_k; steps <= most_k; steps += 2) {
        const std::vector<FormulaPoint> points = sampled_points(steps, samples, at, orbit);
        progress().finish(fmt::format("formulas of {} steps are done", steps));
        progress().wipe();
        for (const FormulaPoint& point : points) table.add(point);
        print_largest(steps, points);
        sampled.insert(sampled.end(), points.begin(), points.end());
      }
      print_share("below", sampled, false);
      print_share("of at least", sampled, true);
      nlohmann::json origin = p.origin();
      origin.update({{"samples", *samples},
                     {"at", *at},
                     {"well_apart", well_apart},
                     {"steps_of_orbit", steps_of_orbit}});
      return origin;
    });
  });
}
