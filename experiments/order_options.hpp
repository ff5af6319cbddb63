#pragma once

#include <CLI/CLI.hpp>

#include "experiments/measurement.hpp"

namespace qddot {

// Adds --max-order and --stability-detection.
void add_order_options(CLI::App& app, OrderChoice& orders);

// Throws InvalidInput unless the order is one that some method has, or that this one has.
void require_orders(const CLI::App& app, const OrderChoice& orders);
void require_orders(const CLI::App& app, const OrderChoice& orders, const Method& method);

}  // namespace qddot
