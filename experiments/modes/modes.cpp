// The natural modes of a scene: the frequencies and shapes of its small motions, about the drawn
// state or about its equilibrium.
//
//   modes --scene cloth --out results/cloth --count 6 --at equilibrium
//
// modes.csv has the lowest and the highest modes by rank. A mode that grows instead of vibrating
// has omega = -(growth rate); it has w^2 < 0, at a state that is no minimum of the energy. A mode
// with w^2 = 0 within rounding has omega = 0. Frequencies are those without damping; a damped scene
// has the column zeta, each mode's own damping ratio.
#include <algorithm>

#include <fmt/format.h>

#include "experiments/kit/program.hpp"
#include "experiments/kit/provenance.hpp"
#include "experiments/modes/spectrum.hpp"
#include "qddot/analysis/largest_frequency.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::modes {
namespace {

constexpr int most_modes = 1000;

bool is_at_equilibrium(const Argument<std::string>& at, const Scene& scene) {
  if (at->empty()) return scene.starts_at_equilibrium;
  if (*at == "drawn" || *at == "equilibrium") return *at == "equilibrium";
  throw InvalidInput(fmt::format("--at: {} is not allowed; it is drawn or equilibrium", *at));
}

}  // namespace
}  // namespace qddot::modes

int main(int argc, char** argv) {
  using namespace qddot;
  using namespace qddot::modes;
  Program p("modes",
            "Finds the natural modes of a scene: frequencies and shapes of its small motions.",
            {has_threads});
  auto scene = p.drawn_scene();
  p.out(
      "the folder for modes.csv (a mode that grows instead of vibrating has omega = -growth "
      "rate; of a damped scene with the column zeta), shapes.csv of the lowest ones, and "
      "springs.csv");
  auto count = p.whole("--count", 10, "number of modes at each end of the spectrum, 1 to 1000")
                   .within(1, most_modes);
  auto at = p.word("--at",
                   "the state of the scene: drawn or equilibrium (default: where its motion "
                   "starts)");
  return p.run(argc, argv, [&] {
    const Scene drawn = load(scene);
    require_no_rods(drawn, scene->name, "its small vibrations are not those of K alone");
    const bool at_equilibrium = is_at_equilibrium(at, drawn);
    if (at_equilibrium) progress().stage("finding the equilibrium");
    const Model model(at_equilibrium ? settled(drawn, scene->name) : drawn,
                      Reductions::all_directions());
    require_folder(p.folder());
    CsvFile table(p.folder() + "/modes.csv", spectrum_header(model));
    CsvFile shapes(p.folder() + "/shapes.csv", shape_header(drawn.dimension));
    CsvFile springs(p.folder() + "/springs.csv", {"i", "j"});

    const System& system = model.system();
    const Vec& q = model.initial().q;
    progress().stage("finding the modes");
    const Spectrum spectrum(model, count);
    const double lanczos = largest_frequency(system, q), bound = frequency_bound(system, q);
    progress().wipe();
    const Index shown = std::min<Index>(*count, spectrum.lowest.squares.size());
    write_spectrum(table, spectrum);
    write_shapes(shapes, model, spectrum.lowest.shapes.leftCols(shown));
    for (const Spring& spring : drawn.springs) springs.row(spring.nodes[0], spring.nodes[1]);

    const char* place = at_equilibrium ? "at equilibrium" : "as drawn";
    const CurvatureSigns& signs = spectrum.signs;
    fmt::print(
        "{} {}: natural modes of finite frequency: {}, unstable: {}, zero within rounding: {}\n",
        drawn.name, place, spectrum.finite, signs.negative, signs.flat);
    print(spectrum);
    fmt::print("w_max: {:.7g} rad/s by Lanczos, at most {:.7g} by Gershgorin; 2/w_max = {:.5g} s\n",
               lanczos, bound, 2 / lanczos);

    nlohmann::json origin = provenance(p.command_line(), drawn);
    origin["at"] = at_equilibrium ? "equilibrium" : "drawn";
    origin["gravity"] = drawn.gravity;
    origin["finite_modes"] = spectrum.finite;
    origin["unstable_directions"] = signs.negative;
    origin["flat_directions"] = signs.flat;
    origin["flat_growth_rate_at_most"] = signs.flat_rate;  // infinite becomes null
    origin["omega_max"] = lanczos;                         // infinite becomes null
    origin["omega_max_bound"] = bound;
    for (CsvFile* file : {&table, &shapes, &springs}) file->commit(origin);
    return done;
  });
}
