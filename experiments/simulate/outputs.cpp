#include "experiments/simulate/outputs.hpp"

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "experiments/kit/node_table.hpp"
#include "experiments/kit/whole_file.hpp"
#include "qddot/measure/motion/samples.hpp"
#include "qddot/scene/scene_file.hpp"

namespace qddot::simulate {

Outputs::Outputs(const Arguments& a, const Every& every, const Scene& drawn, const Scene& start,
                 const Model& scene, double until)
    : scene_(scene),
      is_damped_(is_damped(drawn)),
      is_driven_(is_driven(drawn)),
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
    if (is_damped_ || is_driven_) columns.push_back("balance");
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
  if (!a.written_scene_path->empty()) {
    WholeFile file(a.written_scene_path);
    write_scene(file, drawn);
  }
  if (looks_on_the_way()) behind_.emplace([this](const State& state) { see(state); });
}

Observer Outputs::observer() {
  return {merged({trajectory_times_, energy_times_, motion_times_}),
          [this](const State& state) { behind_->see(state); }};
}

void Outputs::see(const State& state) {
  if (trajectory_ && is_sample(trajectory_times_, state.t)) {
    write_nodes(*trajectory_, scene_.expand(state), scene_.dimension(), state.t);
    trajectory_->flush_if_large();
  }
  if (energy_ && is_sample(energy_times_, state.t)) {
    const double kinetic = scene_.kinetic(state);
    const double potential = scene_.potential(state);
    const double total = kinetic + potential;
    const double dissipated = scene_.dissipated(state), driven = scene_.driven(state);
    const double balance = total + dissipated - driven - start_energy_;
    if (is_damped_ && is_driven_) {
      energy_->row(state.t, kinetic, potential, total, dissipated, driven, balance);
    } else if (is_damped_ || is_driven_) {
      energy_->row(state.t, kinetic, potential, total, is_damped_ ? dissipated : driven, balance);
    } else {
      energy_->row(state.t, kinetic, potential, total);
    }
    energy_->flush_if_large();
  }
  if (motion_ && is_sample(motion_times_, state.t)) motion_->add(state);
}

void Outputs::finish(const State& state, const nlohmann::json& origin) {
  if (behind_) behind_->finish();
  if (final_) {
    write_nodes(*final_, scene_.expand(state), scene_.dimension());
  }
  const std::array files = {final_.get(), trajectory_.get(), energy_.get()};
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
