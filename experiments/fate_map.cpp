#include "experiments/fate_map.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <numeric>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/linear_step.hpp"

namespace qddot {
namespace {

Knobs knobs_of(const Cell& cell) {
  Knobs knobs;
  knobs.rtol = cell.rtol;
  if (cell.method->knob == Knob::step_size) knobs.step_size = cell.h_omega / cell.row->omega_max;
  return knobs;
}

// What tells two cells apart, whatever others there are.
std::string name_of(const Cell& cell) {
  return fmt::format("{} {:.17g} {:.17g} {:.17g}", cell.method->name, cell.row->amplitude,
                     cell.h_omega, cell.rtol);
}

nlohmann::json to_json(const std::string& cell, const Fate& f) {
  const Counts& c = f.counts;
  return {{"cell", cell},
          {"outcome", f.outcome},
          {"numbers", {f.growth_rate, f.t_reached, f.energy_end, f.energy_max, f.mean_step}},
          {"counts", {c.steps, c.rejected, c.force_evaluations, c.newton_iterations}}};
}

Fate fate_from(const nlohmann::json& json) {
  // A number that is not finite is written as null.
  const auto number = [&](std::size_t i) {
    const auto& x = json.at("numbers").at(i);
    return x.is_null() ? std::numeric_limits<double>::quiet_NaN() : x.get<double>();
  };
  const auto count = [&](std::size_t i) { return json.at("counts").at(i).get<std::int64_t>(); };
  Fate f{json.at("outcome"), number(0), number(1), number(2), number(3), number(4)};
  f.counts.steps = count(0);
  f.counts.rejected = count(1);
  f.counts.force_evaluations = count(2);
  f.counts.newton_iterations = count(3);
  return f;
}

// What an interrupted run with this key has left in the file.
std::map<std::string, Fate> read(const std::string& file, const std::string& key) {
  std::map<std::string, Fate> found;
  std::ifstream stream(file);
  std::string line;
  if (!std::getline(stream, line) || line != key) return found;
  while (std::getline(stream, line)) {
    const auto json = nlohmann::json::parse(line, nullptr, /*allow_exceptions=*/false);
    if (json.is_discarded()) break;  // cut off in the middle
    found[json.at("cell")] = fate_from(json);
  }
  return found;
}

Fate fate_in(const Cell& cell, const MapSettings& settings) {
  try {
    return fate_of(*cell.method, knobs_of(cell), *cell.row->scene,
                   {.rest_energy = cell.row->rest_energy,
                    .tolerated = settings.tolerated,
                    .until = settings.until,
                    .seconds = settings.seconds});
  } catch (const std::exception&) {  // which cannot leave a thread
    return {.outcome = std::string(name(Outcome::solver_failed))};
  }
}

// The file with what is known already, whole lines alone, open for more.
std::ofstream begun(const std::string& file, const std::string& key,
                    const std::map<std::string, Fate>& known) {
  std::ofstream stream(file);
  stream << key << '\n';
  for (const auto& [cell, fate] : known) stream << to_json(cell, fate).dump() << '\n';
  return stream;
}

}  // namespace

double predicted_growth_rate(const Cell& cell) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!has_linear_step(*cell.method)) return none;
  const double h = cell.h_omega / cell.row->omega_max;
  double largest = -std::numeric_limits<double>::infinity();
  try {
    for (const Mode& mode : cell.row->modes) {
      const LinearStep step = linear_step(*cell.method, h * mode.omega);
      largest = std::max(largest, std::log(step.spectral_radius()) / h);
    }
  } catch (const std::exception&) {  // a step so long that its numbers overflow
    return none;
  }
  return largest;
}

std::vector<Fate> fates(const std::vector<Cell>& cells, const MapSettings& settings,
                        const std::string& file, const std::string& key,
                        const std::function<void(std::size_t done)>& progress) {
  const auto known = read(file, key);
  std::ofstream kept = begun(file, key, known);
  std::vector<Fate> all(cells.size());
  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return cells[i].h_omega; });
  std::size_t done = 0;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Cell& cell = cells[order[i]];
    const std::string name = name_of(cell);
    const auto found = known.find(name);
    const bool is_new = found == known.end();
    const Fate fate = is_new ? fate_in(cell, settings) : found->second;
    all[order[i]] = fate;
#pragma omp critical
    {
      if (is_new) kept << to_json(name, fate).dump() << std::endl;
      progress(++done);
    }
  }
  return all;
}

}  // namespace qddot
