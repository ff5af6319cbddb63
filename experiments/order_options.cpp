#include "experiments/order_options.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "experiments/catalogue.hpp"
#include "integrators/registry.hpp"
#include "src/scene/invalid_input.hpp"

namespace qddot {
namespace {

void require_up_to(const CLI::App& app, const OrderChoice& orders, int highest) {
  if (app.count("--max-order") == 0 || (orders.max_order >= 1 && orders.max_order <= highest)) {
    return;
  }
  throw InvalidInput(fmt::format("--max-order {} is not allowed; it is a whole number from 1 to {}",
                                 orders.max_order, highest));
}

}  // namespace

void add_order_options(CLI::App& app, OrderChoice& orders) {
  app.add_option("--max-order", orders.max_order,
                 "the highest order that methods of variable order may take (default: their own)")
      ->take_last();
  app.add_flag("--stability-detection", orders.stability_detection,
               "let CVODE's BDF lower its order where it finds itself unstable");
}

void require_orders(const CLI::App& app, const OrderChoice& orders) {
  int highest = 0;
  for (const Method& method : methods()) {
    if (method.varies_order) highest = std::max(highest, method.order);
  }
  require_up_to(app, orders, highest);
}

void require_orders(const CLI::App& app, const OrderChoice& orders, const Method& method) {
  const auto require = [&](const char* option, bool Method::*has) {
    if (app.count(option) == 0 || method.*has) return;
    throw InvalidInput(
        fmt::format("{} is not for {}; it is for {}", option, method.name, names_where(has)));
  };
  require("--max-order", &Method::varies_order);
  require("--stability-detection", &Method::detects_instability);
  require_up_to(app, orders, method.order);
}

}  // namespace qddot
