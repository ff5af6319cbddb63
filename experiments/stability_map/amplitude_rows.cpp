#include "experiments/stability_map/amplitude_rows.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiments/kit/program.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/scene/generators.hpp"
#include "qddot/scene/invalid_input.hpp"
#include "qddot/scene/settle.hpp"

namespace qddot::stability_map {
namespace {

constexpr int modes_predicted = 48;

// Throws InvalidInput unless there is a generator of that name with that parameter.
void require_parameter(const std::string& name, const std::string& vary) {
  const Generator* generator = find_generator(name);
  if (!generator) {
    throw InvalidInput(fmt::format(
        "--vary {}: scene {} is not a generator's, whose parameters can be varied", vary, name));
  }
  std::vector<std::string> names;
  for (const GeneratorParameter& parameter : generator->parameters) names.push_back(parameter.name);
  if (std::ranges::find(names, vary) != names.end()) return;
  throw InvalidInput(fmt::format("--vary {}: it is not a parameter of generator {}; allowed are {}",
                                 vary, name, fmt::join(names, ", ")));
}

// The scene as a generator draws it with its parameter `vary` set.
Scene drawn_with(const std::string& name, const std::string& vary, double value) {
  return generate(*find_generator(name), {{vary, value}}, name);
}

// The scene with each node's distance from its place at rest multiplied by `amplitude`, velocities
// likewise.
Scene scaled(const Scene& start, const Scene& rest, double amplitude) {
  Scene scene = start;
  for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
    Node& node = scene.nodes[i];
    const Eigen::Vector3d& origin = rest.nodes[i].position;
    node.position = origin + amplitude * (node.position - origin);
    node.velocity *= amplitude;
  }
  return scene;
}

double energy_at_rest(const Scene& rest) {
  const ReducedScene scene(rest, Reductions::only({Reduction::pins}));
  return scene.potential(scene.initial());
}

AmplitudeRow row_of(double amplitude, const Scene& start, double rest_energy,
                    const Reductions& reductions) {
  AmplitudeRow row{.amplitude = amplitude,
                   .scene = std::make_unique<ReducedScene>(start, reductions),
                   .rest_energy = rest_energy,
                   .omega_max = 0,
                   .buckling_rate = 0,
                   .modes = {}};
  const System& system = row.scene->system();
  const Vec& q = row.scene->initial().q;
  row.modes = sampled_modes(system, q, modes_predicted);
  row.omega_max = row.modes.empty() ? 0 : row.modes.back().omega;
  row.buckling_rate = buckling_rate(system, q);
  return row;
}

bool moves(const AmplitudeRow& row) {
  return row.omega_max > 0 && row.scene->energy(row.scene->initial()) > row.rest_energy;
}

}  // namespace

double omega_max_of(const ReducedScene& scene) {
  const NaturalModes highest = highest_modes(scene.system(), scene.initial().q, 1);
  return highest.squares.size() == 0 ? 0 : std::sqrt(std::max(0.0, highest.squares[0]));
}

std::vector<AmplitudeRow> rows_of(const Subject& subject, const Reductions& reductions,
                                  const std::optional<Scene>& rest, const std::string& vary,
                                  const std::vector<double>& amplitudes) {
  const bool is_varied = !vary.empty();
  if (is_varied) require_parameter(subject.source, vary);
  if (!is_varied && !rest) return {};
  const auto make = [&](double amplitude) {
    if (!is_varied) {
      return row_of(amplitude, scaled(subject.start, *rest, amplitude), energy_at_rest(*rest),
                    reductions);
    }
    const Scene scene = drawn_with(subject.source, vary, amplitude);
    return row_of(amplitude, scene, energy_at_rest(settled(scene, subject.source)), reductions);
  };
  std::vector<std::string> left_out;
  std::vector<AmplitudeRow> rows;
  for (const double amplitude : amplitudes) {
    try {
      AmplitudeRow row = make(amplitude);
      if (moves(row)) {
        rows.push_back(std::move(row));
      } else {
        left_out.push_back(fmt::format("amplitude {:g}: nothing moves", amplitude));
      }
    } catch (const InvalidInput& error) {
      left_out.emplace_back(error.what());
    } catch (const std::runtime_error& error) {  // numbers that overflow
      left_out.push_back(fmt::format("amplitude {:g}: {}", amplitude, error.what()));
    }
  }
  if (is_varied && rows.empty() && !left_out.empty()) throw InvalidInput(left_out.front());
  for (const std::string& why : left_out)
    say(in_one_line("stability_map: warning: " + why + "; its row is left out"));
  return rows;
}

}  // namespace qddot::stability_map
