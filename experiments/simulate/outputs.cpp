#include "experiments/simulate/outputs.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/node_table.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/measure/motion/samples.hpp"
#include "qddot/scene/scene_file.hpp"

namespace qddot::simulate {

Outputs::Outputs(const Arguments& a, const Every& every, const Scene& drawn, const Scene& start,
                 const Model& scene, double until)
    : start_(start),
      scene_(scene),
      is_damped_(is_damped(drawn)),
      is_driven_(is_driven(drawn)),
      may_break_(std::ranges::any_of(drawn.springs,
                                     [](const Spring& spring) { return spring.law.can_break(); })),
      trajectory_times_(samples(every.trajectory, until)),
      energy_times_(samples(every.energy, until)),
      motion_times_(samples(every.motion, until)) {
  const int d = scene.dimension();
  if (!a.final_path->empty()) {
    final_ = std::make_unique<CsvFile>(a.final_path, node_header(d, {}));
  }
  if (!a.trajectory_path->empty()) {
    trajectory_ = std::make_unique<CsvFile>(a.trajectory_path, node_header(d, {"t"}));
  }
  if (!a.energy_path->empty()) {
    std::vector<std::string> columns = {"t", "kinetic", "potential", "total"};
    if (is_damped_) columns.push_back("dissipated");
    if (is_driven_) columns.push_back("driven");
    if (may_break_) columns.push_back("released");
    if (is_damped_ || is_driven_ || may_break_) columns.push_back("balance");
    energy_ = std::make_unique<CsvFile>(a.energy_path, columns);
    start_energy_ = scene.kinetic(scene.initial()) + scene.potential(scene.initial());
  }
  if (!a.motion_path->empty()) {
    const motion_files::Fields fields =
        a.motion_fields->empty()
            ? motion_files::Fields{}
            : motion_files::fields_named(a.motion_fields, a.motion_path, "--motion-fields");
    motion_ = motion_files::open_motion(a.motion_path, start, scene, false, fields);
  }
  if (!a.breaks_path->empty()) {
    std::vector<std::string> columns = {"t", "spring", "node", "other_node", "strain", "energy"};
    if (a.accuracy.is_given()) columns.push_back("t_error");
    breaks_ = std::make_unique<CsvFile>(a.breaks_path, columns);
  }
  if (!a.strain_path->empty()) {
    strain_ = std::make_unique<CsvFile>(
        a.strain_path,
        columns_in("spring node other_node largest_strain t_largest_strain smallest_strain "
                   "t_smallest_strain largest_tension t_largest_tension smallest_tension "
                   "t_smallest_tension"));
    strains_.emplace(start, scene);
  }
  if (!a.written_scene_path->empty()) {
    WholeFile file(a.written_scene_path);
    write_scene(file, drawn);
  }
  if (looks_on_the_way()) behind_.emplace([this](const State& state) { see(state); });
}

Observer Outputs::observer() {
  Observer observer{merged({trajectory_times_, energy_times_, motion_times_}),
                    [this](const State& state) { behind_->see(state); }};
  if (strains_) observer.step = [this](const State& state) { strains_->see(state); };
  return observer;
}

void Outputs::see(const State& state) {
  if (strains_ && state.t == 0) strains_->see(state);
  if (trajectory_ && is_sample(trajectory_times_, state.t)) {
    write_nodes(*trajectory_, scene_.expand(state), scene_.dimension(), state.t);
    trajectory_->flush_if_large();
  }
  if (energy_ && is_sample(energy_times_, state.t)) {
    const double kinetic = scene_.kinetic(state);
    const double potential = scene_.potential(state);
    const double total = kinetic + potential;
    const double dissipated = scene_.dissipated(state), driven = scene_.driven(state),
                 released = scene_.released(state);
    for (const double value : {state.t, kinetic, potential, total}) energy_->field(value);
    if (is_damped_) energy_->field(dissipated);
    if (is_driven_) energy_->field(driven);
    if (may_break_) energy_->field(released);
    if (is_damped_ || is_driven_ || may_break_)
      energy_->field(total + dissipated - driven + released - start_energy_);
    energy_->end_row();
    energy_->flush_if_large();
  }
  if (motion_ && is_sample(motion_times_, state.t)) motion_->add(state);
}

void Outputs::write_breaks(const std::vector<Break>& breaks,
                           const std::vector<double>& time_errors) {
  for (std::size_t k = 0; k < breaks.size(); ++k) {
    const Break& one = breaks[k];
    const std::size_t spring = scene_.general_springs()[static_cast<std::size_t>(one.number)];
    const auto [node, other] = start_.springs[spring].nodes;
    breaks_->field(one.t);
    for (const std::size_t number : {spring, node, other}) breaks_->field(number);
    breaks_->field(one.strain);
    breaks_->field(one.energy);
    if (!time_errors.empty()) breaks_->field(time_errors[k]);
    breaks_->end_row();
  }
}

void Outputs::write_strains() {
  const std::vector<SpringExtremes>& extremes = strains_->extremes();
  for (std::size_t e = 0; e < extremes.size(); ++e) {
    strain_->field(e);
    for (const std::size_t node : start_.springs[e].nodes) strain_->field(node);
    const SpringExtremes& own = extremes[e];
    for (const Extreme& extreme :
         {own.largest_strain, own.smallest_strain, own.largest_tension, own.smallest_tension}) {
      strain_->field(extreme.value);
      strain_->field(std::isfinite(extreme.value) ? extreme.t : NAN);
    }
    strain_->end_row();
  }
}

std::string strains_in_words(const Scene& scene, const std::vector<SpringExtremes>& extremes) {
  const auto where = [&](std::size_t e, double t) {
    return fmt::format("in spring {} between nodes {} and {} at t = {:.4g} s", e,
                       scene.springs[e].nodes[0], scene.springs[e].nodes[1], t);
  };
  const auto largest = [&](Extreme SpringExtremes::*which) {
    return std::ranges::max_element(
        extremes, {}, [which](const SpringExtremes& own) { return (own.*which).value; });
  };
  std::string words;
  const auto add = [&](const char* what, const char* unit, Extreme SpringExtremes::*which) {
    const auto found = largest(which);
    if (found == extremes.end() || !std::isfinite(((*found).*which).value)) return;
    const Extreme& extreme = (*found).*which;
    words +=
        fmt::format("{}largest {} {:.4g}{} {}", words.empty() ? "" : "; ", what, extreme.value,
                    unit, where(static_cast<std::size_t>(found - extremes.begin()), extreme.t));
  };
  add("strain", "", &SpringExtremes::largest_strain);
  add("tension", " N", &SpringExtremes::largest_tension);
  return words;
}

void Outputs::finish(const State& state, const std::vector<Break>& breaks,
                     const std::vector<double>& time_errors, const nlohmann::json& origin) {
  if (behind_) behind_->finish();
  if (breaks_) write_breaks(breaks, time_errors);
  if (strains_) {
    write_strains();
    if (const std::string words = strains_in_words(start_, strains_->extremes()); !words.empty())
      fmt::print("{}\n", words);
  }
  if (final_) {
    write_nodes(*final_, scene_.expand(state), scene_.dimension());
  }
  const std::array files = {final_.get(), trajectory_.get(), energy_.get(), breaks_.get(),
                            strain_.get()};
  for (CsvFile* file : files) {
    if (file) file->complete(origin);
  }
  if (motion_) motion_->complete(origin);
  for (CsvFile* file : files) {
    if (file) file->commit();
  }
  if (motion_) motion_->commit();
}

void write_scene(WholeFile& file, const Scene& drawn) {
  file.write(signed_text(to_toml(drawn)));
  file.commit();
}

std::string counts_in_words(const Counts& c) {
  std::string words =
      fmt::format("{} steps, {} force and {} stiffness evaluations, {} factorisations", c.steps,
                  c.force_evaluations, c.stiffness_evaluations, c.factorizations);
  if (c.indefinite_factorizations > 0) {
    words += fmt::format(", {} of them indefinite", c.indefinite_factorizations);
  }
  if (c.order_sum > 0) {
    words +=
        fmt::format(", mean order {:.2f}, lowered {} times", order_mean(c), c.order_reductions);
  }
  if (c.stability_limited_steps > 0) {
    words += fmt::format(", {} steps held to the stability limit", c.stability_limited_steps);
  }
  return words;
}

}  // namespace qddot::simulate
