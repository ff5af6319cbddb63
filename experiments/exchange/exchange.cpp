// How stiff springs exchange their energy, by method and step size: the figures of Hairer, Lubich
// and Wanner, Geometric Numerical Integration, I.5.2 and XIII.2.
//
//   exchange --scene fpu --out results/fpu
//   exchange --scene fpu --methods verlet,trbdf2 --h-omega 0.1,0.5,1 --until 400 --out results/fpu
//
//  1. w is the highest frequency at the start that the stiff springs (Scene::stiff_above) make by
//     themselves, without the soft ones. In scene fpu it is its parameter `frequency`. A method's
//     step is h = (h w)/w, all of the way. So the motion is seen at ends of steps only: random
//     ones, about one in each --every.
//  2. The reference is Kahan and Li's composition of order 8 at h w = 0.1. Its distance to Dormand
//     and Prince's Nystrom pair 12(10) at rtol = 1e-12 certifies it.
//  3. exchange.csv has the oscillatory energy of each stiff spring over time (stiff_energies.hpp),
//     springs counted from 0 among the stiff ones, and their sum.
//  4. summary.csv has, for each method and h w:
//       sum_deviation   the largest |sum I(t) - sum I(0)| / sum I(0)
//       energy_error    the largest |H(t) - H(0)| / |H(0)|
//     over the times seen; and, of running means over 40 periods of w (a quarter of the time if
//     that is less; see energy_exchange.hpp),
//       exchange_error  the largest |I_j(t) - I_j,ref(t)| / sum I(0)
//       tempo           the a for which I_j(t) is nearest to I_j,ref(a t): how fast they exchange
//       misfit          the root mean square of what is left then
//       verdict         in words; "as it should" is a tempo within 10 % and a misfit below 0.1
//     The soft springs' slow motion drives the exchange and may be chaotic. In scene fpu 1 % more
//     frequency moves I_j(t) by up to 0.06, so a few per cent of tempo mean nothing.
//     A run that fails has its outcome, and leaves the rest empty.
#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiments/exchange/exchange_results.hpp"
#include "experiments/kit/allowed_options.hpp"
#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/kit/reference_file.hpp"
#include "qddot/scene/invalid_input.hpp"

namespace qddot::exchange {
namespace {

// The steps h = (h w)/w are allowed, and the time has ten of the longest.
void require_steps(const std::vector<double>& h_omegas, const Excitation& excitation) {
  for (const double h_omega : h_omegas) {
    require_step_size(h_omega / excitation.omega, fmt::format("--h-omega {:g}: h =", h_omega),
                      excitation.until);
  }
  const double longest = std::ranges::max(h_omegas) / excitation.omega;
  if (10 * longest <= excitation.until) return;
  throw InvalidInput(
      fmt::format("--until {} is not allowed with --h-omega {}; it is at least ten steps of it, "
                  "{:.3g} s",
                  excitation.until, std::ranges::max(h_omegas), 10 * longest));
}

void require_h_omegas(const std::vector<double>& h_omegas, const std::string& name) {
  for (const double h_omega : h_omegas)
    require_positive(h_omega, name, "a step times the highest frequency of the stiff springs");
  require_each_once(h_omegas, name);
}

}  // namespace
}  // namespace qddot::exchange

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::exchange;
  Program p("exchange", "Follows the energy that stiff springs exchange, by method and step size.",
            {has_resume});
  auto scene = p.scene();
  auto methods =
      p.words("--methods",
              {"symplectic_euler", "verlet", "position_verlet", "rk4", "blanes_moan4",
               "blanes_moan6", "kahan_li8", "implicit_midpoint", "trapezoidal", "discrete_gradient",
               "linear_midpoint", "linear_midpoint4", "implicit_euler"},
              "a,b,...: the methods, of fixed steps");
  auto h_omegas =
      p.numbers("--h-omega", {0.1, 1, 2.25, 5},
                "a,b,...: step sizes as h w, with w the highest frequency of the stiff springs")
          .check(require_h_omegas);
  auto until = p.until();
  auto every = p.number("--every",
                        "the mean time between samples in exchange.csv in s (default: a "
                        "thousandth of --until)")
                   .positive("a time in s");
  auto& courses = p.table("exchange.csv", {"method", "h", "h_omega", "t", "spring", "energy"});
  auto& table = p.table("summary.csv", {"method", "h", "h_omega", "outcome", "t_reached", "steps",
                                        "force_evaluations", "sum_deviation", "energy_error",
                                        "exchange_error", "tempo", "misfit", "verdict"});
  return p.run(argc, argv, [&] {
    Subject subject = subject_of(scene, until);
    require_kept_energy(subject.drawn, subject.source, "its energy is not kept");
    require_no_rods(subject.drawn, subject.source, "its small vibrations are not those of K alone");
    require_reference_exists(subject);
    const auto selected = fixed_step_among(methods, subject);
    const Excitation excitation = [&] {
      Excitation e =
          excitation_of(subject.start(), std::move(subject.model), subject.until, subject.source);
      require_steps(h_omegas, e);
      if (every.is_given()) e.every = every;
      if (e.every <= e.until / 10) return e;
      throw InvalidInput(fmt::format(
          "--every {} is not allowed; it is at most a tenth of the time, {} s", e.every, e.until));
    }();
    nlohmann::json origin =
        provenance(p.command_line(), subject.drawn, excitation.start, excitation.scene);
    origin.update(
        {{"omega", excitation.omega}, {"until", excitation.until}, {"window", excitation.window}});
    const auto measure = [&](Study& study) {
      progress().stage("making the reference");
      const CertifiedCourse reference =
          certified_course(excitation, [&](const std::string& name, const auto& make) {
            return run_of(study.piece(name, [&] { return record_of(make()); }));
          });
      origin["certified"] = reference.certified;
      progress().wipe();
      Reporter report(subject.drawn.name, excitation, reference, *courses, *table);
      report("reference", reference.h, CertifiedCourse::h_omega, reference.run);
      progress().begin(selected.size() * h_omegas->size());
      for (const Method* method : selected) {
        for (const double h_omega : *h_omegas) {
          const double h = h_omega / excitation.omega;
          const std::string shown = fmt::format("{} at h w = {:g}", method->name, h_omega);
          progress().now_at(shown);
          const auto times = looks(excitation, h);
          const auto record = study.piece(fmt::format("{} {:.17g}", method->name, h), [&] {
            return record_of(exchange_run(excitation, *method, h, times));
          });
          progress().finish(shown);
          progress().wipe();
          report(method->name, h, h_omega, run_of(record));
        }
      }
    };
    return p.study(subject.about(), measure, [&] { return origin; });
  });
}
