#pragma once

#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/command/csv.hpp"
#include "experiments/motion_files/motion_file.hpp"
#include "experiments/motions/chosen_runs.hpp"
#include "experiments/motions/reference_motion.hpp"

namespace qddot::motions {

// The motions of one scene in a folder: motions/*.vtkhdf, and the tables motions.csv and
// motions_energy.csv, which appear at the end.
class KeptMotions {
 public:
  // Throws InvalidInput where the folder cannot be written. The scene must outlive it; `start` is
  // that scene as its motion starts, `times` [s] are those that are seen, the start first, and
  // `origin` says how each motion was made (see provenance.hpp).
  KeptMotions(const std::string& folder, const Scene& start, const ReducedScene& scene,
              std::vector<double> times, const nlohmann::json& origin);

  // Keeps the motion that all others are compared with, before any of them.
  void add_reference(const ReferenceMotion& motion);
  // Makes the run once more, up to so many `seconds`, and keeps its motion. Throws Interrupted.
  // What can be seen at the ends of its steps alone takes more of them to end at the frames: such a
  // run has a frame for every fourth of the steps that it took on the chart, at most.
  void add(const ChosenRun& run, const Options& options, const Reference& reference,
           double seconds);
  // How many runs beside the reference, and how many bytes of files.
  std::size_t runs() const { return runs_; }
  double bytes() const { return bytes_; }
  // Lets the tables appear, and removes the motions of an earlier motions.csv that are not in it.
  void finish(const nlohmann::json& origin);

 private:
  // Writes the file of a motion that has a state at every so many-th frame, and its energies.
  // Returns its path in the folder.
  std::string write(const std::string& name, const std::vector<State>& states, std::size_t every,
                    bool is_reference);
  double largest_distance(const std::vector<State>& states, std::size_t every,
                          const Reference& reference) const;

  std::string folder_;
  const Scene& start_;
  const ReducedScene& scene_;
  std::vector<double> times_;
  std::vector<State> reference_;  // none where nobody knows it
  std::vector<std::string> earlier_, files_;
  command::CsvFile table_, energy_;
  nlohmann::json origin_;
  std::size_t runs_ = 0;
  double bytes_ = 0;
};

}  // namespace qddot::motions
