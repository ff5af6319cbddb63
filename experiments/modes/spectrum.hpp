#pragma once

#include <string>
#include <vector>

#include "experiments/kit/csv.hpp"
#include "qddot/analysis/curvature_signs.hpp"
#include "qddot/analysis/natural_modes.hpp"
#include "qddot/scene/model.hpp"

namespace qddot::modes {

// Both ends of the spectrum, by rank.
struct Spectrum {
  Index finite;
  CurvatureSigns signs;          // by rank: growing modes, then those hidden by rounding
  NaturalModes lowest, highest;  // of `count` modes each, if there are so many; highest: the others
  bool is_damped;
  // The damping ratios of the modes that vibrate, NaN for the others.
  Vec lowest_zeta, highest_zeta;

  Spectrum(const Model& scene, Index count);
};

// Prints the lowest modes and the highest one.
void print(const Spectrum& spectrum);
// The columns and rows of modes.csv: rank, angular frequency [rad/s], frequency [Hz] and, of a
// damped scene, the damping ratio.
std::vector<std::string> spectrum_header(const Model& scene);
void write_spectrum(CsvFile& csv, const Spectrum& spectrum);

// The columns and rows of shapes.csv: the positions of all nodes and, in each mode, their
// displacements.
std::vector<std::string> shape_header(int dimension);
void write_shapes(CsvFile& csv, const Model& scene, const Eigen::MatrixXd& shapes);

}  // namespace qddot::modes
