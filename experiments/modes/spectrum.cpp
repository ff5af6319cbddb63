#include "experiments/modes/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace qddot::modes {
namespace {

constexpr int most_printed = 10;

// Angular frequency [rad/s], or minus the rate of growth [1/s].
double omega(double square) { return std::copysign(std::sqrt(std::abs(square)), square); }

Vec damping_ratios(const Model& scene, const NaturalModes& modes) {
  Vec zeta = Vec::Constant(modes.squares.size(), std::numeric_limits<double>::quiet_NaN());
  for (Index j = 0; j < zeta.size(); ++j) {
    const double w = omega(modes.squares[j]);
    if (w > 0) {
      zeta[j] = damping_ratio(scene.system(), scene.initial().q, modes.shapes.col(j), w);
    }
  }
  return zeta;
}

}  // namespace

Spectrum::Spectrum(const Model& scene, Index count)
    : finite(finite_modes(scene.system())),
      signs(curvature_signs(scene.system(), scene.initial().q)) {
  const Vec& q = scene.initial().q;
  lowest = lowest_modes(scene.system(), q, 2 * count >= finite ? finite : count);
  highest = highest_modes(scene.system(), q, std::min(count, finite - lowest.squares.size()));
  for (Index rank = signs.negative; rank < std::min<Index>(signs.negative + signs.flat, finite);
       ++rank) {
    const Index high = rank - (finite - highest.squares.size());
    if (rank < lowest.squares.size()) lowest.squares[rank] = 0;
    if (high >= 0) highest.squares[high] = 0;
  }
  is_damped = scene.system().damping() != nullptr;
  lowest_zeta = damping_ratios(scene, lowest);
  highest_zeta = damping_ratios(scene, highest);
}

void print(const Spectrum& spectrum) {
  fmt::print("{:>6}  {:>14}  {:>14}{}\n", "mode", "omega in rad/s", "frequency in Hz",
             spectrum.is_damped ? "   damping ratio" : "");
  const auto row = [&](Index rank, double square, double zeta) {
    const double w = omega(square);
    const bool has_zeta = spectrum.is_damped && w > 0;
    fmt::print("{:>6}  {:>14.6g}  {:>14.6g}{}{}\n", rank, w, w / (2 * M_PI),
               has_zeta ? fmt::format("  {:>14.4g}", zeta) : "", w < 0 ? "  grows" : "");
  };
  const Vec &low = spectrum.lowest.squares, &high = spectrum.highest.squares;
  const Index shown = std::min<Index>(low.size(), most_printed);
  for (Index j = 0; j < shown; ++j) row(j + 1, low[j], spectrum.lowest_zeta[j]);
  if (shown < spectrum.finite) {
    fmt::print("{:>6}\n", "...");
    const bool has_high = high.size() > 0;
    const Vec& zeta = has_high ? spectrum.highest_zeta : spectrum.lowest_zeta;
    row(spectrum.finite, (has_high ? high : low).tail(1)[0], zeta.tail(1)[0]);
  }
}

std::vector<std::string> spectrum_header(const Model& scene) {
  std::vector<std::string> header = {"mode", "omega", "frequency_hz"};
  if (scene.system().damping()) header.push_back("zeta");
  return header;
}

void write_spectrum(CsvFile& csv, const Spectrum& spectrum) {
  const auto rows = [&](Index first_rank, const Vec& squares, const Vec& zeta) {
    for (Index j = 0; j < squares.size(); ++j) {
      const double w = omega(squares[j]);
      if (spectrum.is_damped) {
        csv.row(first_rank + j, w, w / (2 * M_PI), zeta[j]);
      } else {
        csv.row(first_rank + j, w, w / (2 * M_PI));
      }
    }
  };
  rows(1, spectrum.lowest.squares, spectrum.lowest_zeta);
  rows(spectrum.finite - spectrum.highest.squares.size() + 1, spectrum.highest.squares,
       spectrum.highest_zeta);
}

std::vector<std::string> shape_header(int dimension) {
  std::vector<std::string> header = {"mode", "node"};
  for (const char* kind : {"", "d"}) {
    for (int d = 0; d < dimension; ++d) header.push_back(fmt::format("{}{}", kind, "xyz"[d]));
  }
  return header;
}

void write_shapes(CsvFile& csv, const Model& scene, const Eigen::MatrixXd& shapes) {
  for (Index j = 0; j < shapes.cols(); ++j) {
    // A displacement goes through the reduction as a velocity does.
    const auto nodes = scene.expand({0, scene.initial().q, shapes.col(j)});
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      csv.field(j + 1);
      csv.field(i);
      for (int d = 0; d < scene.dimension(); ++d) csv.field(nodes[i].position[d]);
      for (int d = 0; d < scene.dimension(); ++d) csv.field(nodes[i].velocity[d]);
      csv.end_row();
    }
    csv.flush_if_large();
  }
}

}  // namespace qddot::modes
