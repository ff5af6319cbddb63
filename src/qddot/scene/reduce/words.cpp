#include "qddot/scene/reduce/words.hpp"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace qddot::reduce {
namespace {

// "1 node", "2 nodes".
std::string counted(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

// The first few of a list of nodes, by their numbers.
std::string listed(const std::vector<std::size_t>& nodes) {
  constexpr std::size_t most = 8;
  const std::span shown(nodes.data(), std::min(most, nodes.size()));
  return fmt::format("{}{}", fmt::join(shown, ", "), nodes.size() > most ? ", ..." : "");
}

std::string vector(const Eigen::Vector3d& x, int dimension) {
  std::vector<std::string> numbers;
  // Adding zero turns -0 into 0.
  for (int d = 0; d < dimension; ++d) numbers.push_back(fmt::format("{:.4g}", x[d] + 0.0));
  return fmt::format("({})", fmt::join(numbers, ", "));
}

// "the plane y = 0.5", or by normal and point where it is askew.
std::string plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, int dimension) {
  constexpr std::array<const char*, 3> axes = {"x", "y", "z"};
  const char* kind = dimension == 3 ? "plane" : dimension == 2 ? "line" : "point";
  for (int d = 0; d < dimension; ++d) {
    if (std::abs(normal[d]) == 1) return fmt::format("{} {} = {:.6g}", kind, axes[d], point[d]);
  }
  return fmt::format("{} normal to {} through {}", kind, vector(normal, dimension),
                     vector(point, dimension));
}

std::string subspace(const Part& part, int dimension) {
  const Frame& frame = part.mirrors().frame;
  const Eigen::Vector3d point = part.origin() + frame.origin, normal = frame.axes.col(2);
  if (dimension == 3 && frame.dimension == 2) return plane(normal, point, dimension);
  const Eigen::Vector3d along = frame.axes.col(0);
  const Eigen::Vector3d across(-along.y(), along.x(), 0);
  if (dimension == 2 && across.lpNorm<Eigen::Infinity>() == 1) {
    return plane(across, point, dimension);
  }
  return fmt::format("line along {} through {}", vector(along, dimension),
                     vector(point, dimension));
}

}  // namespace

std::string pinned_sentence(std::size_t pins, std::size_t moving) {
  const std::string where = moving == 0      ? "where drawn"
                            : moving == pins ? "on curves of time"
                                             : fmt::format(
                                                   "where drawn or, {} of them, on curves "
                                                   "of time,",
                                                   moving);
  return fmt::format("{} stay{} {} and {} no unknowns", counted(pins, "pinned node"),
                     pins == 1 ? "s" : "", where, pins == 1 ? "has" : "have");
}

std::string merged_sentence(std::size_t gone, std::size_t left) {
  return fmt::format("{} without stiffness or beside another of the same rest length; {} left",
                     counted(gone, "spring"), left);
}

std::string condensed_sentence(const std::vector<std::size_t>& nodes, std::size_t series) {
  return fmt::format(
      "{} ({}) between springs in series, which are {}: exact while in tension, and the run ends "
      "where one goes slack",
      counted(nodes.size(), "massless node"), listed(nodes), counted(series, "spring"));
}

std::string flying_sentence(const std::vector<std::size_t>& nodes) {
  return fmt::format("{} on no spring ({}) move{} in closed form", counted(nodes.size(), "node"),
                     listed(nodes), nodes.size() == 1 ? "s" : "");
}

std::string falling_sentence(std::size_t falling, std::size_t resting, bool is_loaded) {
  std::vector<std::string> sentences;
  if (falling > 0) {
    const bool one = falling == 1;
    sentences.push_back(fmt::format(
        "{} without pins fall{} as a whole in closed form: gravity {} left out, and what is "
        "integrated is {} motion about {}",
        counted(falling, "part"), one ? "s" : "",
        is_loaded ? "and the acceleration by all loads together are" : "is", one ? "its" : "their",
        one ? "the centre of mass" : "the centres of mass"));
  }
  if (resting > 0) {
    const bool one = resting == 1;
    sentences.push_back(fmt::format(
        "{} without pins {} at rest about {}, every spring at its rest length, and {} no unknowns",
        counted(resting, "part"), one ? "is" : "are",
        one ? "its centre of mass" : "their centres of mass", one ? "has" : "have"));
  }
  return fmt::format("{}", fmt::join(sentences, "; "));
}

std::string parts_sentence(std::size_t parts) {
  return fmt::format("{} that no spring joins, each integrated by itself", counted(parts, "part"));
}

std::string mistaken_sentence(const std::string& difference) {
  return fmt::format(
      "left out of a part, where {}: a defect of qddot that changes no result, please report the "
      "scene",
      difference);
}

std::logic_error defect(const std::string& difference) {
  return std::logic_error(fmt::format(
      "a defect of qddot, please report the scene: with its reductions {} (--no-reduce leaves them "
      "out)",
      difference));
}

std::vector<Finding> findings_of(const std::vector<Part>& parts,
                                 const std::vector<std::unique_ptr<System>>& systems,
                                 int dimension) {
  std::vector<Finding> findings;
  const auto add = [&](Reduction reduction, const auto& is_found, const auto& sentence) {
    const auto count = static_cast<std::size_t>(std::ranges::count_if(parts, is_found));
    if (count == 0) return;
    const Part& first = *std::ranges::find_if(parts, is_found);
    std::string what = sentence(first);
    if (parts.size() > 1) what += fmt::format(" ({} of {} parts alike)", count, parts.size());
    findings.push_back({reduction, std::move(what)});
  };
  add(
      Reduction::dimension,
      [&](const Part& part) { return part.mirrors().frame.dimension < dimension; },
      [&](const Part& part) {
        const Frame& frame = part.mirrors().frame;
        return fmt::format(
            "{} lie in the {}: {} coordinate{} a node",
            part.fall().moves() ? "positions, and velocities about the centre of mass,"
            : part.is_loaded()  ? "positions, velocities, gravity and loads"
                                : "positions, velocities and gravity",
            subspace(part, dimension), frame.dimension, frame.dimension == 1 ? "" : "s");
      });
  add(
      Reduction::mirror, [](const Part& part) { return part.mirrors().count > 0; },
      [&](const Part& part) {
        const Mirrors& mirrors = part.mirrors();
        std::vector<std::string> planes;
        for (int d = 0; d < mirrors.count; ++d) {
          planes.push_back(
              plane(mirrors.frame.axes.col(d), part.origin() + mirrors.frame.origin, dimension));
        }
        return fmt::format(
            "{} is its own mirror image in the {}: {} of {} move freely",
            part.fall().moves() ? "the motion about the centre of mass" : "the scene",
            fmt::join(planes, " and the "), part.originals(), counted(part.nodes().size(), "node"));
      });
  const auto constant = static_cast<std::size_t>(
      std::ranges::count(systems, true, [](const auto& s) { return s->stiffness_is_constant(); }));
  if (constant > 0) {
    const bool by_line = std::ranges::any_of(parts, &Part::is_straightened);
    findings.push_back(
        {Reduction::constant_stiffness,
         fmt::format("K is the same everywhere{}, since {}",
                     constant == systems.size()
                         ? ""
                         : fmt::format(" in {} of {} parts", constant, systems.size()),
                     by_line ? "on a line its energy lets no spring turn over"
                             : "all rest lengths are zero")});
  }
  return findings;
}

}  // namespace qddot::reduce
