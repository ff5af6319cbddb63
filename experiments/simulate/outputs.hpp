#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "experiments/kit/csv.hpp"
#include "experiments/motion_files/motion_file.hpp"
#include "experiments/simulate/arguments.hpp"
#include "experiments/simulate/background_observer.hpp"
#include "qddot/measure/motion/strains.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::simulate {

// The outputs of a run: all nodes at its end, all nodes over time, the energy over time, the
// springs that broke, and extreme strains. Nodes over time are a table or a motion file for other
// programs.
class Outputs {
 public:
  // Writes the scene as `drawn` at once, where --write-scene asks for that. `start`: the scene that
  // `scene` was reduced from. The scene must outlive it. Throws InvalidInput if a file cannot be
  // written.
  Outputs(const Arguments& a, const Every& every, const Scene& drawn, const Scene& start,
          const Model& scene, double until);

  // Asks for the times of the samples.
  Observer observer();
  // Takes the state at time 0, before the run, or an observed one.
  void see(const State& state);

  // Whether an output needs states before the end.
  bool looks_on_the_way() const { return trajectory_ || energy_ || motion_ || strain_; }
  bool is_asked_for() const { return final_ || breaks_ || looks_on_the_way(); }
  // Lets all files appear. `state`: the end; `origin`: how it was made (see provenance.hpp).
  // `time_errors`: a bound of the error of each break's time [s], if there are bounds.
  void finish(const State& state, const std::vector<Break>& breaks,
              const std::vector<double>& time_errors, const nlohmann::json& origin);

 private:
  void write_breaks(const std::vector<Break>& breaks, const std::vector<double>& time_errors);
  void write_strains();

  const Scene& start_;
  const Model& scene_;
  const bool is_damped_, is_driven_, may_break_;
  double start_energy_ = 0;  // [J]
  std::vector<double> trajectory_times_, energy_times_, motion_times_;
  std::unique_ptr<CsvFile> final_, trajectory_, energy_, breaks_, strain_;
  std::optional<Strains> strains_;
  std::unique_ptr<motion_files::MotionFile> motion_;
  std::optional<BackgroundObserver> behind_;  // writes while the run goes on
};

// The largest strain and tension of a run in words, and the springs that broke; empty without
// springs.
std::string strains_in_words(const Scene& scene, const std::vector<SpringExtremes>& extremes);

// Writes a scene file that is exact to the last bit.
void write_scene(WholeFile& file, const Scene& drawn);

// The counts of a run in words.
std::string counts_in_words(const Counts& counts);

}  // namespace qddot::simulate
