#include "experiments/kit/point_notes.hpp"

#include <set>
#include <string>

#include <nlohmann/json.hpp>

#include "experiments/kit/method_options.hpp"

namespace qddot::inline kit {

nlohmann::json notes_on(const std::vector<Point>& points) {
  nlohmann::json methods = nlohmann::json::array();
  nlohmann::json outcomes = nlohmann::json::object();
  std::set<const Method*> noted;
  for (const Point& point : points) {
    const Method& method = *point.method;
    if (noted.insert(&method).second) {
      methods.push_back({{"name", method.name},
                         {"summary", method.summary},
                         {"takes", options_taken_by(method)}});
    }
    if (point.outcome != Outcome::reached_end)
      outcomes[std::string(name(point.outcome))] = advice(point.outcome);
  }
  return {{"methods", methods}, {"outcomes", outcomes}};
}

}  // namespace qddot::inline kit
