#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "experiments/kit/csv.hpp"
#include "experiments/motion_files/motion_file.hpp"
#include "experiments/motions/chosen_runs.hpp"
#include "experiments/motions/reference_motion.hpp"

namespace qddot::motions {

// The motions of one scene in a folder: motions/*.vtkhdf, and the tables motions.csv and
// motions_energy.csv. They are made beside their place, in motions.part/, and take that of earlier
// ones at the end, or never.
class KeptMotions {
 public:
  // Throws InvalidInput where the folder cannot be written. The scene must outlive it. `start` is
  // the drawn scene as its motion starts. `times` [s] are those of the frames, the start first.
  // `origin` records how each motion was made (see provenance.hpp).
  KeptMotions(const std::string& folder, const Scene& start, const Model& scene,
              std::vector<double> times, const nlohmann::json& origin);
  // Removes what has not appeared.
  ~KeptMotions();
  KeptMotions(const KeptMotions&) = delete;
  KeptMotions& operator=(const KeptMotions&) = delete;

  // Keeps the motion that all others are compared with, before any of them.
  void add_reference(const ReferenceMotion& motion);
  // Makes the run once more, up to so many `seconds`, and keeps its motion. Throws Interrupted.
  // Methods that can be seen only at the ends of steps take more steps to end at the frames. Such a
  // run has at most one frame for four of its steps on the chart.
  void add(const ChosenRun& run, const Options& options, const Reference& reference,
           double seconds);
  // How many runs beside the reference, and how many the folder had before; bytes of files.
  std::size_t runs() const { return runs_; }
  std::size_t earlier_runs() const { return earlier_runs_; }
  double bytes() const { return bytes_; }
  // Lets all appear, in the place of what an earlier motions.csv names. Throws CannotWrite.
  void finish(const nlohmann::json& origin);

 private:
  struct Written {
    std::string file;  // its path in the folder
    std::size_t frames = 0;
  };

  // Writes the file of a motion, which has a state at every `every`-th frame, and its energies.
  // Ends before the first state whose numbers the file cannot hold.
  Written write(const std::string& name, const std::vector<State>& states, std::size_t every,
                bool is_reference);
  // A sentence if the run ended elsewhere than on the chart, since its steps end at frames; else
  // empty.
  std::string difference(const Point& point, const State& end, const Reference& reference) const;
  double largest_distance(const std::vector<State>& states, std::size_t every,
                          const Reference& reference) const;

  std::string folder_;
  const Scene& start_;
  const Model& scene_;
  std::vector<double> times_;
  std::vector<State> reference_;  // none where nobody knows it
  std::vector<std::string> earlier_;
  std::size_t earlier_runs_;
  kit::CsvFile table_, energy_;
  nlohmann::json origin_;
  std::size_t runs_ = 0;
  double bytes_ = 0;
};

// The times [s] of the frames of a motion: 0 and the ends of `frames` equal parts of the time.
std::vector<double> frame_times(double until, int frames);
// The number of frames after the start that a motion of so many nodes has unless more are asked
// for.
int usual_number_of_frames(std::size_t nodes);

}  // namespace qddot::motions
